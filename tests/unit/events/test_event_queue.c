/* SPDX-License-Identifier: BSD-3-Clause */
/* event_queue.c: events inside a step in the order of time, against free fall and against two masses on a spring that
 * GSL integrates; and that a step can be shown at any time, taken back and shown again to the same bits. */
#include "verification/triplets.h"

#include <stdlib.h>
#include <string.h>

#include "contact/contact_constraints.h"
#include "contact/contact_source.h"
#include "events/event_queue.h"
#include "forces/local_springs.h"
#include "unit/events/chain.h"
#include "unit/contact/look.h"
#include "verification/support.h"

enum { most_nodes = 6, most_state = 4 * (most_nodes + 4) };

static const double g = 10.0, penetration_tolerance = 1e-10, mass = 2.0;

/* Masses over a floor, and a step of them. */
typedef struct rig {
    dem_model *model;
    forces acting;
    automaton c;
    contact_source contact;
    source_list sources;
    constraints closed;
    local_springs springs;
    local_forces near;
    event_queue q;
    dem_index n, n_all;
    double y0[most_state], f0[most_state], y1[most_state], f1[most_state], state[most_state];
    dense_output dense;
} rig;

static const double floor_points[4] = {-9.0, 0.0, 9.0, 0.0};

static void open_rig(rig *r, const dem_lattice *lattice, double eta, double friction, const double error[2])
{
    const dem_obstacle plane =
        SIZED(dem_obstacle, .n_points = 2, .points = floor_points, .restitution = eta, .friction = friction);
    const contact_rule rule = {.penetration_tolerance = penetration_tolerance,
                               .position_error = 1e-12,
                               .max_step = 0.1,
                               .storm_time = 1.0,
                               .max_impacts = 40,
                               .layout = {.dim = 2,
                                          .n_nodes = lattice->n_nodes,
                                          .n_obstacles = 1,
                                          .n_totals = STATE_OBSTACLE,
                                          .n_rows = lattice->n_nodes + 4}};
    *r = (rig){.n = lattice->n_nodes, .n_all = lattice->n_nodes + 4};
    assert_true(r->n <= most_nodes);
    assert_ok(dem_model_create(&r->model, lattice, &plane, 1));
    r->acting = (forces){.model = r->model, .gravity = {0.0, lattice->n_springs > 0 ? 0.0 : -g}};
    assert_ok(automaton_create(&r->c, &r->acting, &rule));
    local_springs_create(&r->springs, &r->acting, &rule.layout);
    r->near = local_springs_forces(&r->springs);
    r->closed = contact_constraints_of(&r->c);
    assert_ok(contact_source_create(&r->contact, &r->c));
    assert_ok(source_list_add(&r->sources, contact_source_events(&r->contact)));
    const double lax[2] = {1.0, 1.0}, *tolerance = error != NULL ? error : lax;
    assert_ok(event_queue_create(&r->q, &(event_queue_parts){.layout = look_layout(&r->c),
                                                             .forces = &r->near,
                                                             .constraints = &r->closed,
                                                             .sources = &r->sources,
                                                             .rule = {4, tolerance[0], tolerance[1], r->n},
                                                             .happens = true,
                                                             .controlled = error != NULL}));
}

/* n free masses at heights y, in a row along x. */
static void open_masses(rig *r, dem_index n, const double *y, double eta, double friction)
{
    double x[2 * most_nodes], m[most_nodes];
    for (dem_index i = 0; i < n; i++) {
        x[2 * i] = (double)i;
        x[2 * i + 1] = y[i];
        m[i] = mass;
    }
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_lattice(n, x, m, 0, NULL, 0.0, 0.0, NULL);
    lattice.body = malloc((size_t)n * sizeof *lattice.body);
    assert_non_null(lattice.body);
    for (dem_index i = 0; i < n; i++) lattice.body[i] = (int32_t)i;
    open_rig(r, &lattice, eta, friction, NULL);
    memcpy(r->y0, x, 2 * (size_t)n * sizeof *x);
}

static void close_rig(rig *r)
{
    event_queue_destroy(&r->q);
    source_list_destroy(&r->sources);
    contact_source_destroy(&r->contact);
    local_springs_destroy(&r->springs);
    automaton_destroy(&r->c);
    dem_model_destroy(r->model);
}

static void take_up(rig *r, double t0, double h)
{
    r->dense = (dense_output){*look_layout(&r->c), t0, t0 + h, t0 + h, r->y0, r->f0, r->y1, r->f1, false, NULL};
    event_queue_start(&r->q, &r->dense, r->y1, r->f1, r->state);
}

/* A step of length h in free fall, which the quintic follows exactly. */
static void fall(rig *r, double t0, double h)
{
    const vec2 a = {0.0, -g};
    for (dem_index i = 0; i < r->n; i++) {
        const vec2 v = vec2_at(r->y0, r->n_all + i);
        vec2_put(r->f0, i, v);
        vec2_put(r->f0, r->n_all + i, a);
        vec2_put(r->y1, i, vec2_along(vec2_at(r->y0, i), h, vec2_along(v, 0.5 * h, a)));
        vec2_put(r->y1, r->n_all + i, vec2_along(v, h, a));
        vec2_put(r->f1, i, vec2_along(v, h, a));
        vec2_put(r->f1, r->n_all + i, a);
    }
    take_up(r, t0, h);
}

/* Time from rest at height y to the penetration tolerance's depth. */
static double time_of_fall(double y)
{
    return sqrt(2.0 * (y + penetration_tolerance) / g);
}

static void show(rig *r, double t)
{
    assert_ok(event_queue_show(&r->q, t));
}

/* ---- all that a step changes ---- */

typedef struct snapshot {
    double y1[most_state], f1[most_state], state[most_state], impulse[4], energy[3];
    contact_candidate candidates[most_nodes];
    dem_counts counts;
    dem_index n_groups, n_events, n_taken;
    dem_event events[64];
} snapshot;

