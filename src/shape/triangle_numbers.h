/* SPDX-License-Identifier: BSD-3-Clause */
/* The numbers that triangles have before anything is cut: they stay with those that are kept. */
#ifndef DEM_SHAPE_TRIANGLE_NUMBERS_H
#define DEM_SHAPE_TRIANGLE_NUMBERS_H

#include "base/status.h"
#include "lattice/lattice.h"

/* Triangles have no strength yet; what is written there goes along with those that stay. Doubles hold the numbers
 * exactly. */
static inline dem_status triangle_numbers_add(dem_lattice *lattice)
{
    lattice->strength = lattice_zeros(lattice->n_triangles, sizeof *lattice->strength);
    CHECK_MEMORY(lattice->strength);
    for (dem_index t = 0; t < lattice->n_triangles; t++) lattice->strength[t] = (double)t;
    return DEM_OK;
}

#endif
