/* SPDX-License-Identifier: BSD-3-Clause */
/* contact_point.c: frames of closed contacts, by hand and against differences of the distance in prescribed motions. */
#include "unit/contact/bench.h"

#include <gsl/gsl_rng.h>

static void check_vector(vec2 actual, double x, double y, double tolerance)
{
    assert_close(actual.x, x, tolerance);
    assert_close(actual.y, y, tolerance);
}

/* ---- by hand ---- */

/* A node of 4 kg 0.5 m in front of a segment of slope 3/4 that starts at (1, 2). */
TEST(the_frame_of_a_node_is_that_of_its_segment)
{
    bench b;
    bench_open(&b, 2);
    bench_mass(&b, 1, 4.0);
    bench_touch(&b, 1, 0, 0.0, 1);
    b.segments[2] = (segment){.start = {1.0, 2.0}, .normal = {-0.6, 0.8}, .tangent = {0.8, 0.6}, .length = 5.0};
    vec2_put(b.x, 1, (vec2){1.0 + 1.6 - 0.3, 2.0 + 1.2 + 0.4}); /* 2 along, 0.5 up */
    vec2_put(b.v, 1, (vec2){3.0, -7.0});
    const contact_frame f = contact_frame_at(&b.scene, &b.candidates[1], 0, (scene_state){0.0, b.x, b.v});
    assert_int_equal(f.nodes.n, 1);
    assert_int_equal(f.nodes.node[0], 1);
    assert_close(f.nodes.weight[0], 1.0, 0.0);
    check_vector(f.normal, -0.6, 0.8, 0.0);
    check_vector(f.tangent, 0.8, 0.6, 0.0);
    check_vector(f.velocity, 3.0, -7.0, 0.0);
    assert_close(f.gap, 0.5, 1e-15); /* rounding of positions of order 1 */
    assert_close(f.place, 2.0, 1e-15);
    assert_close(contact_point_noise(&f, b.v), 0.0, 0.0);
    assert_close(f.turning, 0.0, 0.0);
    assert_close(f.keep[0], 0.0, 0.0);
    assert_close(f.keep[1], 0.0, 0.0);
    assert_close(f.mobility, 0.25, 0.0);
}

/* An edge from (1, 1) to (1, 5): the body on its left, at smaller x; the vertex 1 m along, 0.25 m inside. The point at
 * a quarter has 3/4 of the first node's velocity; turning 2 rad/s clockwise, sliding 1.5 m/s along. */
TEST(the_frame_of_an_edge_weighs_its_nodes_and_points_into_the_body)
{
    bench b;
    bench_open(&b, 2);
    bench_mass(&b, 0, 3.0);
    bench_mass(&b, 1, 0.5);
    vec2_put(b.x, 0, (vec2){1.0, 1.0});
    vec2_put(b.x, 1, (vec2){1.0, 5.0});
    vec2_put(b.v, 0, (vec2){0.0, 1.0});
    vec2_put(b.v, 1, (vec2){8.0, 3.0});
    const dem_index edge = bench_edge(&b, 0, 1);
    const dem_index feature = bench_touch(&b, edge, 0, 0.0, -1)->feature;
    b.vertices[feature].at = (vec2){0.75, 2.0};
    const contact_frame f = contact_frame_at(&b.scene, &b.candidates[edge], 0, (scene_state){0.0, b.x, b.v});
    assert_int_equal(f.nodes.n, 2);
    assert_int_equal(f.nodes.node[0], 0);
    assert_int_equal(f.nodes.node[1], 1);
    /* halves and quarters: exact */
    assert_close(f.nodes.weight[0], 0.75, 0.0);
    assert_close(f.nodes.weight[1], 0.25, 0.0);
    check_vector(f.normal, -1.0, 0.0, 0.0);
    check_vector(f.tangent, 0.0, 1.0, 0.0);
    check_vector(f.velocity, 2.0, 1.5, 0.0);
    assert_close(f.gap, -0.25, 0.0);
    assert_close(f.place, 0.25, 0.0);
    assert_close(f.turning, 2.0 * -2.0 * 1.5, 0.0);
    assert_close(f.keep[0], f.turning, 1e-90); /* what draws back is of the order of 1/max_step = 1e-100 */
    assert_close(f.mobility, 0.5625 / 3.0 + 0.0625 / 0.5, 1e-15); /* rounding */
}

