/* SPDX-License-Identifier: BSD-3-Clause */
/* Compiles all obstacles of a model into an obstacle_set. */
#ifndef DEM_OBSTACLE_OBSTACLE_SET_H
#define DEM_OBSTACLE_OBSTACLE_SET_H

#include "obstacle/obstacle.h"

/** Validates, copies and compiles; DEM_ERROR_MODEL names the obstacle and the segment. Free with obstacles_free. */
dem_status obstacles_compile(obstacle_set *out, const dem_obstacle *list, dem_index n);
void obstacles_free(obstacle_set *o);

#endif
