/* SPDX-License-Identifier: BSD-3-Clause */
/* Takes the steps of every method: by ARKODE for Runge-Kutta methods, or by velocity Verlet. The order of calls for one
 * step is step (as often as it is taken back with redo), then settle, and after events resume or restart:
 * - take_unseen takes several at once, and settles them;
 * - settle accepts the step, whole or cut short at its event;
 * - resume goes on from the end of a whole step whose state and derivative the caller has changed: no evaluation is
 *   lost;
 * - restart goes on from any state, whose derivative is not known;
 * - renew does the same and forgets the history of errors too, as a run does that is resumed from a checkpoint. */
#ifndef DEM_TIME_INTEGRATOR_H
#define DEM_TIME_INTEGRATOR_H

#include "time/integrator_ops.h"

typedef struct integrator {
    const integrator_ops *ops; /* of the method */
    void *self;                /* what they work on */
} integrator;

/** Starts at (t, y). Free with integrator_destroy. */
dem_status integrator_create(integrator *out, const ode_problem *problem, double t, const double *y);
void integrator_destroy(integrator *e);

/** Takes one accepted step, or goes to the first root within it (`*rooted`). The step refers to arrays of the
 *  integrator, which hold until its next call. After DEM_ERROR_INTEGRATOR the last accepted state is still in force. */
dem_status integrator_step(integrator *e, dense_output *step, bool *rooted);

/** Takes n steps, 1 to ODE_FUSED_STEPS, of which nobody sees any, without roots, and settles them: the state is as if
 *  each had been taken by itself.
 *  \param[out] ends  [n] s, when they end
 *  \param[out] last  the last of them, at its end alone: nothing is known inside
 *  \return false if it cannot: nothing has changed then */
bool integrator_take_unseen(integrator *e, int n, double *ends, dense_output *last);

/** The end of the step just taken, [2 dim n_rows], and its derivative: events inside the step change both before it is
 *  settled. */
void integrator_end(integrator *e, double **y1, double **f1);

/** Rejects the step just taken: the next attempt starts from the same state, with `factor` times the length. Not for
 *  fixed steps. */
dem_status integrator_redo(integrator *e, double factor);

/** Accepts the step just taken as far as step->end: the state there is the start of the next. The step's arrays hold
 *  until the next step or restart. */
void integrator_settle(integrator *e, const dense_output *step);

/** The state from which the next step starts, [2 dim n_rows]. It is no copy: a caller that changes it calls
 *  integrator_restart(), and the end of the step that led to it changes with it. */
double *integrator_state(const integrator *e);

/** Bounds the length of the first step after the restart or resumption that follows, s; infinity does not. */
dem_status integrator_bound(integrator *e, double longest);

/** Goes on from the end of the step just settled, after the caller has changed that state and its derivative. */
dem_status integrator_resume(integrator *e);

/** How long the next step is to be, s; 0 where steps are fixed. */
double integrator_next_step(const integrator *e);

/** Begins anew as an integrator created there would, without any memory of earlier steps; only counts go on. */
dem_status integrator_renew(integrator *e, const integrator_start *from);

/** Goes on from another state, or from its own as it has been changed. */
dem_status integrator_restart(integrator *e, double t, const double *y);

/** Steps, rejections, evaluations and retries so far; the rest is 0. */
dem_counts integrator_counts(const integrator *e);

#endif
