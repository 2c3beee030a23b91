/* SPDX-License-Identifier: BSD-3-Clause */
/* Boundary conditions: components of the motion of chosen nodes that are prescribed, and forces put on nodes, both
 * times a ramp r(t) (base/ramp.h; docs/method.md, Boundary conditions).
 * Prescribed components stay unknowns of the ODE and get given derivatives; the force that this takes follows as a
 * reaction. Fixed nodes are not here but have an inverse mass of 0 (model/model.c); forces that a program computes are
 * in external_force.c. */
#include "forces/boundary_conditions.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/exact_sum.h"
#include "base/ramp.h"
#include "base/status.h"
#include "base/struct_size.h"

enum { BOTH = DEM_COMPONENT_X | DEM_COMPONENT_Y };

/* ---- functions of time ---- */

double boundary_condition_ramp(const boundary_condition *b, double t)
{
    return ramp_value(b->ramp, t);
}

/* A velocity condition moves its nodes with V r, hence by V times the integral of r; a displacement condition by U
 * r. */
vec2 boundary_condition_displacement(const boundary_condition *b, double t)
{
    return vec2_scale(b->kind == DEM_BOUNDARY_VELOCITY ? ramp_area(b->ramp, t) : boundary_condition_ramp(b, t),
                      b->value);
}

/* This is the time derivative of the displacement, and the acceleration below is that of the velocity. */
vec2 boundary_condition_velocity(const boundary_condition *b, double t)
{
    return vec2_scale(b->kind == DEM_BOUNDARY_VELOCITY ? boundary_condition_ramp(b, t) : ramp_slope(b->ramp, t),
                      b->value);
}

vec2 boundary_condition_acceleration(const boundary_condition *b, double t)
{
    return vec2_scale(b->kind == DEM_BOUNDARY_VELOCITY ? ramp_slope(b->ramp, t) : ramp_curvature(b->ramp, t), b->value);
}

/* ---- all of them, in a state ---- */

/* Prescribed motions are functions of the time of the ramps, which runs at the rate 1 or 0: derivatives with respect to
 * that of the motion have this factor, once or twice. */
static vec2 velocity_at(const boundary_conditions *all, const boundary_condition *b, double t)
{
    return vec2_scale(load_clock_rate(&all->clock), boundary_condition_velocity(b, load_clock_time(&all->clock, t)));
}

vec2 boundary_conditions_acceleration(const boundary_conditions *all, const boundary_condition *b, double t)
{
    return vec2_scale(load_clock_rate(&all->clock),
                      boundary_condition_acceleration(b, load_clock_time(&all->clock, t)));
}

vec2 boundary_conditions_push(const boundary_conditions *all, const boundary_condition *b, double t)
{
    return vec2_scale(boundary_condition_ramp(b, load_clock_time(&all->clock, t)), b->value);
}

/* The sum over the list of the node's forces, in one order for each model, so that it has the same bits everywhere. */
vec2 boundary_conditions_force(const boundary_conditions *b, dem_index i, double t)
{
    const double now = load_clock_time(&b->clock, t);
    vec2 force = {0.0, 0.0};
    for (dem_index p = b->first != NULL ? b->first[i] : -1; p >= 0; p = b->pushes[p].next) {
        const boundary_condition *from = &b->list[b->pushes[p].boundary];
        force = vec2_along(force, b->pushes[p].share * boundary_condition_ramp(from, now), from->value);
    }
    return force;
}

/* Powers of a force on its nodes, W. */
static void add_push_power(const boundary_conditions *all, const boundary_condition *b, double t, const double *v,
                           exact_terms *power)
{
    const vec2 force = boundary_conditions_push(all, b, t);
    for (dem_index k = 0; k < b->n_nodes; k++)
        exact_terms_add(power, b->share[k] * vec2_dot(force, vec2_at(v, b->nodes[k])));
}

/* The prescribed vector in the components that the condition names, the free one in the others. */
static vec2 with_components(const boundary_condition *b, vec2 free, vec2 prescribed)
{
    return (vec2){b->components & DEM_COMPONENT_X ? prescribed.x : free.x,
                  b->components & DEM_COMPONENT_Y ? prescribed.y : free.y};
}

/* Puts prescribed components into velocities f and accelerations a. To change the free acceleration to the prescribed
 * one takes the reaction R = m (a - a_free) on each node, whose power R.v is added. */
