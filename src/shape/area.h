/* SPDX-License-Identifier: BSD-3-Clause */
/* True areas of shapes, to hold the masses of lattices against. */
#ifndef DEM_SHAPE_AREA_H
#define DEM_SHAPE_AREA_H

#include "shape/shape.h"

/* Area of the material, m^2: exact to rounding where all edges are straight, to 1e-4 of the body for others; voids may
 * overlap. Takes time of order voids^2. Returns a number below 0 when memory runs out. */
double area_of(const shape *s);

#endif
