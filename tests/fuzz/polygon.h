/* SPDX-License-Identifier: BSD-3-Clause */
/* Where a point is to a polygon, by brute force and with nothing of the library's. */
#ifndef DEM_FUZZ_POLYGON_H
#define DEM_FUZZ_POLYGON_H

#include <math.h>
#include <stdbool.h>

/** Distance from x to the segment ab, m. */
static inline double polygon_to_side(const double *x, const double *a, const double *b)
{
    const double dx = b[0] - a[0], dy = b[1] - a[1], px = x[0] - a[0], py = x[1] - a[1];
    const double u = fmin(1.0, fmax(0.0, (px * dx + py * dy) / (dx * dx + dy * dy)));
    return hypot(px - u * dx, py - u * dy);
}

/** Distance from x to the polyline of n points, m. */
static inline double polygon_to_line(const double *points, long n, const double *x)
{
    double nearest = INFINITY;
    for (long k = 0; k + 1 < n; k++) nearest = fmin(nearest, polygon_to_side(x, points + 2 * k, points + 2 * k + 2));
    return nearest;
}

/** Whether x is inside the closed polyline of n points, the last of which is the first: a ray crosses it an odd number
 *  of times. */
static inline bool polygon_has(const double *points, long n, const double *x)
{
    bool inside = false;
    for (long k = 0; k + 1 < n; k++) {
        const double *a = points + 2 * k, *b = a + 2;
        if ((a[1] > x[1]) != (b[1] > x[1]) && x[0] < a[0] + (x[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
            inside = !inside;
    }
    return inside;
}

/** Whether it goes round counter-clockwise. */
static inline bool polygon_is_left(const double *points, long n)
{
    double twice = 0.0;
    for (long k = 0; k + 1 < n; k++) {
        const double *a = points + 2 * k, *b = a + 2;
        twice += (a[0] - points[0]) * (b[1] - points[1]) - (a[1] - points[1]) * (b[0] - points[0]);
    }
    return twice > 0.0;
}

#endif