static void prescribe(const boundary_conditions *all, const boundary_condition *b, const double *mass, double t,
                      const boundary_derivative *to)
{
    const vec2 velocity = velocity_at(all, b, t), acceleration = boundary_conditions_acceleration(all, b, t);
    for (dem_index k = 0; k < b->n_all; k++) {
        const dem_index i = b->nodes[k];
        const vec2 before = vec2_at(to->a, i), u = with_components(b, vec2_at(to->f, i), velocity),
                   now = with_components(b, before, acceleration);
        vec2_put(to->f, i, u);
        vec2_put(to->a, i, now);
        if (k >= b->n_nodes) continue;
        exact_terms_add(to->power, mass[i] * (now.x - before.x) * u.x);
        exact_terms_add(to->power, mass[i] * (now.y - before.y) * u.y);
    }
}

/* `a` comes in free of the conditions. No component is prescribed twice (check_node), so the order does not matter. */
void boundary_conditions_prescribe(const boundary_conditions *b, const double *mass, double t, const double *v,
                                   const boundary_derivative *to)
{
    for (dem_index k = 0; k < b->n; k++) {
        if (b->list[k].kind == DEM_BOUNDARY_FORCE)
            add_push_power(b, &b->list[k], t, v, to->power);
        else
            prescribe(b, &b->list[k], mass, t, to);
    }
}

/* Velocities have to agree with the conditions: at the start, with a ramp, they are 0. */
static void give(const boundary_conditions *all, const boundary_condition *b, const double *mass, double t, double *v,
                 exact_sum *energy)
{
    const vec2 velocity = velocity_at(all, b, t);
    for (dem_index k = 0; k < b->n_all; k++) {
        const vec2 before = vec2_at(v, b->nodes[k]), now = with_components(b, before, velocity);
        vec2_put(v, b->nodes[k], now);
        if (k >= b->n_nodes) continue;
        exact_sum_add(energy, 0.5 * mass[b->nodes[k]] * (vec2_dot(now, now) - vec2_dot(before, before)));
    }
}

void boundary_conditions_give_velocities(const boundary_conditions *b, const double *mass, double t, double *v,
                                         exact_sum *energy)
{
    for (dem_index k = 0; k < b->n; k++)
        if (b->list[k].kind != DEM_BOUNDARY_FORCE) give(b, &b->list[k], mass, t, v, energy);
}

bool boundary_conditions_move(const boundary_conditions *b)
{
    for (dem_index k = 0; k < b->n; k++)
        if (b->list[k].kind != DEM_BOUNDARY_FORCE) return true;
    return false;
}

double boundary_conditions_speed(const boundary_conditions *b)
{
    double fastest = 0.0;
    for (dem_index k = 0; k < b->n; k++) {
        const boundary_condition *one = &b->list[k];
        const double size = vec2_norm(one->value);
        if (one->kind == DEM_BOUNDARY_VELOCITY) fastest = fmax(fastest, size);
        if (one->kind == DEM_BOUNDARY_DISPLACEMENT) fastest = fmax(fastest, RAMP_STEEPEST * size / one->ramp);
    }
    return fastest;
}

/* ---- compilation ---- */

/* What can be said of a condition without the lattice. A displacement without a ramp would be a jump of position. */
static dem_status check_one(const dem_boundary *b, dem_index k)
{
    const long long number = (long long)k;
    const int32_t wanted = b->kind == DEM_BOUNDARY_FORCE ? 0 : b->components;
    CHECK(b->kind == DEM_BOUNDARY_VELOCITY || b->kind == DEM_BOUNDARY_DISPLACEMENT || b->kind == DEM_BOUNDARY_FORCE,
          DEM_ERROR_ARGUMENT, "boundary %lld: unknown kind %d", number, (int)b->kind);
    CHECK(b->n_nodes > 0 && b->nodes != NULL, DEM_ERROR_ARGUMENT, "boundary %lld has no nodes", number);
    CHECK(b->kind == DEM_BOUNDARY_FORCE || (wanted > 0 && wanted <= BOTH), DEM_ERROR_ARGUMENT,
          "boundary %lld: components must be DEM_COMPONENT_X, DEM_COMPONENT_Y or both, got %d", number, (int)wanted);
    CHECK(isfinite(b->value[0]) && isfinite(b->value[1]), DEM_ERROR_ARGUMENT,
          "boundary %lld: value (%g, %g) is not finite", number, b->value[0], b->value[1]);
    CHECK(b->value[2] == 0.0, DEM_ERROR_ARGUMENT, "boundary %lld: value has a third component in the plane: %g", number,
          b->value[2]);
    CHECK(isfinite(b->ramp) && b->ramp >= 0.0, DEM_ERROR_ARGUMENT, "boundary %lld: ramp must be >= 0, got %g s", number,
          b->ramp);
    CHECK(b->kind != DEM_BOUNDARY_DISPLACEMENT || b->ramp > 0.0, DEM_ERROR_ARGUMENT,
          "boundary %lld: a displacement needs a ramp > 0, in s", number);
    return DEM_OK;
}