static snapshot take_snapshot(rig *r, double t)
{
    snapshot s;
    memset(&s, 0, sizeof s);
    memcpy(s.y1, r->y1, sizeof s.y1);
    memcpy(s.f1, r->f1, sizeof s.f1);
    dense_output_state(&r->dense, t, s.state);
    ledger_list_impulses(&r->c.set.ledger, 1, s.impulse);
    s.energy[0] = exact_sum_value(&r->c.set.ledger.impact);
    s.energy[1] = exact_sum_value(&r->c.set.ledger.projection);
    s.energy[2] = exact_sum_value(&r->c.set.ledger.work);
    look_copy(&r->c, 0, r->n, s.candidates);
    s.counts = r->c.set.ledger.counts;
    s.n_groups = r->c.set.forces.n_groups;
    s.n_taken = r->q.n_taken;
    s.n_events = r->q.n_events;
    assert_true(s.n_events <= 64);
    if (s.n_events > 0) memcpy(s.events, r->q.events, (size_t)s.n_events * sizeof s.events[0]);
    return s;
}

static void assert_same(const snapshot *a, const snapshot *b)
{
    assert_memory_equal(a->y1, b->y1, sizeof a->y1);
    assert_memory_equal(a->f1, b->f1, sizeof a->f1);
    assert_memory_equal(a->state, b->state, sizeof a->state);
    assert_memory_equal(a->impulse, b->impulse, sizeof a->impulse);
    assert_memory_equal(a->candidates, b->candidates, sizeof a->candidates);
    assert_memory_equal(a->energy, b->energy, sizeof a->energy);
    assert_memory_equal(&a->counts, &b->counts, sizeof a->counts);
    assert_memory_equal(a->events, b->events, sizeof a->events);
    assert_memory_equal(a, b, sizeof *a); /* and the numbers */
}

/* ---- order ---- */

TEST(events_come_in_the_order_of_time)
{
    const double heights[5] = {0.03, 0.02, 0.05, 0.025, 0.04};
    const dem_index order[5] = {1, 3, 0, 4, 2};
    CLEANUP(close_rig) rig r;
    open_masses(&r, 5, heights, 0.5, 0.0);
    fall(&r, 0.0, 0.11);
    show(&r, 0.11);
    assert_int_equal(r.q.n_events, 5);
    assert_int_equal(r.q.n_taken, 5);
    for (int k = 0; k < 5; k++) {
        const double t = time_of_fall(heights[order[k]]), v = 0.5 * g * t, tau = 0.11 - t;
        assert_int_equal(r.q.events[k].node, order[k]);
        assert_int_equal(r.q.events[k].kind, DEM_EVENT_IMPACT);
        assert_close(r.q.events[k].t, t, 1e-14);
        assert_close(r.q.events[k].after[1], v, 1e-13);
        assert_close(r.y1[2 * order[k] + 1], v * tau - 0.5 * g * tau * tau, 1e-14);
        assert_close(r.y1[2 * (r.n_all + order[k]) + 1], v - g * tau, 1e-13);
    }
}

/* Those of equal height at once, the lowest number first, whichever is looked at first. */
TEST(events_at_the_same_time_come_in_the_order_of_candidates)
{
    const double heights[6] = {0.03, 0.02, 0.03, 0.02, 0.03, 0.02};
    const dem_index order[6] = {1, 3, 5, 0, 2, 4};
    CLEANUP(close_rig) rig r;
    open_masses(&r, 6, heights, 0.5, 0.0);
    fall(&r, 0.0, 0.1);
    look_enter_backwards(&r.contact, 6);
    show(&r, 0.1);
    assert_int_equal(r.q.n_events, 6);
    for (int k = 0; k < 6; k++) {
        assert_int_equal(r.q.events[k].node, order[k]);
        assert_close(r.q.events[k].t, r.q.events[k - k % 3].t, 0.0);
    }
}

/* Bounces at t, t + 2 eta v/g, t + 2 (eta + eta^2) v/g, ... : the same node again and again within one step. */
TEST(a_node_may_bounce_many_times_in_a_step)
{
    const double height = 0.02, eta = 0.5, t = time_of_fall(height), v = g * t;
    double due = t, up = v;
    CLEANUP(close_rig) rig r;
    open_masses(&r, 1, &height, eta, 0.0);
    fall(&r, 0.0, 0.18);
    show(&r, 0.18);
    assert_true(r.q.n_events >= 4);
    for (dem_index k = 0; k < r.q.n_events; k++) {
        assert_close(r.q.events[k].t, due, 1e-7); /* the penetration tolerance, at ever slower speeds */
        up *= eta;
        due += 2.0 * up / g;
    }
    assert_true(due > 0.18);
}

/* ---- several sources ---- */

enum { n_kicks = 3 };

/* Lets place and velocity of a node jump at given times; its keys are their numbers. */
typedef struct kicks {
    dem_index node;
    double t[n_kicks];                                  /* s */
    double shift[STATE_DIM_MOST], jump[STATE_DIM_MOST]; /* m, m/s */
    bool done[n_kicks];
    dem_index generation; /* of all */
} kicks;

static void kicks_undo(void *self)
{
    kicks *s = self;
    for (int k = 0; k < n_kicks; k++) s->done[k] = false;
}

static void kicks_begin(void *self, const dense_output *step, double *state)
{
    (void)step;
    (void)state;
    kicks_undo(self);
}

static event_due kicks_next(const void *self)
{
    const kicks *s = self;
    event_due first = {.t = (double)INFINITY};
    for (int k = 0; k < n_kicks; k++)
        if (!s->done[k] && s->t[k] < first.t) first = (event_due){s->t[k], s->generation, k};
    return first;
}

static dem_index kicks_seeds(const void *self, dem_index key, dem_index *nodes, dem_index capacity)
{
    (void)key;
    if (capacity > 0) nodes[0] = ((const kicks *)self)->node;
    return 1;
}

static void kicks_see(void *self, const event_place *at)
{
    (void)self;
    (void)at;
}

static dem_status kicks_resolve(void *self, dem_index key, const event_place *at, const event_listener *listener)
{
    kicks *s = self;
    const dem_event event = {.t = at->t, .kind = DEM_EVENT_PASS, .node = s->node, .segment = key};
    const state_layout *l = &at->step->layout;
    double *x = at->state + state_row(l, s->node);
    state_add_row(l, x, 1.0, s->shift);
    state_add_row(l, x + state_velocities(l), 1.0, s->jump);
    s->done[key] = true;
    return listener->event(listener->context, &event);
}

