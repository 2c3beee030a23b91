/* SPDX-License-Identifier: BSD-3-Clause */
/* A kind of motion: what a function of the caller says. It may fail in the middle of a step, which cannot be left
 * half-way: the obstacle then counts as at rest where its points are given, until the time loop has asked. */
#ifndef DEM_OBSTACLE_GIVEN_MOTION_H
#define DEM_OBSTACLE_GIVEN_MOTION_H

#include "obstacle/motion_kind.h"

extern const motion_kind given_motion;

/** How far the point furthest from the origin is, m. */
double given_motion_reach(const dem_obstacle *obstacle);

/** Whether a pose that the caller's function gave in this thread was a failure. */
bool given_motion_failed(void);

/** The status and message of that failure, which is over then. */
dem_status given_motion_failure(void);

#endif
