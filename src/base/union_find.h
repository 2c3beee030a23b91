/* SPDX-License-Identifier: BSD-3-Clause */
/* Disjoint sets of 0 .. n - 1: each member points to one of its set that is not above it, and the lowest one, the root,
 * to itself. So roots do not depend on the order in which sets are united. */
#ifndef DEM_BASE_UNION_FIND_H
#define DEM_BASE_UNION_FIND_H

#include <dem/status.h>

/** All apart. */
static inline void union_find_start(dem_index *parent, dem_index n)
{
    for (dem_index i = 0; i < n; i++) parent[i] = i;
}

/** The lowest member of a set. Halves the path on the way, so that later searches are short. */
static inline dem_index union_find_root(dem_index *parent, dem_index i)
{
    while (parent[i] != i) {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    return i;
}

/** Makes the sets of two members one. */
static inline void union_find_unite(dem_index *parent, dem_index i, dem_index j)
{
    const dem_index a = union_find_root(parent, i), b = union_find_root(parent, j);
    if (a < b)
        parent[b] = a;
    else
        parent[a] = b;
}

#endif
