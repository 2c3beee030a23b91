/* SPDX-License-Identifier: BSD-3-Clause */
/* What is kept of contact events: energies, impulses given by the obstacles, counts; and who is told. */
#ifndef DEM_CONTACT_LEDGER_H
#define DEM_CONTACT_LEDGER_H

#include "contact/contact_point.h"

typedef struct contact_books {
    double impact, projection;          /* J, taken by impacts, put in by projection */
    double *impulse, *friction_impulse; /* [n_obstacles][2] N s, given to the bodies by impacts */
    dem_counts counts;                  /* those of contacts */
} contact_books;

/** Who is told of events. */
typedef struct contact_listener {
    dem_status (*event)(void *context, const dem_event *event);
    void *context;
} contact_listener;

/** The state being changed: views into y = (x, v), and who is told. */
typedef struct contact_moment {
    double t;
    double *x, *v;
    const contact_listener *listener;
    dem_status told; /* the first status other than DEM_OK that the listener returned */
} contact_moment;

dem_status books_create(contact_books *out, dem_index n_obstacles);
void books_destroy(contact_books *b);

/** Adds an impulse (N s) to an obstacle's: `tangential` is the part of it along the surface. */
void books_add_impulse(contact_books *b, dem_index obstacle, vec2 impulse, vec2 tangential);

/** Counts the event and tells the listener. */
void books_enter(contact_books *b, const dem_event *event, contact_moment *now);

#endif
