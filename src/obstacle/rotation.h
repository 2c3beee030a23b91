/* SPDX-License-Identifier: BSD-3-Clause */
/* A kind of motion: turning about a pivot with a constant spin after the ramp, q' = Omega r(t). The pivot goes with the
 * other kinds. */
#ifndef DEM_OBSTACLE_ROTATION_H
#define DEM_OBSTACLE_ROTATION_H

#include "base/ramp.h"
#include "obstacle/motion_kind.h"

/* How far the point furthest from the pivot is, m. */
static inline double rotation_radius(const dem_obstacle *obstacle)
{
    const vec2 pivot = vec2_at(obstacle->pivot, 0);
    double radius = 0.0;
    for (dem_index k = 0; k < obstacle->n_points; k++)
        radius = fmax(radius, vec2_norm(vec2_sub(vec2_at(obstacle->points, k), pivot)));
    return radius;
}

/* A step turns it by 0.05 at most. */
static inline motion_bounds rotation_bounds(const dem_obstacle *obstacle)
{
    const double spin = fabs(obstacle->spin), radius = spin > 0.0 ? rotation_radius(obstacle) : 0.0,
                 rate = obstacle->ramp > 0.0 ? RAMP_STEEPEST * spin / obstacle->ramp : 0.0;
    return (motion_bounds){
        .speed = spin * radius, .acceleration = (spin * spin + rate) * radius, .step_rate = 20.0 * spin};
}

static inline void rotation_add(const motion_law *law, double t, pose *to)
{
    const dem_obstacle *obstacle = law->of;
    to->origin = vec2_at(obstacle->pivot, 0);
    to->centre = vec2_add(to->centre, to->origin);
    to->angle = obstacle->spin * ramp_area(obstacle->ramp, t);
    to->axis = (vec2){cos(to->angle), sin(to->angle)};
    to->spin = obstacle->spin * ramp_value(obstacle->ramp, t);
    to->spin_rate = obstacle->spin * ramp_slope(obstacle->ramp, t);
}

static const dem_motion_field rotation_fields[] = {{"pivot", "m", 2, offsetof(dem_obstacle, pivot)},
                                                   {"spin", "rad/s", 1, offsetof(dem_obstacle, spin)}};
static const motion_kind rotation = {rotation_fields, 2, NULL, rotation_bounds, rotation_add};

#endif
