/* SPDX-License-Identifier: BSD-3-Clause */
/* ARKODE behind a few functions: explicit pairs with adaptive steps and root functions. The only place that knows
 * SUNDIALS; it knows no physics but that y = (x, v) with x' = v. */
#ifndef DEM_INTEGRATOR_H
#define DEM_INTEGRATOR_H

#include <stdbool.h>

#include "path.h"

typedef struct integrator integrator;

typedef struct integrator_problem {
    dem_index n_nodes;  /* y has 4 n_nodes entries */
    dem_index n_books;  /* the last of these nodes are integrated along, and have no part in the error */
    dem_index n_guards; /* root functions, each looked for as it falls through 0; may be 0 */
    /** Derivative f of y at t; returns 0, or 1 if it is not finite. */
    int (*derivative)(double t, const double *y, double *f, void *context);
    void (*guards)(double t, const double *y, double *g, void *context);
    void *context;
    dem_method method;
    double position_error, velocity_error; /* m, m/s: what counts as an error of 1 */
    double max_step;                       /* s */
    double fixed_step;                     /* s; > 0: steps of this length without error control */
} integrator_problem;

/** Starts at (t, y). Free with integrator_destroy. */
dem_status integrator_create(integrator **out, const integrator_problem *problem, double t, const double *y);
void integrator_destroy(integrator *i);

/** Takes one accepted step, or goes to the first root within it (`*rooted`). The path's arrays belong to the
 *  integrator and hold until its next call. DEM_ERROR_INTEGRATOR leaves the last accepted state in force. */
dem_status integrator_step(integrator *i, path *step, bool *rooted);

/** Goes on from another state, with step size and history kept. */
dem_status integrator_restart(integrator *i, double t, const double *y);

/** Steps, rejections, evaluations and retries so far; the rest is 0. */
dem_counts integrator_counts(const integrator *i);

#endif