/* What conditions are compiled for. */
typedef struct bodies {
    const dem_lattice *lattice;
    const domain *domain; /* NULL: the lattice is whole */
    bool touches;         /* whether there are obstacles */
} bodies;

/* Whether condition k may have its p-th node. `held` has for each node the components that are prescribed so far, and
 * in the bit NAMED whether condition k has named the node already. A node with a prescribed motion must not touch
 * obstacles: a contact could not change its velocity. */
static dem_status check_node(const bodies *of, const dem_boundary *b, dem_index k, dem_index p, unsigned char *held)
{
    enum { NAMED = 4 };
    const dem_lattice *l = of->lattice;
    const dem_index n_nodes = of->domain != NULL ? of->domain->n_whole : l->n_nodes;
    const long long number = (long long)k, node = (long long)b->nodes[p];
    CHECK(node >= 0 && node < n_nodes, DEM_ERROR_ARGUMENT, "boundary %lld: node %lld is not in 0 to %lld", number, node,
          (long long)(n_nodes - 1));
    const dem_index i = domain_node(of->domain, b->nodes[p]);
    if (i < 0) return DEM_OK; /* another rank looks at it */
    CHECK(!(held[i] & NAMED), DEM_ERROR_ARGUMENT, "boundary %lld: node %lld is named twice", number, node);
    CHECK(b->share == NULL || isfinite(b->share[p]), DEM_ERROR_ARGUMENT,
          "boundary %lld: the share of node %lld is not finite", number, node);
    /* What follows concerns prescribed motions only: forces may act on any node, several on one. */
    held[i] |= NAMED;
    if (b->kind == DEM_BOUNDARY_FORCE) return DEM_OK;
    CHECK(!(l->flags[i] & DEM_NODE_FIXED), DEM_ERROR_MODEL, "boundary %lld: node %lld is fixed already", number, node);
    CHECK(!(l->flags[i] & DEM_NODE_RIGID), DEM_ERROR_MODEL,
          "boundary %lld: node %lld is of a rigid body, whose motion cannot be prescribed; a guide can", number, node);
    CHECK(!(held[i] & b->components), DEM_ERROR_MODEL,
          "boundary %lld: the motion of node %lld is prescribed by another one already", number, node);
    CHECK(!of->touches || !(l->flags[i] & DEM_NODE_CONTACT), DEM_ERROR_MODEL,
          "boundary %lld: node %lld may touch obstacles, so its motion cannot be prescribed; "
          "dem_lattice_exclude() takes it from contact",
          number, node);
    held[i] |= (unsigned char)b->components;
    return DEM_OK;
}

/* The marks of a condition are removed before the next one is checked. */
static dem_status check_all(const bodies *of, const dem_boundary *list, dem_index n, unsigned char *held)
{
    for (dem_index k = 0; k < n; k++) {
        TRY(check_one(&list[k], k));
        for (dem_index p = 0; p < list[k].n_nodes; p++) TRY(check_node(of, &list[k], k, p, held));
        for (dem_index p = 0; p < list[k].n_nodes; p++) {
            const dem_index i = domain_node(of->domain, list[k].nodes[p]);
            if (i >= 0) held[i] &= BOTH;
        }
    }
    return DEM_OK;
}

/* Nodes of this rank, or else the common ones of others. A force without shares is shared equally among all of its
 * nodes, wherever they are. */
static void copy_nodes(boundary_condition *out, const dem_boundary *from, const domain *d, bool own)
{
    for (dem_index p = 0; p < from->n_nodes; p++) {
        const dem_index i = domain_node(d, from->nodes[p]);
        if (i < 0 || domain_owns(d, i) != own) continue;
        const double equal = 1.0 / (double)from->n_nodes;
        if (out->share != NULL) out->share[out->n_all] = from->share != NULL ? from->share[p] : equal;
        out->nodes[out->n_all++] = i;
    }
}

