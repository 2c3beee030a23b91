/* SPDX-License-Identifier: BSD-3-Clause */
/* Accelerations of the nodes near an event, as the functions of local_forces.h. Where undamped springs are all that
 * acts between nodes (`plain`) they are listed by local numbers, once for an event, and each is evaluated once for both
 * ends. Otherwise every node is evaluated by forces.h in a state of all nodes. The two differ in the order of sums,
 * hence by rounding. Contacts with obstacles near the event are not here but in contact/contact_constraints.c; the step
 * over the neighbourhood is in events/local_correction.c. */
#include "forces/local_springs.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"
#include "forces/rigid_motion.h"

void local_springs_create(local_springs *out, const forces *f, const state_layout *l)
{
    *out = (local_springs){.forces = f, .velocities = state_velocities(l)};
}

void local_springs_destroy(local_springs *b)
{
    free(b->bonds);
    free(b->stiffness);
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

/* Adds every node on which the force on one of the nodes `first` to `last` - 1 depends: one ring. */
static dem_status local_springs_add_neighbours(const void *self, local_nodes *nodes, dem_index first, dem_index last)
{
    const forces *f = ((const local_springs *)self)->forces;
    for (dem_index p = first; p < last; p++)
        for (forces_neighbours j = forces_neighbours_of(f, nodes->list[p]); forces_next_neighbour(&j);)
            TRY(add_node(f, nodes, j.node));
    return DEM_OK;
}

/* ---- springs ---- */

/* All numbers are one allocation. If it fails, the lists stay as they were. What they hold is not kept when they grow,
 * since they are filled anew. */
static dem_status reserve(local_springs *b, dem_index n)
{
    if (n <= b->capacity) return DEM_OK;
    local_bond *bonds = malloc(2 * (size_t)n * sizeof *bonds);
    double *reals = malloc(10 * (size_t)n * sizeof *reals);
    if (bonds == NULL || reals == NULL) {
        free(bonds);
        free(reals);
        return status_fail(DEM_ERROR_MEMORY, "out of memory for what is near an event");
    }
    free(b->bonds);
    free(b->stiffness);
    b->capacity = 2 * n;
    b->bonds = bonds;
    b->stiffness = reals;
    b->rest_length = reals + 2 * n;
    b->dx = reals + 4 * n;
    b->dy = reals + 6 * n;
    b->pull = reals + 8 * n;
    return DEM_OK;
}

/* Lists the springs of local node j whose other end has a higher number. One with a lower number has listed the spring
 * already. All neighbours of a node that moves are local nodes. */
static void add_bonds(local_springs *b, const local_nodes *nodes, dem_index j)
{
    const springs *s = &b->forces->model->springs;
    const dem_index i = nodes->list[j];
    const springs_integrity integrity = element_state_springs(element_state_at(b->forces->elements, i));
    for (dem_index p = s->row[i]; p < s->row[i + 1]; p++) {
        const int32_t other = nodes->number[s->neighbour[p]];
        /* A node that is not local has the number -1. */
        const double left = springs_left(integrity, s->spring[p], 0.0);
        if (other < j || left == 0.0) continue;
        b->bonds[b->n_bonds] = (local_bond){(int32_t)j, other};
        b->stiffness[b->n_bonds] = left * s->stiffness[p];
        b->rest_length[b->n_bonds++] = s->rest_length[p];
    }
}

/* Whether springs are all that acts between the nodes: what acts at all, and no node is near another surface. */
static bool are_plain(const forces *f, const local_nodes *nodes)
{
    for (dem_index j = 0; f->surfaces != NULL && j < nodes->n; j++)
        if (surface_contact_has(f->surfaces, nodes->list[j])) return false;
    return forces_are_plain(f);
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

/* Springs are listed ring by ring, so that those which act on ring r or nearer are the first bonds_end[r]. */
static dem_status local_springs_gather(void *self, const local_nodes *nodes)
{
    local_springs *b = self;
    const springs *s = &b->forces->model->springs;
    dem_index most = 0;
    TRY(reserve_rigid(b));
    b->plain = are_plain(b->forces, nodes);
    if (!b->plain) return DEM_OK;
    for (dem_index j = 0; j < local_nodes_n_moving(nodes); j++)
        most += s->row[nodes->list[j] + 1] - s->row[nodes->list[j]];
    TRY(reserve(b, most));
    b->n_bonds = 0;
    for (int ring = 0; ring < nodes->n_rings; ring++) {
        for (dem_index j = local_nodes_begin(nodes, ring); j < nodes->end[ring]; j++) add_bonds(b, nodes, j);
        b->bonds_end[ring] = b->n_bonds;
    }
    return DEM_OK;
}

/* ---- accelerations ---- */

/* Forces (1) of springs on the nodes of a ring or nearer, N. f [n][2] has room for one ring more, in which the other
 * ends collect sums that are not whole. Gathering and scattering are loops of their own, so that compilers make vector
 * instructions of the roots and divisions in between. */
static void pull(const local_springs *b, const local_nodes *nodes, int ring, const double *x, double *f)
{
    const dem_index n = b->bonds_end[ring];
    double *restrict dx = b->dx, *restrict dy = b->dy, *restrict factor = b->pull;
    for (dem_index k = 0; k < n; k++) {
        const vec2 d = vec2_sub(vec2_at(x, b->bonds[k].second), vec2_at(x, b->bonds[k].first));
        dx[k] = d.x;
        dy[k] = d.y;
    }
    for (dem_index k = 0; k < n; k++)
        factor[k] = springs_pull(b->stiffness[k], b->rest_length[k], sqrt(dx[k] * dx[k] + dy[k] * dy[k]));
    memset(f, 0, 2 * (size_t)nodes->end[ring + 1] * sizeof *f);
    for (dem_index k = 0; k < n; k++) {
        const local_bond bond = b->bonds[k];
        /* The pull is the tension over the length: times the vector between the ends it is the force on the first
         * one. */
        const vec2 force = {factor[k] * dx[k], factor[k] * dy[k]};
        vec2_put(f, bond.first, vec2_add(vec2_at(f, bond.first), force));
        vec2_put(f, bond.second, vec2_sub(vec2_at(f, bond.second), force));
    }
}

/* a = g + F/m - alpha v. */
static void accelerate_plain(const local_springs *b, const local_nodes *nodes, int ring, const local_state *s,
                             double *a)
{
    pull(b, nodes, ring, s->x, a);
    for (dem_index j = 0; j < nodes->end[ring]; j++)
        vec2_put(a, j, forces_acceleration_by(b->forces, nodes->list[j], vec2_at(a, j), vec2_at(s->v, j)));
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
    const local_springs *b = self;
    const forces *f = b->forces;
    const double *v = s->y + b->velocities;
    /* Listed springs read the positions of the local nodes; otherwise each node is evaluated in the state of all
     * nodes. */
    if (b->plain) accelerate_plain(b, nodes, ring, s, a);
    for (dem_index j = 0; j < nodes->end[ring] && !b->plain; j++)
        vec2_put(a, j, forces_own_acceleration(f, nodes->list[j], s->y, v));
    local_springs_evaluate_external(self, nodes, ring, s);
    for (dem_index j = 0; j < nodes->end[ring] && f->external != NULL; j++)
        vec2_put(a, j, forces_with(f, nodes->list[j], vec2_at(a, j), vec2_at(f->external->value, j)));
    move_rigid_bodies(b, nodes, ring, s->y, a);
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
                          .read_state = !forces_are_plain(f) || f->surfaces != NULL,
                          .have_power = forces_have_power(f),
                          .held = f->boundaries != NULL ? f->boundaries->held : NULL,
                          .begin_step = local_springs_begin_step,
                          .add_neighbours = local_springs_add_neighbours,
                          .accelerate_one = local_springs_accelerate_one,
                          .gather = local_springs_gather,
                          .accelerate = local_springs_accelerate,
                          .evaluate_external = local_springs_evaluate_external,
                          .add_power = local_springs_add_power,
                          .friction_power = forces_have_friction(f) ? local_springs_friction_power : NULL};
}
