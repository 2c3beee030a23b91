/* SPDX-License-Identifier: BSD-3-Clause */
/* candidate_resolve.c: every reset of a candidate on its own, without an integrator, and the ledger kept of it.
 * Numbers are worked out by hand; tolerances of 1e-15 to 1e-12 are rounding unless said otherwise. */
#include "harness/motion.h"
#include "unit/contact/resets.h"
#include "harness/message.h"

/* ---- ends of segments ---- */

/* Level, then straight on, then down by 45 degrees at x = 2. */
static const double terrace_points[8] = {-4.0, 0.0, 0.0, 0.0, 2.0, 0.0, 4.0, -2.0};
static const dem_obstacle terrace = SIZED(dem_obstacle, .n_points = 4, .points = terrace_points, .restitution = 0.0);

TEST(a_sliding_node_glides_on_where_the_line_goes_on)
{
    CLEANUP(scene_close) scene s;
    slide(&s, &terrace, -1.0, 1.5);
    scene_put(&s, 0, 1.01 * penetration_tolerance, 0.0, 1.5, 0.0);
    assert_ok(scene_resolve(&s, 0.1));
    assert_int_equal(s.c.set.list[0].closed[0].feature, 1);
    scene_check(&s, 0, 1.01 * penetration_tolerance, 0.0, 1.5, 0.0);
    scene_put(&s, 0, -1.01 * penetration_tolerance, 0.0, -1.5, 0.0); /* and back */
    assert_ok(scene_resolve(&s, 0.2));
    assert_int_equal(s.c.set.list[0].closed[0].feature, 0);
    assert_int_equal(s.c.set.ledger.counts.passings, 2);
    assert_int_equal(s.c.set.ledger.counts.releases, 0);
}

TEST(a_sliding_node_flies_off_a_convex_bend_and_off_a_free_end)
{
    CLEANUP(scene_close) scene s;
    slide(&s, &terrace, 1.0, 1.5);
    scene_put(&s, 0, 2.0 + 1.01 * penetration_tolerance, 0.0, 1.5, 0.0);
    assert_ok(scene_resolve(&s, 0.1));
    assert_int_equal(s.c.set.list[0].n_closed, 0);
    scene_check(&s, 0, 2.0 + 1.01 * penetration_tolerance, 0.0, 1.5, 0.0);
    assert_int_equal(s.c.set.ledger.counts.passings, 1);
    assert_int_equal(s.c.set.ledger.counts.releases, 1);
    scene_close(&s);
    slide(&s, &terrace, -1.0, -1.5);
    scene_put(&s, 0, -4.0 - 1.01 * penetration_tolerance, 0.0, -1.5, 0.0);
    assert_ok(scene_resolve(&s, 0.1));
    assert_int_equal(s.c.set.list[0].n_closed, 0);
}

/* A rise by 30 degrees: the plastic impact leaves the part of the speed along it, u cos 30. */
TEST(a_sliding_node_takes_its_impact_at_a_concave_bend)
{
    const double cosine = sqrt(0.75), ramp_points[6] = {-4.0, 0.0, 0.0, 0.0, 2.0 * cosine, 1.0};
    const dem_obstacle ramp = SIZED(dem_obstacle, .n_points = 3, .points = ramp_points, .restitution = 0.0);
    CLEANUP(scene_close) scene s;
    slide(&s, &ramp, -1.0, 2.0);
    scene_put(&s, 0, 1.01 * penetration_tolerance, 0.0, 2.0, 0.0);
    assert_ok(scene_resolve(&s, 0.1));
    assert_int_equal(s.n_impacts, 1);
    scene_check(&s, 0, 0.0, 0.0, 2.0 * cosine * cosine, 2.0 * cosine * 0.5);
    assert_int_equal(s.c.set.list[0].n_closed, 1);
    assert_int_equal(s.c.set.list[0].closed[0].feature, 1);
    assert_int_equal(s.c.set.ledger.counts.passings, 1);
}

