/* SPDX-License-Identifier: BSD-3-Clause */
/* Accelerations of the nodes near an event, as the functions of local_forces.h. Springs and triangles are listed by
 * local numbers, once for an event (local_elements.c); where springs are damped nothing is listed, and each node is
 * evaluated in a state of all nodes. Both have the bits of forces.h but where undamped springs are all that acts
 * between nodes: their forces are summed up spring by spring, in another order. Contacts with obstacles near
 * the event are not here but in contact/contact_constraints.c; the step over the neighbourhood is in
 * events/local_correction.c. */
#include "forces/local_springs.h"

#include <stdlib.h>

#include "base/status.h"
#include "forces/rigid_motion.h"

void local_springs_create(local_springs *out, const forces *f, const state_layout *l)
{
    *out = (local_springs){.forces = f, .elements.forces = f, .velocities = state_velocities(l)};
}

void local_springs_destroy(local_springs *b)
{
    local_elements_destroy(&b->elements);
    local_cache_destroy(&b->cache);
    free(b->rigid);
    *b = (local_springs){0};
}

/* Which surfaces are near each other depends on the motion in the step. */
static dem_status local_springs_begin_step(const void *self, const double *y0, const double *y1)
{
    const forces *f = ((const local_springs *)self)->forces;
    return f->surfaces != NULL ? surface_contact_begin_step(f->surfaces, y0, y1) : DEM_OK;
}

/* A rigid body moves as a whole: all its nodes are in the ring in which one of them is found. */
static dem_status add_node(const forces *f, local_nodes *nodes, dem_index node)
{
    const rigid_body *body = rigid_bodies_at(&f->model->rigid, node);
    if (body == NULL || nodes->number[node] >= 0) return local_nodes_add(nodes, node);
    for (dem_index k = 0; k < body->n_nodes; k++) TRY(local_nodes_add(nodes, body->nodes[k]));
    return DEM_OK;
}

/* Adds every node on which the force on one node depends. */
static dem_status add_neighbours_of(const forces *f, local_nodes *nodes, dem_index i)
{
    const springs *s = &f->model->springs;
    if (f->model->rigid.n == 0 && forces_neighbours_are_ends(f, i)) {
        for (dem_index p = s->row[i]; p < s->row[i + 1]; p++) TRY(local_nodes_add(nodes, s->neighbour[p]));
        return DEM_OK;
    }
    for (forces_neighbours j = forces_neighbours_of(f, i); forces_next_neighbour(&j);) TRY(add_node(f, nodes, j.node));
    return DEM_OK;
}

/* Adds every node on which the force on one of the nodes `first` to `last` - 1 depends: one ring. */
static dem_status local_springs_add_neighbours(const void *self, local_nodes *nodes, dem_index first, dem_index last)
{
    const forces *f = ((const local_springs *)self)->forces;
    for (dem_index p = first; p < last; p++) TRY(add_neighbours_of(f, nodes, nodes->list[p]));
    return DEM_OK;
}

/* ---- lists ---- */

/* Whether no node is near another surface. */
static bool are_apart(const forces *f, const local_nodes *nodes)
{
    for (dem_index j = 0; f->surfaces != NULL && j < nodes->n; j++)
        if (surface_contact_has(f->surfaces, nodes->list[j])) return false;
    return true;
}

/* Makes room for the accelerations of all nodes, if there are rigid bodies. */
static dem_status reserve_rigid(local_springs *b)
{
    const dem_index n = b->forces->model->rigid.n > 0 ? b->forces->model->lattice.n_nodes : 0;
    if (n == 0 || b->rigid != NULL) return DEM_OK;
    b->rigid = calloc(2 * (size_t)n, sizeof *b->rigid);
    CHECK(b->rigid != NULL, DEM_ERROR_MEMORY, "out of memory for the accelerations of rigid bodies");
    return DEM_OK;
}

/* Damping is not listed. */
static dem_status local_springs_gather(void *self, const local_nodes *nodes)
{
    local_springs *b = self;
    TRY(reserve_rigid(b));
    const bool apart = are_apart(b->forces, nodes);
    b->reads_state = !apart || forces_couple_velocities(b->forces) || b->forces->model->rigid.n > 0;
    b->alone = apart && !forces_push(b->forces) && !forces_couple_velocities(b->forces);
    if (forces_couple_velocities(b->forces)) return DEM_OK;
    return local_elements_list(&b->elements, nodes, !(apart && forces_are_plain(b->forces)));
}

/* ---- lists that are kept ---- */

/* Whether lists depend on the model alone: no node is near another surface, and all elements that are listed, each at a
 * node that moves, are whole. */
