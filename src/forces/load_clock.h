/* SPDX-License-Identifier: BSD-3-Clause */
/* The time of the ramps of boundary conditions. It runs with that of the motion, but for pauses, in which it stands
 * still: behind all pauses it is late by their sum. */
#ifndef DEM_FORCES_LOAD_CLOCK_H
#define DEM_FORCES_LOAD_CLOCK_H

#include <stdbool.h>

typedef struct load_clock {
    double late;  /* s, sum of the pauses that are over */
    double since; /* s, time of the motion at which the present pause began */
    bool stands;  /* whether there is one */
} load_clock;

/** Its time, s, at the time t of the motion. */
static inline double load_clock_time(const load_clock *c, double t)
{
    return (c->stands ? c->since : t) - c->late;
}

/** How fast it runs: 1, and 0 in a pause. */
static inline double load_clock_rate(const load_clock *c)
{
    return c->stands ? 0.0 : 1.0;
}

/** Begins a pause at the time t of the motion, if there is none. */
static inline void load_clock_stop(load_clock *c, double t)
{
    if (!c->stands) c->since = t;
    c->stands = true;
}

/** Ends the pause. */
static inline void load_clock_go_on(load_clock *c, double t)
{
    c->late += t - c->since;
    c->stands = false;
}

#endif
