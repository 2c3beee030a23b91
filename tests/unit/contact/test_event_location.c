/* SPDX-License-Identifier: BSD-3-Clause */
/* event_location.c: the first change of a candidate's contacts within a step, at times worked out by hand. Times are
 * located to 100 units of rounding of t + h; each tolerance is twice that, or what rounding of 1e-16 m is at the speed
 * of crossing. */
#include "harness/cleanup_gsl.h"
#include "unit/contact/scene_fixture.h"

#include "contact/node_motion.h"

#include <float.h>

#include <gsl/gsl_rng.h>

#include "contact/event_location.h"

static const double penetration_tolerance = 1e-3, g = scene_gravity, masses[3] = {2.0, 2.0, 2.0};
static const vec2 nothing = {0.0, 0.0};

static const double floor_points[4] = {0.0, 0.0, 4.0, 0.0};
static const dem_obstacle plane = SIZED(dem_obstacle, .n_points = 2, .points = floor_points, .restitution = 0.5);

/* A roof with its ridge in the origin; the floor of a ledge that ends left of it. */
static const double roof_points[6] = {-4.0, -4.0, 0.0, 0.0, 4.0, -4.0}, ledge_points[4] = {-4.0, 0.0, -0.5, 0.0};
static const dem_obstacle roof = {.struct_size = sizeof(dem_obstacle), .n_points = 3, .points = roof_points};
static const dem_obstacle roof_and_ledge[2] = {
    {.struct_size = sizeof(dem_obstacle), .n_points = 3, .points = roof_points},
    {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = ledge_points}};

static void open_node(scene *s, double x, double y, double u, double v)
{
    const double at[2] = {x, y};
    scene_open(s, 1, at, masses, 0, NULL, &plane, 1);
    s->c.set.scene.rule.penetration_tolerance = penetration_tolerance;
    s->y[2] = u;
    s->y[3] = v;
}

static double crossing(const scene *s, dem_index k, const dense_output *p)
{
    return event_location_crossing(&s->c.set.scene, &s->c.set.list[k], p, p->t0);
}

TEST(times_are_located_to_a_hundred_units_of_rounding)
{
    const dense_output p = {.t0 = -3.0, .t1 = -2.5}, q = {.t0 = 6.0, .t1 = 8.0};
    assert_close(dense_output_resolution(&p), 300.0 * DBL_EPSILON, 1e-28);
    assert_close(dense_output_resolution(&q), 1000.0 * DBL_EPSILON, 1e-28);
}

/* ---- a free node ---- */

/* Falls from 0.2 m: as deep as the penetration tolerance d after sqrt(2 (0.2 + d)/g). The time found is on the deep
 * side. */
TEST(a_fall_reaches_the_penetration_tolerance_at_the_time_of_free_fall)
{
    const double start = 7.0, t = sqrt(2.0 * (0.2 + penetration_tolerance) / g);
    CLEANUP(scene_close) scene s;
    scene_flight f;
    open_node(&s, 1.0, 0.2, 0.3, 0.0);
    scene_fly(&s, (vec2){0.0, -g}, start, 0.3, &f);
    const double found = crossing(&s, 0, &f.dense);
    assert_close(found, start + t, 200.0 * DBL_EPSILON * (start + 0.3));
    assert_true(node_motion_position(&f.dense, found, 0).y <= -penetration_tolerance);
    f.dense.end = start + 0.9 * t;
    assert_true(isinf(crossing(&s, 0, &f.dense)) != 0);
}

TEST(a_crossing_just_before_the_end_is_found)
{
    const double t = sqrt(2.0 * (0.2 + penetration_tolerance) / g);
    CLEANUP(scene_close) scene s;
    scene_flight f;
    open_node(&s, 1.0, 0.2, 0.0, 0.0);
    scene_fly(&s, (vec2){0.0, -g}, 0.0, 0.3, &f);
    f.dense.end = t * (1.0 + 1e-12);
    assert_close(crossing(&s, 0, &f.dense), t, 1e-13);
    f.dense.end = 1.2 * t; /* an eighth before this end it is deep already */
    assert_close(crossing(&s, 0, &f.dense), t, 1e-13);
}

