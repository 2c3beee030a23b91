/* SPDX-License-Identifier: BSD-3-Clause */
/* The interface of a kind of motion of obstacles. Each kind has a file; motion_law.c lists them, and adds up those that
 * an obstacle has. */
#ifndef DEM_OBSTACLE_MOTION_KIND_H
#define DEM_OBSTACLE_MOTION_KIND_H

#include <stdbool.h>
#include <stddef.h>

#include "obstacle/pose.h"

/** Bounds that no point of an obstacle exceeds at any time. */
typedef struct motion_bounds {
    double speed, acceleration; /* m/s, m/s^2; not finite if the motion cannot be computed with */
    double step_rate;           /* 1/s: the motion wants that many steps in a second at least */
} motion_bounds;

/** The motion of one obstacle. */
typedef struct motion_law {
    bool moves;             /* else the pose is that of the points as given, at all times */
    unsigned kinds;         /* bit k is set: it moves by kind k */
    const dem_obstacle *of; /* which has to stay */
    double reach;           /* m, of a motion by a function: of the point furthest from the origin; else 0 */
    bool has_start;         /* whether `start` is known: of a motion by a function, so that it is asked only once */
    pose start;             /* at t = 0 */
} motion_law;

typedef struct motion_kind {
    const dem_motion_field *fields; /* [n_fields] by which it is given */
    dem_index n_fields;
    const char *(*fault)(const dem_obstacle *obstacle);    /* what is wrong with its fields, NULL: nothing; or NULL */
    motion_bounds (*bounds)(const dem_obstacle *obstacle); /* speed 0: the obstacle does not move in this way */
    void (*add)(const motion_law *law, double t, pose *to);
} motion_kind;

#endif