TEST(another_obstacle_stops_a_sliding_node)
{
    const dem_obstacle corner[2] = {
        {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = floor_points, .restitution = 0.0},
        {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = wall_points, .restitution = 0.5}};
    CLEANUP(scene_close) scene s;
    open_scene(&s, 1, corner, 2);
    scene_put(&s, 0, 1.0, 0.0, 3.0, 0.0);
    assert_ok(scene_take_up(&s));
    scene_put(&s, 0, 2.0 + penetration_tolerance, 0.0, 3.0, 0.0);
    assert_ok(scene_resolve(&s, 0.1));
    scene_check(&s, 0, 2.0, 0.0, -1.5, 0.0);
    assert_int_equal(s.c.set.list[0].n_closed, 1);
    assert_int_equal(s.c.set.list[0].closed[0].feature, 0);
    assert_close(exact_sum_value(&s.c.set.ledger.impulse[2]), -2.0 * 4.5, 1e-14);
    assert_close(exact_sum_value(&s.c.set.ledger.impulse[1]), 0.0, 1e-14);
}

/* ---- slip and stick ---- */

static void set_wind(scene *s, double a)
{
    s->acting.gravity[0] = a;
}

/* mu = 1/2 holds a wind of up to g/2. */
TEST(a_sliding_node_stops_and_starts_again_when_it_is_driven)
{
    CLEANUP(scene_close) scene s;
    rub(&s, 0.5);
    assert_close(s.c.set.list[0].closed[0].friction, -10.0, 1e-14);
    assert_ok(scene_resolve(&s, 0.1));
    assert_int_equal(s.n_events, 1);
    scene_put(&s, 0, 0.5, 0.0, -1e-6, 0.0);
    assert_ok(scene_resolve(&s, 0.2));
    assert_int_equal(s.n_events, 2);
    check_event(&s, 1, DEM_EVENT_STICK, DEM_CONTACT_STICK);
    scene_check(&s, 0, 0.5, 0.0, 0.0, 0.0);
    set_wind(&s, -0.49 * g);
    assert_ok(scene_resolve(&s, 0.3));
    assert_int_equal(s.n_events, 2);
    assert_close(s.c.set.list[0].closed[0].friction, 0.98 * g, 1e-14);
    set_wind(&s, -0.51 * g);
    assert_ok(scene_resolve(&s, 0.4));
    assert_int_equal(s.n_events, 3);
    check_event(&s, 2, DEM_EVENT_SLIP, DEM_CONTACT_SLIP);
    assert_int_equal(s.c.set.list[0].closed[0].slide, -1);
    assert_close(s.c.set.list[0].closed[0].friction, 10.0, 1e-14);
    assert_int_equal(s.c.set.ledger.counts.sticks, 1);
    assert_int_equal(s.c.set.ledger.counts.slips, 1);
}

/* A wind of 0.6 g brings it back: it stops and goes on the other way at once. */
TEST(a_sliding_node_turns_back_where_friction_cannot_hold_it)
{
    for (int k = -1; k <= 1; k += 2) {
        CLEANUP(scene_close) scene s;
        rub(&s, 0.5 * k);
        set_wind(&s, -0.6 * g * k);
        scene_put(&s, 0, 0.5, 0.0, -1e-6 * k, 0.0);
        assert_ok(scene_resolve(&s, 0.2));
        assert_int_equal(s.n_events, 2);
        check_event(&s, 1, DEM_EVENT_STICK, DEM_CONTACT_SLIP);
        scene_check(&s, 0, 0.5, 0.0, 0.0, 0.0);
        assert_int_equal(s.c.set.list[0].closed[0].slide, -k);
        assert_close(s.c.set.list[0].closed[0].friction, 10.0 * k, 1e-14);
    }
}

/* The same once it has changed twice in a step: it stays until the next step begins, with the force that this takes. */
TEST(a_sliding_node_that_has_turned_back_often_sticks_until_the_step_ends)
{
    CLEANUP(scene_close) scene s;
    rub(&s, 0.5);
    s.c.set.scene.rule.turns_in_step = 2;
    s.c.set.step = 7.0;
    set_wind(&s, -0.6 * g);
    for (int k = 0; k < 3; k++) {
        s.c.set.list[0].closed[0].slide = 1;
        scene_put(&s, 0, 0.5, 0.0, -1e-6, 0.0);
        assert_ok(scene_resolve(&s, 0.1 * (k + 1)));
        check_event(&s, k + 1, DEM_EVENT_STICK, k < 2 ? DEM_CONTACT_SLIP : DEM_CONTACT_STICK);
    }
    assert_close(s.c.set.list[0].closed[0].friction, 1.2 * g, 1e-14);
    assert_int_equal(s.n_events, 4); /* nor does it slip at once */
    s.c.set.step = 8.0;
    s.c.set.list[0].closed[0].pinned = false;
    assert_ok(scene_resolve(&s, 0.4));
    check_event(&s, 4, DEM_EVENT_SLIP, DEM_CONTACT_SLIP);
}

