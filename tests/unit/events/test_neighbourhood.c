/* SPDX-License-Identifier: BSD-3-Clause */
/* neighbourhood.c: rings by distances over the lattice, found another way, and the accelerations that the model
 * gives. */
#include "events/neighbourhood.h"

#include <stdlib.h>

#include "contact/contact_constraints.h"
#include "forces/local_springs.h"
#include "unit/events/chain.h"
#include "unit/forces/look.h"
#include "verification/support.h"

typedef struct rig {
    dem_model *model;
    forces acting;
    automaton c;
    constraints closed;
    local_springs springs;
    local_forces near;
    neighbourhood b;
    dem_index n;
    double *y, *x, *v, *a; /* [4 n] states and what the neighbourhood has of them */
} rig;

/* A block on a floor, deformed and moving. */
static void open_rig(rig *r, int n_rings)
{
    static const double points[4] = {-1.0, 0.0, 1.0, 0.0};
    const dem_obstacle floor = {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = points, .friction = 0.3};
    const dem_material rubber = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0,
                                      .density = 1050.0, .thickness = 1.0, .guard = 0.0);
    CLEANUP(dem_lattice_free) dem_lattice block = support_rectangle(0.05, 0.05, 5e-3, &rubber);
    *r = (rig){.n = block.n_nodes};
    assert_ok(dem_model_create(&r->model, &block, &floor, 1));
    const contact_rule rule = {
        .penetration_tolerance = 1e-9, .max_step = 1e-6, .layout = {.dim = 2, .n_nodes = r->n, .n_rows = r->n}};
    r->acting = (forces){.model = r->model, .gravity = {0.0, -9.81}, .mass_damping = 3.0};
    assert_ok(automaton_create(&r->c, &r->acting, &rule));
    r->closed = contact_constraints_of(&r->c);
    local_springs_create(&r->springs, &r->acting, &rule.layout);
    r->near = local_springs_forces(&r->springs);
    assert_ok(neighbourhood_create(&r->b, &rule.layout, &r->near, &r->closed, n_rings));
    r->y = calloc(4 * (size_t)r->n, sizeof(double));
    r->x = calloc(3 * 2 * (size_t)r->n, sizeof(double));
    assert_true(r->y != NULL && r->x != NULL);
    r->v = r->x + 2 * r->n;
    r->a = r->v + 2 * r->n;
    for (dem_index k = 0; k < 2 * r->n; k++) {
        r->y[k] = block.x[k] + 1e-4 * sin(3.0 * (double)k);
        r->y[2 * r->n + k] = cos(5.0 * (double)k);
    }
}

static void close_rig(rig *r)
{
    neighbourhood_destroy(&r->b);
    local_springs_destroy(&r->springs);
    automaton_destroy(&r->c);
    dem_model_destroy(r->model);
    free(r->y);
    free(r->x);
}

/* Round what an event of a candidate changes at once. */
static dem_status gather(rig *r, dem_index candidate)
{
    dem_index seeds[16];
    const dem_index n = contact_set_seeds(&r->c.set, candidate, seeds, 16);
    assert_true(n <= 16);
    return neighbourhood_gather(&r->b, (neighbourhood_seeds){seeds, n, false});
}

static dem_index bottom_candidate(const rig *r)
{
    dem_index lowest = 0;
    for (dem_index k = 0; k < r->model->surface.n_nodes; k++)
        if (r->model->lattice.x[2 * r->model->surface.nodes[k] + 1] <
            r->model->lattice.x[2 * r->model->surface.nodes[lowest] + 1])
            lowest = k;
    return lowest + 4;
}

/* Steps over springs from a node to all others: what has been reached goes on until nothing is new. */
static int *distances(const rig *r, dem_index from)
{
    const dem_lattice *l = &r->model->lattice;
    int *d = malloc((size_t)r->n * sizeof *d);
    bool more = true;
    assert_non_null(d);
    for (dem_index i = 0; i < r->n; i++) d[i] = i == from ? 0 : 1000;
    while (more) {
        more = false;
        for (dem_index k = 0; k < l->n_springs; k++)
            for (int e = 0; e < 2; e++) {
                const dem_index i = l->ends[2 * k + e], j = l->ends[2 * k + 1 - e];
                if (d[i] + 1 >= d[j]) continue;
                d[j] = d[i] + 1;
                more = true;
            }
    }
    return d;
}

