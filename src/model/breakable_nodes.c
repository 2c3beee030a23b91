/* SPDX-License-Identifier: BSD-3-Clause */
#include "model/breakable_nodes.h"

#include <math.h>
#include <stdlib.h>

#include "base/status.h"
#include "base/union_find.h"
#include "domain/adjacency.h"
#include "lattice/lattice.h"

static const dem_index *nodes_of(const dem_lattice *l, dem_index element)
{
    return element < l->n_triangles ? &l->triangles[3 * element] : &l->ends[2 * (element - l->n_triangles)];
}

bool breakable_element(const dem_lattice *l, dem_index element)
{
    const dem_index spring = element - l->n_triangles;
    const double *limits = spring >= 0 ? l->critical_stretch : l->strength;
    return limits != NULL && isfinite(limits[spring >= 0 ? spring : element]) &&
           !(l->flags[*nodes_of(l, element)] & DEM_NODE_RIGID);
}

/* `part` has the lowest node of the part of each that springs and triangles join; nodes of an element are of one. */
static void mark_parts(const dem_lattice *l, dem_index *part, unsigned char *marked)
{
    for (dem_index e = 0; e < l->n_triangles + l->n_springs; e++)
        if (breakable_element(l, e)) marked[union_find_root(part, *nodes_of(l, e))] = 1;
    for (dem_index i = 0; i < l->n_nodes; i++) marked[i] = marked[union_find_root(part, i)];
}

dem_status breakable_nodes_mark(const dem_lattice *l, unsigned char *marked)
{
    for (dem_index i = 0; i < l->n_nodes; i++) marked[i] = 0;
    if (!breakable_lattice(l)) return DEM_OK;
    dem_index *part = lattice_zeros(l->n_nodes, sizeof *part), pair[2];
    CHECK_MEMORY(part);
    union_find_start(part, l->n_nodes);
    for (dem_index k = 0; k < adjacency_pairs(l); k++) {
        adjacency_pair(l, k, pair);
        union_find_unite(part, pair[0], pair[1]);
    }
    mark_parts(l, part, marked);
    free(part);
    return DEM_OK;
}