static bool are_untouched(const forces *f, const local_nodes *nodes)
{
    for (dem_index j = 0; f->elements != NULL && j < local_nodes_n_moving(nodes); j++)
        if (f->elements->node[nodes->list[j]]) return false;
    return are_apart(f, nodes);
}

/* Damping is not listed, and rigid bodies are found by way of their nodes. */
static bool keeps_lists(const forces *f)
{
    return !forces_couple_velocities(f) && f->model->rigid.n == 0;
}

static void local_springs_keep(void *self, dem_index node, const local_nodes *nodes)
{
    local_springs *b = self;
    if (keeps_lists(b->forces) && are_untouched(b->forces, nodes))
        local_cache_keep(&b->cache, node, nodes, &b->elements.lists);
}

static bool local_springs_recall(void *self, dem_index node, local_nodes *nodes)
{
    local_springs *b = self;
    local_record kept;
    if (!local_cache_find(&b->cache, node, nodes->n_rings, &kept)) return false;
    if (local_nodes_fill(nodes, kept.n, kept.list, kept.end) != DEM_OK) return false;
    b->reads_state = false;
    b->alone = !forces_push(b->forces);
    if (are_untouched(b->forces, nodes) && local_elements_take(&b->elements, nodes, &kept.lists) == DEM_OK) return true;
    local_nodes_clear(nodes);
    return false;
}

static dem_status local_springs_renew(void *self, const local_nodes *nodes)
{
    local_springs *b = self;
    return forces_couple_velocities(b->forces) ? DEM_OK : local_elements_renew(&b->elements, nodes);
}

/* ---- accelerations ---- */

/* Accelerations of n nodes by forces in a, where elements are all that acts between nodes; those of
 * forces_undamped_acceleration() two components at a time, unless masses are damped. Then velocities are read. */
static void accelerate_alone(const local_springs *b, const local_nodes *nodes, dem_index n, const double *v, double *a)
{
    const forces *f = b->forces;
    const bool damped = f->mass_damping > 0.0;
    const double *inverse_mass = b->elements.lists.inverse_mass;
    const row_pair gravity = row_pair_at(f->gravity, 0), none = {0.0, 0.0};
    for (dem_index j = 0; j < n && !damped; j++) {
        const row_pair by_force = gravity + inverse_mass[j] * row_pair_at(a + 2 * j, 0);
        row_pair_put(a + 2 * j, 0, inverse_mass[j] == 0.0 ? none : by_force);
    }
    for (dem_index j = 0; j < n && damped; j++)
        vec2_put(a, j, forces_acceleration_by(f, nodes->list[j], vec2_at(a, j), vec2_at(v, j)));
}

/* By lists, which read the positions of the local nodes. Where elements are all that acts between nodes, nothing else
 * has to be asked for. */
static void accelerate_listed(local_springs *b, const local_nodes *nodes, int ring, const local_state *s, double *a)
{
    const forces *f = b->forces;
    const dem_index n = nodes->end[ring];
    local_elements_push(&b->elements, nodes, ring, s->x, a);
    if (b->alone) accelerate_alone(b, nodes, n, s->v, a);
    for (dem_index j = 0; j < n && !b->alone; j++) {
        const dem_index i = nodes->list[j];
        const vec2 own = forces_acceleration_of(f, i, vec2_at(a, j), vec2_at(s->v, j), s->y + b->velocities);
        vec2_put(a, j, forces_with_surfaces(f, i, own, s->y));
    }
}

/* Node by node, in the state of all nodes. */
static void accelerate_damped(const local_springs *b, const local_nodes *nodes, int ring, const double *y, double *a)
{
    for (dem_index j = 0; j < nodes->end[ring]; j++)
        vec2_put(a, j, forces_own_acceleration(b->forces, nodes->list[j], y, y + b->velocities));
}

/* The time is that among the quadratures of the state, which the integrator carries along. */
static void local_springs_evaluate_external(void *self, const local_nodes *nodes, int ring, const local_state *s)
{
    const local_springs *b = self;
    external_force *c = b->forces->external;
    if (c == NULL) return;
    const double t = s->y[b->velocities + b->forces->clock];
    external_force_evaluate(c, &(dem_force_query){t, nodes->end[ring], nodes->list, s->x, s->v});
}