/* What is not pressed any more goes, whatever else is due: no stick, no slip, and the velocity stays as it is. */
TEST(release_comes_before_stick_and_slip)
{
    for (int k = 0; k < 2; k++) {
        CLEANUP(scene_close) scene s;
        rub(&s, k == 0 ? 0.5 : 0.0);
        set_wind(&s, 2.0 * g);
        s.acting.gravity[1] = 0.1;
        scene_put(&s, 0, 0.5, 0.0, k == 0 ? -0.25 : 0.0, 0.0);
        assert_ok(scene_resolve(&s, 0.2));
        assert_int_equal(s.n_events, 2);
        check_event(&s, 1, DEM_EVENT_RELEASE, DEM_CONTACT_FREE);
        scene_check(&s, 0, 0.5, 0.0, k == 0 ? -0.25 : 0.0, 0.0);
    }
}

TEST(a_sticking_node_does_not_move_in_any_wind_it_withstands)
{
    CLEANUP(scene_close) scene s;
    double a[2] = {0.3 * g, -g};
    rub(&s, 0.0);
    automaton_constrain(&s.c, 0.0, s.y, a);
    assert_close(a[0], 0.0, 0.0);
    assert_close(a[1], 0.0, 0.0);
    scene_close(&s);
    a[0] = 0.3 * g;
    a[1] = -g;
    rub(&s, 1.0);
    automaton_constrain(&s.c, 0.0, s.y, a);
    assert_close(a[0], 0.3 * g - 0.5 * g, 1e-14);
    assert_close(a[1], 0.0, 0.0);
}

/* ---- edges on vertices ---- */

/* The ridge under 3/4 of edge 0-1, of masses 1 and 3: W = 1/16 + 9/48 = 1/4, so that N = 40 N; mu = 1/2. A wind of
 * 0.6 g drives the point against friction with 0.6 g/W = 24 N. */
TEST(an_edge_slides_stops_and_slides_on_a_vertex)
{
    CLEANUP(scene_close) scene s;
    double rate[6] = {0.0};
    open_side(&s, &rough_roof, 0.25, 0.0, 0.0);
    launch(&s, 0.5, 0.0);
    assert_ok(scene_take_up(&s));
    const contact_point *point = &s.c.set.list[scene_edge(&s, 0, 1)].closed[0];
    assert_close(point->force, 40.0, 1e-13);
    assert_close(point->friction, -20.0, 1e-13);
    scene_add_rates(&s, rate);
    const double expected[6] = {-20.0, 40.0, -20.0, 0.0, 10.0, 0.0};
    for (int q = 0; q < 6; q++) assert_close(rate[q], expected[q], 1e-13);
    launch(&s, -1e-6, 0.0);
    assert_ok(scene_resolve(&s, 0.1));
    check_event(&s, 1, DEM_EVENT_STICK, DEM_CONTACT_STICK);
    assert_close(point->place, 0.75, 1e-15);
    assert_close(0.25 * s.y[8] + 0.75 * s.y[10], 0.0, 1e-21); /* 1e-15 of 1e-6 m/s */
    set_wind(&s, 0.49 * g);
    assert_ok(scene_resolve(&s, 0.2));
    assert_int_equal(s.n_events, 2);
    assert_close(point->friction, -19.6, 1e-12);
    set_wind(&s, 0.6 * g);
    assert_ok(scene_resolve(&s, 0.3));
    assert_int_equal(s.n_events, 3);
    check_event(&s, 2, DEM_EVENT_SLIP, DEM_CONTACT_SLIP);
    assert_int_equal(point->slide, 1);
    s.acting.gravity[1] = 0.1;
    assert_ok(scene_resolve(&s, 0.4));
    check_event(&s, 3, DEM_EVENT_RELEASE, DEM_CONTACT_FREE);
    assert_int_equal(s.n_events, 4);
}