static dem_status kicks_save(const void *self, dem_checkpoint *checkpoint)
{
    return dem_checkpoint_put(checkpoint, "kicks", self, sizeof(kicks));
}

static dem_status kicks_restore(void *self, const dem_checkpoint *checkpoint, double t, const double *y)
{
    (void)t;
    (void)y;
    return dem_checkpoint_get(checkpoint, "kicks", self, sizeof(kicks));
}

static event_source kicks_events(kicks *s)
{
    return (event_source){.name = "kick",
                          .self = s,
                          .begin = kicks_begin,
                          .next = kicks_next,
                          .seeds = kicks_seeds,
                          .prepare = kicks_see,
                          .resolve = kicks_resolve,
                          .follow = kicks_see,
                          .undo = kicks_undo,
                          .save = kicks_save,
                          .restore = kicks_restore};
}

/* Masses 0 and 1 hit the floor. Mass 2 is kicked between both impacts, by the last key, and twice at the time of the
 * second: after the impact, for contact is the first source, and in the order of keys. */
TEST(events_of_sources_come_in_the_order_of_time_kind_and_key)
{
    const double heights[3] = {0.02, 0.03, 0.05}, h = 0.1, between = 0.07;
    const dem_index nodes[5] = {0, 2, 1, 2, 2}, keys[5] = {0, 2, 0, 0, 1};
    kicks jumps = {.node = 2, .jump = {0.0, 0.25}};
    CLEANUP(close_rig) rig r;
    open_masses(&r, 3, heights, 0.5, 0.0);
    assert_ok(source_list_add(&r.sources, kicks_events(&jumps)));
    fall(&r, 0.0, h);
    const double second = look_due(&r.contact, 1);
    jumps.t[0] = jumps.t[1] = second;
    jumps.t[2] = between;
    show(&r, h);
    assert_int_equal(r.q.n_events, 5);
    assert_int_equal(r.q.n_taken, 5);
    for (int k = 0; k < 5; k++) {
        assert_int_equal(r.q.events[k].node, nodes[k]);
        assert_int_equal(r.q.events[k].kind, nodes[k] == 2 ? DEM_EVENT_PASS : DEM_EVENT_IMPACT);
        if (nodes[k] == 2) assert_int_equal(r.q.events[k].segment, keys[k]);
    }
    const double way = jumps.jump[1] * ((h - between) + 2.0 * (h - second));
    assert_close(r.y1[2 * (r.n_all + 2) + 1], 3.0 * jumps.jump[1] - g * h,
                 1e-14);                                                      /* rounding of velocities of order 1 */
    assert_close(r.y1[2 * 2 + 1], heights[2] + way - 0.5 * g * h * h, 1e-15); /* and of lengths of order 0.1 */
}

/* At one time the first generation of all sources comes before the second of any. */
TEST(a_generation_comes_before_the_next_whatever_the_source)
{
    const double heights[3] = {0.02, 0.05, 0.05}, h = 0.1, t = 0.08;
    const dem_index nodes[7] = {0, 2, 2, 2, 1, 1, 1};
    kicks later = {.node = 1, .t = {t, t, t}, .generation = 1}, sooner = {.node = 2, .t = {t, t, t}};
    CLEANUP(close_rig) rig r;
    open_masses(&r, 3, heights, 0.5, 0.0);
    assert_ok(source_list_add(&r.sources, kicks_events(&later)));
    assert_ok(source_list_add(&r.sources, kicks_events(&sooner)));
    fall(&r, 0.0, h);
    show(&r, h);
    assert_int_equal(r.q.n_events, 7);
    for (int k = 0; k < 7; k++) assert_int_equal(r.q.events[k].node, nodes[k]);
}

/* The kick keeps mass 1 off the floor: contact looks at it anew, and back in time finds the impact of before. */
TEST(sources_are_undone_and_redone_to_the_bit)
{
    const double heights[2] = {0.02, 0.03}, h = 0.1;
    kicks jumps = {.node = 1, .t = {0.07, (double)INFINITY, (double)INFINITY}, .jump = {0.0, 1.0}};
    CLEANUP(close_rig) rig r;
    open_masses(&r, 2, heights, 0.5, 0.0);
    assert_ok(source_list_add(&r.sources, kicks_events(&jumps)));
    fall(&r, 0.0, h);
    const double alone = look_due(&r.contact, 1);
    const snapshot before = take_snapshot(&r, h);
    show(&r, h);
    assert_int_equal(r.q.n_events, 2);
    assert_int_equal(r.q.n_taken, 2);
    const snapshot once = take_snapshot(&r, h);
    event_queue_undo(&r.q);
    const snapshot undone = take_snapshot(&r, h);
    assert_same(&undone, &before);
    show(&r, 0.0);
    assert_close(look_due(&r.contact, 1), alone, 0.0);
    show(&r, h);
    const snapshot again = take_snapshot(&r, h);
    assert_same(&again, &once);
}

/* ---- three dimensions, without contact ---- */

/* A step of a chain with kicks of two of its nodes, both twice, the second a little later. They shift the nodes too,
 * which is felt a ring further at the end of the step: nodes beside those that have moved accelerate otherwise. */
typedef struct kicked_chain {
    chain chain;
    kicks sources[2];
    source_list list;
    event_queue q;
    double middle[CHAIN_STATE]; /* state at the middle of the step */
} kicked_chain;

static kicks kicks_of(dem_index node, double first, double second, const double jump[3])
{
    return (kicks){.node = node,
                   .t = {second * chain_step, first * chain_step, (double)INFINITY},
                   .shift = {0.01 * jump[0], 0.01 * jump[1], 0.01 * jump[2]},
                   .jump = {jump[0], jump[1], jump[2]}};
}

static const dem_index kicked[2] = {5, 8};

