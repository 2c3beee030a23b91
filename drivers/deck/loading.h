/* SPDX-License-Identifier: BSD-3-Clause */
/* What the groups &boundary mean: which nodes, and what is done to them. */
#ifndef DEM_LOADING_H
#define DEM_LOADING_H

#include <dem/dem.h>
#include <dem/slab.h>

#include "placement.h"
#include "schema.h"

/* Faults that can be found without geometry. */
void loading_check_all(const schema_deck *groups, namelist_errors *errors);

/* Takes the defaults of keys away that a group does not use. */
void loading_drop_unused(schema_deck *groups);

/* What is found of boundaries in a lattice, or in one slab of it after the other. */
typedef struct loading_target loading_target;
typedef struct loading_search {
    const schema_deck *groups;
    loading_target *targets; /* [n] */
    size_t n;                /* &boundary groups */
} loading_search;

/* Returns false only when memory runs out. In any case the search is to be freed with loading_forget().
 * \param bodies    [number of &body] with numbers of the whole; kept
 * \param outline   a lattice that has the outermost nodes of each body and its shortest spring, as the whole or its
 *                  boundary strip
 * \param outlines  [number of &body] with the numbers that it has */
bool loading_begin(loading_search *out, const schema_deck *groups, const placement *bodies, const dem_lattice *outline,
                   const placement *outlines);

/* Looks at a slab with masses, where its nodes are in the end; slabs come in their order. A whole lattice is a slab of
 * own nodes. Returns false only when memory runs out. */
bool loading_look(loading_search *s, const dem_slab *slab);

/* Makes the boundaries, in the order of the deck. Faults are appended to `errors`. Returns false only when memory runs
 * out. Free with loading_free in any case.
 * \param[out] list  [number of &boundary]
 * \param whole      the numbers of all nodes, and where they are, for messages; no places: they have none */
bool loading_end(dem_boundary **list, dem_index *n, loading_search *s, const dem_slab *whole, namelist_errors *errors);
void loading_forget(loading_search *s);

/* Takes nodes with prescribed motion from contact. Returns false when memory runs out. */
bool loading_hold(dem_lattice *lattice, const dem_boundary *list, dem_index n);

/* The force that group k, a traction on a side of a rectangle, asks for, N: over the side of the true shape, where the
 * lattice may be shorter. False for other groups, and where there is no such group. */
bool loading_asked(double force[2], const schema_deck *groups, size_t k);

void loading_free(dem_boundary *list, dem_index n);

#endif