/* Thrown down against an upward pull: inside from 0.24 t1 to 0.76 t1, outside at both ends. */
TEST(a_dip_within_the_step_is_found)
{
    const double depth = 0.05, a = 10.0, bottom = 0.2; /* y = -depth + a (t - bottom)^2/2 */
    CLEANUP(scene_close) scene s;
    scene_flight f;
    open_node(&s, 1.0, -depth + 0.5 * a * bottom * bottom, 0.0, -a * bottom);
    scene_fly(&s, (vec2){0.0, a}, 0.0, 2.0 * bottom, &f);
    assert_true(s.y[1] > 0.0 && f.dense.y1[1] > 0.0);
    assert_close(crossing(&s, 0, &f.dense), bottom - sqrt(2.0 * (depth - penetration_tolerance) / a), 1e-13);
}

/* A parabola whose bottom, wherever between two of the eight samples, is a micrometre deeper than the penetration
 * tolerance for 1/500 of the step; one that stays as much above it is none. Times to rounding over a vertical speed of
 * 4.5 mm/s. */
TEST(the_shortest_dip_is_found_and_a_near_miss_is_none)
{
    const double a = 10.0, end = 0.45;
    for (int k = 0; k < 20; k++) {
        const double depth = penetration_tolerance + (k % 2 == 0 ? 1e-6 : -1e-6), bottom = 0.172 + 0.0025 * k;
        CLEANUP(scene_close) scene s;
        scene_flight f;
        open_node(&s, 1.0, -depth + 0.5 * a * bottom * bottom, 0.0, -a * bottom);
        scene_fly(&s, (vec2){0.0, a}, 0.0, end, &f);
        const double found = crossing(&s, 0, &f.dense);
        if (k % 2 == 0)
            assert_close(found, bottom - sqrt(2.0 * (depth - penetration_tolerance) / a), 1e-12);
        else
            assert_true(isinf(found) != 0);
    }
}

static const double far_points[4] = {90.0, -90.0, 91.0, -90.0};

enum { ROUGH = 21 };

/* Rough ground from -5 to 5 m and, far below, an obstacle that nothing reaches. */
static void open_over_rough_ground(scene *s, const double *ground, dem_index n_obstacles, const double *state)
{
    const dem_obstacle obstacles[2] = {{.struct_size = sizeof(dem_obstacle), .n_points = ROUGH, .points = ground},
                                       {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = far_points}};
    scene_open(s, 1, state, masses, 0, NULL, obstacles, n_obstacles);
    s->c.set.scene.rule.penetration_tolerance = penetration_tolerance;
    s->y[2] = state[2];
    s->y[3] = state[3];
}

/* Over a single obstacle a node is asked for a lone segment; with a second obstacle there is none, and all is searched.
 * Ways of up to 3 m, over segments of 0.5 m. */
TEST(what_a_node_meets_is_found_alike_by_a_lone_segment_and_by_a_search)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    int n_met = 0, n_passed = 0;
    for (int turn = 0; turn < 400; turn++) {
        double ground[2 * ROUGH], found[2];
        const double state[4] = {2.0 * gsl_rng_uniform(rng) - 1.0, 0.3 + 0.5 * gsl_rng_uniform(rng),
                                 6.0 * gsl_rng_uniform(rng) - 3.0, -4.0 * gsl_rng_uniform(rng)};
        const vec2 acceleration = {0.0, 40.0 * gsl_rng_uniform(rng) - 10.0};
        for (int k = 0; k < ROUGH; k++)
            vec2_put(ground, k, (vec2){0.5 * (k - 10), 0.2 * gsl_rng_uniform(rng) * (turn % 4)});
        for (int q = 0; q < 2; q++) {
            CLEANUP(scene_close) scene s;
            scene_flight f;
            open_over_rough_ground(&s, ground, 1 + q, state);
            scene_fly(&s, acceleration, 0.0, 0.05 + 0.45 * (turn % 3), &f);
            f.dense.parabolic = turn % 2 == 1;
            found[q] = crossing(&s, 0, &f.dense);
        }
        assert_true(found[0] == found[1]);
        n_met += isfinite(found[0]) != 0;
        n_passed += isinf(found[0]) != 0;
    }
    assert_true(n_met > 100 && n_passed > 100);
}

/* Level with 1 m/s through the tip of the roof, 1 cm below it, in the first eighth of the step. That nothing was within
 * 5 cm of its start says less about its gap than the roof does. */