static void move(bench *b, dem_index obstacle, vec2 velocity)
{
    vec2_put(b->list[obstacle].velocity, 0, velocity);
    b->laws[obstacle] = motion_law_of(&b->list[obstacle]);
    b->model.obstacles.bounds = motion_bounds_of_both(b->model.obstacles.bounds, motion_law_bounds(&b->laws[obstacle]));
}

/* The segment of the node, 5 m long, has gone (2, -3) m in 0.5 s. */
TEST(on_an_obstacle_that_moves_velocities_are_relative_to_it)
{
    bench b;
    bench_open(&b, 2);
    b.segments[2] = (segment){.start = {1.0, 2.0}, .normal = {-0.6, 0.8}, .tangent = {0.8, 0.6}, .length = 5.0};
    move(&b, 0, (vec2){4.0, -6.0});
    b.candidates[0].n_closed = 1;
    b.candidates[0].closed[0] = (contact_point){.feature = 2, .slide = 1};
    vec2_put(b.x, 0, (vec2){3.0 + 2.0 * 0.8 - 0.25 * 0.6, -1.0 + 2.0 * 0.6 + 0.25 * 0.8});
    vec2_put(b.v, 0, (vec2){5.0, 1.0});
    const contact_frame f = contact_frame_at(&b.scene, &b.candidates[0], 0, (scene_state){0.5, b.x, b.v});
    assert_close(f.gap, 0.25, 1e-15);
    assert_close(f.place, 2.0, 1e-15);
    const vec2 seen = contact_frame_velocity(&f, b.v);
    assert_true(seen.x == 5.0 && seen.y == 1.0 && f.velocity.x == 1.0 && f.velocity.y == 7.0);
    assert_true(f.wall.x == 4.0 && f.wall.y == -6.0);
    assert_true(f.turning == 0.0 && f.keep[0] == 0.0 && f.keep[1] == 0.0); /* nothing accelerates it */
}

/* The node has sunk in by 0.04 m and leaves the wall behind at (-0.2, 0.3) m/s; beta = 1/s for steps of 0.1 s. */
TEST(a_node_that_has_drifted_is_drawn_back_where_obstacles_accelerate)
{
    bench b;
    bench_open(&b, 1);
    b.scene.rule.max_step = 0.1;
    b.segments[0] = (segment){.normal = {0.0, 1.0}, .tangent = {1.0, 0.0}, .length = 9.0};
    move(&b, 0, (vec2){2.0, 0.0});
    b.candidates[0].n_closed = 1;
    b.candidates[0].closed[0] = (contact_point){.slide = 0};
    vec2_put(b.x, 0, (vec2){1.0, -0.04});
    vec2_put(b.v, 0, (vec2){1.8, 0.3});
    contact_frame f = contact_frame_at(&b.scene, &b.candidates[0], 0, (scene_state){0.0, b.x, b.v});
    assert_true(f.keep[0] == 0.0 && f.keep[1] == 0.0);
    b.model.obstacles.bounds.acceleration = 5.0;
    f = contact_frame_at(&b.scene, &b.candidates[0], 0, (scene_state){0.0, b.x, b.v});
    assert_close(f.keep[0], -2.0 * 0.3 + 0.04, 1e-15);
    assert_close(f.keep[1], 2.0 * 0.2, 1e-15);
    assert_true(f.turning == 0.0 && f.carried == 0.0);
}