static void open_kicked_chain(kicked_chain *s, int dim, const int *axes, const dem_index nodes[2],
                              const constraints *held)
{
    static const double along[2][3] = {{1.0, -2.0, 3.0}, {0.5, 4.0, -1.0}};
    chain *c = &s->chain;
    double jump[2][3] = {{0.0}};
    chain_open(c, dim, axes, 9, false);
    for (int k = 0; k < 2; k++)
        for (int d = 0; d < dim; d++) jump[k][d] = along[k][axes[d]];
    s->sources[0] = kicks_of(nodes[0], 0.2, 0.7, jump[0]);
    s->sources[1] = kicks_of(nodes[1], 0.4, 0.7, jump[1]);
    s->list = (source_list){0};
    for (int k = 0; k < 2; k++) assert_ok(source_list_add(&s->list, kicks_events(&s->sources[k])));
    assert_ok(event_queue_create(&s->q, &(event_queue_parts){.layout = &c->layout,
                                                             .forces = &c->forces,
                                                             .constraints = held,
                                                             .sources = &s->list,
                                                             .rule = {5, 1.0, 1.0, c->layout.n_nodes},
                                                             .happens = true}));
    event_queue_start(&s->q, &c->step, c->y1, c->f1, c->state);
}

static void close_kicked_chain(kicked_chain *s)
{
    event_queue_destroy(&s->q);
    source_list_destroy(&s->list);
}

static void take_kicked_step(kicked_chain *s, int dim, const int *axes)
{
    open_kicked_chain(s, dim, axes, kicked, NULL);
    assert_ok(event_queue_show(&s->q, chain_step));
    dense_output_state(&s->chain.step, 0.5 * chain_step, s->middle);
}

TEST(in_three_dimensions_each_component_is_that_of_two)
{
    static const int axes[3] = {0, 1, 2}, others[2] = {2, 0};
    static const dem_index nodes[4] = {5, 8, 5, 8};
    kicked_chain three, two[2];
    chain untouched;
    take_kicked_step(&three, 3, axes);
    take_kicked_step(&two[0], 2, axes);
    take_kicked_step(&two[1], 2, others);
    for (int k = 0; k < 2; k++) {
        assert_int_equal(two[k].q.n_events, 4);
        chain_check_components(&three.chain, three.chain.y1, &two[k].chain, two[k].chain.y1);
        chain_check_components(&three.chain, three.chain.f1, &two[k].chain, two[k].chain.f1);
        chain_check_components(&three.chain, three.middle, &two[k].chain, two[k].middle);
    }
    assert_int_equal(three.q.n_events, 4);
    assert_int_equal(three.q.n_taken, 4);
    for (int k = 0; k < 4; k++) assert_int_equal(three.q.events[k].node, nodes[k]);
    chain_open(&untouched, 3, axes, 9, false);
    for (int c = 0; c < 3; c++)
        assert_true(state_v(&untouched.layout, three.chain.y1, 5)[c] != state_v(&untouched.layout, untouched.y1, 5)[c]);
    close_kicked_chain(&three);
    for (int k = 0; k < 2; k++) close_kicked_chain(&two[k]);
}

/* Derivatives at the end are those of the state there, but for the prescribed component of node 9, which keeps its
 * velocity. */
TEST(the_end_of_a_step_in_three_dimensions_has_its_own_derivative)
{
    static const int axes[3] = {0, 1, 2};
    double f[CHAIN_STATE];
    CLEANUP(close_kicked_chain) kicked_chain s;
    take_kicked_step(&s, 3, axes);
    const state_layout *l = &s.chain.layout;
    chain_derive(&s.chain, s.chain.y1, f);
    for (dem_index i = 0; i < CHAIN_NODES; i++) {
        assert_memory_equal(state_x(l, s.chain.f1, i), state_x(l, f, i), 3 * sizeof *f);
        assert_memory_equal(state_v(l, s.chain.f1, i), state_v(l, f, i), 3 * sizeof *f);
    }
}

/* Node 1 is held where it is, and is put elsewhere at the end of the step. */
typedef struct hold {
    int32_t of_nodes[CHAIN_NODES], *group_at;
    double of_held[3 * CHAIN_NODES], *a;
    const state_layout *layout;
} hold;

static dem_status hold_each_node(const void *self, dem_index group, dem_status (*add)(void *context, dem_index node),
                                 void *context)
{
    (void)self;
    assert_int_equal(group, 0);
    return add(context, 1);
}

static dem_index hold_groups_at(void *self, const dem_index *nodes, dem_index n, const dem_index **list)
{
    static const dem_index only[] = {0};
    (void)self;
    *list = only;
    for (dem_index j = 0; j < n; j++)
        if (nodes[j] == 1) return 1;
    return 0;
}

static void hold_settle(void *self, dem_index group, double t, double *y)
{
    const hold *h = self;
    (void)t;
    assert_int_equal(group, 0);
    y[state_row(h->layout, 1)] += 1e-3;
}

static void hold_solve(void *self, dem_index group, constraint_state at, const constraint_free *known)
{
    (void)self;
    (void)at;
    (void)known;
    assert_int_equal(group, 0);
}

static dem_status hold_add_rates(const void *self, dem_index group, constraint_state at, const constraint_rates *to)
{
    (void)self;
    (void)at;
    (void)to;
    assert_int_equal(group, 0);
    return DEM_OK;
}

static void hold_add_all_rates(void *self, constraint_state at, double *a)
{
    (void)self;
    (void)at;
    (void)a;
}

/* It is beside the last node that moves in the correction round node 5, whose acceleration at the end of the step was
 * evaluated before node 1 went. */
TEST(the_end_of_a_step_is_that_of_what_constraints_have_moved)
{
    static const int axes[2] = {0, 1};
    double f[CHAIN_STATE];
    hold h = {.group_at = h.of_nodes, .a = h.of_held};
    CLEANUP(close_kicked_chain) kicked_chain s;
    h.layout = &s.chain.layout;
    for (dem_index i = 0; i < CHAIN_NODES; i++) h.of_nodes[i] = i == 1 ? 0 : -1;
    const constraints held = {.self = &h,
                              .group_at = &h.group_at,
                              .a = &h.a,
                              .each_node = hold_each_node,
                              .groups_at = hold_groups_at,
                              .solve = hold_solve,
                              .add_rates = hold_add_rates,
                              .settle = hold_settle,
                              .add_all_rates = hold_add_all_rates};
    open_kicked_chain(&s, 2, axes, (const dem_index[2]){1, 5}, &held);
    assert_ok(event_queue_show(&s.q, chain_step));
    const state_layout *l = &s.chain.layout;
    chain_derive(&s.chain, s.chain.y1, f);
    for (dem_index i = 2; i < CHAIN_NODES; i++)
        assert_memory_equal(state_v(l, s.chain.f1, i), state_v(l, f, i), 2 * sizeof *f);
}

