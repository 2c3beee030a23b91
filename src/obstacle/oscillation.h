/* SPDX-License-Identifier: BSD-3-Clause */
/* A kind of motion: a harmonic oscillation along a line about the place where the points are given,
 *     c = A r(t) sin(omega t + phi),  omega = 2 pi f. */
#ifndef DEM_OBSTACLE_OSCILLATION_H
#define DEM_OBSTACLE_OSCILLATION_H

#include "base/ramp.h"
#include "obstacle/motion_kind.h"

static const double oscillation_turn = 6.283185307179586; /* 2 pi */

static inline const char *oscillation_fault(const dem_obstacle *obstacle)
{
    const vec2 amplitude = vec2_at(obstacle->amplitude, 0);
    const bool wanted = amplitude.x != 0.0 || amplitude.y != 0.0;
    if (obstacle->frequency < 0.0) return "a frequency is below 0";
    return wanted && obstacle->frequency == 0.0 ? "an amplitude is given without a frequency" : NULL;
}

/* Each time derivative is at most the sum of those of its terms: that of the ramp times that of the sine. A period has
 * 20 steps at least. */
static inline motion_bounds oscillation_bounds(const dem_obstacle *obstacle)
{
    const double omega = oscillation_turn * obstacle->frequency, size = vec2_norm(vec2_at(obstacle->amplitude, 0));
    const double steep = obstacle->ramp > 0.0 ? RAMP_STEEPEST / obstacle->ramp : 0.0,
                 curved = obstacle->ramp > 0.0 ? RAMP_MOST_CURVED / (obstacle->ramp * obstacle->ramp) : 0.0;
    return (motion_bounds){.speed = size * (omega + steep) * (omega > 0.0),
                           .acceleration = size * (omega * omega + 2.0 * omega * steep + curved),
                           .step_rate = 20.0 * obstacle->frequency};
}

static inline void oscillation_add(const motion_law *law, double t, pose *to)
{
    const dem_obstacle *obstacle = law->of;
    const vec2 amplitude = vec2_at(obstacle->amplitude, 0);
    const double omega = oscillation_turn * obstacle->frequency,
                 angle = oscillation_turn * (obstacle->frequency * t + obstacle->phase / 360.0);
    const double s = sin(angle), c = omega * cos(angle), r = ramp_value(obstacle->ramp, t),
                 slope = ramp_slope(obstacle->ramp, t), curvature = ramp_curvature(obstacle->ramp, t);
    to->centre = vec2_along(to->centre, r * s, amplitude);
    to->velocity = vec2_along(to->velocity, r * c + slope * s, amplitude);
    to->acceleration = vec2_along(to->acceleration, (curvature - r * omega * omega) * s + 2.0 * slope * c, amplitude);
}

static const dem_motion_field oscillation_fields[] = {{"amplitude", "m", 2, offsetof(dem_obstacle, amplitude)},
                                                      {"frequency", "Hz", 1, offsetof(dem_obstacle, frequency)},
                                                      {"phase", "degrees", 1, offsetof(dem_obstacle, phase)}};
static const motion_kind oscillation = {oscillation_fields, 3, oscillation_fault, oscillation_bounds, oscillation_add};

#endif
