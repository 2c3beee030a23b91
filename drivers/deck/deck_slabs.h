/* SPDX-License-Identifier: BSD-3-Clause */
/* Decks whose one body ranks make in slabs, each its own, so that nobody has the whole of it. What the deck says of
 * that body is found slab by slab; where anything is unusual the whole is built instead (deck.h). */
#ifndef DEM_DECK_SLABS_H
#define DEM_DECK_SLABS_H

#include "body.h"
#include "lattice_facts.h"

/* Whether the keys ask for nothing that takes the whole: a single elastic body with stepped edges, without cracks,
 * loads and rest. */
bool deck_slabs_suit(const schema_deck *groups);

/* What makes of a slab, besides the keys, what it is in the whole. */
typedef struct slab_place {
    double centre[2]; /* m, of the mass of the body where its keys put it, about which it spins */
    double shift[2];  /* m, of the body to its clearance */
} slab_place;

typedef struct deck_slabs {
    dem_index n;       /* slabs in which the body is looked at, if the deck suits; 0: it is built as a whole */
    bool are_made;     /* its lattice is made in slabs, and the deck has none; */
    dem_index n_nodes; /* that the body has then */
    slab_place place;
} deck_slabs;

/* What would be found of the whole. */
typedef struct deck_slabs_found {
    dem_lattice strip; /* in its place */
    body_facts body;
    lattice_facts lattice;
    body_start start;
} deck_slabs_found;

/* Looks at the body slab by slab. Where slabs->are_made is false afterwards nothing has been found; else the caller
 * owns it. False when memory runs out. */
bool deck_slabs_look(deck_slabs_found *out, deck_slabs *slabs, const body_scene *scene);

/* Shows each slab as its rank will make it, in their order; what fails here does not fail on the ranks but for memory.
 * \return what `visit` does */
typedef dem_status deck_slabs_visitor(void *visitor, const dem_slab *slab);
dem_status deck_slabs_each(const deck_slabs *slabs, const schema_deck *groups, deck_slabs_visitor *visit,
                           void *visitor);

/* What rank 0 sends to the others: bytes, malloc'ed; NULL when memory runs out.
 * \param echo  the resolved deck */
void *deck_slabs_recipe(size_t *size, const deck_slabs *slabs, const char *echo);

/* Makes a slab by the bytes of a recipe, as dem_private_slab_maker (base/slab_recipe.h). */
dem_status deck_slabs_make(void *program, const void *bytes, size_t size, dem_index part, dem_index n_parts,
                           dem_slab *out);

#endif