/* Taken back, and taken again by sources that come back from a checkpoint. */
TEST(a_step_in_three_dimensions_is_undone_and_redone_to_the_bit)
{
    static const int axes[3] = {0, 1, 2};
    static chain before, after;
    CLEANUP(close_kicked_chain) kicked_chain s;
    CLEANUP(free_checkpoint) dem_checkpoint *checkpoint;
    open_kicked_chain(&s, 3, axes, kicked, NULL);
    memcpy(&before, &s.chain, sizeof before);
    assert_ok(event_queue_show(&s.q, chain_step));
    memcpy(&after, &s.chain, sizeof after);
    event_queue_undo(&s.q);
    assert_memory_equal(s.chain.y1, before.y1, sizeof before.y1);
    assert_memory_equal(s.chain.f1, before.f1, sizeof before.f1);
    assert_ok(dem_checkpoint_create(&checkpoint));
    assert_ok(kicks_save(&s.sources[0], checkpoint));
    memset(&s.sources[0], 0, sizeof s.sources[0]);
    assert_ok(kicks_restore(&s.sources[0], checkpoint, 0.0, s.chain.y0));
    assert_ok(event_queue_show(&s.q, 0.0));
    assert_memory_equal(s.chain.y1, before.y1, sizeof before.y1);
    assert_ok(event_queue_show(&s.q, chain_step));
    assert_int_equal(s.q.n_events, 4);
    assert_memory_equal(s.chain.y1, after.y1, sizeof after.y1);
    assert_memory_equal(s.chain.f1, after.f1, sizeof after.f1);
}

/* ---- candidates that come and go ---- */

/* Gives the bodies another surface at a time, by an event at node 1. */
typedef struct exposure {
    contact_source *contact;
    const surface *before, *after;
    double t; /* s */
    bool done;
} exposure;

static void exposure_undo(void *self)
{
    exposure *s = self;
    if (s->done) assert_ok(contact_source_follow_surface(s->contact, s->before));
    s->done = false;
}

static void exposure_begin(void *self, const dense_output *step, double *state)
{
    (void)step;
    (void)state;
    assert_false(((exposure *)self)->done);
}

static event_due exposure_next(const void *self)
{
    const exposure *s = self;
    return (event_due){.t = s->done ? (double)INFINITY : s->t};
}

static dem_index exposure_seeds(const void *self, dem_index key, dem_index *nodes, dem_index capacity)
{
    (void)self;
    (void)key;
    if (capacity > 0) nodes[0] = 1;
    return 1;
}

static dem_status exposure_resolve(void *self, dem_index key, const event_place *at, const event_listener *listener)
{
    exposure *s = self;
    (void)key;
    (void)at;
    (void)listener;
    s->done = true;
    return contact_source_follow_surface(s->contact, s->after);
}

/* A rig of three masses, two of which fall from the same height; its surface is changed before they land, while the
 * third bounces. */
static void open_exposed(rig *r, exposure *s, const surface *before, const surface *after)
{
    const double heights[3] = {0.03, 0.03, 0.005};
    open_masses(r, 3, heights, 0.5, 0.0);
    *s = (exposure){&r->contact, before, after, 0.07, false};
    assert_ok(contact_source_follow_surface(&r->contact, before));
    assert_ok(source_list_add(&r->sources, (event_source){.name = "exposure",
                                                          .self = s,
                                                          .begin = exposure_begin,
                                                          .next = exposure_next,
                                                          .seeds = exposure_seeds,
                                                          .prepare = kicks_see,
                                                          .resolve = exposure_resolve,
                                                          .follow = kicks_see,
                                                          .undo = exposure_undo}));
    fall(r, 0.0, 0.1);
}

static dem_index every_node[3] = {0, 1, 2}, outer_nodes[2] = {0, 2};

/* 0 and 1 land together, in the order of nodes, though 1 has come last. */
TEST(a_candidate_that_comes_within_a_step_counts_as_if_it_had_always_been_there)
{
    const surface all = {.n_nodes = 3, .nodes = every_node}, outer = {.n_nodes = 2, .nodes = outer_nodes};
    exposure late, early;
    CLEANUP(close_rig) rig r, whole;
    open_exposed(&r, &late, &outer, &all);
    open_exposed(&whole, &early, &all, &all);
    contact_candidate first, last;
    look_copy(&r.c, 1, 1, &first);
    for (int k = 0; k < 3; k++) { /* there, back and there again */
        dem_index e = 0;
        show(&r, 0.1);
        show(&whole, 0.1);
        assert_int_equal(r.q.n_events, whole.q.n_events);
        while (r.q.events[e].node != 0) e++;
        assert_int_equal(r.q.events[e + 1].node, 1);
        assert_true(r.q.events[e + 1].t == r.q.events[e].t);
        assert_memory_equal(r.q.events, whole.q.events, (size_t)r.q.n_events * sizeof *r.q.events);
        assert_memory_equal(r.y1, whole.y1, sizeof r.y1);
        assert_memory_equal(r.f1, whole.f1, sizeof r.f1);
        assert_int_equal(r.c.set.n, 3);
        show(&r, 0.069); /* before the surface changes */
        assert_int_equal(r.c.set.n, 2);
        assert_true(r.q.n_events > 0);
    }
    show(&r, 0.1);
    event_queue_undo(&r.q);
    assert_int_equal(r.c.set.ledger.counts.impacts, 0);
    look_copy(&r.c, 1, 1, &last);
    assert_memory_equal(&last, &first, sizeof first);
}