TEST(rings_are_distances)
{
    CLEANUP(close_rig) rig r;
    open_rig(&r, 4);
    const dem_index candidate = bottom_candidate(&r);
    for (int turn = 0; turn < 2; turn++) { /* the second forgets the first */
        CLEANUP(free_memory) int *d = distances(&r, r.model->surface.nodes[candidate + turn]);
        assert_ok(gather(&r, candidate + turn));
        for (dem_index i = 0; i < r.n; i++) {
            assert_int_equal(look_number(&r.b.nodes, i) >= 0, d[i] <= 4);
            for (int ring = 0; ring <= 4; ring++) assert_int_equal(local_nodes_have(&r.b.nodes, i, ring), d[i] <= ring);
        }
        for (dem_index j = 0; j < r.b.nodes.n; j++) assert_int_equal(look_number(&r.b.nodes, r.b.nodes.list[j]), j);
    }
}

/* As far as two rings. Sums of forces of 1e3 N on 0.02 kg, in another order: 1e-16 times some ten of them. */
static void check_accelerations(rig *r)
{
    const local_nodes *nodes = &r->b.nodes;
    CLEANUP(free_memory) double *y = calloc(4 * (size_t)r->n, sizeof *y);
    const local_state s = {0.0, r->x, r->v, y};
    assert_non_null(y);
    for (dem_index j = 0; j < nodes->n; j++) {
        vec2_put(r->x, j, vec2_at(r->y, nodes->list[j]));
        vec2_put(r->v, j, vec2_at(r->y, r->n + nodes->list[j]));
    }
    neighbourhood_put(&r->b, &s, nodes->end[3], y);
    neighbourhood_accelerate(&r->b, 2, &s, r->a);
    CLEANUP(free_memory) double *all = calloc(2 * (size_t)r->n, sizeof *all);
    assert_non_null(all);
    for (dem_index i = 0; i < r->n; i++) vec2_put(all, i, forces_acceleration(&r->acting, i, r->y, r->y + 2 * r->n));
    contact_forces_hold(&r->c.set.forces, (scene_state){0.0, r->y, r->y + 2 * r->n}, all);
    for (dem_index k = 0; k < 2 * nodes->end[2]; k++)
        assert_close(r->a[k], all[2 * nodes->list[k / 2] + (k & 1)], 1e-9);
}

TEST(a_closed_contact_holds_its_node)
{
    CLEANUP(close_rig) rig r;
    open_rig(&r, 4);
    const dem_index candidate = bottom_candidate(&r);
    assert_ok(gather(&r, candidate));
    assert_int_equal(r.b.n_groups, 0);
    assert_ok(contact_set_close(&r.c.set, candidate + 1, (contact_point){.feature = 0, .slide = 1}));
    assert_ok(contact_set_close(&r.c.set, candidate, (contact_point){.feature = 0, .slide = 0}));
    assert_ok(neighbourhood_regroup(&r.b));
    assert_int_equal(r.b.n_groups, 2);
    assert_int_equal(r.b.groups[0].ring, 0);
    assert_int_equal(r.b.groups[1].ring, 1);
    check_accelerations(&r);
    assert_close(r.a[0], 0.0, 0.0); /* the node of the candidate sticks */
    assert_close(r.a[1], 0.0, 0.0);
}

/* The rings are kept for the next event. A contact that has closed meanwhile is found all the same. */
TEST(rings_that_are_kept_do_not_hide_a_closed_contact)
{
    CLEANUP(close_rig) rig r;
    open_rig(&r, 4);
    const dem_index candidate = bottom_candidate(&r), node = r.model->surface.nodes[candidate];
    local_nodes *nodes = &r.b.nodes;
    assert_ok(gather(&r, candidate));
    const dem_index n = nodes->n;
    local_nodes_clear(nodes);
    assert_true(r.near.recall(r.near.self, node, nodes));
    assert_int_equal(nodes->n, n);
    for (int turn = 0; turn < 2; turn++) {
        assert_ok(gather(&r, candidate));
        assert_int_equal(r.b.n_groups, turn);
        assert_int_equal(nodes->n, n); /* the contact ties no nodes together */
        if (turn == 0)
            assert_ok(contact_set_close(&r.c.set, candidate + 1, (contact_point){.feature = 0, .slide = 0}));
        else
            check_accelerations(&r);
    }
}

/* ---- three dimensions, without contact ---- */

/* Ties nodes 8 and 9 of a chain together: both accelerate as their velocities are. */
typedef struct tie {
    chain *of;
    int32_t group_at[CHAIN_NODES], *groups;
    double a[STATE_DIM_MOST * CHAIN_NODES], *accelerations;
} tie;

