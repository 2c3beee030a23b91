/* SPDX-License-Identifier: BSD-3-Clause */
/* Pairs of nodes that are next to each other: a spring joins them or a triangle has both. Then the force on one may
 * depend on the other. */
#ifndef DEM_DOMAIN_ADJACENCY_H
#define DEM_DOMAIN_ADJACENCY_H

#include <dem/dem.h>

/** How many pairs there are; some come more than once. */
static inline dem_index adjacency_pairs(const dem_lattice *l)
{
    return l->n_springs + 3 * l->n_triangles;
}

/** The nodes of pair k. */
static inline void adjacency_pair(const dem_lattice *l, dem_index k, dem_index pair[2])
{
    const dem_index side = k - l->n_springs, next = side / 3 * 3 + (side + 1) % 3;
    pair[0] = side < 0 ? l->ends[2 * k] : l->triangles[side];
    pair[1] = side < 0 ? l->ends[2 * k + 1] : l->triangles[next];
}

#endif