TEST(a_dip_through_a_tip_is_found_whatever_was_known_of_the_gap)
{
    const double at[2] = {-0.1, -0.01};
    CLEANUP(scene_close) scene s;
    scene_flight f;
    scene_open(&s, 1, at, masses, 0, NULL, &roof, 1);
    s.c.set.scene.rule.penetration_tolerance = penetration_tolerance;
    scene_put(&s, 0, at[0], at[1], 1.0, 0.0);
    s.c.set.list[0].clearance.distance = 0.05;
    s.c.set.list[0].clearance.at[0] = vec2_at(at, 0);
    scene_fly(&s, nothing, 0.0, 1.0, &f);
    assert_close(crossing(&s, 0, &f.dense), 0.09 + sqrt(2.0) * penetration_tolerance, 1e-13);
}

/* Up from the floor with 2 m/s through a plate at 0.3 m, a fifth of the way thick: the gap grows at both ends. */
TEST(a_plate_between_two_ends_that_recede_is_found)
{
    const double points[10] = {2.0, 0.3, 0.0, 0.3, 0.0, 0.5, 2.0, 0.5, 2.0, 0.3}, at[2] = {1.0, 0.05};
    const dem_obstacle floor_and_plate[2] = {plane,
                                             {.struct_size = sizeof(dem_obstacle), .n_points = 5, .points = points}};
    CLEANUP(scene_close) scene s;
    scene_flight f;
    scene_open(&s, 1, at, masses, 0, NULL, floor_and_plate, 2);
    s.c.set.scene.rule.penetration_tolerance = penetration_tolerance;
    scene_put(&s, 0, at[0], at[1], 0.0, 2.0);
    scene_fly(&s, nothing, 0.0, 0.5, &f);
    assert_close(crossing(&s, 0, &f.dense), 0.5 * (0.25 + penetration_tolerance), 1e-13);
}

TEST(a_candidate_out_of_reach_never_crosses)
{
    CLEANUP(scene_close) scene s;
    scene_flight f;
    open_node(&s, 1.0, 0.9, 4.0, 0.0);
    scene_fly(&s, nothing, 0.0, 0.1, &f);
    assert_true(isinf(crossing(&s, 0, &f.dense)) != 0);
}

/* ---- a free edge ---- */

/* Its node 0 at (-1.5, y): the ridge is over three quarters of it. */
static dem_index open_edge(scene *s, double y)
{
    scene_open_triangle(s, masses, -1.5, y, &roof, 1);
    s->c.set.scene.rule.penetration_tolerance = penetration_tolerance;
    return scene_edge(s, 0, 1);
}

TEST(a_level_edge_falls_on_a_ridge_at_the_time_of_free_fall)
{
    const double start = 3.0, t = sqrt(2.0 * (0.1 + penetration_tolerance) / g);
    CLEANUP(scene_close) scene s;
    scene_flight f;
    const dem_index k = open_edge(&s, 0.1);
    scene_fly(&s, (vec2){0.0, -g}, start, 0.2, &f);
    assert_close(crossing(&s, k, &f.dense), start + t, 200.0 * DBL_EPSILON * (start + 0.2));
    assert_true(isinf(crossing(&s, scene_edge(&s, 1, 2), &f.dense)) != 0);
}

/* Node 1 falls with 2 m/s from 0.3 m, node 0 stays there. With w = 2 t the edge's point over the ridge is 0.75 w - 0.3
 * below it, along the normal that times 2/sqrt(4 + w^2). That is the penetration tolerance d where
 * (4 * 0.5625 - d^2) w^2 - 1.8 w + 0.36 - 4 d^2 = 0. */
TEST(a_turning_edge_meets_a_ridge_where_its_line_does)
{
    const double a = 2.25 - penetration_tolerance * penetration_tolerance,
                 c = 0.36 - 4.0 * penetration_tolerance * penetration_tolerance;
    const double w = (1.8 + sqrt(1.8 * 1.8 - 4.0 * a * c)) / (2.0 * a);
    CLEANUP(scene_close) scene s;
    scene_flight f;
    const dem_index k = open_edge(&s, 0.3);
    scene_put(&s, 1, 0.5, 0.3, 0.0, -2.0);
    scene_fly(&s, nothing, 0.0, 0.3, &f);
    assert_close(crossing(&s, k, &f.dense), 0.5 * w, 1e-13);
}

