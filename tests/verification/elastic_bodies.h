/* SPDX-License-Identifier: BSD-3-Clause */
/* Discs of irregular triangles. */
#ifndef DEM_TEST_ELASTIC_BODIES_H
#define DEM_TEST_ELASTIC_BODIES_H

#include <dem/dem.h>

/** A disc of n rings about a node, ring k of 6 k nodes at the radius k: triangles of 45 to 88 degrees, of sixfold
 *  symmetry. Not assembled; free with dem_lattice_free. */
void elastic_bodies_rings(dem_lattice *out, dem_index n);

/** The Delaunay triangulation of a disc of radius 1: `rim` nodes on the circle, `inside` more at random in it, no two
 *  nearer than 0.4 of their mean distance. Not assembled; free with dem_lattice_free. */
void elastic_bodies_delaunay(dem_lattice *out, dem_index rim, dem_index inside, unsigned long seed);

#endif
