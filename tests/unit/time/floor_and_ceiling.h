/* SPDX-License-Identifier: BSD-3-Clause */
/* A floor and a ceiling 1 m above it as the events of an ode_problem of one node: the root function is the lower of its
 * distances to them, in units of those at the start of the step. One that is not above 0 there is left out. */
#ifndef DEM_TEST_FLOOR_AND_CEILING_H
#define DEM_TEST_FLOOR_AND_CEILING_H

#include <math.h>
#include <stdbool.h>

#include "time/dense_output.h"

typedef struct floor_and_ceiling {
    double floor;    /* m */
    double start[2]; /* m, the distances at the start of the step */
    bool broken;     /* the root function is no number */
    int asked;       /* times */
} floor_and_ceiling;

static inline void floor_and_ceiling_begin(floor_and_ceiling *f, const double *y)
{
    f->start[0] = y[1] - f->floor;
    f->start[1] = f->floor + 1.0 - y[1];
}

static inline double floor_and_ceiling_root(floor_and_ceiling *f, const dense_output *step)
{
    double y[4], low = 1.0;
    dense_output_state(step, step->end, y);
    const double distance[2] = {y[1] - f->floor, f->floor + 1.0 - y[1]};
    f->asked++;
    for (int k = 0; k < 2; k++)
        if (f->start[k] > 0.0) low = fmin(low, distance[k] / f->start[k]);
    return f->broken ? (double)NAN : low;
}

#endif
