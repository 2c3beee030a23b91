/* SPDX-License-Identifier: BSD-3-Clause */
/* Rectangles along the axes. */
#ifndef DEM_BOX_H
#define DEM_BOX_H

#include <math.h>
#include <stdbool.h>

typedef struct box {
    double x0, y0, x1, y1;
} box;

static inline box box_empty(void)
{
    return (box){(double)INFINITY, (double)INFINITY, -(double)INFINITY, -(double)INFINITY};
}

static inline bool box_is_empty(box b)
{
    return !(b.x0 <= b.x1 && b.y0 <= b.y1);
}

static inline double box_width(box b)
{
    return b.x1 - b.x0;
}

static inline double box_height(box b)
{
    return b.y1 - b.y0;
}

static inline box box_join(box a, box b)
{
    return (box){fmin(a.x0, b.x0), fmin(a.y0, b.y0), fmax(a.x1, b.x1), fmax(a.y1, b.y1)};
}

static inline box box_grown(box b, double margin)
{
    return (box){b.x0 - margin, b.y0 - margin, b.x1 + margin, b.y1 + margin};
}

static inline bool box_meets(box a, box b)
{
    return a.x0 <= b.x1 && b.x0 <= a.x1 && a.y0 <= b.y1 && b.y0 <= a.y1;
}

/** Around n points, [n][2]. */
static inline box box_around(long n, const double *xy)
{
    box b = box_empty();
    for (long k = 0; k < n; k++) {
        b.x0 = fmin(b.x0, xy[2 * k]), b.x1 = fmax(b.x1, xy[2 * k]);
        b.y0 = fmin(b.y0, xy[2 * k + 1]), b.y1 = fmax(b.y1, xy[2 * k + 1]);
    }
    return b;
}

#endif
