/* SPDX-License-Identifier: BSD-3-Clause */
/* What an event inside a step does to the rest of the step: the change d of the motion that follows from it solves
 *   d'' = a(x + d, contacts after) - a(x, contacts before)
 * and spreads by a ring of neighbours for every two stages of a Runge-Kutta step (for every one where springs are
 * damped). So it is integrated on a patch of 3 (6) rings round the event, by one step of Fehlberg's pair; outside it
 * is 0 to the bit. */
#ifndef DEM_PATCH_H
#define DEM_PATCH_H

#include "method.h"
#include "path.h"
#include "sites.h"

enum { PATCH_STAGES = 6, PATCH_RINGS = 6 };

/** A node of the patch, or a pair of the books. */
typedef struct patch_node {
    dem_index place;     /* in a state */
    bool grouped;        /* it takes part in closed contacts */
    int held;            /* components that a boundary prescribes */
    trail_motion motion; /* without the event, from there on */
} patch_node;

/** Closed contacts that share nodes, in the ring where they begin. */
typedef struct patch_group {
    dem_index group;
    int ring;
} patch_group;

typedef struct patch {
    contact_sites *sites;
    const unsigned char *held;             /* [n_nodes] as boundaries have it */
    double position_error, velocity_error; /* what counts as an error of 1 */
    method_table table;
    int n_rings;       /* that the change spreads over */
    signed char *ring; /* [n_nodes] of a node of the patch; -1: it is none */
    dem_index n, n_books, capacity;
    patch_node *nodes; /* [n] by rings, the last as a frame that stays as it is; then the books [n_books] */
    double *block;     /* those that follow, [n + n_books][2]: */
    double *x[PATCH_STAGES], *v[PATCH_STAGES], *a[PATCH_STAGES]; /* at each stage, without the event: and x'' */
    double *dx[PATCH_STAGES + 1], *dv[PATCH_STAGES + 1], *da[PATCH_STAGES + 1]; /* the change, and at the end */
    dem_index end[PATCH_RINGS + 2];                                             /* nodes of ring r or nearer */
    dem_index n_groups, group_capacity;
    patch_group *groups; /* [n_groups] with nodes in the patch */
    double t, h;         /* s, of the event; from it to the end of the step */
} patch;

/** Borrows the sites, and held. Free with patch_destroy(). */
dem_status patch_create(patch *out, contact_sites *sites, const unsigned char *held, double position_error,
                        double velocity_error);
void patch_destroy(patch *p);

/** Before an event at a site: gathers the patch and what moves it, and puts the state of its nodes at t into `state`
 *  [4 n]. The forces of the closed contacts are to be those at the end of the step. */
dem_status patch_open(patch *p, const path *step, dem_index site, double t, double *state);

/** After the event has changed `state` and the contacts: integrates the change and makes it one of the step.
 *  \param[out] error  squared, of all unknowns of the bodies together, in units of the tolerance */
dem_status patch_close(patch *p, const path *step, trail *tr, double *state, double *error);

#endif
