/* SPDX-License-Identifier: BSD-3-Clause */
/* The automaton within an accepted step: when the contacts of a candidate change, and what has to be refreshed at the
 * end of the step. */
#ifndef DEM_CONTACT_AUTOMATON_STEP_H
#define DEM_CONTACT_AUTOMATON_STEP_H

#include "contact/automaton.h"

/** Bounds how far candidates go in an accepted step, and solves for the forces in closed contacts at its end.
 *  \param[out] state  [4 n] scratch */
void automaton_begin_step(automaton *c, const dense_output *p, double *state);

/** Solves for the forces of one group at the end of the step. */
void automaton_solve_group(automaton *c, const dense_output *p, dem_index group, double *state);

/** Evaluates the root functions of the active candidates in the state y from which a step goes, as units for
 *  automaton_root_function() in the step. */
void automaton_begin_roots(automaton *c, double t, const double *y);

/** The root function of all contact events, at the end of a path: the lowest of those of the active candidates
 *  (candidate_root_functions()), at most 1. Each is taken in units of its value at the start of the step, so that the
 *  first secant ends where the first of theirs does. One that was not above 0 at the start is left out:
 *  automaton_check_step() finds what comes of it in the step.  \param[out] state  [4 n] scratch */
double automaton_root_function(automaton *c, const dense_output *p, double *state);

/** Candidates whose contacts can change in the step: their number, and the a-th of them. */
static inline dem_index automaton_n_active(const automaton *c)
{
    return c->all ? c->set.n : c->broad_phase.n;
}

static inline dem_index automaton_active_candidate(const automaton *c, dem_index a)
{
    return c->all ? a : c->broad_phase.active[a];
}

/** When a candidate with fewer than two closed contacts touches in the step. Changes nothing but the candidate's
 *  clearance, so that threads may ask for different candidates at once.
 *  \return the time; `from` for a candidate that is inside already; infinity if it does not touch */
double automaton_crossing(automaton *c, const dense_output *p, dem_index k, double from);

/** First time after `from` in the step at which a candidate's contacts change, after automaton_begin_step(): it gets
 *  inside an obstacle, even if it is outside again at the end of the step, or a closed contact has to change and still
 *  has to at the end. Infinity if nothing changes.
 *  \param[out] state  [4 n] scratch */
double automaton_next_change(automaton *c, const dense_output *p, dem_index k, double from, double *state);

/** Looks in an accepted step for changes that the integrator's root finder has missed. If there is one, moves the end
 *  of the step to the first of them and returns true. `rooted`: the step ends at a root already.
 *  \param[out] state  [4 n] scratch */
bool automaton_check_step(automaton *c, dense_output *p, bool rooted, double *state);

/** Puts closed vertex contacts that the integrator's error has opened back on their surfaces, and takes from the
 *  velocities of their groups what closed contacts do not allow.
 *  \return whether there were any */
bool automaton_project(automaton *c, double t, double *y);

/** Steps in which no contact is closed and no candidate comes near anything, one after the other. */
typedef struct automaton_flight {
    int n;
    const double *t;      /* [n + 1] s, their start and their ends */
    const double *square; /* [n] m^2/s^2, of the highest speed of the nodes of the surface at each end */
} automaton_flight;

/** Whether steps for so long, s, may well be of this kind. */
bool automaton_may_fly(const automaton *c, double time);

/** Whether the steps were of this kind; and then, follows them as automaton_begin_step() and automaton_end_step() do
 *  each. */
bool automaton_can_fly(const automaton *c, const automaton_flight *flight);
void automaton_fly(automaton *c, const automaton_flight *flight);

/** Follows an accepted step that ends at y: refreshes the forces, and measures clearances again. */
void automaton_end_step(automaton *c, const dense_output *p, const double *y);

#endif