/* Mass 1 falls through the floor, on which 0 bounces. */
TEST(a_candidate_that_goes_within_a_step_touches_no_more)
{
    const surface all = {.n_nodes = 3, .nodes = every_node}, outer = {.n_nodes = 2, .nodes = outer_nodes};
    exposure late, early;
    CLEANUP(close_rig) rig r, without;
    open_exposed(&r, &late, &all, &outer);
    open_exposed(&without, &early, &outer, &outer);
    show(&r, 0.1);
    show(&without, 0.1);
    for (dem_index e = 0; e < r.q.n_events; e++) assert_int_not_equal(r.q.events[e].node, 1);
    assert_true(r.y1[3] < 0.0 && r.y1[1] > 0.0);
    assert_memory_equal(r.y1, without.y1, sizeof r.y1);
    assert_memory_equal(r.f1, without.f1, sizeof r.f1);
}

/* ---- any time ---- */

TEST(a_step_without_events_is_left_as_it_is)
{
    const double height = 5.0;
    CLEANUP(close_rig) rig r;
    open_masses(&r, 1, &height, 0.5, 0.0);
    fall(&r, 1.0, 0.1);
    const snapshot before = take_snapshot(&r, 1.05);
    show(&r, 1.1);
    const snapshot after = take_snapshot(&r, 1.05);
    assert_same(&after, &before);
    assert_int_equal(r.q.n_taken, 0);
    assert_close(event_queue_error(&r.q), 0.0, 0.0);
}

/* The first of two impacts concerns a node that all ranks have, the second one that they have not. */
TEST(an_event_that_concerns_what_not_all_ranks_have_stops)
{
    static const double heights[] = {0.0112, 0.0163};
    static const unsigned char is_common[] = {1, 0};
    CLEANUP(close_rig) rig r;
    open_masses(&r, 2, heights, 0.5, 0.0);
    r.q.is_common = is_common;
    fall(&r, 0.0, 0.1);
    show(&r, 0.5 * (time_of_fall(heights[0]) + time_of_fall(heights[1])));
    assert_false(event_queue_lacks_nodes(&r.q));
    assert_int_equal(r.q.n_events, 1);
    assert_int_equal(event_queue_show(&r.q, 0.1), DEM_STOPPED);
    assert_true(event_queue_lacks_nodes(&r.q));
    assert_int_equal(r.q.n_events, 1);
    assert_non_null(strstr(dem_status_message(), "not all ranks"));
}

/* Between the impacts of the lower and the higher mass: one has happened, the other not, in motion and in ledger. */
TEST(a_step_shown_at_a_time_is_what_it_is_then)
{
    const double heights[2] = {0.02, 0.04}, t = time_of_fall(0.02), v = 0.5 * g * t, now = 0.08;
    double y[most_state];
    CLEANUP(close_rig) rig r;
    open_masses(&r, 2, heights, 0.5, 0.0);
    fall(&r, 0.0, 0.1);
    show(&r, now);
    dense_output_state(&r.dense, now, y);
    assert_int_equal(r.q.n_events, 1);
    assert_int_equal(r.c.set.ledger.counts.impacts, 1);
    assert_close(exact_sum_value(&r.c.set.ledger.impulse[1]), mass * 1.5 * g * t, 1e-12);
    assert_close(y[1], v * (now - t) - 0.5 * g * (now - t) * (now - t), 1e-14);
    assert_close(y[2 * r.n_all + 1], v - g * (now - t), 1e-13);
    assert_close(y[3], 0.04 - 0.5 * g * now * now, 1e-15);
    show(&r, r.q.events[0].t); /* at the instant itself it has happened */
    assert_int_equal(r.q.n_events, 1);
    dense_output_state(&r.dense, r.q.events[0].t, y);
    assert_close(y[1], 0.0, 1e-16);
    assert_close(y[2 * r.n_all + 1], v, 1e-13);
    show(&r, nextafter(r.q.events[0].t, 0.0));
    assert_int_equal(r.q.n_events, 0);
    assert_int_equal(r.c.set.ledger.counts.impacts, 0);
    show(&r, 0.5 * t);
    dense_output_state(&r.dense, 0.5 * t, y);
    assert_close(y[1], 0.02 - 0.125 * g * t * t, 1e-15);
}

/* Some bounce, some stay and slide; forwards, backwards, to the end and back again. */
TEST(any_way_to_a_time_gives_the_same_bits)
{
    static const double heights[6] = {0.03, 0.01, 0.05, 0.01, 0.0, 0.03},
                        way[10] = {0.11, 0.02, 0.07, 0.07, 0.0, 0.11, 0.065, 0.09, 0.01, 0.11};
    for (int eta = 0; eta < 2; eta++) {
        rig direct, r;
        open_masses(&r, 6, heights, 0.6 * eta, 0.3);
        for (dem_index i = 0; i < 6; i++) r.y0[2 * (r.n_all + i)] = 1.0 - 0.3 * (double)i;
        fall(&r, 0.0, 0.11);
        for (int k = 0; k < 10; k++) {
            open_masses(&direct, 6, heights, 0.6 * eta, 0.3);
            memcpy(direct.y0, r.y0, sizeof r.y0);
            fall(&direct, 0.0, 0.11);
            show(&direct, way[k]);
            show(&r, way[k]);
            const snapshot there = take_snapshot(&direct, way[k]), here = take_snapshot(&r, way[k]);
            assert_true(there.n_events > 0 || way[k] < 0.05);
            assert_same(&here, &there);
            close_rig(&direct);
        }
        close_rig(&r);
    }
}

TEST(undoing_brings_every_bit_back)
{
    static const double heights[6] = {0.03, 0.01, 0.05, 0.01, 0.0, 0.03};
    for (int eta = 0; eta < 2; eta++) {
        CLEANUP(close_rig) rig r;
        open_masses(&r, 6, heights, 0.6 * eta, 0.3);
        fall(&r, 0.0, 0.11);
        const snapshot before = take_snapshot(&r, 0.1);
        show(&r, 0.11);
        const snapshot after = take_snapshot(&r, 0.1);
        assert_memory_not_equal(&after, &before, sizeof before);
        assert_true(after.n_groups > 0 || eta > 0);
        event_queue_undo(&r.q);
        const snapshot undone = take_snapshot(&r, 0.1);
        assert_same(&undone, &before);
        event_queue_undo(&r.q);
        const snapshot twice = take_snapshot(&r, 0.1);
        assert_same(&twice, &before);
    }
}

