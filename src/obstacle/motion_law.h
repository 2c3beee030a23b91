/* SPDX-License-Identifier: BSD-3-Clause */
/* How an obstacle moves: its pose as a function of time. What stands at rest is asked for nothing. Richer laws have
 * their place here; nothing else knows of more than poses. */
#ifndef DEM_OBSTACLE_MOTION_LAW_H
#define DEM_OBSTACLE_MOTION_LAW_H

#include <stdbool.h>

#include "obstacle/pose.h"

typedef struct motion_law {
    bool moves;    /* else the pose is that of the points as given, at all times */
    vec2 velocity; /* m/s, constant */
} motion_law;

/** That of an obstacle as it is given. */
motion_law motion_law_of(const dem_obstacle *obstacle);

/** At t = 0 it is that of the points as given. */
pose motion_law_pose(const motion_law *law, double t);

/** No point of the obstacle is faster, m/s. */
double motion_law_speed(const motion_law *law);

/** Whether two obstacles never move against each other. */
bool motion_law_is_same(const motion_law *a, const motion_law *b);

#endif