/* Node 0 slides under a smooth slope, along (4, 3)/5, with the ridge at 1/5 of edge 0-1, of masses 1 and 4: along t and
 * n the point there has the mobility W = .64 (16, 12; 12, 9)/25 + .01 I, so beta = -W_nt/W_nn = -1.28. A wind of
 * (1, .6) gives it the acceleration b = (.9424, .6768); -b/W is T = -2.87, N = .849, and sliding T = -mu N. So mu = 4
 * holds it. With mu = 2 its acceleration would be -.0203 as it slides to the right with N = 1.81, and to the left
 * N < 0: it opens, and goes away from ridge and slope. */
TEST(an_edge_that_can_neither_stick_nor_slide_opens)
{
    const double slope_points[4] = {8.0, 6.0, -8.0, -6.0}, ridge_points[6] = {0.3, -4.0, 0.4, 0.0, 0.5, -4.0};
    const double at[6] = {0.0, 0.0, 2.0, 0.0, 1.5, 0.3}, mass[3] = {1.0, 4.0, 1.0};
    const dem_index corners[3] = {0, 1, 2};
    for (int k = 0; k < 2; k++) {
        const dem_obstacle obstacles[2] = {SIZED(dem_obstacle, .n_points = 3, .points = ridge_points,
                                                 .friction = k == 0 ? 4.0 : 2.0, .friction_law = DEM_FRICTION_COULOMB),
                                           SIZED(dem_obstacle, .n_points = 2, .points = slope_points)};
        CLEANUP(scene_close) scene s;
        scene_open(&s, 3, at, mass, 1, corners, obstacles, 2);
        scene_put(&s, 1, 2.0, 0.0, -1e-6, 0.0);
        s.acting.gravity[0] = 1.0;
        s.acting.gravity[1] = 0.6;
        const dem_index edge = scene_edge(&s, 0, 1);
        assert_ok(contact_set_close(&s.c.set, edge, (contact_point){.feature = 0, .slide = 1}));
        assert_ok(contact_set_close(&s.c.set, 0, (contact_point){.feature = 2, .slide = 1}));
        assert_ok(scene_resolve(&s, 0.1));
        assert_close(0.8 * scene_v(&s)[0] + 0.2 * scene_v(&s)[2], 0.0, 1e-20); /* it has been stopped */
        const contact_candidate *on = &s.c.set.list[edge], *under = &s.c.set.list[0];
        if (k == 0) {
            check_event(&s, 0, DEM_EVENT_STICK, DEM_CONTACT_STICK);
            assert_int_equal(s.n_events, 1);
            assert_close(on->closed[0].force, (0.3072 * 0.9424 - 0.4196 * 0.6768) / 0.0065, 1e-12);
        } else {
            check_event(&s, 0, DEM_EVENT_RELEASE, DEM_CONTACT_FREE);
            check_event(&s, 1, DEM_EVENT_RELEASE, DEM_CONTACT_FREE);
            assert_int_equal(on->n_closed + under->n_closed, 0);
        }
    }
}

/* The body goes right along edge 1-2 with u: the ridge, closed with that, comes over node 1 to edge 0-1. */
static void slide_on(scene *s, double bend, double u)
{
    open_side(s, &roof, 1.01 * penetration_tolerance, 1.01 * penetration_tolerance * bend, bend);
    launch(s, u, u * bend);
    assert_ok(contact_set_close(&s->c.set, scene_edge(s, 1, 2), (contact_point){.feature = 0, .slide = 1}));
}

TEST(a_vertex_glides_from_edge_to_edge_of_a_flat_side)
{
    CLEANUP(scene_close) scene s;
    slide_on(&s, 0.0, 0.5);
    const contact_candidate *from = &s.c.set.list[scene_edge(&s, 1, 2)], *to = &s.c.set.list[scene_edge(&s, 0, 1)];
    assert_ok(scene_resolve(&s, 0.1));
    assert_int_equal(from->n_closed, 0);
    assert_int_equal(to->n_closed, 1);
    assert_int_equal(to->closed[0].slide, 1);
    scene_check(&s, 1, 0.0, 0.0, 0.5, 0.0);
    assert_int_equal(s.n_impacts, 0);
    assert_int_equal(s.n_events, 3);
    check_event(&s, 0, DEM_EVENT_PASS, DEM_CONTACT_SLIP);
    check_event(&s, 1, DEM_EVENT_RELEASE, DEM_CONTACT_FREE);
    check_event(&s, 2, DEM_EVENT_CLOSE, DEM_CONTACT_SLIP);
    assert_int_equal(s.events[0].node, 1);
    assert_int_equal(s.events[2].node, 0);
    assert_close(s.events[2].weight, 1.0, 1e-15);
}

