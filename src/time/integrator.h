/* SPDX-License-Identifier: BSD-3-Clause */
/* What takes the steps, whichever method they are of: ARKODE for those of Runge and Kutta, or Verlet's. */
#ifndef DEM_TIME_INTEGRATOR_H
#define DEM_TIME_INTEGRATOR_H

#include <stdbool.h>

#include "time/ode_problem.h"

typedef struct engine {
    struct integrator *integrator; /* one of both */
    struct verlet *verlet;
} engine;

/** Starts at (t, y). Free with engine_destroy. */
dem_status engine_create(engine *out, const motion *problem, double t, const double *y);
void engine_destroy(engine *e);

/** Takes one accepted step, or goes to the first root within it (`*rooted`). The path's arrays belong to the engine and
 *  hold until its next call. DEM_ERROR_INTEGRATOR leaves the last accepted state in force. */
dem_status engine_step(engine *e, path *step, bool *rooted);

/** The end of the step just taken, [4 n], and its derivative, for who changes both before settling. */
void engine_end(engine *e, double **y1, double **f1);

/** Takes the step just taken back: the next goes from its start, and is shorter by the factor. */
dem_status engine_redo(engine *e, double factor);

/** Makes the state at the end of the step just taken, where it was cut short too, the one to go on from. The step's
 *  path holds on until the next step or restart. */
void engine_settle(engine *e, const path *step);

/** The state from which the next step goes, [4 n]. Who changes it restarts the engine there: it is no copy, and the end
 *  of the step that led to it changes with it. */
double *engine_state(const engine *e);

/** Bounds the first step after the restart or resumption that follows, s. */
dem_status engine_bound(engine *e, double longest);

/** Goes on from the end of the step just settled, which has been changed and its derivative with it. */
dem_status engine_resume(engine *e);

/** How long the next step is to be, s; 0 where steps are fixed. */
double engine_next_step(const engine *e);

/** Begins anew, so that nothing before it shows: as an engine does that is created there, but with counts. */
dem_status engine_renew(engine *e, const engine_start *from);

/** Goes on from another state, or from its own as it has been changed. */
dem_status engine_restart(engine *e, double t, const double *y);

/** Steps, rejections, evaluations and retries so far; the rest is 0. */
dem_counts engine_counts(const engine *e);

#endif