static dem_status tie_each_node(const void *self, dem_index group, dem_status (*add)(void *context, dem_index node),
                                void *context)
{
    (void)self;
    assert_int_equal(group, 3);
    assert_ok(add(context, 8));
    return add(context, 9);
}

static void tie_solve(void *self, dem_index group, constraint_state at, const constraint_free *known)
{
    tie *s = self;
    const state_layout *l = &s->of->layout;
    assert_int_equal(group, 3);
    for (dem_index i = 8; i <= 9; i++) {
        double free[STATE_DIM_MOST];
        chain_accelerate_one(s->of, i, at.y, free);
        assert_in_range(known->number[i], 0, known->n - 1);
        assert_memory_equal(known->a + state_row(l, known->number[i]), free, (size_t)l->dim * sizeof *free);
        state_copy_row(l, s->a + state_row(l, i), state_v(l, at.y, i));
    }
}

static constraints tie_constraints(tie *s, chain *of)
{
    *s = (tie){.of = of};
    for (dem_index i = 0; i < CHAIN_NODES; i++) s->group_at[i] = i == 8 || i == 9 ? 3 : -1;
    s->groups = s->group_at;
    s->accelerations = s->a;
    return (constraints){
        .self = s, .group_at = &s->groups, .a = &s->accelerations, .each_node = tie_each_node, .solve = tie_solve};
}

/* Round node 6: 5 and 7; 4 and 8, with 9, to which it is tied; 3 and 10. */
TEST(tied_nodes_are_in_one_ring_and_move_as_they_must_in_any_dimension)
{
    static const int axes[3] = {0, 1, 2};
    static const dem_index order[8] = {6, 5, 7, 4, 8, 9, 3, 10}, end[4] = {1, 3, 6, 8}, seed = 6;
    for (int dim = 2; dim <= 3; dim++) {
        chain s;
        tie t;
        CLEANUP(neighbourhood_destroy) neighbourhood b;
        double x[STATE_DIM_MOST * CHAIN_NODES], v[STATE_DIM_MOST * CHAIN_NODES], a[STATE_DIM_MOST * CHAIN_NODES];
        chain_open(&s, dim, axes, -1, false);
        const constraints c = tie_constraints(&t, &s);
        assert_ok(neighbourhood_create(&b, &s.layout, &s.forces, &c, 3));
        assert_ok(neighbourhood_gather(&b, (neighbourhood_seeds){&seed, 1, false}));
        assert_int_equal(b.nodes.n, 8);
        for (int j = 0; j < 8; j++) assert_int_equal(b.nodes.list[j], order[j]);
        for (int ring = 0; ring < 4; ring++) assert_int_equal(b.nodes.end[ring], end[ring]);
        assert_int_equal(b.n_groups, 1);
        assert_int_equal(b.groups[0].ring, 2);
        for (int j = 0; j < 8; j++) {
            state_copy_row(&s.layout, x + state_row(&s.layout, j), state_x(&s.layout, s.y0, order[j]));
            state_copy_row(&s.layout, v + state_row(&s.layout, j), state_v(&s.layout, s.y0, order[j]));
        }
        const local_state here = {0.0, x, v, s.state};
        neighbourhood_put(&b, &here, 8, s.state);
        neighbourhood_accelerate(&b, 2, &here, a);
        for (int j = 0; j < 6; j++) {
            double expected[STATE_DIM_MOST];
            const double *tied = state_v(&s.layout, s.y0, order[j]);
            chain_accelerate_one(&s, order[j], s.y0, expected);
            for (int k = 0; k < dim; k++)
                assert_close(a[state_row(&s.layout, j) + k], order[j] >= 8 ? tied[k] : expected[k], 0.0);
        }
    }
}

/* Of two seeds the first is free, and the second is tied. */
TEST(forces_alone_take_one_ring_less_where_no_constraint_holds_the_seeds)
{
    static const dem_index seeds[2] = {4, 8};
    chain s;
    tie t;
    CLEANUP(neighbourhood_destroy) neighbourhood b;
    chain_open(&s, 2, (const int[2]){0, 1}, -1, false);
    const constraints c = tie_constraints(&t, &s);
    assert_ok(neighbourhood_create(&b, &s.layout, &s.forces, &c, 3));
    for (int k = 0; k < 2; k++)
        for (int by_forces = 0; by_forces < 2; by_forces++) {
            assert_ok(neighbourhood_gather(&b, (neighbourhood_seeds){seeds + k, 1, by_forces}));
            assert_int_equal(neighbourhood_is_short(&b), by_forces && k == 0);
            assert_int_equal(b.nodes.n_rings, by_forces && k == 0 ? 2 : 3);
        }
}
