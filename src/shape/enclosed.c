/* SPDX-License-Identifier: BSD-3-Clause */
/* What of a lattice lies in a figure: triangles by their centres, springs by their middles. */
#include <dem/shape.h>

#include "base/status.h"
#include "lattice/lattice.h"
#include "shape/outline_input.h"

typedef struct extent {
    dem_index n, arity, step; /* number of elements, of the nodes of each, of elements that are marked together */
} extent;

/* The mean of n nodes. */
static void find_centre(double centre[2], const dem_lattice *lattice, const dem_index *nodes, dem_index n)
{
    centre[0] = centre[1] = 0.0;
    for (dem_index c = 0; c < 2 * n; c++) centre[c % 2] += lattice->x[2 * nodes[c / 2] + c % 2] / (double)n;
}

/* Elements of `arity` nodes each, `step` of them at a time. */
static void mark(bool *flags, const dem_lattice *lattice, const outline *o, const dem_index *nodes, const extent *e)
{
    for (dem_index k = 0; k < e->n && flags != NULL; k += e->step) {
        double centre[2];
        find_centre(centre, lattice, nodes + e->arity * k, e->arity * e->step);
        const bool inside = outline_distance(o, centre[0], centre[1]) <= 0.0;
        for (dem_index i = k; i < k + e->step; i++) flags[i] = inside;
    }
}

dem_status dem_lattice_inside(const dem_lattice *lattice, const dem_outline *figure, dem_index step, bool *triangles,
                              bool *springs)
{
    outline o;
    TRY(lattice_check(lattice));
    CHECK(step == 1 || step == 2, DEM_ERROR_ARGUMENT, "step must be 1 or 2, got %lld", (long long)step);
    CHECK(triangles == NULL || lattice->n_triangles % step == 0, DEM_ERROR_ARGUMENT,
          "cells are of two triangles, but there are %lld triangles", (long long)lattice->n_triangles);
    TRY(outline_input_read(&o, figure));
    mark(triangles, lattice, &o, lattice->triangles, &(extent){lattice->n_triangles, 3, step});
    mark(springs, lattice, &o, lattice->ends, &(extent){lattice->n_springs, 2, 1});
    outline_free(&o);
    return DEM_OK;
}
