/* SPDX-License-Identifier: BSD-3-Clause */
/* Rectangles of rubber for the tests of lattices. */
#ifndef DEM_TEST_SOLIDS_H
#define DEM_TEST_SOLIDS_H

#include "unit/close.h"

#include <dem/dem.h>

static const dem_material rubber = {.struct_size = sizeof(dem_material),
                                    .youngs_modulus = 1e7,
                                    .poissons_ratio = 1.0 / 3.0,
                                    .density = 1050.0,
                                    .thickness = 0.5,
                                    .guard = 0.02};

static inline dem_lattice make_rectangle(double width, double height, double step)
{
    dem_lattice lattice = dem_lattice_empty();
    assert_int_equal(dem_lattice_rectangle(&lattice, width, height, step), DEM_OK);
    return lattice;
}

static inline dem_lattice make_solid(double width, double height, double step)
{
    dem_lattice lattice = make_rectangle(width, height, step);
    assert_int_equal(dem_lattice_assemble(&lattice, &rubber), DEM_OK);
    return lattice;
}

static inline double area_of(const dem_lattice *lattice, dem_index t)
{
    const dem_index *corner = lattice->triangles + 3 * t;
    const double *a = lattice->x + 2 * corner[0], *b = lattice->x + 2 * corner[1], *c = lattice->x + 2 * corner[2];
    return 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
}

#endif