/* The next edge falls away by 1/4 to the other side: nothing holds. */
TEST(a_vertex_leaves_a_convex_corner_of_the_body)
{
    CLEANUP(scene_close) scene s;
    slide_on(&s, 0.25, 0.5);
    assert_ok(scene_resolve(&s, 0.1));
    assert_int_equal(s.n_events, 2);
    check_event(&s, 0, DEM_EVENT_PASS, DEM_CONTACT_SLIP);
    check_event(&s, 1, DEM_EVENT_RELEASE, DEM_CONTACT_FREE);
    scene_check(&s, 1, 0.0, 0.0, 0.5, 0.125);
    for (dem_index k = 4; k < s.c.set.n; k++) assert_int_equal(s.c.set.list[k].n_closed, 0);
}

/* The next edge, of normal n = (-1/4, 1)/L, stands in the way: the plastic impact takes v.n = -1/4/L from node 1, where
 * the vertex is, and the contact goes on with that edge. */
TEST(a_vertex_hits_the_next_edge_where_the_body_bends_in)
{
    const double L = sqrt(1.0625), n[2] = {-0.25 / L, 1.0 / L}, vn = -0.25 / L;
    CLEANUP(scene_close) scene s;
    slide_on(&s, -0.25, 0.5);
    assert_ok(scene_resolve(&s, 0.1));
    assert_int_equal(s.n_events, 3);
    check_event(&s, 0, DEM_EVENT_PASS, DEM_CONTACT_SLIP);
    check_event(&s, 1, DEM_EVENT_RELEASE, DEM_CONTACT_FREE);
    check_event(&s, 2, DEM_EVENT_IMPACT, DEM_CONTACT_SLIP);
    const vec2 after = vec2_at(scene_v(&s), 1);
    assert_close(s.events[2].impulse[0], -3.0 * vn * n[0],
                 1e-6); /* it is put on the ridge: a penetration tolerance in 1 m of slope */
    assert_close(s.events[2].impulse[1], -3.0 * vn * n[1], 1e-6);
    assert_close(after.x, 0.5 - vn * n[0], 1e-6);
    assert_close(after.y, -0.125 - vn * n[1], 1e-6);
    assert_int_equal(s.c.set.list[scene_edge(&s, 0, 1)].n_closed, 1);
    assert_int_equal(s.c.set.list[scene_edge(&s, 1, 2)].n_closed, 0);
}

/* Too slow to rise above the position error: both edges hold the vertex, each with half the weight of node 1 over its
 * normal's cosine 1/L; and on, when that is pulled up. */
TEST(a_vertex_comes_to_rest_where_the_body_bends_in)
{
    const double L = sqrt(1.0625);
    CLEANUP(scene_close) scene s;
    slide_on(&s, -0.25, 1e-5);
    assert_ok(scene_resolve(&s, 0.1));
    const contact_candidate *left = &s.c.set.list[scene_edge(&s, 0, 1)], *right = &s.c.set.list[scene_edge(&s, 1, 2)];
    assert_true(left->n_closed == 1 && left->closed[0].held);
    assert_true(right->n_closed == 1 && right->closed[0].held);
    scene_check(&s, 1, 0.0, 0.0, 0.0, 0.0);
    assert_close(left->closed[0].force, 15.0 * L, 3e-5); /* a penetration tolerance in 1 m of slope, of 15 N */
    assert_close(right->closed[0].force, 15.0 * L, 3e-5);
    s.acting.gravity[1] = 0.1;
    assert_ok(scene_resolve(&s, 0.2));
    assert_int_equal(left->n_closed, 0);
    assert_int_equal(right->n_closed, 0);
    assert_int_equal(s.c.set.ledger.counts.releases, 2);
}

/* Held in a notch there is no friction; when the wind has lifted one side off, the vertex sticks to the other where it
 * is, at its start, and not where it stuck there before it slid into the notch. */
