/* SPDX-License-Identifier: BSD-3-Clause */
/* Forces in closed contacts. Contacts that share nodes are coupled: each group of them is one linear system, in the
 * order of the bodies' boundaries so that it is banded. The same system yields the impulses that stop a group, and the
 * displacements that put it back on the surfaces. The contacts' states (stick, slip and its sign) are given; nothing
 * here decides about them. */
#ifndef DEM_CONTACT_CONTACT_FORCES_H
#define DEM_CONTACT_CONTACT_FORCES_H

#include "contact/group_walk.h"
#include "events/constraints.h"

/** Force of a closed contact on the body, N. */
typedef struct contact_force {
    double normal, tangent;
} contact_force;

/** One unknown: a force along `push` on the nodes of a contact, such that the point's motion along `direction` is as
 *  asked for. */
typedef struct contact_equation {
    dem_index candidate;
    int q;
    bool tangential;
    contact_nodes nodes;
    vec2 direction, push;
    double wanted; /* right-hand side, then the solution */
} contact_equation;

typedef struct contact_forces {
    const contact_scene *scene;
    const contact_candidate *candidates; /* [n_candidates] nodes first, then edges */
    dem_index n_candidates;
    dem_index n_groups;
    dem_index *groups;         /* [n_groups] by their first candidates, in the order of candidate_is_before(); from it
                                  next[] leads along the boundary through all of a group, which are closed */
    dem_index *group, *next;   /* [n_candidates] of a closed candidate, else -1; the next of its group, or -1 */
    int32_t *at_node;          /* [n_nodes] the group that has closed contacts at a node, or -1 */
    dem_index *members;        /* [2 n_candidates] scratch: candidates whose groups are found again, */
    group_walk walk;           /* and their order */
    contact_force (*force)[2]; /* [n_candidates] of each closed contact, as last solved for */
    dem_index *root, *first;   /* [n_nodes] scratch: union-find; first row that touches the node */
    double *a;              /* [n_nodes][2] accelerations of the nodes of the group last solved for, or its shifts; of
                                  others not set */
    contact_equation *rows; /* [4 n_candidates] scratch */
    double *band;           /* [capacity] scratch */
    size_t capacity;
} contact_forces;

/** Borrows scene and candidates. Free with contact_forces_destroy. */
dem_status contact_forces_create(contact_forces *out, const contact_scene *scene, const contact_candidate *candidates,
                                 dem_index n_candidates);
void contact_forces_destroy(contact_forces *r);

/** Finds all groups.  \return DEM_ERROR_MEMORY */
dem_status contact_forces_regroup(contact_forces *r);

/** Finds the groups again when these candidates have opened or closed contacts, and no others: the cost is that of the
 *  groups that they leave and join.
 *  \return DEM_ERROR_MEMORY, with the groups as they should be */
dem_status contact_forces_regroup_some(contact_forces *r, const dem_index *changed, dem_index n);

/** The groups at some nodes, each once and in the order of `groups`, into `list`, which holds until groups are found
 *  again.  \return how many */
dem_index contact_forces_groups_at(contact_forces *r, const dem_index *nodes, dem_index n, const dem_index **list);

/** Adds to the free accelerations a [n][2] those by the forces of all closed contacts; fills force. */
void contact_forces_hold(contact_forces *r, scene_state state, double *a);

/** Fills force for the contacts of one group in a state. */
void contact_forces_solve(contact_forces *r, dem_index group, scene_state state);

/** The same where some free accelerations are known; NULL: none. */
void contact_forces_solve_free(contact_forces *r, dem_index group, scene_state state, const constraint_free *known);

/** Takes from the velocities v [n][2] of a group's nodes, which are those of the state, what the closed contacts do not
 *  allow; fills force with the impulses that this takes, N s. */
void contact_forces_stop(contact_forces *r, dem_index group, scene_state state, double *v);

/** How far the nodes of a group have to be moved, [n][2], so that its contacts touch, to first order. */
const double *contact_forces_shift(contact_forces *r, dem_index group, scene_state state);

#endif
