/* SPDX-License-Identifier: BSD-3-Clause */
#include "model/breakable_nodes.h"

#include <math.h>

#include "domain/common_nodes.h"

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

static void mark_elements(const dem_lattice *l, unsigned char *marked)
{
    for (dem_index e = 0; e < l->n_triangles + l->n_springs; e++)
        for (int c = 0; c < (e < l->n_triangles ? 3 : 2) && breakable_element(l, e); c++) marked[nodes_of(l, e)[c]] = 1;
}

void breakable_nodes_mark(const dem_lattice *l, unsigned char *marked)
{
    for (dem_index i = 0; i < l->n_nodes; i++) marked[i] = 0;
    if (!breakable_lattice(l)) return;
    mark_elements(l, marked);
    common_nodes_add_rings(l, 1, marked);
    for (dem_index i = 0; i < l->n_nodes; i++) marked[i] = marked[i] > 0;
}
