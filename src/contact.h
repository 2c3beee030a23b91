/* SPDX-License-Identifier: BSD-3-Clause */
/* The contact automaton: when a node touches an obstacle, leaves it, slides off a segment's end or is stopped in a corner.
 * Guards and resets depend on (t, x, v) and the forces that follow from x, and on nothing of the integrator. What an
 * impact does to a velocity is impact.c's. */
#ifndef DEM_CONTACT_H
#define DEM_CONTACT_H

#include "model.h"
#include "path.h"

/** Guard functions per site; each is > 0 while nothing happens and falls through 0 when something does. */
#define CONTACT_GUARDS 3

/** One node that may touch. FREE: n_closed = 0; sliding on a segment: 1; held in a corner: 2. */
typedef struct contact_site {
    dem_index node;
    dem_index behind; /* obstacle whose free end the node has passed round, or -1 */
    int n_closed;
    dem_index segments[2];
    dem_contact closed[2];
    double storm_start; /* s */
    dem_index storm;    /* changes of this site since then */
} contact_site;

typedef struct contact_rule {
    double skin;           /* m, depth at which an impact is taken */
    double position_error; /* m, tolerance of positions: hops below it are rest */
    double rest_speed;     /* m/s, 0: by the rule */
    double max_step;       /* s, longest step: with t it sets how exactly an event is located */
    double storm_time;     /* s */
    dem_index max_impacts; /* within storm_time at one node */
    double gravity[2];     /* m/s^2 */
} contact_rule;

typedef struct contact {
    const dem_model *model;
    contact_rule rule;
    contact_site *sites;      /* [model->n_sites] */
    double impact_energy;     /* J, taken so far */
    double projection_energy; /* J, put in so far */
    double *impulse;          /* [n_obstacles][2] N s, given to the bodies so far */
    dem_counts counts;        /* impacts, closings, releases, passings, late, behind */
} contact;

/** Who is told of impacts; the first status other than DEM_OK is returned by contact_resolve. */
typedef struct contact_listener {
    dem_status (*impact)(void *context, const dem_impact *impact);
    void *context;
} contact_listener;

dem_status contact_create(contact *out, const dem_model *model, const contact_rule *rule);
void contact_destroy(contact *c);

/** Whether no site is deeper in an obstacle than the skin: else DEM_ERROR_MODEL names the node.  \param x [n][2] */
dem_status contact_admissible(const contact *c, const double *x);

/** Takes up the contacts of the initial state y = (x, v), where touching is enough. */
dem_status contact_start(contact *c, double t, double *y, const contact_listener *listener);

/** Values of all guards at a state: [n_sites][CONTACT_GUARDS].
 *  free: gap + skin; sliding: reaction, distance to the segment's nearer end, gap to everything else + skin;
 *  held: both reactions. */
void contact_guards(const contact *c, const double *y, double *g);

/** Takes from the accelerations a [n][2] what the closed contacts hold. */
void contact_constrain(const contact *c, double *a);

/** Looks in an accepted step for what the root finder has not seen: a site inside an obstacle, a closed contact that should
 *  have ended, an entry and exit within the step. If there is one, cuts path->end short to the first and returns true.
 *  `rooted`: the path ends at a root already. \param[out] state  [4 n] scratch */
bool contact_check(contact *c, path *p, bool rooted, double *state);

/** Adds the reactions' impulse over the step of length h that ends at y, and refreshes the forces. */
void contact_accumulate(contact *c, double h, const double *y);

/** Makes every change that is due in the state y at t, in the order of node ids, until none is; refreshes the forces.
 *  \return DEM_ERROR_CONTACT on a storm, or for a node found inside an obstacle */
dem_status contact_resolve(contact *c, double t, double *y, const contact_listener *listener);

/** Closed contacts, in the order of nodes, into list [2 n_sites]; returns their number. */
dem_index contact_list(const contact *c, dem_contact *list);

#endif
