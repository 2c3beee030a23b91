/* SPDX-License-Identifier: BSD-3-Clause */
/* Meshes without rows: Delaunay's triangles of points at random. */
#ifndef DEM_TEST_UNSTRUCTURED_H
#define DEM_TEST_UNSTRUCTURED_H

#include <dem/dem.h>

/** Moves the inner nodes of a triangulation, which is not yet assembled, until nothing of its rows is left, and spaces
 *  them evenly again. Its outline stays. */
void unstructured_make(dem_lattice *l, double spacing, uint64_t seed);

#endif
