/* SPDX-License-Identifier: BSD-3-Clause */
/* Moving a body along gravity to a given distance from the obstacles. */
#ifndef DEM_CLEARANCE_H
#define DEM_CLEARANCE_H

#include <stdbool.h>

#include <dem/dem.h>

/* The shift along `gravity` (not 0) after which the smallest dem_model_gap() of the nodes that may touch, where their
 * motion starts, is `clearance`. A body nearer than that or inside an obstacle goes back to the first place free
 * of it; from there, or from where it is, it goes on until it is as near as that for the first time.
 * Returns false if no obstacle lies in its way. */
bool clearance_shift(double shift[2], const dem_model *model, const double gravity[2], double clearance);

#endif