/* As for a node: 1 cm deep at the bottom, outside at both ends. */
TEST(a_dip_of_an_edge_within_the_step_is_found)
{
    const double depth = 0.01, a = 10.0, bottom = 0.11;
    CLEANUP(scene_close) scene s;
    scene_flight f;
    const dem_index k = open_edge(&s, -depth + 0.5 * a * bottom * bottom);
    for (dem_index i = 0; i < 3; i++) vec2_put(scene_v(&s), i, (vec2){0.0, -a * bottom});
    scene_fly(&s, (vec2){0.0, a}, 0.0, 0.2, &f);
    assert_true(s.y[1] > 0.0 && f.dense.y1[1] > 0.0);
    assert_close(crossing(&s, k, &f.dense), bottom - sqrt(2.0 * (depth - penetration_tolerance) / a), 1e-13);
}

/* Down and left with 1 m/s each way: the ridge goes in through the edge 1 cm before its end, and is beyond that by the
 * next sample. */
TEST(a_ridge_that_cuts_a_corner_of_the_body_within_an_eighth_is_found)
{
    CLEANUP(scene_close) scene s;
    scene_flight f;
    scene_open_triangle(&s, masses, -2.0 + 0.03, 0.02, &roof, 1);
    s.c.set.scene.rule.penetration_tolerance = penetration_tolerance;
    for (dem_index i = 0; i < 3; i++) vec2_put(scene_v(&s), i, (vec2){-1.0, -1.0});
    scene_fly(&s, nothing, 0.0, 1.0, &f);
    assert_close(crossing(&s, scene_edge(&s, 0, 1), &f.dense), 0.02 + penetration_tolerance, 1e-13);
}

/* Near node 1, at s = 0.9, the edge dips while node 0 rises all the time: h + a t^2/2 - 0.9 a b t is lowest at 0.9 b,
 * between two samples, where it is 1 mm deeper than the penetration tolerance and nothing else would tell. */
TEST(a_dip_at_one_end_of_a_turning_edge_is_found)
{
    const double a = 10.0, b = 0.1, low = 0.405 * a * b * b, depth = 2.0 * penetration_tolerance;
    CLEANUP(scene_close) scene s;
    scene_flight f;
    scene_open_triangle(&s, masses, -1.8, low - depth, &roof, 1);
    s.c.set.scene.rule.penetration_tolerance = penetration_tolerance;
    scene_put(&s, 1, 0.2, low - depth, 0.0, -a * b);
    scene_fly(&s, (vec2){0.0, a}, 0.0, 8.0 * 0.036, &f); /* samples at 0.072 and 0.108 */
    const double found = crossing(&s, scene_edge(&s, 0, 1), &f.dense);
    assert_close(found, 0.09 - sqrt(2.0 * (depth - penetration_tolerance) / a),
                 2e-4); /* the slope of the edge, 0.05, turns it a little */
}

/* ---- closed contacts ---- */

static double first_due(scene *s, dem_index k, scene_flight *f)
{
    double y[4 * SCENE_NODES];
    const double *v = y + 2 * s->model->lattice.n_nodes;
    contact_forces *r = &s->c.set.forces;
    assert_ok(contact_set_regroup(&s->c.set));
    const double found = event_location_change(r, &s->c.set.list[k], &f->dense, f->dense.t0, f->scratch);
    for (int after = 0; after < 2; after++) { /* due there, and not a little before */
        dense_output_state(&f->dense, found - (1 - after) * 4.0 * dense_output_resolution(&f->dense), y);
        contact_forces_solve(r, r->group[k], (scene_state){0.0, y, v});
        assert_int_equal(candidate_due(&s->c.set.scene, &s->c.set.list[k], r->force[k], (scene_state){0.0, y, v}),
                         after);
    }
    return found;
}

static void close_contact(scene *s, dem_index k, dem_index feature, int sign)
{
    contact_candidate *candidate = &s->c.set.list[k];
    candidate->closed[candidate->n_closed++] = (contact_point){.feature = feature, .slide = sign};
}

/* Slides from x = 3 with 2 m/s: beyond the end by the penetration tolerance after half a second and the time for
 * that. */
TEST(a_sliding_candidate_is_first_due_when_it_reaches_the_end)
{
    CLEANUP(scene_close) scene s;
    scene_flight f;
    open_node(&s, 3.0, 0.0, 2.0, 0.0);
    close_contact(&s, 0, 0, 1);
    scene_fly(&s, nothing, 1.0, 0.7, &f);
    assert_close(first_due(&s, 0, &f), 1.5 + 0.5 * penetration_tolerance, 200.0 * DBL_EPSILON * 2.4);
}