/* A floor that moves along and a wall that comes: the corner has the floor's height and the wall's speed. */
TEST(the_corner_of_two_obstacles_moves_along_the_normals_as_they_do)
{
    bench b;
    const dem_index both[2] = {0, 1};
    bench_open(&b, 1);
    b.segments[0] = (segment){.normal = {0.0, 1.0}, .tangent = {1.0, 0.0}, .length = 1.0};
    b.segments[1] = (segment){.normal = {1.0, 0.0}, .tangent = {0.0, -1.0}, .length = 1.0, .obstacle = 1};
    assert_false(surface_corner_motion(&b.scene, both, (surface_query){0.5, {0.0, 0.0}}).moves);
    move(&b, 0, (vec2){4.0, 0.5});
    move(&b, 1, (vec2){3.0, -6.0});
    const obstacle_motion corner = surface_corner_motion(&b.scene, both, (surface_query){0.5, {0.0, 0.0}});
    assert_true(corner.moves);
    assert_close(corner.velocity.x, 3.0, 0.0);
    assert_close(corner.velocity.y, 0.5, 0.0);
}

/* Where the lines of two segments cross at t. */
static vec2 crossing(const bench *b, double t)
{
    const surface_line a = surface_line_at(&b->scene, 0, t), c = surface_line_at(&b->scene, 1, t);
    const double along = vec2_cross(vec2_sub(c.start, a.start), c.tangent) / vec2_cross(a.tangent, c.tangent);
    return vec2_along(a.start, along, a.tangent);
}

/* A line that turns and oscillates against one that turns the other way, by a ramp. Differences over 1e-4 s are off by
 * 1e-8 of the fourth derivatives, some 1e3 here, and by 1e-16/1e-8 of rounding. */
TEST(the_corner_of_two_obstacles_that_turn_moves_as_their_crossing)
{
    const dem_index both[2] = {0, 1};
    const double t = 0.3, h = 1e-4, points[4] = {-1.0, 0.0, 1.0, 0.0};
    bench b;
    bench_open(&b, 1);
    for (int k = 0; k < 2; k++) {
        b.list[k].points = points; /* a rotation needs some extent */
        b.list[k].n_points = 2;
    }
    b.segments[0] = (segment){.start = {-0.2, 0.1}, .normal = {0.0, 1.0}, .tangent = {1.0, 0.0}, .length = 1.0};
    b.segments[1] =
        (segment){.start = {0.3, 0.4}, .normal = {0.8, 0.6}, .tangent = {0.6, -0.8}, .length = 1.0, .obstacle = 1};
    vec2_put(b.list[0].amplitude, 0, (vec2){0.0, 0.05});
    b.list[0].frequency = 0.7;
    b.list[0].spin = 0.9;
    b.list[1].spin = -1.4;
    b.list[1].ramp = 0.5;
    vec2_put(b.list[1].pivot, 0, (vec2){0.5, -0.3});
    move(&b, 0, (vec2){0.3, 0.2});
    move(&b, 1, (vec2){-0.4, 0.1});
    const vec2 before = crossing(&b, t - h), x = crossing(&b, t), after = crossing(&b, t + h);
    const obstacle_motion corner = surface_corner_motion(&b.scene, both, (surface_query){t, x});
    const vec2 v = vec2_scale(0.5 / h, vec2_sub(after, before)),
               a = vec2_scale(1.0 / (h * h), vec2_sub(vec2_add(before, after), vec2_scale(2.0, x)));
    assert_true(corner.moves && vec2_norm(a) > 1.0);
    assert_close(corner.velocity.x, v.x, 1e-6);
    assert_close(corner.velocity.y, v.y, 1e-6);
    assert_close(corner.acceleration.x, a.x, 1e-5);
    assert_close(corner.acceleration.y, a.y, 1e-5);
}

/* The node is 0.05 m off the corner along each of two walls that are not square, and drifts at (-0.2, 0.3) m/s; beta is
 * 1/s for steps of 0.1 s. */
