/* SPDX-License-Identifier: BSD-3-Clause */
/* The contact automaton of all sites: what changes when a node touches an obstacle, leaves it, slides off a
 * segment's end or is stopped in a corner. Guards (site.c) and resets depend on (t, x, v) and the forces that follow
 * from x, and on nothing of the integrator. What an impact does to a velocity is impact.c's. */
#ifndef DEM_CONTACT_H
#define DEM_CONTACT_H

#include "site.h"

typedef struct contact {
    contact_scene scene;
    contact_site *sites;      /* [n_sites of the model] */
    double impact_energy;     /* J, taken so far */
    double projection_energy; /* J, put in so far */
    double *impulse;          /* [n_obstacles][2] N s, given to the bodies so far */
    dem_counts counts;        /* impacts, closings, releases, passings, late, behind */
    dem_index idle;           /* events in a row that changed nothing */
} contact;

/** Who is told of events. */
typedef struct contact_listener {
    dem_status (*event)(void *context, const dem_event *event);
    void *context;
} contact_listener;

dem_status contact_create(contact *out, const dem_model *model, const contact_rule *rule);
void contact_destroy(contact *c);

/** Whether no site is deeper in an obstacle than the skin: else DEM_ERROR_MODEL names the node.  \param x [n][2] */
dem_status contact_admissible(const contact *c, const double *x);

/** Takes up the contacts of the initial state y = (x, v), where touching is enough. */
dem_status contact_start(contact *c, double t, double *y, const contact_listener *listener);

/** Values of all guards at a state, [n_sites][SITE_GUARDS]: see site_guards(). */
void contact_guards(const contact *c, const double *y, double *g);

/** Takes from the accelerations a [n][2] what the closed contacts hold. */
void contact_constrain(const contact *c, double *a);

/** Looks in an accepted step for what the root finder has not seen: a site inside an obstacle, a closed contact that
 *  should have ended, an entry and exit within the step. If there is one, cuts path->end short to the first and
 *  returns true. `rooted`: the path ends at a root already. \param[out] state  [4 n] scratch */
bool contact_check(contact *c, path *p, bool rooted, double *state);

/** Follows an accepted step of length h that ends at y: adds the reactions' impulse over it, refreshes the forces,
 *  and notes which nodes have come from behind an obstacle to its front. */
void contact_follow(contact *c, double h, const double *y);

/** Makes every change that is due in the state y at t, in the order of node ids, until none is; refreshes the
 *  forces.
 *  \return DEM_ERROR_CONTACT on a storm, or for a node found inside an obstacle; else, everything done, the first
 *  status other than DEM_OK that the listener returned */
dem_status contact_resolve(contact *c, double t, double *y, const contact_listener *listener);

/** Closed contacts, in the order of nodes, into list [2 n_sites]; returns their number. */
dem_index contact_list(const contact *c, dem_contact *list);

#endif
