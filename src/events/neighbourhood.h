/* SPDX-License-Identifier: BSD-3-Clause */
/* The nodes round an event, ring by ring of neighbours, with numbers of their own, and what accelerates them.
 * Nodes of a group that constraints tie together are in one ring: they move at once. */
#ifndef DEM_EVENTS_NEIGHBOURHOOD_H
#define DEM_EVENTS_NEIGHBOURHOOD_H

#include "events/constraints.h"
#include "forces/local_forces.h"

/** A group of the constraints, in the ring where it begins. */
typedef struct neighbourhood_group {
    dem_index group;
    int ring;
} neighbourhood_group;

/** The nodes that an event may change at once. */
typedef struct neighbourhood_seeds {
    const dem_index *list;
    dem_index n;
    bool by_forces; /* the forces between them, and neither positions nor velocities */
} neighbourhood_seeds;

typedef struct neighbourhood {
    state_layout layout;
    int n_rings; /* at most */
    const local_forces *forces;
    const constraints *constraints; /* NULL: none */
    local_nodes nodes;
    dem_index n_felt; /* the first ones of them, which may feel the event: they or neighbours move otherwise after it */
    dem_index n_groups, group_capacity;
    neighbourhood_group *groups; /* [n_groups] with nodes in it */
} neighbourhood;

/** Borrows forces and constraints. Free with neighbourhood_destroy(). */
dem_status neighbourhood_create(neighbourhood *out, const state_layout *layout, const local_forces *f,
                                const constraints *c, int n_rings);
void neighbourhood_destroy(neighbourhood *b);

/** Gathers the nodes round the seeds, which are ring 0: as many rings as there may be, or one less where only forces
 *  between the seeds change and no constraint holds them. */
dem_status neighbourhood_gather(neighbourhood *b, neighbourhood_seeds seeds);

/** Whether there is one ring less. */
static inline bool neighbourhood_is_short(const neighbourhood *b)
{
    return b->nodes.n_rings < b->n_rings;
}

/** Finds the groups again, after an event has changed them. */
dem_status neighbourhood_regroup(neighbourhood *b);

/** Puts the first n nodes of a local state into the state y of all. */
void neighbourhood_put(const neighbourhood *b, const local_state *s, dem_index n, double *y);

/** Accelerations a [n][dim] of the nodes of a ring or nearer, constraints included, in a state that
 *  neighbourhood_put() has filled as far as the next ring. */
void neighbourhood_accelerate(neighbourhood *b, int ring, const local_state *s, double *a);

#endif
