/* SPDX-License-Identifier: BSD-3-Clause */
/* The least angle of triangles: how sound they are. Its cotangent needs no inverse trigonometric function. */
#ifndef DEM_LEAST_ANGLE_H
#define DEM_LEAST_ANGLE_H

#include <dem/dem.h>

/* Cotangent of the least angle of a triangle, infinite if it is turned over.
 * \param x  [n_nodes][2] m, places of nodes
 * \param corner  [3] its nodes, counter-clockwise */
double least_angle_cotangent(const double *x, const dem_index *corner);

/* Of all triangles, degrees; 0 if one is turned over. Without triangles it is 90. */
double least_angle_of(const dem_lattice *lattice);

#endif
