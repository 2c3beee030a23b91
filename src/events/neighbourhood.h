/* SPDX-License-Identifier: BSD-3-Clause */
/* The nodes round a contact site, ring by ring of neighbours, with numbers of their own, and what accelerates them.
 * Nodes whose closed contacts are coupled are in one ring: they move at once. */
#ifndef DEM_EVENTS_NEIGHBOURHOOD_H
#define DEM_EVENTS_NEIGHBOURHOOD_H

#include "contact/contact_set.h"

enum { BALL_RINGS = 8 };

typedef struct ball_node {
    dem_index i;  /* in the lattice */
    bool grouped; /* it takes part in closed contacts */
} ball_node;

/** A spring between two of its nodes: first < second. */
typedef struct ball_bond {
    int32_t first, second;
} ball_bond;

/** Closed contacts that share nodes, in the ring where they begin. */
typedef struct ball_group {
    dem_index group;
    int ring;
} ball_group;

typedef struct ball {
    contact_sites *sites;
    bool plain;      /* springs are all that acts between nodes, and forces do not depend on time */
    int n_rings;     /* the last is a frame: its nodes accelerate others, but are not accelerated */
    int32_t *number; /* [n_nodes] of a node of the lattice here; -1: it is not */
    dem_index n, capacity;
    ball_node *nodes;                /* [n] */
    dem_index end[BALL_RINGS];       /* nodes of ring r or nearer */
    dem_index bonds_end[BALL_RINGS]; /* springs that act on them */
    dem_index n_bonds, bond_capacity;
    ball_bond *bonds;                /* [n_bonds] */
    double *stiffness, *rest_length; /* [n_bonds] */
    double *dx, *dy, *pull;          /* [n_bonds] scratch */
    dem_index n_groups, group_capacity;
    ball_group *groups; /* [n_groups] with nodes in it */
} ball;

/** Borrows the sites. `n_rings` < BALL_RINGS. Free with ball_destroy(). */
dem_status ball_create(ball *out, contact_sites *sites, int n_rings);
void ball_destroy(ball *b);

/** Gathers the nodes round a site. Ring 0 is what an event there may change at once: its nodes, and where obstacles
 *  have vertices those of the edges at them. */
dem_status ball_gather(ball *b, dem_index site);

/** Finds the groups again, after contacts have opened or closed. */
dem_status ball_regroup(ball *b);

static inline bool ball_has(const ball *b, dem_index node, int rings)
{
    return b->number[node] >= 0 && b->number[node] < b->end[rings];
}

/** A state of the nodes: [n][2] by their numbers here. */
typedef struct ball_state {
    const double *x, *v;
    double *y; /* [4 n_nodes] the same in a state of all nodes, as far as was put there */
} ball_state;

/** Puts the first n nodes into the state of all. */
void ball_put(const ball *b, const ball_state *s, dem_index n);

/** Asks for the forces from outside, if there are any, on the nodes of some rings at t: the answer is by their numbers
 *  here. */
void ball_push(const ball *b, int rings, double t, const double *x, const double *v);

/** Accelerations a [n][2] of the nodes of some rings, closed contacts included, in a state that ball_put() has put as
 *  far as one ring more. */
void ball_accelerate(ball *b, int rings, const ball_state *s, double *a);

#endif