TEST(a_vertex_let_go_by_one_side_of_a_notch_sticks_to_the_other_where_it_is)
{
    for (int k = 1; k < 8; k++) {
        CLEANUP(scene_close) scene s;
        open_side(&s, &rough_roof, 1.01 * penetration_tolerance, -0.05 * k * 1.01 * penetration_tolerance, -0.05 * k);
        launch(&s, 1e-5, -0.05 * k * 1e-5);
        const dem_index k_left = scene_edge(&s, 0, 1), k_right = scene_edge(&s, 1, 2);
        const contact_candidate *left = &s.c.set.list[k_left], *right = &s.c.set.list[k_right];
        assert_ok(contact_set_close(&s.c.set, k_right, (contact_point){.feature = 0, .slide = 1, .place = 0.5}));
        assert_ok(scene_resolve(&s, 0.1));
        assert_true(left->closed[0].held && right->closed[0].held);
        set_wind(&s, -0.06 * k * g);
        assert_ok(scene_resolve(&s, 0.2));
        assert_int_equal(left->n_closed, 0);
        assert_true(right->n_closed == 1 && right->closed[0].slide == 0);
        assert_close(right->closed[0].place, 0.0, 1e-12);
    }
}

/* The node hits first, but it is the side that has come down on the ridge. */
TEST(a_flat_side_comes_down_on_an_apex_with_its_own_normal)
{
    const dem_obstacle springy = SIZED(dem_obstacle, .n_points = 3, .points = roof_points, .restitution = 0.5);
    const double x[3] = {0.0, 0.1 * penetration_tolerance, -0.1 * penetration_tolerance};
    for (int k = 0; k < 3; k++) {
        CLEANUP(scene_close) scene s;
        open_side(&s, &springy, x[k], -1.7 * penetration_tolerance,
                  0.0); /* the node 1.2 penetration tolerances inside a flank */
        launch(&s, 0.25, -1.0);
        assert_ok(scene_resolve(&s, 0.1));
        assert_int_equal(s.n_impacts, 1);
        assert_true(s.impacts[0].other >= 0);
        assert_close(s.impacts[0].normal[0], 0.0, 3e-6); /* its nodes are lifted on to the ridge, one by it */
        assert_close(s.impacts[0].impulse[1], 4.5, 1e-5);
        assert_close(s.y[8 + 2], 0.25, 1e-5);
        assert_close(s.y[8 + 3], 0.5, 1e-5);
    }
}

/* ---- what must not happen ---- */

TEST(a_node_found_deep_inside_is_an_error)
{
    CLEANUP(scene_close) scene s;
    open_scene(&s, 1, &half, 1);
    scene_put(&s, 0, 0.5, -0.125, 0.0, -1.0);
    assert_int_equal(scene_resolve(&s, 0.25), DEM_ERROR_CONTACT);
    assert_message_parts("node 0 * (0.5, -0.125) m * 0.125 m inside obstacle 0 * t = 0.25 s");
}

TEST(too_many_changes_of_one_node_in_a_short_time_are_a_storm)
{
    CLEANUP(scene_close) scene s;
    open_scene(&s, 1, &half, 1);
    s.c.set.scene.rule.max_impacts = 2;
    for (int k = 0; k < 3; k++) {
        scene_put(&s, 0, 0.5, -penetration_tolerance, 0.0, -1.0);
        assert_int_equal(scene_resolve(&s, 0.1 * (k + 1)), k < 2 ? DEM_OK : DEM_ERROR_CONTACT);
    }
    assert_message_parts("node 0 * (0.5, 0) m * 2 contact events * 0.5 s * t = 0.3 s");
}

TEST(changes_further_apart_are_no_storm)
{
    CLEANUP(scene_close) scene s;
    open_scene(&s, 1, &half, 1);
    s.c.set.scene.rule.max_impacts = 2;
    for (int k = 0; k < 20; k++) {
        scene_put(&s, 0, 0.5, -penetration_tolerance, 0.0, -1.0);
        assert_ok(scene_resolve(&s, 0.3 * (k + 1)));
    }
}

