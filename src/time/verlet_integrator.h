/* SPDX-License-Identifier: BSD-3-Clause */
/* Velocity Verlet, (5) as kick, drift and kick, with root functions. The same interface as arkode_integrator.h. */
#ifndef DEM_TIME_VERLET_INTEGRATOR_H
#define DEM_TIME_VERLET_INTEGRATOR_H

#include <stdbool.h>

#include "time/ode_problem.h"

typedef struct verlet_integrator verlet_integrator;

/** Starts at (t, y). Free with verlet_integrator_destroy. */
dem_status verlet_integrator_create(verlet_integrator **out, const ode_problem *problem, double t, const double *y);
void verlet_integrator_destroy(verlet_integrator *V);

/** Takes one step, or goes to the first root within it (`*rooted`). The path's arrays belong to the engine and hold
 *  until its next call. DEM_ERROR_INTEGRATOR leaves the last state in force. */
dem_status verlet_integrator_step(verlet_integrator *V, dense_output *step, bool *rooted);

/** The end of the step just taken and its derivative, to be changed. */
void verlet_integrator_end(verlet_integrator *v, double **y1, double **f1);

/** Makes the state at the end of the step just taken, where it was cut short too, the one to go on from. The step's
 *  path holds on until the next step or restart. */
void verlet_integrator_settle(verlet_integrator *V, const dense_output *step);

/** The state from which the next step goes; who changes it restarts. */
double *verlet_integrator_state(const verlet_integrator *V);

/** Goes on from another state, or from its own as it has been changed. */
void verlet_integrator_restart(verlet_integrator *V, double t, const double *y);

/** Begins anew, with these counts. */
void verlet_integrator_renew(verlet_integrator *V, const integrator_start *from);

/** Steps and evaluations so far; the rest is 0. */
dem_counts verlet_integrator_counts(const verlet_integrator *V);

#endif
