/* SPDX-License-Identifier: BSD-3-Clause */
/* Evaluates the external force, and keeps its failure. */
#include "forces/external_force.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"

dem_status external_force_create(external_force **out, const dem_options *options, dem_index n_nodes)
{
    const size_t n = (size_t)n_nodes;
    *out = NULL;
    if (options->force == NULL) return DEM_OK;
    external_force *c = calloc(1, sizeof *c);
    CHECK_MEMORY(c);
    *c = (external_force){.force = options->force, .context = options->force_context, .n_nodes = n_nodes};
    c->all = malloc(n * sizeof *c->all);
    c->value = malloc(2 * n * sizeof *c->value);
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

static void fail(external_force *c, const dem_force_query *query, dem_status status, dem_index node)
{
    c->status = status;
    c->t = query->t;
    c->node = node;
}

static void check(external_force *c, const dem_force_query *query, const double *force)
{
    for (dem_index k = 0; k < query->n && c->status == DEM_OK; k++)
        if (!isfinite(force[2 * k]) || !isfinite(force[2 * k + 1]))
            fail(c, query, DEM_ERROR_INTEGRATOR, query->nodes[k]);
}

static void ask(external_force *c, const dem_force_query *query, double *force)
{
    const size_t size = 2 * (size_t)query->n * sizeof *force;
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
    ask(c, query, c->value);
}

vec2 external_force_of_node(external_force *c, double t, dem_index node, vec2 x, vec2 v)
{
    const double at[2] = {x.x, x.y}, speed[2] = {v.x, v.y};
    double force[2];
    ask(c, &(dem_force_query){.t = t, .n = 1, .nodes = &node, .x = at, .v = speed}, force);
    return vec2_at(force, 0);
}

double external_force_power(const external_force *c, const double *v)
{
    double power = 0.0;
    for (dem_index i = 0; i < c->n_nodes; i++) power += vec2_dot(vec2_at(c->value, i), vec2_at(v, i));
    return power;
}

dem_status external_force_failure(external_force *c)
{
    const dem_status status = c->status;
    c->status = DEM_OK;
    if (c->node >= 0)
        return status_fail(status, "the external force on node %lld is not finite at t = %.9g s", (long long)c->node,
                           c->t);
    return status_fail(status, "the external force was refused at t = %.9g s", c->t);
}
