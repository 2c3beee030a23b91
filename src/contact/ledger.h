/* SPDX-License-Identifier: BSD-3-Clause */
/* Sums over contact events: energies, impulses given by the obstacles, counts. They are exact, and so do not depend on
 * the order of events. Every rank of a model that ranks share has all of them. */
#ifndef DEM_CONTACT_LEDGER_H
#define DEM_CONTACT_LEDGER_H

#include "base/exact_sum.h"
#include "contact/contact_point.h"
#include "events/event_listener.h"

typedef struct contact_ledger {
    exact_sum impact, projection;          /* J, taken by impacts, put in by projection */
    exact_sum work;                        /* J, put in by moving obstacles at impacts */
    exact_sum *impulse, *friction_impulse; /* [n_obstacles][2] N s, given to the bodies by impacts */
    dem_counts counts;                     /* those of contacts */
} contact_ledger;

/** The state that events change, as views into y = (x, v), and the listener to call. */
typedef struct contact_instant {
    double t;
    double *x, *v;
    const event_listener *listener;
    dem_status listener_status; /* the first status other than DEM_OK that the listener returned */
} contact_instant;

static inline scene_state instant_state(const contact_instant *now)
{
    return (scene_state){now->t, now->x, now->v};
}

dem_status ledger_create(contact_ledger *out, dem_index n_obstacles);
void ledger_destroy(contact_ledger *b);

/** Makes `to`, which has been created for as many obstacles, equal to `from`. */
void ledger_copy(contact_ledger *to, const contact_ledger *from, dem_index n_obstacles);

/** Adds a vector to the sums of both components. */
static inline void ledger_add_vector(exact_sum sum[2], vec2 term)
{
    exact_sum_add(&sum[0], term.x);
    exact_sum_add(&sum[1], term.y);
}

/** Adds an impulse (N s) to an obstacle's: `tangential` is the part of it along the surface. */
void ledger_add_impulse(contact_ledger *b, dem_index obstacle, vec2 impulse, vec2 tangential);

/** The impulses of all obstacles, and then those of friction, rounded. \param[out] list  [2 n_obstacles][2] N s */
void ledger_list_impulses(const contact_ledger *b, dem_index n_obstacles, double *list);

/** Begins the sums of impulses anew with such a list. */
void ledger_begin_impulses(contact_ledger *b, dem_index n_obstacles, const double *list);

/** Counts the event and calls the listener. */
void ledger_enter(contact_ledger *b, const dem_event *event, contact_instant *now);

#endif