/* ---- at the ends of the step ---- */

/* Found three penetration tolerances deep as the step begins, and reflected there once; what follows is free flight. */
TEST(an_event_at_the_very_start_happens_once)
{
    const double height = 0.0, h = 0.01;
    CLEANUP(close_rig) rig r;
    double y[most_state], v[STATE_DIM_MOST];
    open_masses(&r, 1, &height, 0.5, 0.0);
    r.y0[1] = -1.5 * penetration_tolerance;
    r.y0[2 * r.n_all + 1] = -2.0;
    fall(&r, 0.0, h);
    show(&r, h);
    assert_int_equal(r.q.n_events, 1);
    assert_close(r.q.events[0].t, 0.0, 0.0);
    assert_close(r.y1[1], 1.0 * h - 0.5 * g * h * h, 1e-15);
    assert_close(r.y1[2 * r.n_all + 1], 1.0 - g * h, 1e-15);
    dense_output_state(&r.dense, 0.0, y);
    assert_close(y[1], 0.0, 0.0);
    assert_close(y[2 * r.n_all + 1], 1.0, 0.0);
    dense_output_velocity(&r.dense, 0.0, 0, v);
    assert_close(v[1], 1.0, 0.0);
}

/* The step ends a few units of rounding after the impact. */
TEST(an_event_at_the_very_end_is_in_the_state_there)
{
    const double height = 0.02, t = time_of_fall(height);
    for (int k = 0; k < 4; k++) {
        CLEANUP(close_rig) rig r;
        open_masses(&r, 1, &height, 0.5, 0.0);
        fall(&r, 0.0, t * (1.0 + k * 1e-15));
        show(&r, r.dense.t1);
        if (r.q.n_events > 0) {
            assert_close(r.y1[1], 0.0, 1e-14);
            assert_close(r.y1[2 * r.n_all + 1], 0.5 * g * t, 1e-13);
        } else {
            assert_true(k < 3);
            assert_close(r.y1[1], -penetration_tolerance, 1e-14);
        }
    }
}

/* ---- what follows from events ---- */

/* Two masses on a spring, its length 1 m, 0.3 m/m aslant; the lower one hits first. */
static void open_pair(rig *r, dem_lattice *lattice, const double error[2])
{
    const double x[4] = {0.0, 0.03, sqrt(0.99), 0.13}, masses[2] = {1.0, 0.5}, v[4] = {0.2, -1.0, -0.4, -1.1};
    const dem_index ends[2] = {0, 1};
    *lattice = support_lattice(2, x, masses, 1, ends, 1.0, 300.0, NULL);
    support_start(lattice, NULL, v);
    open_rig(r, lattice, 0.8, 0.0, error);
}

static void swing(rig *r, dem_lattice *lattice, double h)
{
    double y[8], f[8];
    triplets_start(lattice, y);
    memcpy(r->y0, y, 4 * sizeof *y);
    memcpy(r->y0 + 2 * r->n_all, y + 4, 4 * sizeof *y);
    (void)triplets_derivative(0.0, y, f, lattice);
    memcpy(r->f0, f, 4 * sizeof *y);
    memcpy(r->f0 + 2 * r->n_all, f + 4, 4 * sizeof *y);
    triplets_reach(lattice, h, y);
    memcpy(r->y1, y, 4 * sizeof *y);
    memcpy(r->y1 + 2 * r->n_all, y + 4, 4 * sizeof *y);
    (void)triplets_derivative(h, y, f, lattice);
    memcpy(r->f1, f, 4 * sizeof *y);
    memcpy(r->f1 + 2 * r->n_all, f + 4, 4 * sizeof *y);
    take_up(r, 0.0, h);
}

/* The pair from y to the time at which a mass is as deep as the penetration tolerance, by bisection. */
static double impact_time(dem_lattice *lattice, int node, double *y)
{
    double low = 0.0, high = 0.2, z[8];
    while (high - low > 1e-15) {
        const double t = 0.5 * (low + high);
        memcpy(z, y, sizeof z);
        if (t > 0.0) triplets_reach(lattice, t, z);
        if (z[2 * node + 1] < -penetration_tolerance)
            high = t;
        else
            low = t;
    }
    triplets_reach(lattice, high, y);
    y[2 * node + 1] = 0.0;
    y[4 + 2 * node + 1] *= -0.8;
    return high;
}

/* The spring is turned by the impact of the first mass and pulls otherwise at the second: it hits at another time
 * than the step without impacts has it, by GSL's account too. */
TEST(the_neighbours_events_are_looked_for_anew)
{
    const double h = 0.16;
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    CLEANUP(close_rig) rig r;
    double y[8];
    open_pair(&r, &lattice, NULL);
    swing(&r, &lattice, h);
    const double alone = look_due(&r.contact, 1);
    show(&r, h);
    assert_int_equal(r.q.n_events, 2);
    triplets_start(&lattice, y);
    const double first = impact_time(&lattice, 0, y), second = first + impact_time(&lattice, 1, y);
    triplets_reach(&lattice, h - second, y);
    print_message("# second impact at %.6f s, without the first at %.6f s, %.1e s off\n", second, alone,
                  r.q.events[1].t - second);
    assert_true(fabs(second - alone) > 1e-3);
    assert_close(r.q.events[0].t, first, 5e-5); /* omega h = 4.8: coarse on purpose */
    assert_close(r.q.events[1].t, second, 0.2 * fabs(second - alone));
}

