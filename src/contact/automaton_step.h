/* SPDX-License-Identifier: BSD-3-Clause */
/* The automaton within an accepted step: when something happens at a candidate, and what follows when the step is
 * over. */
#ifndef DEM_CONTACT_AUTOMATON_STEP_H
#define DEM_CONTACT_AUTOMATON_STEP_H

#include "contact/automaton.h"

/** Looks how far candidates go in an accepted step, and solves for the forces in closed contacts at its end.
 *  \param[out] state  [4 n] scratch */
void automaton_begin_step(automaton *c, const dense_output *p, double *state);

/** Solves for the forces of one group there. */
void automaton_solve_group(automaton *c, const dense_output *p, dem_index group, double *state);

/** Candidates for which something can happen in the step: their number, and the a-th of them. */
static inline dem_index automaton_n_active(const automaton *c)
{
    return c->all ? c->set.n : c->broad_phase.n;
}

static inline dem_index automaton_active_candidate(const automaton *c, dem_index a)
{
    return c->all ? a : c->broad_phase.active[a];
}

/** When a candidate that has room for a contact touches, as it is known by now: changes nothing but the candidate, so
 *  that threads may ask for different ones at once. `from` for one that is inside already. */
double automaton_crossing(automaton *c, const dense_output *p, dem_index k, double from);

/** First time after `from` in the step at which something happens at a candidate, after automaton_begin_step(): it is
 *  inside an obstacle, if only between entry and exit, or a closed contact of it has to change that still has to at
 *  the end. Infinity if nothing happens.  \param[out] state  [4 n] scratch */
double automaton_next_change(automaton *c, const dense_output *p, dem_index k, double from, double *state);

/** Looks in an accepted step for what the root finder has not seen. If there is something, cuts path->end short to the
 *  first and returns true. `rooted`: the path ends at a root already. \param[out] state  [4 n] scratch */
bool automaton_check_step(automaton *c, dense_output *p, bool rooted, double *state);

/** Puts closed vertex contacts that the integrator's error has opened back on their surfaces, and takes the velocity
 *  that they have across.  \return whether any was */
bool automaton_project(automaton *c, double t, double *y);

/** Follows an accepted step that ends at y: refreshes the forces, and looks where the candidates are. */
void automaton_end_step(automaton *c, const dense_output *p, const double *y);

#endif
