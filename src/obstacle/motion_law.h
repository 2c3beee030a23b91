/* SPDX-License-Identifier: BSD-3-Clause */
/* How an obstacle moves: its pose as a function of time, the sum of the kinds of motion that it has. For an obstacle at
 * rest no pose is computed. Other files know poses and their bounds only, not the kinds. */
#ifndef DEM_OBSTACLE_MOTION_LAW_H
#define DEM_OBSTACLE_MOTION_LAW_H

#include <stdbool.h>

#include "obstacle/motion_kind.h"

/** DEM_ERROR_MODEL names obstacle o and the field of its motion that is not finite or too large. */
dem_status motion_law_check(const dem_obstacle *obstacle, dem_index o);

/** The law of an obstacle as it is given and checked, which must stay where it is. */
motion_law motion_law_of(const dem_obstacle *obstacle);

/** Asks the caller's function, if there is one, for the pose at t = 0, which the law keeps.
 *  \return DEM_ERROR_MODEL with obstacle o if it gives none */
dem_status motion_law_ask_start(motion_law *law, dem_index o);

/** The pose at t. The points are given where they are at t = 0; those of an oscillation in its middle. */
pose motion_law_pose(const motion_law *law, double t);

/* Bounds over all time; 0 at rest. */
motion_bounds motion_law_bounds(const motion_law *law);

/** Bounds that hold for both of two obstacles. */
static inline motion_bounds motion_bounds_of_both(motion_bounds a, motion_bounds b)
{
    return (motion_bounds){fmax(a.speed, b.speed), fmax(a.acceleration, b.acceleration),
                           fmax(a.step_rate, b.step_rate)};
}

/** Whether two obstacles are at rest relative to each other at all times. */
bool motion_law_is_same(const motion_law *a, const motion_law *b);

#endif
