/* SPDX-License-Identifier: BSD-3-Clause */
#include "enclosed.h"

/* The mean of n nodes. */
static void find_centre(double centre[2], const dem_lattice *lattice, const dem_index *nodes, dem_index n)
{
    centre[0] = centre[1] = 0.0;
    for (dem_index c = 0; c < 2 * n; c++) centre[c % 2] += lattice->x[2 * nodes[c / 2] + c % 2] / (double)n;
}

dem_index enclosed_triangles(dem_index *of, const dem_lattice *lattice, const outline *o, dem_index value,
                             dem_index step)
{
    dem_index n = 0;
    for (dem_index t = 0; t < lattice->n_triangles; t += step) {
        double centre[2];
        find_centre(centre, lattice, lattice->triangles + 3 * t, 3 * step);
        if (outline_distance(o, centre[0], centre[1]) > 0.0) continue;
        for (dem_index i = t; i < t + step; i++) of[i] = value;
        n += step;
    }
    return n;
}

void enclosed_springs(bool *springs, const dem_lattice *lattice, const outline *o)
{
    for (dem_index k = 0; k < lattice->n_springs; k++) {
        double centre[2];
        find_centre(centre, lattice, lattice->ends + 2 * k, 2);
        if (outline_distance(o, centre[0], centre[1]) <= 0.0) springs[k] = true;
    }
}
