/* SPDX-License-Identifier: BSD-3-Clause */
/* The force from outside: how it is asked for. What asks goes on with a force of 0 when there is no answer, so that
 * nothing in the midst of its work has to give up; who began the work looks afterwards. */
#ifndef DEM_FORCES_EXTERNAL_FORCE_H
#define DEM_FORCES_EXTERNAL_FORCE_H

#include <stdbool.h>

#include "base/vec2.h"

typedef struct external_force {
    dem_force force;
    void *context;
    dem_index n_nodes;
    dem_index *all;    /* [n_nodes] 0, 1, 2 ... */
    dem_index *some;   /* [n_nodes] for who asks about some nodes only */
    double *value;     /* [n_nodes][2] N, to the last question about more than one */
    dem_status status; /* DEM_OK; else there is no answer any more, since */
    double t;          /* s, when */
    dem_index node;    /* the force on this node was not finite; -1: the status was returned */
} external_force;

/** Free with external_force_destroy(). */
dem_status external_force_create(external_force **out, const dem_options *options, dem_index n_nodes);
void external_force_destroy(external_force *c);

/** Puts the forces on the nodes that are asked about into `answer`. */
void external_force_evaluate(external_force *c, const dem_force_query *query);

/** Force on one node with place x and velocity v at t, N; leaves `answer` alone. */
vec2 external_force_of_node(external_force *c, double t, dem_index node, vec2 x, vec2 v);

/** Power of the answer about all nodes, W, with velocities v [n_nodes][2]. */
double external_force_power(const external_force *c, const double *v);

/** Whether a question had no answer; of no coupling none has been asked. */
static inline bool external_force_failed(const external_force *c)
{
    return c != NULL && c->status != DEM_OK;
}

/** The status and message of the failure, after which the force is asked again. */
dem_status external_force_failure(external_force *c);

#endif
