/* SPDX-License-Identifier: BSD-3-Clause */
/* What came of the contact of a run: when the bodies touched, how they came and how they left, what pushed them. */
#ifndef DEM_REBOUND_H
#define DEM_REBOUND_H

#include <stdbool.h>
#include <stdio.h>

#include <dem/dem.h>

/** Velocities are of the centre of mass of all bodies. To be set to 0. */
typedef struct rebound {
    bool touched;          /* there was a contact; before that what follows is 0 */
    double first, last;    /* s, instants of contact */
    double touching;       /* s of the time between with a lasting contact, as steps see it */
    double approach[2];    /* m/s, just before the first contact */
    double velocity[2];    /* m/s, at the last instant of contact */
    double spin;           /* rad/s, the same: angular momentum over moment of inertia, both about that centre */
    double speed;          /* m/s, the part of `velocity` against gravity */
    double normal[2];      /* out of the obstacle that was touched last, there */
    dem_index obstacle;    /* which one */
    double impulse[2];     /* N s, given to the bodies by impacts */
    double reaction[2];    /* N, the largest resultant of the lasting contacts at the end of a step */
    double reaction_t;     /* s, when */
    bool started;          /* a step has been seen */
    double t, before[2];   /* s, m/s: the last accepted step */
    double opened, closed; /* s, the first contact of the step now taken that lasts, the last one that ends; -1: none */
    dem_index n_contacts, n_impacts; /* after the last accepted step */
} rebound;

/** To be called for every contact event. */
void rebound_note(rebound *r, const dem_simulation *simulation, const dem_event *event);

/** To be called at t = 0 and after every accepted step. */
void rebound_follow(rebound *r, const dem_simulation *simulation, const dem_state *state);

/** Velocities along the normal and out of the obstacle, against where it moves, m/s: < 0 in, > 0 out. NaN where nothing
 *  was touched. */
typedef struct rebound_normal {
    double in, out;
    double ratio; /* -out/in; NaN where they did not come to the obstacle */
} rebound_normal;
rebound_normal rebound_along(const rebound *r, const dem_simulation *simulation);

/** Velocity of the centre of mass of all bodies against gravity, m/s. */
double rebound_rising_speed(const dem_simulation *simulation);

void rebound_print(FILE *out, const rebound *r, const dem_simulation *simulation);

/** The vertical velocities alone. */
void rebound_print_details(FILE *out, const rebound *r, const dem_simulation *simulation);

#endif
