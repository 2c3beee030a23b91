/* SPDX-License-Identifier: BSD-3-Clause */
/* How far nodes may have moved relative to each other since they were last looked at, without another look. Two
 * nodes whose speed relative to each other is V at most at the start of a step of length h, in which no acceleration is
 * larger than A, have moved relative to each other at any of its stages by no more than
 *   c h V + 2 p h^2 A,   and at its end are no faster relative to each other than   V + 2 q h A,
 * with c, p and q of the method (base/step_reach.h). A is known when it is needed, as a stage follows from
 * accelerations that have been evaluated. So steps in which no surfaces come near each other take no look at them, and
 * nothing is missed; nor at triangles, as long as none comes near to folding (simulation/guard_bound.h). */
#ifndef DEM_SURFACE_CONTACT_APPROACH_BOUND_H
#define DEM_SURFACE_CONTACT_APPROACH_BOUND_H

#include <stdbool.h>

#include "base/step_reach.h"

typedef struct approach_bound {
    step_reach reach;
    double longest_step;    /* s */
    bool is_known;          /* else nothing is bounded, */
    double left;            /* m: nodes may move relative to each other by this from the start of the step on, */
    double speed;           /* m/s, relative to each other, is bounded at the start */
    double at_start;        /* m/s^2, of accelerations at the start of the step; infinity: unknown */
    double largest, last;   /* m/s^2, of all that have been evaluated in the step, and of the last of them */
    int worth_noting;       /* evaluations without a look, by which what it takes to note the bound is saved */
    int n_saved, n_to_wait; /* those since it was noted; steps until it is noted again if they were fewer */
} approach_bound;

/** Nothing is known yet. No step is longer than this, s. */
void approach_bound_create(approach_bound *out, step_reach reach, double longest_step, int worth_noting);

/** Begins a step, or begins it again.
 *  \return whether nodes should be looked at, for approach_bound_note() */
bool approach_bound_begin_step(approach_bound *b);

/** From the start of the step on, nodes may move relative to each other by `left`, m, before another look is
 *  needed. Their speeds relative to each other are no larger than `speed`, m/s. */
void approach_bound_note(approach_bound *b, double left, double speed);

/** Whether the next state evaluated in the step needs no look. */
bool approach_bound_holds(approach_bound *b);

/** Takes the result of an evaluation: no node has a larger acceleration, m/s^2. */
void approach_bound_take(approach_bound *b, double acceleration);

/** Ends the step, after its length in s. */
void approach_bound_end_step(approach_bound *b, double length);

/** Follows a step of this length, s, that is taken in one with those after it, at whose only evaluation no node has a
 *  larger acceleration, m/s^2.
 *  \return false if it needs a look: the bound is lost then */
bool approach_bound_pass_step(approach_bound *b, double length, double acceleration);

/** Nothing is bounded any more, since nodes are compared with another state. */
void approach_bound_lose(approach_bound *b);

/** The same, since the state has changed, or its accelerations: they are unknown. */
void approach_bound_forget(approach_bound *b);

#endif
