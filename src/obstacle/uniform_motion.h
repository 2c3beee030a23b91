/* SPDX-License-Identifier: BSD-3-Clause */
/* A kind of motion: constant velocity, c = V t. */
#ifndef DEM_OBSTACLE_UNIFORM_MOTION_H
#define DEM_OBSTACLE_UNIFORM_MOTION_H

#include "obstacle/motion_kind.h"

static inline motion_bounds uniform_motion_bounds(const dem_obstacle *obstacle)
{
    return (motion_bounds){.speed = vec2_norm(vec2_at(obstacle->velocity, 0))};
}

static inline void uniform_motion_add(const dem_obstacle *obstacle, double t, pose *to)
{
    const vec2 velocity = vec2_at(obstacle->velocity, 0);
    to->centre = vec2_along(to->centre, t, velocity);
    to->velocity = vec2_add(to->velocity, velocity);
}

static const dem_motion_field uniform_motion_fields[] = {{"velocity", "m/s", 2, offsetof(dem_obstacle, velocity)}};
static const motion_kind uniform_motion = {uniform_motion_fields, 1, uniform_motion_bounds, uniform_motion_add};

#endif