TEST(a_node_is_drawn_back_into_a_corner)
{
    bench b;
    bench_open(&b, 1);
    b.scene.rule.max_step = 0.1;
    b.model.obstacles.bounds.acceleration = 5.0;
    vec2_put(b.x, 0, (vec2){0.03, -0.04});
    vec2_put(b.v, 0, (vec2){1.8, 0.3});
    const surface_line lines[2] = {{.normal = {0.0, 1.0}, .tangent = {1.0, 0.0}},
                                   {.normal = {0.6, 0.8}, .tangent = {0.8, -0.6}}};
    const obstacle_motion corner = {.moves = true, .velocity = {2.0, 0.0}, .acceleration = {7.0, 8.0}};
    const scene_state state = {0.0, b.x, b.v};
    vec2 keep = contact_point_keep_corner(&b.scene, 0, lines, &corner, state);
    assert_close(keep.x, 7.0 + 2.0 * 0.2 - 0.03, 1e-14);
    assert_close(keep.y, 8.0 - 2.0 * 0.3 + 0.04, 1e-14);
    b.model.obstacles.bounds.acceleration = 0.0;
    keep = contact_point_keep_corner(&b.scene, 0, lines, &corner, state);
    assert_true(keep.x == 7.0 && keep.y == 8.0);
}

TEST(a_fixed_node_has_no_mobility)
{
    bench b;
    bench_open(&b, 2);
    b.inverse_mass[0] = 0.0;
    vec2_put(b.x, 1, (vec2){1.0, 0.0});
    const dem_index edge = bench_edge(&b, 0, 1);
    bench_touch(&b, edge, 0, 0.5, 1);
    assert_close(contact_frame_at(&b.scene, &b.candidates[edge], 0, (scene_state){0.0, b.x, b.v}).mobility, 0.25, 0.0);
}

/* The edge lies on the x axis, the vertex 0.02 m ahead of where it sticks and 0.01 m below; beta = 1/s for steps of
 * 0.1 s. The point moves (-0.05, 0.3) m/s. */
TEST(a_vertex_contact_that_has_drifted_is_drawn_back_within_ten_steps)
{
    bench b;
    bench_open(&b, 2);
    b.scene.rule.max_step = 0.1;
    vec2_put(b.x, 1, (vec2){1.0, 0.0});
    for (int i = 0; i < 2; i++) vec2_put(b.v, i, (vec2){-0.05, 0.3});
    const dem_index edge = bench_edge(&b, 0, 1);
    contact_point *point = bench_touch(&b, edge, 0, 0.5, 0);
    b.vertices[point->feature].at = (vec2){0.52, -0.01};
    contact_frame f = contact_frame_at(&b.scene, &b.candidates[edge], 0, (scene_state){0.0, b.x, b.v});
    assert_close(f.keep[0], -(2.0 * 0.3 + 0.01), 1e-15); /* rounding of terms of order 1 */
    assert_close(f.keep[1], -(2.0 * -0.05 - 0.02), 1e-15);
    point->slide = 1;
    f = contact_frame_at(&b.scene, &b.candidates[edge], 0, (scene_state){0.0, b.x, b.v});
    assert_close(f.keep[0], -(2.0 * 0.3 + 0.01), 1e-15); /* it does not turn */
    vec2_put(b.v, 0, (vec2){-0.05, 0.3 - 0.52});         /* by 1 rad/s now, about a point that moves as before */
    vec2_put(b.v, 1, (vec2){-0.05, 0.3 + 0.48});
    f = contact_frame_at(&b.scene, &b.candidates[edge], 0, (scene_state){0.0, b.x, b.v});
    assert_close(f.turning, -0.1, 1e-15);
    assert_close(f.keep[0], -0.1 - (2.0 * 0.3 + 0.01), 1e-15);
}

/* ---- against differences ---- */

/* Both ends of an edge move as polynomials of degree 3 in time. */
typedef struct edge_motion {
    vec2 a[4], b[4];
} edge_motion;

static vec2 poly(const vec2 c[4], double t)
{
    return vec2_along(vec2_along(vec2_along(c[0], t, c[1]), t * t, c[2]), t * t * t, c[3]);
}

