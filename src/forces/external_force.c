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

static dem_status allocate(external_force *c)
{
    const size_t n = (size_t)c->n_nodes, row = (size_t)c->dim * sizeof(double);
    const bool is_shared = c->domain != NULL;
    c->all = malloc(n * sizeof *c->all);
    c->value = malloc(n * row);
    if (is_shared) {
        c->numbers = malloc(n * sizeof *c->numbers);
        c->x = malloc(n * row);
        c->v = malloc(n * row);
    }
    CHECK(c->all && c->value && (!is_shared || (c->numbers && c->x && c->v)), DEM_ERROR_MEMORY,
          "out of memory for forces on %lld nodes", (long long)c->n_nodes);
    return DEM_OK;
}

/* Without a function of the caller there is no object: *out stays NULL, and nothing is evaluated. */
dem_status external_force_create(external_force **out, const dem_options *options, int dim, dem_index n_nodes,
                                 const domain *d)
{
    *out = NULL;
    if (options->force == NULL) return DEM_OK;
    external_force *c = calloc(1, sizeof *c);
    CHECK_MEMORY(c);
    *c = (external_force){
        .force = options->force, .context = options->force_context, .dim = dim, .n_nodes = n_nodes, .domain = d};
    const dem_status status = allocate(c);
    if (status != DEM_OK) {
        external_force_destroy(c);
        return status;
    }
    for (dem_index i = 0; i < n_nodes; i++)
        if (d == NULL || !d->is_ghost[i]) c->all[c->n_all++] = i;
    *out = c;
    return DEM_OK;
}

void external_force_destroy(external_force *c)
{
    if (c == NULL) return;
    free(c->all);
    free(c->numbers);
    free(c->x);
    free(c->v);
    free(c->value);
    free(c);
}

/* Keeps the first failure, with time and node for its message. Ranks make the same queries in the same order; of those
 * that fail in one, the lowest node is named, as by a process alone. */
static void fail(external_force *c, const dem_force_query *query, dem_status status, dem_index node)
{
    const double n_whole = (double)(c->domain != NULL ? c->domain->n_whole : c->n_nodes);
    c->status = status;
    c->t = query->t;
    c->node = node;
    c->key = c->n_asked + (double)(node + 1) / (n_whole + 1.0);
}

/* A force that is not finite is a failure, too: it would spoil the whole state. The first such node is named. */
static void check(external_force *c, const dem_force_query *query, const double *force)
{
    for (dem_index k = 0; k < c->dim * query->n && c->status == DEM_OK; k++)
        if (!isfinite(force[k])) fail(c, query, DEM_ERROR_INTEGRATOR, query->nodes[k / c->dim]);
}

/* The function is called with forces of 0, so that it may set only some of them. What it has set when it fails is
 * dropped.
 * \param query  with numbers of the whole lattice */
static void ask(external_force *c, const dem_force_query *query, double *force)
{
    const size_t size = (size_t)c->dim * (size_t)query->n * sizeof *force;
    memset(force, 0, size);
    c->n_asked++;
    if (c->status != DEM_OK) return;
    const dem_status status = c->force(c->context, query, force);
    if (status != DEM_OK)
        fail(c, query, status, -1);
    else
        check(c, query, force);
    if (c->status != DEM_OK) memset(force, 0, size);
}

void external_force_pass_over(external_force *c)
{
    c->n_asked++;
}

void external_force_ask(external_force *c, const dem_force_query *query, double *force)
{
    dem_force_query whole = *query;
    for (dem_index k = 0; k < query->n && c->domain != NULL; k++) c->numbers[k] = c->domain->number[query->nodes[k]];
    if (c->domain != NULL) whole.nodes = c->numbers;
    ask(c, &whole, force);
}

void external_force_ask_here(external_force *c, double t, const double *x, const double *v, double *force)
{
    ask(c, &(dem_force_query){t, c->n_nodes, c->domain != NULL ? c->domain->number : c->all, x, v}, force);
}

void external_force_evaluate(external_force *c, const dem_force_query *query)
{
    external_force_ask(c, query, c->value);
}

static void copy_row(const external_force *c, double *to, dem_index row, const double *from, dem_index of)
{
    for (int k = 0; k < c->dim; k++) to[c->dim * row + k] = from[c->dim * of + k];
}

/* The answers, which are side by side, go to the places of their nodes, the last one first; ghosts get 0. */
static void spread(external_force *c)
{
    dem_index k = c->n_all - 1;
    for (dem_index i = c->n_nodes - 1; i >= 0; i--) {
        const bool is_here = k >= 0 && c->all[k] == i;
        if (is_here)
            copy_row(c, c->value, i, c->value, k--);
        else
            memset(c->value + c->dim * i, 0, (size_t)c->dim * sizeof *c->value);
    }
}

void external_force_evaluate_all(external_force *c, double t, const double *x, const double *v)
{
    dem_force_query query = {t, c->n_all, c->all, x, v};
    if (c->domain == NULL) {
        external_force_evaluate(c, &query);
        return;
    }
    for (dem_index k = 0; k < c->n_all; k++) {
        copy_row(c, c->x, k, x, c->all[k]);
        copy_row(c, c->v, k, v, c->all[k]);
    }
    query.x = c->x;
    query.v = c->v;
    external_force_evaluate(c, &query);
    spread(c);
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
        if (!domain_owns(c->domain, i)) continue;
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
