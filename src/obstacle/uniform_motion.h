/* SPDX-License-Identifier: BSD-3-Clause */
/* A kind of motion: a constant velocity after the ramp, c' = V r(t). */
#ifndef DEM_OBSTACLE_UNIFORM_MOTION_H
#define DEM_OBSTACLE_UNIFORM_MOTION_H

#include "base/ramp.h"
#include "obstacle/motion_kind.h"

static inline motion_bounds uniform_motion_bounds(const dem_obstacle *obstacle)
{
    const double speed = vec2_norm(vec2_at(obstacle->velocity, 0));
    return (motion_bounds){.speed = speed,
                           .acceleration = obstacle->ramp > 0.0 ? RAMP_STEEPEST * speed / obstacle->ramp : 0.0};
}

static inline void uniform_motion_add(const motion_law *law, double t, pose *to)
{
    const dem_obstacle *obstacle = law->of;
    const vec2 velocity = vec2_at(obstacle->velocity, 0);
    to->centre = vec2_along(to->centre, ramp_area(obstacle->ramp, t), velocity);
    to->velocity = vec2_along(to->velocity, ramp_value(obstacle->ramp, t), velocity);
    to->acceleration = vec2_along(to->acceleration, ramp_slope(obstacle->ramp, t), velocity);
}

static const dem_motion_field uniform_motion_fields[] = {{"velocity", "m/s", 2, offsetof(dem_obstacle, velocity)}};
static const motion_kind uniform_motion = {uniform_motion_fields, 1, NULL, uniform_motion_bounds, uniform_motion_add};

#endif
