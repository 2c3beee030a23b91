/* SPDX-License-Identifier: BSD-3-Clause */
/* ARKODE behind a few functions: explicit Runge-Kutta methods with root functions, in adaptive steps or fixed ones. */
#ifndef DEM_TIME_ARKODE_INTEGRATOR_H
#define DEM_TIME_ARKODE_INTEGRATOR_H

#include <stdbool.h>

#include "time/ode_problem.h"

typedef struct arkode_integrator arkode_integrator;

/** Starts at (t, y). Free with arkode_integrator_destroy. */
dem_status arkode_integrator_create(arkode_integrator **out, const ode_problem *problem, double t, const double *y);
void arkode_integrator_destroy(arkode_integrator *i);

/** Takes one accepted step, or goes to the first root within it (`*rooted`). The path's arrays belong to the
 *  integrator and hold until its next call. DEM_ERROR_INTEGRATOR leaves the last accepted state in force. */
dem_status arkode_integrator_step(arkode_integrator *i, dense_output *step, bool *rooted);

/** The end of the step just taken and its derivative, to be changed. */
void arkode_integrator_end(arkode_integrator *i, double **y1, double **f1);

/** Goes back to the start of the step just taken; the next is shorter by the factor. */
dem_status arkode_integrator_redo(arkode_integrator *i, double factor);

/** Makes the state at the end of the step just taken, where it was cut short too, the one to go on from. The step's
 *  path holds on until the next step or restart. */
void arkode_integrator_settle(arkode_integrator *i, const dense_output *step);

/** The state from which the next step goes; who changes it restarts. */
double *arkode_integrator_state(const arkode_integrator *i);

/** Goes on from another state, or from its own as it has been changed, with step size and history kept. */
dem_status arkode_integrator_restart(arkode_integrator *i, double t, const double *y);

/** How long the next step is to be, s; 0 where steps are fixed. */
double arkode_integrator_next_step(const arkode_integrator *i);

/** Begins anew, without step size and history of before. */
dem_status arkode_integrator_renew(arkode_integrator *i, const integrator_start *from);

/** Bounds the first step after the restart or resumption that follows, s. */
dem_status arkode_integrator_bound(arkode_integrator *i, double longest);

/** Goes on from the end of the step just settled as it has been changed, whose derivative is known. */
dem_status arkode_integrator_resume(arkode_integrator *i);

/** Steps, rejections, evaluations and retries so far; the rest is 0. */
dem_counts arkode_integrator_counts(const arkode_integrator *i);

#endif
