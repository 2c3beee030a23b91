/* SPDX-License-Identifier: BSD-3-Clause */
/* The nodes round an event, ring by ring of neighbours, with numbers of their own, and what accelerates them.
 * Nodes of a group that constraints tie together are in one ring: they move at once. */
#ifndef DEM_EVENTS_NEIGHBOURHOOD_H
#define DEM_EVENTS_NEIGHBOURHOOD_H

#include "events/constraints.h"
#include "forces/forces.h"

enum { NEIGHBOURHOOD_RINGS = 8 };

typedef struct neighbourhood_node {
    dem_index i;  /* in the lattice */
    bool grouped; /* it is in a group of the constraints */
} neighbourhood_node;

/** A spring between two of its nodes: first < second. */
typedef struct neighbourhood_bond {
    int32_t first, second;
} neighbourhood_bond;

/** A group of the constraints, in the ring where it begins. */
typedef struct neighbourhood_group {
    dem_index group;
    int ring;
} neighbourhood_group;

typedef struct neighbourhood {
    state_layout layout;
    const forces *acting;
    const constraints *constraints; /* NULL: none */
    bool plain;                     /* springs are all that acts between nodes, and forces do not depend on time */
    int n_rings;                    /* the last is a frame: its nodes accelerate others, but are not accelerated */
    int32_t *number;                /* [n_nodes] the number here of a node of the lattice; -1: none */
    dem_index n, capacity;
    neighbourhood_node *nodes;                /* [n] */
    dem_index end[NEIGHBOURHOOD_RINGS];       /* nodes of ring r or nearer */
    dem_index bonds_end[NEIGHBOURHOOD_RINGS]; /* springs that act on them */
    dem_index n_bonds, bond_capacity;
    neighbourhood_bond *bonds;       /* [n_bonds] */
    double *stiffness, *rest_length; /* [n_bonds] */
    double *dx, *dy, *pull;          /* [n_bonds] scratch */
    dem_index n_groups, group_capacity;
    neighbourhood_group *groups; /* [n_groups] with nodes in it */
} neighbourhood;

/** Borrows forces and constraints. `n_rings` < NEIGHBOURHOOD_RINGS. Free with neighbourhood_destroy(). */
dem_status neighbourhood_create(neighbourhood *out, const state_layout *l, const forces *acting, const constraints *c,
                                int n_rings);
void neighbourhood_destroy(neighbourhood *b);

/** Gathers the nodes round some, which are ring 0: what an event may change at once. */
dem_status neighbourhood_gather(neighbourhood *b, const dem_index *seeds, dem_index n_seeds);

/** Finds the groups again, after an event has changed them. */
dem_status neighbourhood_regroup(neighbourhood *b);

static inline bool neighbourhood_has(const neighbourhood *b, dem_index node, int rings)
{
    return b->number[node] >= 0 && b->number[node] < b->end[rings];
}

/** A state of the nodes: [n][2] by their numbers here. */
typedef struct neighbourhood_state {
    double t; /* s */
    const double *x, *v;
    double *y; /* [4 n_nodes] the same in a state of all nodes, as far as was put there */
} neighbourhood_state;

/** Puts the first n nodes into the state of all. */
void neighbourhood_put(const neighbourhood *b, const neighbourhood_state *s, dem_index n);

/** Evaluates the external force, if there is one, on the nodes of some rings at t; its values go by local numbers. */
void neighbourhood_push(const neighbourhood *b, int rings, double t, const double *x, const double *v);

/** Accelerations a [n][2] of the nodes of some rings, constraints included, in a state that neighbourhood_put() has
 *  filled as far as the next ring. */
void neighbourhood_accelerate(neighbourhood *b, int rings, const neighbourhood_state *s, double *a);

#endif
