/* SPDX-License-Identifier: BSD-3-Clause */
/* The motion within one accepted step: the quintic that matches position, velocity and acceleration at both ends; or,
 * for methods of order 2, parabolas. Events inside a step change it for some nodes from their time on. Everything that
 * looks into a step reads it here: frames, root functions, event location, observers. docs/method.md, Dense output. */
#ifndef DEM_TIME_DENSE_OUTPUT_H
#define DEM_TIME_DENSE_OUTPUT_H

#include <stdbool.h>

#include "time/changed_motion.h"

typedef struct dense_output {
    state_layout layout;
    double t0, t1;    /* the accepted step, s */
    double end;       /* the motion holds up to here, t0 <= end <= t1: an event cuts it short */
    const double *y0; /* [2 dim n_rows] state (x, v) at t0 */
    const double *f0; /* [2 dim n_rows] its derivative, of which the second half is read, accelerations */
    const double *y1, *f1;
    bool parabolic; /* positions through x0, v0, x1 and velocities through v0, a0, v1: the way of Verlet's method */
    const changed_motion *changed; /* how nodes go on from events inside, up to y1; NULL: there were none */
} dense_output;

/** Width to which the time of an event in the step is located, s: that of ARKODE's root finder. */
double dense_output_resolution(const dense_output *p);

/** Position and velocity [dim] of a node, or of any other row of the state, before the end of the step. */
void dense_output_position_inside(const dense_output *p, double t, dem_index i, double *out);
void dense_output_velocity_inside(const dense_output *p, double t, dem_index i, double *out);

/** The same up to the end, which is the most frequent case. */
static inline void dense_output_position(const dense_output *p, double t, dem_index i, double *out)
{
    if (t == p->t1)
        state_copy_row(&p->layout, out, state_x(&p->layout, p->y1, i));
    else
        dense_output_position_inside(p, t, i, out);
}

static inline void dense_output_velocity(const dense_output *p, double t, dem_index i, double *out)
{
    if (t == p->t1)
        state_copy_row(&p->layout, out, state_v(&p->layout, p->y1, i));
    else
        dense_output_velocity_inside(p, t, i, out);
}

/** Both of n nodes, into x, v [n][dim]: in less time. */
void dense_output_put_nodes(const dense_output *p, double t, dem_index n, const dem_index *nodes, double *x, double *v);

/** Positions of the n nodes of a list at t, to the bits of dense_output_position(), into their rows of x [n_rows][dim]:
 *  of many nodes in less time. */
void dense_output_put_positions(const dense_output *p, double t, const int32_t *list, int n, double *x);

enum { DENSE_OUTPUT_HULL = MOTION_TERMS };

/** Points [DENSE_OUTPUT_HULL][dim] in whose convex hull a node stays, but for rounding, from the start of the step, or
 *  from the last event that has changed its motion, to t1.  \return how many */
int dense_output_hull(const dense_output *p, dem_index node, double *hull);

/** The motions [n] of nodes: over the whole step, or from the last event inside that has changed it. */
void dense_output_motions(const dense_output *p, dem_index n, const dem_index *nodes, motion_polynomial *out);

/** The whole state at t into y [2 dim n_rows]. At t0 and t1 it is y0 and y1 to the bit, but for what an event right at
 *  t0 has changed there. */
void dense_output_state(const dense_output *p, double t, double *y);

#endif