static dem_status copy(boundary_condition *out, const dem_boundary *from, const domain *d)
{
    const size_t n = (size_t)from->n_nodes;
    *out = (boundary_condition){
        .kind = from->kind, .components = from->components, .value = vec2_at(from->value, 0), .ramp = from->ramp};
    out->nodes = malloc(n * sizeof *out->nodes);
    CHECK_MEMORY(out->nodes);
    if (from->kind == DEM_BOUNDARY_FORCE) CHECK_MEMORY(out->share = malloc(n * sizeof *out->share));
    copy_nodes(out, from, d, true);
    out->n_nodes = out->n_all;
    if (d != NULL) copy_nodes(out, from, d, false);
    return DEM_OK;
}

/* Makes a linked list of forces for each node. They are entered at the head, so a list has the last condition first.
 * Where there are forces at all every rank has lists, so that all go the same way. */
static dem_status list_pushes(boundary_conditions *b, dem_index n_nodes)
{
    size_t n = 0;
    bool any = false;
    for (dem_index k = 0; k < b->n; k++) {
        if (b->list[k].share == NULL) continue;
        any = true;
        n += (size_t)b->list[k].n_all;
    }
    if (!any) return DEM_OK;
    b->first = malloc((size_t)n_nodes * sizeof *b->first);
    b->pushes = malloc((n + 1) * sizeof *b->pushes);
    CHECK(b->first && b->pushes, DEM_ERROR_MEMORY, "out of memory for %zu forces on nodes", n);
    for (dem_index i = 0; i < n_nodes; i++) b->first[i] = -1;
    /* Entry `at` belongs to node p of condition k; the head of the node's list moves on to it. */
    dem_index at = 0;
    for (dem_index k = 0; k < b->n; k++)
        for (dem_index p = 0; p < b->list[k].n_all && b->list[k].share != NULL; p++, at++) {
            dem_index *first = &b->first[b->list[k].nodes[p]];
            b->pushes[at] = (boundary_condition_share){k, *first, b->list[k].share[p]};
            *first = at;
        }
    return DEM_OK;
}

/* Conditions are counted before they are copied, so that a failure half-way leaves no memory behind. */
static dem_status compile(boundary_conditions *b, const bodies *of, const dem_boundary *list, dem_index n)
{
    b->list = calloc((size_t)n, sizeof *b->list);
    CHECK_MEMORY(b->list);
    while (b->n < n) {
        b->n++;
        TRY(copy(&b->list[b->n - 1], &list[b->n - 1], of->domain));
    }
    return list_pushes(b, of->lattice->n_nodes);
}

/* *out is empty until everything is in order, so that a failure leaves nothing to free. */
static dem_status make(boundary_conditions *out, const bodies *of, const dem_boundary *list, dem_index n)
{
    boundary_conditions b = {0};
    /* Kept after the checks: the right-hand side asks for the prescribed components of each node. */
    b.held = calloc((size_t)of->lattice->n_nodes, sizeof *b.held);
    CHECK_MEMORY(b.held);
    dem_status status = check_all(of, list, n, b.held);
    if (status == DEM_OK) status = compile(&b, of, list, n);
    if (status == DEM_OK)
        *out = b;
    else
        boundary_conditions_free(&b);
    return status;
}

/* `ramp` is the last member of the first version. */
static const struct_kind kind = {"dem_boundary", STRUCT_SIZE_WITH(dem_boundary, ramp), sizeof(dem_boundary)};

dem_status boundary_conditions_compile(boundary_conditions *out, const dem_boundary *list, dem_index n,
                                       const dem_lattice *lattice, const domain *d, dem_index n_obstacles)
{
    void *own;
    *out = (boundary_conditions){0};
    CHECK(n >= 0 && (n == 0 || list != NULL), DEM_ERROR_ARGUMENT, "%lld boundaries, the list is %s", (long long)n,
          list != NULL ? "given" : "NULL");
    if (n == 0) return DEM_OK;
    TRY(struct_size_read_array(&kind, &own, list, n));
    const dem_status status = make(out, &(bodies){lattice, d, n_obstacles > 0}, own, n);
    free(own);
    return status;
}

void boundary_conditions_free(boundary_conditions *b)
{
    for (dem_index k = 0; b->list != NULL && k < b->n; k++) {
        free(b->list[k].nodes);
        free(b->list[k].share);
    }
    free(b->list);
    free(b->first);
    free(b->pushes);
    free(b->held);
    *b = (boundary_conditions){0};
}
