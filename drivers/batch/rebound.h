/* SPDX-License-Identifier: BSD-3-Clause */
/* What came of the contact of a run: when the bodies touched, how they came and how they left, what pushed them. */
#ifndef DEM_REBOUND_H
#define DEM_REBOUND_H

#include <stdbool.h>
#include <stdio.h>

#include <dem/dem.h>

#include "initial_motion.h"

/** Velocities are of the centre of mass of all bodies. To be set to 0. */
typedef struct rebound {
    bool touched;        /* there was a contact; before that what follows is 0 */
    double first, last;  /* s, instants of contact */
    double touching;     /* s of the time between with a lasting contact, as steps see it */
    dem_index n_bounces; /* the last one may not be over; another begins when the centre of mass has left the obstacle
                            and comes back, not where nodes part for a moment */
    double begin;        /* s, of the last bounce */
    double approach[2];  /* m/s, just before the last bounce, */
    double ground[2];    /* m/s, and that of the obstacle where it began */
    double velocity[2];  /* m/s, at the last instant of contact */
    double spin;         /* rad/s, the same, known when that contact is over: angular momentum over moment of inertia,
                            both about that centre */
    double speed;        /* m/s, the part of `velocity` against gravity */
    double normal[2];    /* out of the obstacle that was touched last, there, */
    double place[2];     /* m, and where that was */
    dem_index obstacle;  /* which one */
    bool several;        /* the last bounce touched several obstacles */
    double given[2];     /* N s, by all obstacles, when nothing touched any more */
    double given_before[2]; /* N s, the same before the last bounce */
    double impulse[2];      /* N s, given to the bodies by impacts */
    double reaction[2];     /* N, the largest resultant of the lasting contacts at the end of a step */
    double reaction_t;      /* s, when */
    bool started;           /* a step has been seen */
    double t, before[2];    /* s, m/s: the last accepted step */
    double opened, closed; /* s, the first contact of the step now taken that lasts, the last one that ends; -1: none */
    dem_index n_contacts, n_impacts; /* after the last accepted step */
} rebound;

/** To be called for every contact event.  \param initial  of all bodies as one */
void rebound_note(rebound *r, const initial_motion *initial, const dem_simulation *simulation, const dem_event *event);

/** To be called at t = 0 and after every accepted step in which something touches, and with the state from which the
 *  first of them goes; after others, too. */
void rebound_follow(rebound *r, const dem_simulation *simulation, const dem_progress *now);

/** Whether the last bounce is over, so that there is a velocity after it. */
bool rebound_is_over(const rebound *r);

/** Velocities before and after the last bounce along a normal out of the obstacle, against where it moves, m/s: < 0 in,
 *  > 0 out. NaN where no bounce is over. */
typedef struct rebound_normal {
    double normal[2];   /* that of a straight obstacle; else the direction of what the obstacles gave in the bounce */
    bool along_impulse; /* the latter */
    double in, out;
    double ratio; /* -out/in; NaN where they did not come to the obstacle */
} rebound_normal;
rebound_normal rebound_along(const rebound *r, const dem_simulation *simulation);

/** Velocity of the centre of mass of all bodies against gravity, m/s. */
double rebound_rising_speed(const dem_simulation *simulation);

/** Values below 1e-12 of their scale are printed as 0.
 *  \param extent  m, of all bodies at rest
 *  \param rests   the run ends at rest, where nothing rebounds */
void rebound_print(FILE *out, const rebound *r, const dem_simulation *simulation, double extent, bool rests);

/** When the force was largest, what impacts gave, vertical velocities. */
void rebound_print_details(FILE *out, const rebound *r, const dem_simulation *simulation);

#endif
