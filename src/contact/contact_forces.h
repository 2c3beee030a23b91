/* SPDX-License-Identifier: BSD-3-Clause */
/* Forces in closed contacts. Contacts that share nodes are coupled: each group of them is one linear system, in the
 * order of the bodies' boundaries so that it is banded. The same system takes velocities and positions to where closed
 * contacts ask for. */
#ifndef DEM_CONTACT_CONTACT_FORCES_H
#define DEM_CONTACT_CONTACT_FORCES_H

#include "contact/contact_point.h"

/** Force of a closed contact on the body, N. */
typedef struct reaction {
    double normal, tangent;
} reaction;

/** One unknown: a force along `push` on the nodes of a contact, such that the point's motion along `direction` is as
 *  asked for. */
typedef struct reaction_row {
    dem_index site;
    int q;
    bool tangential;
    int n;
    dem_index node[2];
    double weight[2];
    vec2 direction, push;
    double wanted; /* right-hand side, then the solution */
} reaction_row;

typedef struct reactions {
    const contact_scene *scene;
    const contact_site *sites; /* [n_sites] nodes first, then edges */
    dem_index n_sites;
    dem_index *order;                   /* [n_sites] along the boundaries */
    dem_index n_groups, *row, *members; /* group g: sites members[row[g]] .. members[row[g+1]-1], all closed */
    dem_index *group;                   /* [n_sites] of a closed site */
    reaction (*force)[2];               /* [n_sites] of each closed contact, as last solved for */
    dem_index *root, *first;            /* [n_nodes] scratch: union-find; first row that touches the node */
    double *a;                          /* [2 n_nodes] scratch */
    reaction_row *rows;                 /* [4 n_sites] scratch */
    double *band;                       /* [capacity] scratch */
    size_t capacity;
} reactions;

/** Borrows scene and sites. Free with reactions_destroy. */
dem_status reactions_create(reactions *out, const contact_scene *scene, const contact_site *sites, dem_index n_sites);
void reactions_destroy(reactions *r);

/** Finds the groups; to be called when a site has opened or closed a contact.  \return DEM_ERROR_MEMORY */
dem_status reactions_regroup(reactions *r);

/** Takes from the free accelerations a [n][2] what all closed contacts hold; fills force. */
void reactions_hold(reactions *r, const double *x, const double *v, double *a);

/** Fills force for the contacts of one group in a state. */
void reactions_solve(reactions *r, dem_index group, const double *x, const double *v);

/** Takes from the velocities of a group's nodes what the closed contacts do not allow; fills force with the impulses
 *  that this takes, N s. */
void reactions_stop(reactions *r, dem_index group, const double *x, double *v);

/** How far the nodes of a group have to be moved, [n][2], so that its contacts touch, to first order. */
const double *reactions_shift(reactions *r, dem_index group, const double *x, const double *v);

#endif
