/* SPDX-License-Identifier: BSD-3-Clause */
/* The broad phase: which candidates are near enough to touch something else. One that is far from everything is
 * inactive until the bodies may have gone as far. */
#ifndef DEM_CONTACT_BROAD_PHASE_H
#define DEM_CONTACT_BROAD_PHASE_H

#include "contact/contact_set.h"

typedef struct broad_phase {
    double travelled; /* m, bound of how far any candidate has gone since the start */
    double speed;     /* m/s, broad_phase_speed() at the last update */
    dem_index n, capacity;
    dem_index *active; /* [n] candidates that are closed, or may touch something in the next step */
    double earliest; /* m, `travelled` at which the first inactive candidate becomes active; infinity: there is none */
} broad_phase;

/** Room for as many candidates; it never shrinks.  \return DEM_ERROR_MEMORY */
dem_status broad_phase_reserve(broad_phase *w, dem_index n_candidates);
void broad_phase_destroy(broad_phase *w);

/** Whether no candidate will ever touch anything, since there is nothing to touch. */
static inline bool broad_phase_is_idle(const broad_phase *w, const contact_set *c)
{
    return w->n == 0 && w->earliest == (double)INFINITY && c->ledger.counts.behind == 0;
}

/** Largest speed of the nodes that may touch plus that of the obstacles, m/s. */
double broad_phase_speed(const contact_set *c, const double *v);

/** How far the longest step takes a candidate at this speed, m, and a quarter more. */
static inline double broad_phase_reach(const contact_set *c, double speed)
{
    return 1.25 * c->scene.rule.max_step * speed;
}

/** Measures again, before a step from a state, the clearance of those candidates that may have used it up. A node found
 *  inside an obstacle that it cannot have touched has gone round a free end, and is marked as behind it; one that has
 *  come back is unmarked. */
void broad_phase_update(broad_phase *w, contact_set *c, scene_state state);

/** Lists the active candidates by their clearance, after candidates have come, gone or changed their places. */
void broad_phase_list(broad_phase *w, const contact_set *c);

/** Whether all candidates have to be checked after `way` (m) more: else no inactive one can have touched anything. */
static inline bool broad_phase_covers_all(const broad_phase *w, double way)
{
    return w->earliest <= w->travelled + way;
}

/** Whether a candidate may have touched something after `way` (m) more. */
static inline bool broad_phase_may_touch(const broad_phase *w, const contact_candidate *candidate, double way)
{
    return !candidate->clearance.inactive || candidate->clearance.active_from <= w->travelled + way;
}

#endif