/* The ridge is 0.5 m before the edge's end and the body goes left with 2 m/s: it passes the end by the penetration
 * tolerance. */
TEST(a_sliding_edge_is_first_due_when_its_vertex_reaches_the_end)
{
    CLEANUP(scene_close) scene s;
    scene_flight f;
    const dem_index k = open_edge(&s, 0.0);
    for (dem_index i = 0; i < 3; i++) vec2_put(scene_v(&s), i, (vec2){-2.0, 0.0});
    close_contact(&s, k, 0, 1);
    scene_fly(&s, nothing, 1.0, 0.4, &f);
    assert_close(first_due(&s, k, &f), 1.0 + 0.5 * (0.5 + penetration_tolerance), 200.0 * DBL_EPSILON * 1.8);
}

/* Node 0 on the ledge, the edge on the ridge at s: that takes m g/s for node 1, and so node 0 presses the ledge with
 * m g - (1 - s) m g/s, which is nothing where s = 1/2. The body goes right with 2 m/s from s = 0.75. */
TEST(a_node_is_first_due_when_the_edge_beside_it_takes_its_weight)
{
    CLEANUP(scene_close) scene s;
    scene_flight f;
    scene_open_triangle(&s, masses, -1.5, 0.0, roof_and_ledge, 2);
    s.c.set.scene.rule.penetration_tolerance = penetration_tolerance;
    for (dem_index i = 0; i < 3; i++) vec2_put(scene_v(&s), i, (vec2){2.0, 0.0});
    const dem_index k = scene_edge(&s, 0, 1);
    close_contact(&s, 0, 2, 1);
    close_contact(&s, k, 0, 1);
    scene_fly(&s, nothing, 1.0, 0.35, &f);
    assert_close(first_due(&s, 0, &f), 1.25, 200.0 * DBL_EPSILON * 1.7);
    assert_int_equal(s.c.set.forces.group[0], s.c.set.forces.group[k]);
}

/* A square 0 to 3 and two more nodes, in free flight. */
static void fly_square(scene *s, scene_flight *f)
{
    const double x[12] = {0.0, 0.0, 2.0, 0.0, 2.0, 1.0, 0.0, 1.0, 7.0, 5.0, 6.0, 6.0};
    const double mass[6] = {1.0, 1.0, 1.0, 1.0, 1.0, 1.0};
    const dem_index corners[6] = {0, 1, 2, 0, 2, 3};
    scene_open(s, 6, x, mass, 2, corners, &roof, 1);
    scene_fly(s, (vec2){1.0, -g}, 0.0, 1.0, f);
}

/* Edge 0-1 of the square is closed: those of the group, and the edge's neighbours, are
 * where the dense output has them; others are not looked at. */
TEST(the_state_of_a_group_is_that_of_its_nodes_and_their_neighbours)
{
    CLEANUP(scene_close) scene s;
    scene_flight f;
    double y[24];
    fly_square(&s, &f);
    close_contact(&s, scene_edge(&s, 0, 1), 0, 1);
    assert_ok(contact_set_regroup(&s.c.set));
    dense_output_state(&f.dense, 0.3, y);
    for (int k = 0; k < 24; k++) f.scratch[k] = 77.0;
    event_location_state(&s.c.set.forces, contact_set_group_at(&s.c.set, 0), &f.dense, 0.3, f.scratch);
    for (int k = 0; k < 24; k++) assert_close(f.scratch[k], k % 12 < 8 ? y[k] : 77.0, 0.0);
}

/* The gap of an edge depends on its nodes and on those before and after it. */
TEST(the_place_of_a_candidate_is_that_of_its_nodes_and_those_beside_them)
{
    CLEANUP(scene_close) scene s;
    scene_flight f;
    double y[24];
    fly_square(&s, &f);
    dense_output_state(&f.dense, 0.3, y);
    for (int k = 0; k < 24; k++) f.scratch[k] = 77.0;
    event_location_place(&s.c.set.list[0], &f.dense, 0.3, f.scratch);
    for (int k = 0; k < 24; k++) assert_close(f.scratch[k], k < 2 ? y[k] : 77.0, 0.0);
    event_location_place(&s.c.set.list[scene_edge(&s, 0, 1)], &f.dense, 0.3, f.scratch);
    for (int k = 0; k < 24; k++) assert_close(f.scratch[k], k < 8 ? y[k] : 77.0, 0.0);
}