/* The same with ever shorter steps, the impacts in one of them. */
TEST(times_and_motion_converge_with_the_step)
{
    double wrong[2];
    for (int k = 0; k < 2; k++) {
        const double h = 0.08 / (1 << k);
        CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
        CLEANUP(close_rig) rig r;
        double y[8];
        open_pair(&r, &lattice, NULL);
        lattice.x[1] = 0.3 * h, lattice.x[3] = 0.7 * h; /* hit after about these shares of the step */
        lattice.velocity[0] = lattice.velocity[2] = 0.0;
        swing(&r, &lattice, h);
        show(&r, h);
        assert_int_equal(r.q.n_events, 2);
        triplets_start(&lattice, y);
        const double first = impact_time(&lattice, 0, y), second = first + impact_time(&lattice, 1, y);
        triplets_reach(&lattice, h - second, y);
        wrong[k] = fabs(r.q.events[1].t - second);
        for (int c = 0; c < 4; c++) wrong[k] = fmax(wrong[k], fabs(r.y1[c] - y[c]));
    }
    print_message("# wrong by %.1e, %.1e\n", wrong[0], wrong[1]);
    assert_true(wrong[1] < wrong[0] / 16.0 + 1e-12);
}

/* ---- rejection ---- */

/* With a tolerance out of reach the first event ends it, and all can be taken back; without control the error is of no
 * account. */
TEST(an_error_beyond_what_is_allowed_ends_the_step)
{
    static const double strict[2] = {1e-12, 1e-12}, lax[2] = {1.0, 1.0};
    for (int k = 0; k < 3; k++) {
        CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
        CLEANUP(close_rig) rig r;
        open_pair(&r, &lattice, k == 0 ? strict : (k == 1 ? lax : NULL));
        swing(&r, &lattice, 0.16);
        const snapshot before = take_snapshot(&r, 0.1);
        show(&r, 0.16);
        assert_int_equal(r.q.n_events, k == 0 ? 1 : 2);
        assert_true(k != 0 || event_queue_error(&r.q) > 1.0);
        assert_true(k != 1 || (event_queue_error(&r.q) > 0.0 && event_queue_error(&r.q) < 1.0));
        assert_true(k != 2 || event_queue_error(&r.q) == 0.0);
        event_queue_undo(&r.q);
        const snapshot undone = take_snapshot(&r, 0.1);
        assert_same(&undone, &before);
    }
}

/* The pair has three events in a long step, of which the second has the largest error. With a tolerance a little above
 * that all are resolved, though the first two are beyond it together; with one a little below it the second is the
 * last. Errors are independent, so that of one is what the sum of squares gains by it. */
TEST(the_sum_of_errors_does_not_end_a_step_but_one_error_does)
{
    const double h = 0.29, lax = 1e6; /* s; m, m/s */
    double own[3] = {0.0}, sum = 0.0;
    for (int k = 0; k < 3; k++) {
        const double one = k == 0 ? lax : lax * sqrt(own[1]) * (k == 1 ? 1.0 + 1e-9 : 1.0 - 1e-9);
        CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
        CLEANUP(close_rig) rig r;
        open_pair(&r, &lattice, (const double[2]){one, one});
        swing(&r, &lattice, h);
        for (double t = 0.0; k == 0 && t < h; t += h / 4096.0) {
            const dem_index before = r.q.n_events;
            show(&r, t);
            const double error = event_queue_error(&r.q);
            assert_true(r.q.n_events <= before + 1 && r.q.n_events <= 3);
            if (r.q.n_events > before) own[before] = error * error - sum;
            sum = error * error;
        }
        show(&r, h);
        assert_int_equal(r.q.n_events, k < 2 ? 3 : 2);
        assert_true(k == 0 || event_queue_error(&r.q) > 1.0);
    }
    assert_true(own[0] > 1e-3 * own[1] && own[2] < own[1] && own[2] > 0.0);
}

/* Hit at a fifth of the step, the pair could go on for as long with an error (5/4)^6 times as large; where that is
 * too much the next step has to be shorter. */
TEST(what_events_have_done_bounds_the_next_step)
{
    double error = 0.0;
    for (int k = 0; k < 3; k++) {
        const double one = k == 0 ? 1.0 : error * (k == 1 ? 1.5 : 30.0), tolerance[2] = {one, one};
        CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
        CLEANUP(close_rig) rig r;
        open_pair(&r, &lattice, tolerance);
        swing(&r, &lattice, 0.16);
        assert_true(isinf(event_queue_reach(&r.q)) != 0);
        show(&r, 0.16);
        if (k == 0) error = event_queue_error(&r.q);
        if (k == 1)
            assert_true(event_queue_error(&r.q) < 1.0 && event_queue_reach(&r.q) < 0.16 &&
                        event_queue_reach(&r.q) > 0.08);
        if (k == 2) assert_true(isinf(event_queue_reach(&r.q)) != 0);
    }
}

/* More bounces than are allowed: DEM_ERROR_CONTACT, and all can be taken back. */
TEST(a_storm_can_be_taken_back)
{
    const double heights[2] = {0.02, 0.001};
    CLEANUP(close_rig) rig r;
    open_masses(&r, 2, heights, 0.9, 0.0);
    look_limit_impacts(&r.c, 3);
    fall(&r, 0.0, 0.2);
    const snapshot before = take_snapshot(&r, 0.1);
    assert_int_equal(event_queue_show(&r.q, 0.2), DEM_ERROR_CONTACT);
    assert_non_null(strstr(dem_status_message(), "more than 3 contact events"));
    event_queue_undo(&r.q);
    const snapshot undone = take_snapshot(&r, 0.1);
    assert_same(&undone, &before);
}

/* The next step knows nothing of the events of the last. */
TEST(the_next_step_begins_anew)
{
    const double height = 0.02, t = time_of_fall(height);
    CLEANUP(close_rig) rig r;
    open_masses(&r, 1, &height, 0.5, 0.0);
    fall(&r, 0.0, 0.1);
    show(&r, 0.1);
    assert_int_equal(r.q.n_events, 1);
    const dem_index n_impacts = r.c.set.ledger.counts.impacts;
    memcpy(r.y0, r.y1, sizeof r.y0);
    fall(&r, 0.1, 0.03);
    assert_int_equal(r.q.n_events, 0);
    assert_int_equal(r.q.n_taken, 0);
    show(&r, 0.13);
    assert_int_equal(r.q.n_events, 1);
    assert_int_equal(r.c.set.ledger.counts.impacts, n_impacts + 1);
    assert_close(r.q.events[0].t, 2.0 * t, 1e-9);
    event_queue_undo(&r.q);
    assert_int_equal(r.c.set.ledger.counts.impacts, n_impacts);
}