typedef struct seen {
    double height, place; /* of the edge above a fixed point, m; of that point along it, a fraction */
} seen;

static seen look(const edge_motion *m, vec2 at, double t)
{
    const vec2 a = poly(m->a, t), ab = vec2_sub(poly(m->b, t), a), to = vec2_sub(at, a);
    return (seen){vec2_cross(to, ab) / vec2_norm(ab), vec2_dot(to, ab) / vec2_dot(ab, ab)};
}

/* Central differences of order 6 with h = 0.01 s: truncation h^6 f^(7)/140, about 1e-11 for motions with rates of order
 * 1/s; rounding 1e-16/h for the first and 1e-16 x 10/h^2 = 1e-11 for the second. */
static const double step = 0.01, difference_tolerance = 1e-9;

static void differentiate(const edge_motion *m, vec2 at, seen *first, seen *second)
{
    static const double odd[4] = {0.0, 3.0 / 4.0, -3.0 / 20.0, 1.0 / 60.0};
    static const double even[4] = {-49.0 / 18.0, 3.0 / 2.0, -3.0 / 20.0, 1.0 / 90.0};
    const seen now = look(m, at, 0.0);
    *first = (seen){0.0, 0.0};
    *second = (seen){even[0] * now.height / (step * step), even[0] * now.place / (step * step)};
    for (int k = 1; k < 4; k++) {
        const seen after = look(m, at, k * step), before = look(m, at, -k * step);
        first->height += odd[k] * (after.height - before.height) / step;
        first->place += odd[k] * (after.place - before.place) / step;
        second->height += even[k] * (after.height + before.height) / (step * step);
        second->place += even[k] * (after.place + before.place) / (step * step);
    }
}

static double any(gsl_rng *rng)
{
    return 2.0 * gsl_rng_uniform(rng) - 1.0;
}

/* An edge with a contact on a vertex, as nodes and vertex are moved anyhow. */
typedef struct moving_edge {
    gsl_rng *rng;
    bench b;
    dem_index edge;
} moving_edge;

static void open_moving_edge(moving_edge *e, int slide)
{
    e->rng = gsl_rng_alloc(gsl_rng_mt19937);
    bench_open(&e->b, 2);
    e->edge = bench_edge(&e->b, 0, 1);
    bench_touch(&e->b, e->edge, 0, 0.5, slide);
}

static vec2 *vertex_of(moving_edge *e)
{
    return &e->b.vertices[e->b.candidates[e->edge].closed[0].feature].at;
}

static contact_frame frame_of(const moving_edge *e)
{
    return contact_frame_at(&e->b.scene, &e->b.candidates[e->edge], 0, (scene_state){0.0, e->b.x, e->b.v});
}

/* The edge about 2 m long, with the vertex at a fraction of it. */
static edge_motion move_anyhow(moving_edge *e, double place)
{
    edge_motion m;
    for (int k = 0; k < 4; k++) {
        m.a[k] = (vec2){any(e->rng), any(e->rng)};
        m.b[k] = (vec2){any(e->rng), any(e->rng)};
    }
    m.b[0] = vec2_along(m.a[0], 2.0 / vec2_norm(m.b[0]), m.b[0]);
    vec2_put(e->b.x, 0, m.a[0]);
    vec2_put(e->b.x, 1, m.b[0]);
    vec2_put(e->b.v, 0, m.a[1]);
    vec2_put(e->b.v, 1, m.b[1]);
    e->b.candidates[e->edge].closed[0].place = place;
    *vertex_of(e) = vec2_along(m.a[0], place, vec2_sub(m.b[0], m.a[0]));
    return m;
}

