/* SPDX-License-Identifier: BSD-3-Clause */
/* Contact pairs as evaluations of all of them read them: a record of half the size, and their nodes numbered by
 * themselves, so that the positions and forces of these nodes lie side by side. The places of nodes are in the order in
 * which pairs come to them, and have no part in any result. */
#ifndef DEM_SURFACE_CONTACT_COMPACT_PAIRS_H
#define DEM_SURFACE_CONTACT_COMPACT_PAIRS_H

#include "surface_contact/contact_pair.h"

typedef struct compact_pair {
    unsigned rows[CONTACT_PAIR_PUSHED]; /* where the vectors of its nodes begin in x and force */
    bool is_plain;            /* its edge and the first end alone push: it fills nothing, nor ends_at_second */
    double thickness, weight; /* as contact_pair */
} compact_pair;

typedef struct compact_pairs {
    const contact_pair *list; /* [n] borrowed */
    dem_index n, capacity;
    dem_index n_fillings; /* pairs that fill a crack */
    compact_pair *pairs;  /* [n] in the order of the list */
    dem_index n_nodes;
    dem_index *nodes;   /* [n_nodes] the node at each place, of n_all */
    double *x;          /* [n_nodes][2] m, positions in the state in hand, of the nodes of pairs; and */
    double *force;      /* [n_nodes][2] N, what acts there so far */
    unsigned *place_of; /* [n_all] 1 + the place of a node; 0: it has none */
} compact_pairs;

/** None, of a lattice of n_all nodes. Free with compact_pairs_destroy().  \return DEM_ERROR_MEMORY */
dem_status compact_pairs_create(compact_pairs *out, dem_index n_all);
void compact_pairs_destroy(compact_pairs *c);

/** Removes all pairs and nodes. */
void compact_pairs_clear(compact_pairs *c);

/** Takes the pairs of a list in the place of those it had; nothing acts on their nodes. Borrows the list.
 *  \return DEM_ERROR_MEMORY, DEM_ERROR_MODEL if they are too many to count; there are none then */
dem_status compact_pairs_take(compact_pairs *c, const contact_pair *list, dem_index n);

/** Reads the positions of the nodes out of x [n_all][2]. */
void compact_pairs_read(compact_pairs *c, const double *x);

/** Sets all forces to 0. */
void compact_pairs_clear_forces(compact_pairs *c);

/** Where the vectors of a node begin, which gets a place if it has none. */
unsigned compact_pairs_row(compact_pairs *c, dem_index node);

#endif
