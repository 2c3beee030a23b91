/* SPDX-License-Identifier: BSD-3-Clause */
/* Decks whose bodies ranks make in slabs, each its own, so that nobody has the whole of them. What the deck says of
 * these bodies is found slab by slab; where anything is unusual the whole is built instead (deck.h). */
#ifndef DEM_DECK_SLABS_H
#define DEM_DECK_SLABS_H

#include "base/slab_recipe.h"
#include "body.h"
#include "lattice_facts.h"

/* Whether the keys ask for nothing that takes the whole: elastic bodies that are no meshes; lattice files are
 * looked at later. */
bool deck_slabs_suit(const schema_deck *groups);

/* What makes of slabs of a body, or of one of its copies, besides the keys, what they are in the whole. */
typedef struct slab_body {
    dem_index n_nodes, n_triangles; /* of one copy */
    double centre[2];               /* m, of its mass where its keys put it, about which it spins */
    double shift[2];                /* m, from there to its clearance */
} slab_body;

typedef struct deck_slabs {
    dem_index n;       /* slabs that ranks make, if the deck suits; 0: bodies are built as a whole */
    dem_index least;   /* nodes of slabs in which lattice files are looked at, if these have so many: a piece of a file
                          is unpacked for each slab that has some of it */
    bool are_made;     /* their lattice is made in slabs, and the deck has none */
    slab_body *bodies; /* [n_bodies] owned, one for each &body group */
    dem_index **rows;  /* [n_bodies] owned, as body_keys has them */
    size_t n_bodies;
    dem_index *held; /* [n_held] owned: nodes with prescribed motion, which may not touch */
    dem_index n_held;
} deck_slabs;

void deck_slabs_free(deck_slabs *slabs);

/* Holds the nodes of n boundaries that prescribe their motion. False when memory runs out. */
bool deck_slabs_hold(deck_slabs *slabs, const dem_boundary *list, dem_index n);

/* Nodes of the first n bodies, with all of their copies. */
dem_index deck_slabs_nodes(const schema_deck *groups, const slab_body *bodies, size_t n);

/* What would be found of the whole. */
typedef struct deck_slabs_found {
    size_t n;
    dem_lattice *strips;   /* [n] of each body, as body_place_strip() takes it */
    body_facts *bodies;    /* [n] */
    lattice_facts lattice; /* without box */
    bool at_once;          /* one look at each slab was enough */
} deck_slabs_found;

/* Looks at the bodies slab by slab, by groups and folder of the scene, and sets slabs->are_made where nothing is
 * unusual; shifts of bodies are the caller's to set. False when memory runs out. Free with deck_slabs_forget() in any
 * case. */
bool deck_slabs_look(deck_slabs_found *out, deck_slabs *slabs, const body_scene *scene);
void deck_slabs_forget(deck_slabs_found *found);

/* Shows each slab as its rank will make it, in their order.
 * \return what `visit` does; DEM_ERROR_MEMORY; DEM_ERROR_MODEL if a rank would have no nodes */
typedef dem_status deck_slabs_visitor(void *visitor, const dem_slab *slab);
dem_status deck_slabs_each(const deck_slabs *slabs, const body_scene *scene, deck_slabs_visitor *visit, void *visitor);

/* What rank 0 sends to the others: bytes, malloc'ed; NULL when memory runs out.
 * \param echo  the resolved deck */
void *deck_slabs_recipe(size_t *size, const deck_slabs *slabs, const char *echo);

/* Makes a slab by the bytes of a recipe, as dem_private_slab_maker (base/slab_recipe.h). */
dem_status deck_slabs_make(void *program, const void *bytes, size_t size, const slab_share *which, dem_slab *out);

#endif
