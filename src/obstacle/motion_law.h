/* SPDX-License-Identifier: BSD-3-Clause */
/* How an obstacle moves: its pose as a function of time, the sum of the kinds of motion that it has. For an obstacle at
 * rest no pose is computed. Other files know poses and their bounds only, not the kinds. */
#ifndef DEM_OBSTACLE_MOTION_LAW_H
#define DEM_OBSTACLE_MOTION_LAW_H

#include <stdbool.h>

#include "obstacle/motion_kind.h"

typedef struct motion_law {
    bool moves;             /* else the pose is that of the points as given, at all times */
    unsigned kinds;         /* bit k is set: it moves by kind k */
    const dem_obstacle *of; /* which has to stay */
} motion_law;

/** DEM_ERROR_MODEL names obstacle o and what of its motion cannot be computed with. */
dem_status motion_law_check(const dem_obstacle *obstacle, dem_index o);

/** That of an obstacle as it is given. */
motion_law motion_law_of(const dem_obstacle *obstacle);

/** At t = 0 it is that of the points as given. */
pose motion_law_pose(const motion_law *law, double t);

motion_bounds motion_law_bounds(const motion_law *law);

/** What neither of two exceeds. */
static inline motion_bounds motion_bounds_of_both(motion_bounds a, motion_bounds b)
{
    return (motion_bounds){fmax(a.speed, b.speed), fmax(a.acceleration, b.acceleration), fmax(a.rate, b.rate)};
}

/** Whether two obstacles never move against each other. */
bool motion_law_is_same(const motion_law *a, const motion_law *b);

#endif
