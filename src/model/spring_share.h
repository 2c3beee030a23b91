/* SPDX-License-Identifier: BSD-3-Clause */
/* What triangles have given to a spring, by the rule of dem_lattice_assemble(): how they share it between them. */
#ifndef DEM_MODEL_SPRING_SHARE_H
#define DEM_MODEL_SPRING_SHARE_H

#include <dem/dem.h>

/** Thickness times area of a triangle at rest, m^3; without a list of thicknesses 1 m. */
double spring_share_volume(const dem_lattice *lattice, dem_index triangle);

/** modulus * thickness * area of a triangle at a spring, times the spring's weight (triangle_share.h) where the
 *  triangle is coupled. The share of a triangle is this over the sum of the same of all triangles of the spring. */
double spring_share_given(const dem_lattice *lattice, dem_index triangle, dem_index spring);

#endif
