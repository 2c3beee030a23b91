/* SPDX-License-Identifier: BSD-3-Clause */
/* Where the edges of two outlines cross, as where a void opens a side of its body. */
#ifndef DEM_SHAPE_CROSSINGS_H
#define DEM_SHAPE_CROSSINGS_H

#include "shape/outline.h"

/* Called for every crossing, m. */
typedef void (*crossings_take)(void *context, const double x[2]);

/* Finds the points that both edges have, by pairs of their sides and circles. Where they only touch, or run along each
 * other, rounding decides. */
void crossings_find(const outline *a, const outline *b, crossings_take take, void *context);

#endif
