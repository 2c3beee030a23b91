/* SPDX-License-Identifier: BSD-3-Clause */
/* The broad phase: which candidates are near enough to touch something else. One that is far from everything sleeps
 * until the bodies may have gone as far. */
#ifndef DEM_CONTACT_BROAD_PHASE_H
#define DEM_CONTACT_BROAD_PHASE_H

#include "contact/contact_set.h"

typedef struct broad_phase {
    double travelled; /* m, no candidate has gone further since the start */
    double speed;     /* m/s, of broad_phase_speed() at the last look */
    dem_index n;
    dem_index *active; /* [n] candidates that are closed, or may touch something in the next step */
    double
        earliest; /* m, what `travelled` has to reach for the first of the others to wake; infinity: there are none */
} broad_phase;

dem_status broad_phase_create(broad_phase *out, dem_index n_candidates);
void broad_phase_destroy(broad_phase *w);

/** Fastest of the nodes that may touch and of the obstacles, together, m/s. */
double broad_phase_speed(const contact_set *c, const double *v);

/** Looks again at what has woken, before a step from a state. A node found inside an obstacle that it cannot have
 *  touched has come round its free end, and is behind it; one that is behind may have come back. */
void broad_phase_update(broad_phase *w, contact_set *c, scene_state state);

/** Whether all candidates have to be asked after `way` (m) more: else none becomes active that was inactive at the
 *  last look. */
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
