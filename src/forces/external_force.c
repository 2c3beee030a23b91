/* SPDX-License-Identifier: BSD-3-Clause */
/* The external force: asks the caller's function for forces on nodes, and keeps its failure (docs/method.md, Forces and
 * motions from outside). An evaluation stands in the middle of a step of the integrator, which cannot be left half-way.
 * After a failure the force is therefore 0 until the time loop has asked for the status with external_force_failure()
 * and thrown the step away. Forces that a deck prescribes are not here but in boundary_conditions.c. */
#include "forces/external_force.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/status.h"

/* Without a function of the caller there is no object: *out stays NULL, and nothing is evaluated. */
dem_status external_force_create(external_force **out, const dem_options *options, int dim, dem_index n_nodes)
{
    const size_t n = (size_t)n_nodes;
    *out = NULL;
    if (options->force == NULL) return DEM_OK;
    external_force *c = calloc(1, sizeof *c);
    CHECK_MEMORY(c);
    *c = (external_force){.force = options->force, .context = options->force_context, .dim = dim, .n_nodes = n_nodes};
    c->all = malloc(n * sizeof *c->all);
    c->value = malloc((size_t)dim * n * sizeof *c->value);
    if (c->all == NULL || c->value == NULL) {
        external_force_destroy(c);
        return status_fail(DEM_ERROR_MEMORY, "out of memory for forces on %lld nodes", (long long)n_nodes);
    }
    for (dem_index i = 0; i < n_nodes; i++) c->all[i] = i;
    *out = c;
    return DEM_OK;
}

void external_force_destroy(external_force *c)
{
    if (c == NULL) return;
    free(c->all);
    free(c->value);
    free(c);
}

/* Keeps the first failure, with time and node for its message. */
static void fail(external_force *c, const dem_force_query *query, dem_status status, dem_index node)
{
    c->status = status;
    c->t = query->t;
    c->node = node;
}

/* A force that is not finite is a failure, too: it would spoil the whole state. The first such node is named. */
static void check(external_force *c, const dem_force_query *query, const double *force)
{
    for (dem_index k = 0; k < c->dim * query->n && c->status == DEM_OK; k++)
        if (!isfinite(force[k])) fail(c, query, DEM_ERROR_INTEGRATOR, query->nodes[k / c->dim]);
}

/* The function is called with forces of 0, so that it may set only some of them. What it has set when it fails is
 * dropped. */
void external_force_ask(external_force *c, const dem_force_query *query, double *force)
{
    const size_t size = (size_t)c->dim * (size_t)query->n * sizeof *force;
    memset(force, 0, size);
    if (c->status != DEM_OK) return;
    const dem_status status = c->force(c->context, query, force);
    if (status != DEM_OK)
        fail(c, query, status, -1);
    else
        check(c, query, force);
    if (c->status != DEM_OK) memset(force, 0, size);
}

void external_force_evaluate(external_force *c, const dem_force_query *query)
{
    external_force_ask(c, query, c->value);
}

void external_force_of_node(external_force *c, double t, dem_index node, const double *x, const double *v,
                            double *force)
{
    external_force_ask(c, &(dem_force_query){.t = t, .n = 1, .nodes = &node, .x = x, .v = v}, force);
}

void external_force_add_power(const external_force *c, const double *v, exact_terms *power)
{
    for (dem_index i = 0; i < c->n_nodes; i++) {
        double of_node = 0.0;
        for (dem_index k = c->dim * i; k < c->dim * (i + 1); k++) of_node += c->value[k] * v[k];
        exact_terms_add(power, of_node);
    }
}

/* Clears the failure, so that a program may go on after it has mended its function. */
dem_status external_force_failure(external_force *c)
{
    const dem_status status = c->status;
    c->status = DEM_OK;
    if (c->node >= 0)
        return status_fail(status, "the external force on node %lld is not finite at t = %.9g s", (long long)c->node,
                           c->t);
    return status_fail(status, "the external force was refused at t = %.9g s", c->t);
}