/* A rigid body with obstacles, and with its accelerations projected, as the right-hand side does it. */
static void move_body(const local_springs *b, const local_nodes *nodes, dem_index k, const double *y, double *a)
{
    const forces *f = b->forces;
    const rigid_body *body = &f->model->rigid.list[k];
    const double *v = y + b->velocities;
    for (dem_index j = 0; j < body->n_nodes; j++)
        vec2_put(b->rigid, body->nodes[j], vec2_at(a, nodes->number[body->nodes[j]]));
    if (f->rigid != NULL && rigid_contact_evaluate_body(f->rigid, k, v[f->clock], y))
        (void)rigid_contact_accelerate(f->rigid, k, b->rigid);
    rigid_motion_accelerate_body(body, y, v, b->rigid);
    for (dem_index j = 0; j < body->n_nodes; j++)
        vec2_put(a, nodes->number[body->nodes[j]], vec2_at(b->rigid, body->nodes[j]));
}

static void move_rigid_bodies(const local_springs *b, const local_nodes *nodes, int ring, const double *y, double *a)
{
    const rigid_bodies *r = &b->forces->model->rigid;
    for (dem_index k = 0; k < r->n; k++)
        if (local_nodes_have(nodes, r->list[k].nodes[0], ring)) move_body(b, nodes, k, y, a);
}

/* The external force is evaluated for all these nodes in one call, and added last, as in forces_acceleration(). */
static void local_springs_accelerate(void *self, const local_nodes *nodes, int ring, const local_state *s, double *a)
{
    local_springs *b = self;
    const forces *f = b->forces;
    if (forces_couple_velocities(f))
        accelerate_damped(b, nodes, ring, s->y, a);
    else
        accelerate_listed(b, nodes, ring, s, a);
    local_springs_evaluate_external(self, nodes, ring, s);
    for (dem_index j = 0; j < nodes->end[ring] && f->external != NULL; j++)
        vec2_put(a, j, forces_with(f, nodes->list[j], vec2_at(a, j), vec2_at(f->external->value, j)));
    move_rigid_bodies(b, nodes, ring, s->y, a);
}

static void local_springs_accelerate_moved(void *self, const local_nodes *nodes, dem_index n_moved, int ring,
                                           const local_state *s, double *a)
{
    local_springs *b = self;
    local_elements_push_moved(&b->elements, nodes, n_moved, ring, s->x, a);
    accelerate_alone(b, nodes, nodes->end[ring], s->v, a);
}

static bool local_springs_read_state(const void *self)
{
    return ((const local_springs *)self)->reads_state;
}

/* What rounds otherwise, or might, is left out. */
static bool local_springs_are_exact(const void *self)
{
    const local_springs *b = self;
    const forces *f = b->forces;
    return b->alone && b->elements.lists.by_node && f->external == NULL && f->model->rigid.n == 0;
}

/* A single node, with the bits of the sweep over all nodes. */
static void local_springs_accelerate_one(const void *self, dem_index node, const double *y, double *a)
{
    const local_springs *b = self;
    vec2_put(a, 0, forces_acceleration(b->forces, node, y, y + b->velocities));
}

/* Adds to the rates of the totals, W, with the external forces that have been evaluated last. */
static void local_springs_add_power(const void *self, const local_nodes *nodes, int ring, const double *y,
                                    double *totals)
{
    const local_springs *b = self;
    const external_force *c = b->forces->external;
    for (dem_index j = 0; j < nodes->end[ring]; j++) {
        const vec2 external = c != NULL ? vec2_at(c->value, j) : (vec2){0.0, 0.0};
        const forces_power power = forces_node_power(b->forces, nodes->list[j], external, y, y + b->velocities);
        totals[STATE_DAMPING] += power.damping;
        totals[STATE_WORK] += power.work;
        totals[STATE_FRICTION] += power.friction;
    }
}

static double local_springs_friction_power(const void *self, const double *y)
{
    const local_springs *b = self;
    return forces_friction_power(b->forces, y, y + b->velocities);
}

local_forces local_springs_forces(local_springs *b)
{
    const forces *f = b->forces;
    return (local_forces){.self = b,
                          .couple_velocities = forces_couple_velocities(f),
                          .are_driven = forces_are_driven(f),
                          .read_state = local_springs_read_state,
                          .have_power = forces_have_power(f),
                          .held = f->boundaries != NULL ? f->boundaries->held : NULL,
                          .begin_step = local_springs_begin_step,
                          .add_neighbours = local_springs_add_neighbours,
                          .accelerate_one = local_springs_accelerate_one,
                          .are_exact = local_springs_are_exact,
                          .gather = local_springs_gather,
                          .recall = local_springs_recall,
                          .keep = local_springs_keep,
                          .renew = local_springs_renew,
                          .accelerate = local_springs_accelerate,
                          .accelerate_moved = local_springs_accelerate_moved,
                          .evaluate_external = local_springs_evaluate_external,
                          .add_power = local_springs_add_power,
                          .friction_power = forces_have_friction(f) ? local_springs_friction_power : NULL};
}