/* Steps begin at 7, 8 and 9 s; 0.6 s apart no changes are a storm. */
TEST(too_many_changes_of_one_candidate_in_a_step_ask_for_a_shorter_one)
{
    CLEANUP(scene_close) scene s;
    open_scene(&s, 1, &half, 1);
    s.c.set.scene.rule.most_in_step = 2;
    for (int k = 0; k < 5; k++) {
        s.c.set.step = 7 + k / 2;
        scene_put(&s, 0, 0.5, -penetration_tolerance, 0.0, -1.0);
        assert_ok(scene_resolve(&s, 0.6 * (k + 1)));
    }
    scene_put(&s, 0, 0.5, -penetration_tolerance, 0.0, -1.0);
    assert_ok(scene_resolve(&s, 3.6));
    scene_put(&s, 0, 0.5, -penetration_tolerance, 0.0, -1.0);
    assert_int_equal(scene_resolve(&s, 4.2), DEM_ERROR_CONTACT);
    assert_message_parts("node 0 * (0.5, 0) m * 2 contact events in a step * t = 4.2 s");
}

/* 50 changes are made at 0.5 s, where events are located to 1e-14 s. An instant later all begins anew. */
TEST(too_many_changes_of_one_candidate_at_once_are_an_error)
{
    CLEANUP(scene_close) scene s;
    open_scene(&s, 1, &half, 1);
    for (int k = 0; k < 101; k++) {
        s.n_events = s.n_impacts = 0;
        scene_put(&s, 0, 0.5, -penetration_tolerance, 0.0, -1.0);
        assert_int_equal(scene_resolve(&s, k < 50 ? 0.5 : 0.5 + 1e-11), k < 100 ? DEM_OK : DEM_ERROR_CONTACT);
    }
    assert_message_parts("node 0 * (0.5, 0) m * 50 contact events at once, at t = 0.5 s");
}

TEST(a_vertex_found_deep_inside_a_body_is_an_error)
{
    CLEANUP(scene_close) scene s;
    open_side(&s, &roof, 0.25, -0.125, 0.0);
    assert_int_equal(scene_resolve(&s, 0.25), DEM_ERROR_CONTACT);
    assert_message_parts("vertex * (0, 0) m * obstacle 0 * 0.125 m inside * edge * node 0 * 1 * t = 0.25 s");
}

TEST(too_many_changes_of_one_edge_in_a_short_time_are_a_storm)
{
    CLEANUP(scene_close) scene s;
    open_side(&s, &roof, 0.5, 0.0, 0.0);
    s.c.set.scene.rule.max_impacts = 2;
    for (int k = 0; k < 3; k++) {
        const dem_index edge = scene_edge(&s, 0, 1);
        if (s.c.set.list[edge].n_closed > 0) assert_ok(contact_set_open(&s.c.set, edge, 0));
        scene_put(&s, 0, -0.5, -penetration_tolerance, 0.0, -1.0);
        scene_put(&s, 1, 0.5, -penetration_tolerance, 0.0, -1.0);
        assert_int_equal(scene_resolve(&s, 0.1 * (k + 1)), k < 2 ? DEM_OK : DEM_ERROR_CONTACT);
    }
    assert_non_null(strstr(dem_status_message(), "the edge from node 0 at (-0.5, "));
    assert_non_null(strstr(dem_status_message(), "had more than 2 contact events within 0.5 s, at t = 0.3 s"));
}

/* ---- the check after a step ---- */

TEST(a_nearly_straight_concave_bend_moves_the_node_by_no_more_than_rounding)
{
    const double c = cos(0.3), s = sin(0.3), ox = 0.37, oy = 0.21, turn = 2e-9, t = 0.35;
    const double points[6] = {ox - 2.0 * c, oy - 2.0 * s, ox, oy, ox + 2.0 * (c - turn * s), oy + 2.0 * (s + turn * c)};
    const double x[2] = {ox + 0.5 * (c - turn * s), oy + 0.5 * (s + turn * c)}, v[2] = {-c, -s};
    support_run run;
    support_point(&run, 1.0, x, v, points, 3, 0.0);
    const motion now = support_at(&run, t);
    const double along = (now.x[0] - ox) * c + (now.x[1] - oy) * s, lift = now.energy.projection;
    support_close(&run);
    assert_close(lift, 0.0, 1e-11);
    assert_close(along, 0.5 - t - 0.5 * 9.81 * s * t * t, 1e-8);
}
