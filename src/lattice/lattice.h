/* SPDX-License-Identifier: BSD-3-Clause */
/* What the files about lattices share. */
#ifndef DEM_LATTICE_LATTICE_H
#define DEM_LATTICE_LATTICE_H

#include <dem/dem.h>

/* Whether struct_size is one that this library knows, and springs and triangles stay inside the arrays: numbers >= 0,
 * arrays present, node indices in range. */
dem_status lattice_check(const dem_lattice *lattice);

/* Copies a caller's lattice, with its arrays, of which those that are missing are NULL. */
dem_status lattice_read(dem_lattice *ours, const dem_lattice *theirs);

/* Zeroed array of n items, never of no bytes; NULL without memory. */
void *lattice_zeros(dem_index n, size_t size);

#endif
