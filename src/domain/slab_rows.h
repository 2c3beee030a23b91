/* SPDX-License-Identifier: BSD-3-Clause */
/* A whole lattice that is on no rank: each has a slab of it (dem/slab.h), and gives others rows of its own nodes. The
 * row of a node is what the arrays of a lattice have of it, the springs and triangles of which it is the lowest node,
 * and the numbers of all nodes next to it. A spring or triangle is *owned* with its lowest node; owned ones are
 * numbered slab by slab in the order that they have there. */
#ifndef DEM_DOMAIN_SLAB_ROWS_H
#define DEM_DOMAIN_SLAB_ROWS_H

#include "base/bundle.h"
#include "lattice/lattice_arrays.h"
#include "lattice/node_rows.h"

typedef struct slab_rows {
    const ranks *ranks;
    dem_lattice *lattice;             /* of the slab, borrowed */
    dem_index first_own;              /* of the slab's nodes, the first own one */
    const dem_index *rim;             /* numbers in the whole of those that are not own, borrowed */
    dem_index *first;                 /* [ranks + 1] the number of the first own node of each rank, and behind all */
    dem_index n[LATTICE_ITEMS];       /* of the whole */
    dem_index *number[LATTICE_ITEMS]; /* [springs], [triangles] in the whole; -1: owned by another rank. Not of nodes */
    node_rows springs, triangles;     /* at each node */
    uint32_t arrays;                  /* bit k: lattice_arrays[k] is in rows */
} slab_rows;

/** Finds the places of all slabs. Borrows ranks and the lattice of the slab, of which flags, bodies and velocities are
 *  filled. Arrays that assembling leaves out where all would be 0 are made where only other slabs have them.
 *  Collective. Free with slab_rows_free(), after a failure, too.
 *  \return DEM_ERROR_ARGUMENT where slabs do not follow each other, rank by rank, or do not have the same arrays
 *          besides; DEM_ERROR_MEMORY */
dem_status slab_rows_create(slab_rows *out, const ranks *r, dem_slab *slab);
void slab_rows_free(slab_rows *s);

/** The rank that owns node `number` of the whole. */
int slab_rows_owner(const slab_rows *s, dem_index number);

/** The number in the whole of node i of the slab of this rank. */
dem_index slab_rows_number(const slab_rows *s, dem_index i);

/** Whether this rank owns node i of its slab. */
bool slab_rows_owns(const slab_rows *s, dem_index i);

/** Whether array k of lattice_arrays is in rows. */
static inline bool slab_rows_has(const slab_rows *s, int k)
{
    return (s->arrays >> k & 1) != 0;
}

/** Appends how many nodes are next to own node `number`, and their numbers, to a bundle.
 *  \return false without memory */
bool slab_rows_pack_next(const slab_rows *s, dem_index number, bundle *to);

/** Appends the row of own node `number`: its number, how many springs and triangles it owns; the nodes next to it, as
 *  slab_rows_pack_next(); its items of all arrays; of each spring its number, its ends, and its items of all other
 *  arrays; likewise of triangles.  \return false without memory */
bool slab_rows_pack(const slab_rows *s, dem_index number, bundle *to);

#endif
