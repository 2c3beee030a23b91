/* SPDX-License-Identifier: BSD-3-Clause */
/* The contact automaton FREE - SLIP - STICK of all candidates: what changes when one touches an obstacle, leaves it,
 * stops or begins to slide, passes an end or is stopped in a corner. Root functions (candidate.c) and resets depend on
 * (t, x, v) and the forces that follow from them, and on nothing of the integrator. How an impact changes a velocity is
 * in impact_law.c. */
#ifndef DEM_CONTACT_AUTOMATON_H
#define DEM_CONTACT_AUTOMATON_H

#include "base/rate_sums.h"
#include "contact/broad_phase.h"

typedef struct automaton {
    contact_set set;
    broad_phase broad_phase;
    double solved;      /* s, time of the state for which the contacts' forces are known; NAN: none */
    bool quiet;         /* and all root functions were > 0 in that state: no change is due */
    double way;         /* m, bound of how far any candidate goes in the step checked last */
    bool all;           /* by that, inactive candidates may touch: all have to be checked */
    dem_index idle;     /* events of the whole body in a row that changed nothing */
    rate_sums rates;    /* scratch of automaton_add_rates() */
    dem_index capacity; /* active candidates that there is room for in: */
    double *units;      /* [n_active][CANDIDATE_ROOTS] root functions of the active candidates at the start of a step */
} automaton;

/** The state y = (x, v) at t. */
static inline scene_state automaton_state(const automaton *c, double t, const double *y)
{
    return scene_state_at(&c->set.scene, t, y);
}

/** `out` must stay where it is. */
dem_status automaton_create(automaton *out, const forces *acting, const contact_rule *rule);
void automaton_destroy(automaton *c);

/** The same as contact_set_follow_surface(): a new candidate is active until the next look.
 *  \return DEM_ERROR_MEMORY, with all as it was */
dem_status automaton_follow_surface(automaton *c, const surface *to);

/** Reports the release of contacts that have gone with their surface, in the state y at t.
 *  \return the first status other than DEM_OK that the listener returned */
dem_status automaton_release_orphans(automaton *c, double t, double *y, const event_listener *listener);

/** Whether no candidate without contacts is deeper in an obstacle than the penetration tolerance, and no obstacle goes
 *  through an edge: else DEM_ERROR_MODEL
 *  names the node, the vertex or the edge.
 *  \param x  [n][2] */
dem_status automaton_check_start(const automaton *c, double t, const double *x);

/** Takes up the contacts of the initial state y = (x, v), where touching is enough. */
dem_status automaton_start(automaton *c, double t, double *y, const event_listener *listener);

/** Opens all contacts without an event, orphans too, so that automaton_start() can find those of another motion.
 *  \return DEM_ERROR_MEMORY */
dem_status automaton_open_all(automaton *c);

/** Goes on with the closed contacts that the candidates have from a checkpoint of the state y at t: finds groups,
 *  forces and active candidates anew.
 *  \return DEM_ERROR_MEMORY */
dem_status automaton_restore(automaton *c, double t, const double *y);

/** Adds to the accelerations a [n][2] in a state those by the forces of the closed contacts. */
void automaton_constrain(automaton *c, double t, const double *y, double *a);

/** Adds to the rates of the quadratures among the accelerations a [n_rows][2], after automaton_constrain() in the same
 *  state: the force of each obstacle's closed contacts, N; the part of it that is friction; and the power that friction
 *  takes
 *  and the power of moving obstacles on the bodies, W. */
void automaton_add_rates(const automaton *c, double t, const double *y, double *a);

/** Makes every change that is due in the state y at t, in the order of candidates, until none is; refreshes the forces.
 *  \return DEM_ERROR_CONTACT on a storm, which is too many events of one candidate in a short time, or for a node found
 *  inside an obstacle; otherwise, when everything is done, the first status other than DEM_OK that the listener
 *  returned */
dem_status automaton_resolve(automaton *c, double t, double *y, const event_listener *listener);

/** The same for one candidate and those that share nodes with it, where no other change is known to be due. Reads and
 *  changes only the state near them; projection, other forces and the broad phase are left to the caller. */
dem_status automaton_resolve_near(automaton *c, dem_index k, double t, double *y, const event_listener *listener);

/** Closed contacts at positions x at t, [*n] in the order of candidates, until the next call or another surface. */
const dem_contact *automaton_list(const automaton *c, double t, const double *x, dem_index *n);

#endif
