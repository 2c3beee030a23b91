/* SPDX-License-Identifier: BSD-3-Clause */
/* The area of all triangles of a lattice, m^2, by their corners. */
#ifndef DEM_HARNESS_LATTICE_AREA_H
#define DEM_HARNESS_LATTICE_AREA_H

#include <dem/lattice.h>

static inline double lattice_area(const dem_lattice *l)
{
    double area = 0.0;
    for (dem_index t = 0; t < l->n_triangles; t++) {
        const dem_index *n = l->triangles + 3 * t;
        const double *a = l->x + 2 * n[0], *b = l->x + 2 * n[1], *c = l->x + 2 * n[2];
        area += 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
    }
    return area;
}

#endif
