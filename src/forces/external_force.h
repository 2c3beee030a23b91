/* SPDX-License-Identifier: BSD-3-Clause */
/* The external force, which a function of the caller gives. Where that fails, the computation goes on with a force of
 * 0, since a step of the integrator cannot be left half-way; the time loop checks for the failure after the step.
 * Where ranks share the model the function sees nodes by their numbers in the whole lattice. Each rank asks for the
 * nodes that it integrates: of ghosts it does not know the velocities. */
#ifndef DEM_FORCES_EXTERNAL_FORCE_H
#define DEM_FORCES_EXTERNAL_FORCE_H

#include <stdbool.h>

#include <dem/dem.h>

#include "base/exact_terms.h"
#include "domain/domain.h"

typedef struct external_force {
    dem_force force;
    void *context;
    int dim;
    dem_index n_nodes;
    const domain *domain; /* NULL: all nodes of the lattice are here */
    dem_index n_all;
    dem_index *all;     /* [n_all] nodes that are integrated here, ascending */
    dem_index *numbers; /* [n_nodes] of the nodes of a query in the whole lattice; NULL without a domain */
    double *x, *v;      /* [n_all][dim] side by side, m, m/s; NULL: all nodes are integrated here */
    double *value;      /* [n_nodes][dim] N, of the last query about more than one node */
    double n_asked;     /* queries so far, as many on all ranks */
    dem_status status;  /* DEM_OK; else a failure, since which the force is 0 */
    double t;           /* s, when, */
    double key;         /* in which order of those of all ranks */
    dem_index node;     /* the force on this node of the whole lattice was not finite; -1: the status was returned */
} external_force;

/** Free with external_force_destroy().
 *  \param d  of a model that ranks share, borrowed; NULL: all nodes are here */
dem_status external_force_create(external_force **out, const dem_options *options, int dim, dem_index n_nodes,
                                 const domain *d);
void external_force_destroy(external_force *c);

/** Evaluates the forces on the nodes of a query, into `force`; leaves `value` alone. */
void external_force_ask(external_force *c, const dem_force_query *query, double *force);

/** Counts a query that other ranks make, and this one has no node for. */
void external_force_pass_over(external_force *c);

/** Evaluates the forces on the nodes of a query, into `value`. */
void external_force_evaluate(external_force *c, const dem_force_query *query);

/** Evaluates the forces on all nodes with places x and velocities v [n_nodes][dim] at t, into `value`; 0 on ghosts. */
void external_force_evaluate_all(external_force *c, double t, const double *x, const double *v);

/** The forces on all nodes with places x and velocities v [n_nodes][dim] at t, ghosts too, whose velocities are known;
 *  leaves `value` alone.  \param[out] force  [n_nodes][dim] N */
void external_force_ask_here(external_force *c, double t, const double *x, const double *v, double *force);

/** Force on one node with place x and velocity v at t, N; leaves `value` alone. */
void external_force_of_node(external_force *c, double t, dem_index node, const double *x, const double *v,
                            double *force);

/** Adds the powers of the forces in `value`, those on all nodes, W, with velocities v [n_nodes][dim]; of own nodes. */
void external_force_add_power(const external_force *c, const double *v, exact_terms *power);

/** Whether an evaluation has failed; no force (NULL) never fails. */
static inline bool external_force_failed(const external_force *c)
{
    return c != NULL && c->status != DEM_OK;
}

/** The status and message of the failure, after which the force is evaluated again. */
dem_status external_force_failure(external_force *c);

#endif
