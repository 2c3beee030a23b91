/* SPDX-License-Identifier: BSD-3-Clause */
/* The broad phase: which sites are near enough to touch something else. One that is far from everything sleeps until
 * the bodies may have gone as far. */
#ifndef DEM_CONTACT_BROAD_PHASE_H
#define DEM_CONTACT_BROAD_PHASE_H

#include "contact/contact_set.h"

typedef struct contact_watch {
    double travelled; /* m, no site has gone further since the start */
    double speed;     /* m/s, of watch_speed() at the last look */
    dem_index n;
    dem_index *awake; /* [n] sites that are closed, or may touch something in the next step */
    double
        earliest; /* m, what `travelled` has to reach for the first of the others to wake; infinity: there are none */
} contact_watch;

dem_status watch_create(contact_watch *out, dem_index n_sites);
void watch_destroy(contact_watch *w);

/** Fastest of the nodes that may touch, m/s. */
double watch_speed(const contact_sites *c, const double *v);

/** Looks again at what has woken, before a step from (x, v). A node found inside an obstacle that it cannot have
 *  touched has come round its free end, and is behind it; one that is behind may have come back. */
void watch_look(contact_watch *w, contact_sites *c, const double *x, const double *v);

/** Whether all sites have to be asked after `way` (m) more: else none wakes that was not awake at the last look. */
static inline bool watch_asks_all(const contact_watch *w, double way)
{
    return w->earliest <= w->travelled + way;
}

/** Whether a site may have touched something after `way` (m) more. */
static inline bool watch_wakes(const contact_watch *w, const contact_site *site, double way)
{
    return !site->asleep || site->wake <= w->travelled + way;
}

#endif
