/* SPDX-License-Identifier: BSD-3-Clause */
/* What the files about lattices share. */
#ifndef DEM_LATTICE_LATTICE_H
#define DEM_LATTICE_LATTICE_H

#include <dem/dem.h>

/* Whether springs and triangles stay inside the arrays: numbers >= 0, arrays present, node indices in range. */
dem_status lattice_check(const dem_lattice *lattice);

/* Zeroed array of n items, never of no bytes; NULL without memory. */
void *lattice_zeros(dem_index n, size_t size);

#endif