/* g' = v_P.N and s' = -v_P.t/L; with the accelerations of the ends g'' = a_P.N - keep: 0 if a_P.N is what is asked. */
TEST(a_sliding_contact_stays_closed_under_the_acceleration_asked_for)
{
    moving_edge e;
    double largest = 0.0;
    open_moving_edge(&e, 1);
    for (int k = 0; k < 2000; k++) {
        seen first, second;
        const edge_motion m = move_anyhow(&e, gsl_rng_uniform(e.rng));
        e.b.candidates[e.edge].closed[0].slide = k % 2 == 0 ? 1 : -1; /* has no say in it */
        const contact_frame f = frame_of(&e);
        const vec2 at = *vertex_of(&e);
        const vec2 a = vec2_along(vec2_scale(2.0 * f.nodes.weight[0], m.a[2]), 2.0 * f.nodes.weight[1], m.b[2]);
        differentiate(&m, at, &first, &second);
        assert_close(f.gap, look(&m, at, 0.0).height, 1e-15); /* rounding of positions of order 1 */
        assert_close(f.place, look(&m, at, 0.0).place, 1e-15);
        assert_close(vec2_dot(f.velocity, f.normal), first.height, difference_tolerance);
        assert_close(-vec2_dot(f.velocity, f.tangent) / 2.0, first.place, difference_tolerance);
        assert_close(vec2_dot(a, f.normal) - f.keep[0], second.height, difference_tolerance);
        assert_close(f.turning, f.keep[0], 1e-90); /* 1/max_step */
        largest = fmax(largest, fabs(f.keep[0]));
    }
    assert_true(largest > 1.0); /* turning was in it */
    gsl_rng_free(e.rng);
}

/* A material point that is at rest and is not accelerated stays on the vertex: nothing is asked for, however the edge
 * turns and stretches about it. */
TEST(a_sticking_contact_asks_for_no_acceleration)
{
    moving_edge e;
    open_moving_edge(&e, 0);
    for (int k = 0; k < 2000; k++) {
        const double place = 0.1 + 0.8 * gsl_rng_uniform(e.rng);
        seen first, second;
        edge_motion m = move_anyhow(&e, place);
        for (int q = 1; q < 4; q++) m.b[q] = vec2_scale(-(1.0 - place) / place, m.a[q]); /* P does not move */
        vec2_put(e.b.v, 1, m.b[1]);
        const contact_frame f = frame_of(&e);
        differentiate(&m, *vertex_of(&e), &first, &second);
        /* P stays where it is, so there is rounding only */
        assert_close(first.height, 0.0, difference_tolerance);
        assert_close(second.height, 0.0, difference_tolerance);
        assert_close(first.place, 0.0, difference_tolerance);
        assert_true(vec2_norm(f.velocity) <=
                    contact_point_noise(&f, e.b.v)); /* what rounding leaves of it, and that is little: */
        assert_true(contact_point_noise(&f, e.b.v) > 0.0 && contact_point_noise(&f, e.b.v) < 1e-12);
        assert_close(f.turning, 0.0, 0.0);
        assert_close(f.keep[0], 0.0, 1e-90); /* 1/max_step */
        assert_close(f.keep[1], 0.0, 1e-90);
    }
    gsl_rng_free(e.rng);
}

/* Wherever its nodes are, and however its vertex lies, an edge that sticks touches with the same point of it. */
TEST(a_sticking_contact_keeps_its_place)
{
    moving_edge e;
    open_moving_edge(&e, 0);
    for (int k = 0; k < 100; k++) {
        const edge_motion m = move_anyhow(&e, 0.375);
        *vertex_of(&e) = (vec2){any(e.rng), any(e.rng)};
        const contact_frame f = frame_of(&e);
        const vec2 at = vec2_add(vec2_scale(0.625, m.a[0]), vec2_scale(0.375, m.b[0]));
        assert_close(f.place, 0.375, 0.0);
        assert_close(f.nodes.weight[0], 0.625, 0.0);
        assert_close(f.nodes.weight[1], 0.375, 0.0);
        /* rounding of lengths of order 1 */
        assert_close(f.gap, vec2_dot(vec2_sub(at, *vertex_of(&e)), f.normal), 1e-15);
    }
    gsl_rng_free(e.rng);
}

