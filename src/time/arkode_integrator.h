/* SPDX-License-Identifier: BSD-3-Clause */
/* ARKODE behind a few functions: explicit Runge-Kutta methods with root functions, in adaptive steps or fixed ones. */
#ifndef DEM_TIME_ARKODE_INTEGRATOR_H
#define DEM_TIME_ARKODE_INTEGRATOR_H

#include <stdbool.h>

#include "time/ode_problem.h"

typedef struct integrator integrator;

/** Starts at (t, y). Free with integrator_destroy. */
dem_status integrator_create(integrator **out, const motion *problem, double t, const double *y);
void integrator_destroy(integrator *i);

/** Takes one accepted step, or goes to the first root within it (`*rooted`). The path's arrays belong to the
 *  integrator and hold until its next call. DEM_ERROR_INTEGRATOR leaves the last accepted state in force. */
dem_status integrator_step(integrator *i, path *step, bool *rooted);

/** The end of the step just taken and its derivative, to be changed. */
void integrator_end(integrator *i, double **y1, double **f1);

/** Goes back to the start of the step just taken; the next is shorter by the factor. */
dem_status integrator_redo(integrator *i, double factor);

/** Makes the state at the end of the step just taken, where it was cut short too, the one to go on from. The step's
 *  path holds on until the next step or restart. */
void integrator_settle(integrator *i, const path *step);

/** The state from which the next step goes; who changes it restarts. */
double *integrator_state(const integrator *i);

/** Goes on from another state, or from its own as it has been changed, with step size and history kept. */
dem_status integrator_restart(integrator *i, double t, const double *y);

/** How long the next step is to be, s; 0 where steps are fixed. */
double integrator_next_step(const integrator *i);

/** Begins anew, without step size and history of before. */
dem_status integrator_renew(integrator *i, const engine_start *from);

/** Bounds the first step after the restart or resumption that follows, s. */
dem_status integrator_bound(integrator *i, double longest);

/** Goes on from the end of the step just settled as it has been changed, whose derivative is known. */
dem_status integrator_resume(integrator *i);

/** Steps, rejections, evaluations and retries so far; the rest is 0. */
dem_counts integrator_counts(const integrator *i);

#endif
