/* SPDX-License-Identifier: BSD-3-Clause */
/* The least angle of triangles: how sound they are. Its cotangent needs no inverse trigonometric function. */
#ifndef DEM_SHAPE_LEAST_ANGLE_H
#define DEM_SHAPE_LEAST_ANGLE_H

#include <dem/dem.h>

/* Cotangent of the least angle of a triangle, infinite if it is turned over.
 * \param x  [n_nodes][2] m, places of nodes
 * \param corner  [3] its nodes, counter-clockwise */
double least_angle_cotangent(const double *x, const dem_index *corner);

#endif