/* ---- what a contact is on ---- */

TEST(a_scene_knows_its_margin_and_where_velocities_begin)
{
    bench b;
    bench_open(&b, 2);
    assert_close(scene_margin(&b.scene), 1e-5, 1e-20); /* ten penetration tolerances, rounded */
    assert_int_equal(scene_layout(&b.scene)->n_nodes, 2);
}

TEST(only_coulombs_law_has_sustained_friction)
{
    bench b;
    bench_open(&b, 1);
    for (dem_index s = 0; s < 3; s++) b.segments[s].obstacle = s;
    assert_close(contact_point_friction(&b.scene, &b.candidates[0], 0), 0.0, 0.0);
    assert_close(contact_point_friction(&b.scene, &b.candidates[0], 1), 0.3, 0.0);
    assert_close(contact_point_friction(&b.scene, &b.candidates[0], 2), 0.0, 0.0); /* (10) */
}

TEST(a_contact_reports_where_it_is_and_what_it_carries)
{
    bench b;
    bench_open(&b, 3);
    vec2_put(b.x, 1, (vec2){0.25, 0.5});
    vec2_put(b.x, 2, (vec2){4.25, 0.5});
    contact_point *node = bench_touch(&b, 1, 2, 0.5 * M_PI, 1);
    node->force = 7.0;
    node->friction = -3.0;
    b.segments[2].index = 40;
    dem_contact c = contact_point_describe(&b.scene, &b.candidates[1], 0, 0.0, b.x);
    assert_int_equal(c.n_nodes, 1);
    assert_int_equal(c.nodes[0], 1);
    assert_int_equal(c.obstacle, 2);
    assert_int_equal(c.segment, 40);
    assert_int_equal(c.state, DEM_CONTACT_SLIP);
    assert_close(c.weights[0], 1.0, 0.0);
    check_vector((vec2){c.x[0], c.x[1]}, 0.25, 0.5, 0.0);
    check_vector((vec2){c.normal[0], c.normal[1]}, 0.0, 1.0, 1e-16); /* the cosine of pi/2 */
    assert_close(c.force, 7.0, 0.0);
    assert_close(c.friction[0], -3.0, 0.0);
    node->slide = 0;
    assert_int_equal(contact_point_describe(&b.scene, &b.candidates[1], 0, 0.0, b.x).state, DEM_CONTACT_STICK);
    node->slide = 1;
    node->held = true;
    assert_int_equal(contact_point_describe(&b.scene, &b.candidates[1], 0, 0.0, b.x).state, DEM_CONTACT_STICK);
}

TEST(the_second_contact_of_an_edge_reports_its_own_vertex)
{
    bench b;
    bench_open(&b, 3);
    vec2_put(b.x, 1, (vec2){0.25, 0.5});
    vec2_put(b.x, 2, (vec2){4.25, 0.5});
    const dem_index edge = bench_edge(&b, 1, 2);
    bench_touch(&b, edge, 0, 0.5, 1);
    bench_touch(&b, edge, 1, 0.75, -1)->force = 9.0;
    const dem_contact c = contact_point_describe(&b.scene, &b.candidates[edge], 1, 0.0, b.x);
    assert_int_equal(c.n_nodes, 2);
    assert_int_equal(c.nodes[0], 1);
    assert_int_equal(c.nodes[1], 2);
    assert_close(c.weights[0], 0.25, 0.0);
    assert_close(c.weights[1], 0.75, 0.0);
    assert_int_equal(c.obstacle, 1);
    assert_int_equal(c.segment, 2 * edge + 1);
    assert_int_equal(c.state, DEM_CONTACT_SLIP);
    check_vector((vec2){c.x[0], c.x[1]}, 3.25, 0.5, 0.0);
    check_vector((vec2){c.normal[0], c.normal[1]}, 0.0, 1.0, 0.0);
    assert_close(c.force, 9.0, 0.0);
}
