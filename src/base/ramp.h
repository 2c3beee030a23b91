/* SPDX-License-Identifier: BSD-3-Clause */
/* A factor that grows from 0 at t = 0 to 1 at t = T. With s = t/T it is
 *     r = 10 s^3 - 15 s^4 + 6 s^5,
 * which is twice continuously differentiable and of degree 5, so that a method of order 5 integrates it to rounding.
 * Before and after the ramp its derivatives are 0. Without a ramp (T = 0) it is over from the start. */
#ifndef DEM_BASE_RAMP_H
#define DEM_BASE_RAMP_H

#include <stdbool.h>

/** Largest values of the derivatives: r' <= 15/8 1/T in the middle, abs(r'') <= 10/sqrt(3) 1/T^2. */
#define RAMP_STEEPEST    1.875
#define RAMP_MOST_CURVED 5.773502691896258

/** Sets s = t/T, and tells whether the ramp is going on there. */
static inline bool ramp_within(double length, double t, double *s)
{
    *s = length > 0.0 ? t / length : 1.0;
    return *s > 0.0 && *s < 1.0;
}

/** r(t), between 0 and 1. */
static inline double ramp_value(double length, double t)
{
    double s;
    if (ramp_within(length, t, &s)) return s * s * s * (10.0 + s * (6.0 * s - 15.0));
    return s > 0.0 ? 1.0 : 0.0;
}

/** dr/dt = 30 s^2 (1 - s)^2/T, 1/s. */
static inline double ramp_slope(double length, double t)
{
    double s;
    return ramp_within(length, t, &s) ? 30.0 * s * s * (1.0 - s) * (1.0 - s) / length : 0.0;
}

/** d^2r/dt^2 = 60 s (1 - s) (1 - 2 s)/T^2, 1/s^2. */
static inline double ramp_curvature(double length, double t)
{
    double s;
    return ramp_within(length, t, &s) ? 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s) / (length * length) : 0.0;
}

/** Integral of r from 0 to t, s: T (5/2 s^4 - 3 s^5 + s^6) within the ramp, T/2 at its end, and t - T/2 from there
 *  on. */
static inline double ramp_area(double length, double t)
{
    double s;
    if (ramp_within(length, t, &s)) return length * s * s * s * s * (2.5 + s * (s - 3.0));
    return s > 0.0 ? t - 0.5 * length : 0.0;
}

#endif
