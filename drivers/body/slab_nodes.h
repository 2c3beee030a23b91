/* SPDX-License-Identifier: BSD-3-Clause */
/* Nodes of a slab, and their numbers in the whole. */
#ifndef DEM_SLAB_NODES_H
#define DEM_SLAB_NODES_H

#include <stdbool.h>

#include <dem/slab.h>

static inline bool slab_nodes_own(const dem_slab *slab, dem_index i)
{
    return i >= slab->first_own && i < slab->first_own + slab->n_own;
}

/* Where a node that is no own one is among those of the rim: those above the own ones come behind those below. */
static inline dem_index slab_nodes_rim(const dem_slab *slab, dem_index i)
{
    return i < slab->first_own ? i : i - slab->n_own;
}

static inline dem_index slab_nodes_number(const dem_slab *slab, dem_index i)
{
    return slab_nodes_own(slab, i) ? slab->first_node + i - slab->first_own : slab->rim[slab_nodes_rim(slab, i)];
}

/* Whether the lowest of the nodes of a spring or triangle is an own one, as it is in one slab of all that have it. The
 * nodes of a slab are in the order of their numbers. */
static inline bool slab_nodes_owns(const dem_slab *slab, const dem_index *corner, int arity)
{
    dem_index lowest = corner[0];
    for (int c = 1; c < arity; c++) lowest = corner[c] < lowest ? corner[c] : lowest;
    return slab_nodes_own(slab, lowest);
}

#endif
