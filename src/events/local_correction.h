/* SPDX-License-Identifier: BSD-3-Clause */
/* Correction of the rest of a step for an event inside it: the change d of the motion that follows from it solves
 *   d'' = a(x + d, constraints after) - a(x, constraints before)
 * and spreads by a ring of neighbours for every two stages of a Runge-Kutta step (for every one where springs are
 * damped). So it is integrated on a neighbourhood of 3 (6) rings round the event, by one step of Fehlberg's pair;
 * outside it is 0 to the bit. For methods of order 2 Heun's pair and 1 (3) rings suffice. Where an event changes
 * forces alone it is one ring less. Inside the step the change is interpolated as the step is: by quintics, or by
 * parabolas. */
#ifndef DEM_EVENTS_LOCAL_CORRECTION_H
#define DEM_EVENTS_LOCAL_CORRECTION_H

#include "events/neighbourhood.h"
#include "time/butcher.h"
#include "time/dense_output.h"

enum { LOCAL_CORRECTION_STAGES = 6 };

/** How a change is integrated. */
typedef struct local_correction_rule {
    int order;                             /* of the method that the step is of */
    double position_error, velocity_error; /* m, m/s: what counts as an error of 1 */
    dem_index n_nodes;                     /* of all bodies, on any rank: errors are a mean over these */
} local_correction_rule;

typedef struct local_correction {
    neighbourhood near; /* the change spreads over all its rings but the last */
    local_correction_rule rule;
    butcher_table table;
    int last;                /* stage at the end of the step */
    double t, h;             /* s, of the event; from it to the end of the step */
    bool opens_late;         /* accelerations without the event are evaluated stage by stage with those with it */
    bool parabolic;          /* the step is interpolated by parabolas, and so is the change */
    dem_index n_quadratures; /* rows of the quadratures that change, behind the nodes of the neighbourhood */
    dem_index capacity;
    dem_index *rows;            /* [n_quadratures] their places in a state */
    motion_polynomial *motions; /* of the nodes after t, without the event */
    double *block;              /* memory of the arrays that follow, [n + n_quadratures][dim] each */
    double *x[LOCAL_CORRECTION_STAGES], *v[LOCAL_CORRECTION_STAGES],
        *a[LOCAL_CORRECTION_STAGES]; /* x, v, x'' at each stage, without the event */
    double *dx[LOCAL_CORRECTION_STAGES + 1], *dv[LOCAL_CORRECTION_STAGES + 1],
        *da[LOCAL_CORRECTION_STAGES + 1]; /* their changes, at the end of the step as well */
    double *changed[3];                   /* x, v, x'' with the change at a stage */
} local_correction;

/** Borrows forces and constraints (NULL: none). Free with local_correction_destroy(). */
dem_status local_correction_create(local_correction *out, const state_layout *l, const local_forces *f,
                                   const constraints *c, const local_correction_rule *rule);
void local_correction_destroy(local_correction *p);

/** Called before an event that may change the seeds at once: gathers their neighbourhood, computes its
 *  motion without the event at all stages, and puts its state at t into `state` [2 dim n_rows]. The constraints are to
 *  be solved for the end of the step. */
dem_status local_correction_open(local_correction *p, const dense_output *step, neighbourhood_seeds seeds, double t,
                                 double *state);

/** Called when the event has changed `state` and the constraints: integrates the change of motion and adds it to the
 *  step.
 *  \param[out] error  squared, of all unknowns of the bodies together, in units of the tolerance */
dem_status local_correction_close(local_correction *p, const dense_output *step, changed_motion *tr, double *state,
                                  double *error);

#endif
