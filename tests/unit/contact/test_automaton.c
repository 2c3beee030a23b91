/* SPDX-License-Identifier: BSD-3-Clause */
/* automaton.c: all candidates at the start and at an event, without an integrator, and the ledger kept of it. Numbers
 * are worked out by hand; tolerances of 1e-15 to 1e-12 are rounding unless said otherwise. */
#include "unit/contact/resets.h"
#include "harness/message.h"

TEST(touching_is_admissible_and_deeper_than_the_penetration_tolerance_is_not)
{
    CLEANUP(scene_close) scene s;
    open_scene(&s, 2, &half, 1);
    scene_put(&s, 0, 0.5, 0.0, 0.0, 0.0);
    scene_put(&s, 1, 1.5, -penetration_tolerance, 0.0, 0.0);
    assert_ok(automaton_check_start(&s.c, 0.0, s.y));
    scene_put(&s, 1, 1.5, -0.25, 0.0, 0.0);
    assert_int_equal(automaton_check_start(&s.c, 0.0, s.y), DEM_ERROR_MODEL);
    assert_message_parts("node 1 * (1.5, -0.25) m * 0.25 m inside obstacle 0 * penetration tolerance * 1e-06 m");
}

enum { most_nodes = SCENE_NODES };

TEST(at_the_start_touching_is_enough_for_a_contact)
{
    CLEANUP(scene_close) scene s;
    dem_index n;
    open_scene(&s, 3, &half, 1);
    scene_put(&s, 0, 0.0, 0.0, 3.0, 0.0);
    scene_put(&s, 1, 1.0, 0.0, 0.0, -2.0);
    scene_put(&s, 2, 2.0, 1e-9, 0.0, -2.0);
    assert_ok(scene_take_up(&s));
    scene_check(&s, 0, 0.0, 0.0, 3.0, 0.0);
    scene_check(&s, 1, 1.0, 0.0, 0.0, 1.0);
    scene_check(&s, 2, 2.0, 1e-9, 0.0, -2.0);
    const dem_contact *list = automaton_list(&s.c, 0.0, s.y, &n);
    assert_int_equal(n, 1);
    assert_int_equal(list[0].nodes[0], 0);
    assert_int_equal(list[0].state, DEM_CONTACT_SLIP);
    assert_close(list[0].force, 2.0 * g, 0.0);
    assert_int_equal(s.n_impacts, 1); /* the resting node's velocity did not change */
    assert_int_equal(s.c.set.ledger.counts.closings, 1);
}

TEST(a_node_that_leaves_the_surface_at_the_start_is_free)
{
    CLEANUP(scene_close) scene s;
    open_scene(&s, 1, &half, 1);
    scene_put(&s, 0, 0.0, 0.0, 0.0, 0.5);
    assert_ok(scene_take_up(&s));
    scene_check(&s, 0, 0.0, 0.0, 0.0, 0.5);
    assert_int_equal(s.c.set.list[0].n_closed, 0);
    assert_int_equal(s.n_impacts, 0);
}

/* ---- impacts ---- */

/* 2 kg at (3, -4) m/s on a floor of eta = 1/2: rises with 2 m/s, the floor gives 2 * 6 N s and takes 2/2 (16 - 4) =
 * 12 J; the lift by the penetration tolerance d costs 2 g d. */
TEST(an_impact_is_reflected_reported_and_entered)
{
    CLEANUP(scene_close) scene s;
    open_scene(&s, 1, &half, 1);
    scene_put(&s, 0, 0.25, -penetration_tolerance, 3.0, -4.0);
    assert_ok(scene_resolve(&s, 0.125));
    scene_check(&s, 0, 0.25, 0.0, 3.0, 2.0);
    assert_int_equal(s.n_impacts, 1);
    const dem_event hit = s.impacts[0];
    assert_close(hit.t, 0.125, 0.0);
    assert_int_equal(hit.node, 0);
    assert_int_equal(hit.obstacle, 0);
    assert_int_equal(hit.segment, 0);
    assert_int_equal(hit.state, DEM_CONTACT_FREE);
    const double expected[10] = {0.25, 0.0, 0.0, 1.0, 0.0, 12.0, 3.0, -4.0, 3.0, 2.0};
    const double actual[10] = {hit.x[0],       hit.x[1],      hit.normal[0], hit.normal[1], hit.impulse[0],
                               hit.impulse[1], hit.before[0], hit.before[1], hit.after[0],  hit.after[1]};
    for (int k = 0; k < 10; k++) assert_close(actual[k], expected[k], 1e-15);
    assert_close(exact_sum_value(&s.c.set.ledger.impact), 12.0, 1e-14);
    assert_close(exact_sum_value(&s.c.set.ledger.impulse[0]), 0.0, 0.0);
    assert_close(exact_sum_value(&s.c.set.ledger.impulse[1]), 12.0, 1e-14);
    assert_close(exact_sum_value(&s.c.set.ledger.projection), 2.0 * g * penetration_tolerance,
                 1e-14); /* a difference of energies of order 20 m g */
    assert_int_equal(s.c.set.ledger.counts.impacts, 1);
    assert_int_equal(s.c.set.ledger.counts.closings, 0);
}

TEST(a_plastic_impact_becomes_a_contact_with_the_weight_as_its_force)
{
    CLEANUP(scene_close) scene s;
    dem_index n;
    open_scene(&s, 1, &plastic, 1);
    scene_put(&s, 0, 0.25, -penetration_tolerance, 3.0, -4.0);
    assert_ok(scene_resolve(&s, 0.125));
    scene_check(&s, 0, 0.25, 0.0, 3.0, 0.0);
    assert_int_not_equal(s.impacts[0].state, DEM_CONTACT_FREE);
    assert_int_equal(s.c.set.ledger.counts.closings, 1);
    const dem_contact *list = automaton_list(&s.c, 0.0, s.y, &n);
    assert_int_equal(n, 1);
    assert_int_equal(list[0].n_nodes, 1);
    assert_int_equal(list[0].obstacle, 0);
    assert_int_equal(list[0].segment, 0);
    assert_close(list[0].weights[0], 1.0, 0.0);
    assert_close(list[0].normal[1], 1.0, 0.0);
    assert_close(list[0].force, 2.0 * g, 0.0);
}

TEST(a_node_not_yet_as_deep_as_the_penetration_tolerance_is_left_alone)
{
    CLEANUP(scene_close) scene s;
    open_scene(&s, 1, &half, 1);
    scene_put(&s, 0, 0.25, -0.98 * penetration_tolerance, 3.0, -4.0);
    assert_ok(scene_resolve(&s, 0.0));
    scene_check(&s, 0, 0.25, -0.98 * penetration_tolerance, 3.0, -4.0);
    assert_int_equal(s.n_impacts, 0);
}

static void land(double eta, double speed, double rest_speed, int closed)
{
    const dem_obstacle plane = SIZED(dem_obstacle, .n_points = 2, .points = floor_points, .restitution = eta);
    CLEANUP(scene_close) scene s;
    open_scene(&s, 1, &plane, 1);
    s.c.set.scene.rule.rest_speed = rest_speed;
    scene_put(&s, 0, 0.25, -penetration_tolerance, 1.0, -speed / eta);
    assert_ok(scene_resolve(&s, 0.0));
    assert_int_equal(s.impacts[0].state != DEM_CONTACT_FREE, closed);
    scene_check(&s, 0, 0.25, 0.0, 1.0, closed ? 0.0 : speed);
}

/* At rest is what rises no higher than the position error; or than twice the hop that impacts at a depth d, the
 * penetration tolerance, keep up: d eta^2/(1 - eta^2), a third of d at eta = 1/2 and 1e-4 of it at 1/100. And what is
 * not faster than the rest speed that is given, which takes nothing from these limits. */
TEST(a_rebound_too_slow_becomes_a_contact)
{
    const double error = sqrt(2.0 * g * 1e-9), kept_up = sqrt(2.0 * g * 2.0 * penetration_tolerance / 3.0);
    for (int k = 0; k < 2; k++) {
        const double rest_speed = k * 1e-9; /* less than either */
        land(0.01, 0.99 * error, rest_speed, 1);
        land(0.01, 1.01 * error, rest_speed, 0);
        land(0.5, 0.99 * kept_up, rest_speed, 1);
        land(0.5, 1.01 * kept_up, rest_speed, 0);
    }
    land(0.5, 0.099, 0.1, 1);
    land(0.5, 0.101, 0.1, 0);
}

TEST(a_contact_does_not_last_where_nothing_presses)
{
    const double pull[4] = {0.1, 0.1, 0.0, 0.0}, rest_speed[4] = {0.0, 0.1, 0.0, 0.1};
    for (int k = 0; k < 4; k++) {
        CLEANUP(scene_close) scene s;
        open_scene(&s, 1, &plastic, 1);
        s.acting.gravity[1] = pull[k];
        s.c.set.scene.rule.rest_speed = rest_speed[k];
        scene_put(&s, 0, 0.25, -penetration_tolerance, 1.0, -1.0);
        assert_ok(scene_resolve(&s, 0.0));
        scene_check(&s, 0, 0.25, 0.0, 1.0, 0.0);
        assert_int_equal(s.impacts[0].state, DEM_CONTACT_FREE);
        assert_int_equal(s.c.set.list[0].n_closed, 0);
    }
}

TEST(simultaneous_hits_are_taken_in_one_batch_in_the_order_of_nodes)
{
    CLEANUP(scene_close) scene s;
    open_scene(&s, 3, &half, 1);
    scene_put(&s, 0, 2.0, -penetration_tolerance, 0.0, -1.0);
    scene_put(&s, 1, 1.0, -0.995 * penetration_tolerance, 0.0,
              -2.0); /* within a hundredth of the penetration tolerance counts as the same */
    scene_put(&s, 2, 0.0, -1.005 * penetration_tolerance, 0.0, -3.0);
    assert_ok(scene_resolve(&s, 0.0));
    assert_int_equal(s.n_impacts, 3);
    for (int k = 0; k < 3; k++) {
        assert_int_equal(s.impacts[k].node, k);
        scene_check(&s, k, 2.0 - k, 0.0, 0.0, 0.5 * (1.0 + k));
    }
    assert_close(exact_sum_value(&s.c.set.ledger.impulse[1]), 2.0 * 1.5 * (1.0 + 2.0 + 3.0), 1e-14);
}

TEST(the_status_of_a_listener_that_stops_is_returned)
{
    CLEANUP(scene_close) scene s;
    open_scene(&s, 1, &half, 1);
    s.value = DEM_STOPPED;
    scene_put(&s, 0, 0.25, -penetration_tolerance, 3.0, -4.0);
    assert_int_equal(scene_resolve(&s, 0.0), DEM_STOPPED);
}

/* Floor of eta 1/2 and wall of eta 1/4 as two obstacles; the wall's solid is on its right, x > 2. */
TEST(in_a_corner_each_obstacle_gets_the_impulse_along_its_normal)
{
    const dem_obstacle corner[2] = {
        {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = wall_points, .restitution = 0.25},
        {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = floor_points, .restitution = 0.5}};
    CLEANUP(scene_close) scene s;
    open_scene(&s, 1, corner, 2);
    scene_put(&s, 0, 2.0 + penetration_tolerance, -penetration_tolerance, 4.0, -3.0);
    assert_ok(scene_resolve(&s, 0.0));
    scene_check(&s, 0, 2.0, 0.0, -1.0, 1.5);
    assert_close(exact_sum_value(&s.c.set.ledger.impulse[0]), -2.0 * 5.0, 1e-14);
    assert_close(exact_sum_value(&s.c.set.ledger.impulse[1]), 0.0, 1e-14);
    assert_close(exact_sum_value(&s.c.set.ledger.impulse[2]), 0.0, 1e-14);
    assert_close(exact_sum_value(&s.c.set.ledger.impulse[3]), 2.0 * 4.5, 1e-14);
    assert_int_equal(s.n_impacts, 1);
    assert_int_equal(s.impacts[0].obstacle, 0); /* approached faster */
    assert_close(exact_sum_value(&s.c.set.ledger.impact), 25.0 - 1.0 - 2.25, 1e-13);
}

/* ---- lasting contacts ---- */

TEST(a_contact_that_would_have_to_pull_lets_go_and_changes_no_velocity)
{
    CLEANUP(scene_close) scene s;
    open_pair(&s);
    scene_put(&s, 1, 0.0, 1.19, 0.5, 2.0); /* pulls with 19 N against 20 N */
    assert_ok(scene_resolve(&s, 0.1));
    assert_int_equal(s.c.set.list[0].n_closed, 1);
    assert_close(s.c.set.list[0].closed[0].force, 1.0, 1e-13);
    scene_put(&s, 1, 0.0, 1.21, 0.5, 2.0);
    assert_ok(scene_resolve(&s, 0.2));
    assert_int_equal(s.c.set.list[0].n_closed, 0);
    scene_check(&s, 0, 0.0, 0.0, 0.5, 0.0);
    assert_int_equal(s.c.set.ledger.counts.releases, 1);
    assert_int_equal(s.n_impacts, 0);
}

TEST(closed_contacts_hold_the_acceleration_along_their_normals)
{
    const double slope_points[6] = {-2.0, 2.0, 0.0, 0.0, 2.0, 2.0}; /* a groove of 90 degrees */
    const dem_obstacle groove = SIZED(dem_obstacle, .n_points = 3, .points = slope_points, .restitution = 0.0);
    CLEANUP(scene_close) scene s;
    open_scene(&s, 3, &groove, 1);
    scene_put(&s, 0, 0.5, 3.0, 0.0, 0.0);
    scene_put(&s, 1, 1.0, 1.0, 0.0, 0.0);
    scene_put(&s, 2, 0.0, 0.0, 0.0, 0.0);
    assert_ok(scene_take_up(&s));
    double a[6] = {1.0, -g, 1.0, -g, 1.0, -g};
    automaton_constrain(&s.c, 0.0, s.y, a);
    const double expected[6] = {1.0, -g, 0.5 * (1.0 - g), 0.5 * (1.0 - g), 0.0, 0.0};
    for (int k = 0; k < 6; k++) assert_close(a[k], expected[k], 1e-14);
    assert_int_equal(s.c.set.list[2].n_closed, 2);
    assert_true(s.c.set.list[2].closed[0].held && s.c.set.list[2].closed[1].held);
}

TEST(contacts_are_listed_in_the_order_of_nodes)
{
    const double slope_points[6] = {-2.0, 2.0, 0.0, 0.0, 2.0, 2.0};
    const dem_obstacle groove = SIZED(dem_obstacle, .n_points = 3, .points = slope_points, .restitution = 0.0);
    dem_index n;
    CLEANUP(scene_close) scene s;
    open_scene(&s, 3, &groove, 1);
    scene_put(&s, 0, 0.0, 0.0, 0.0, 0.0);
    scene_put(&s, 1, 0.5, 3.0, 0.0, 0.0);
    scene_put(&s, 2, -1.0, 1.0, 0.0, 0.0);
    assert_ok(scene_take_up(&s));
    const dem_contact *list = automaton_list(&s.c, 0.0, s.y, &n);
    assert_int_equal(n, 3);
    assert_int_equal(list[0].nodes[0], 0);
    assert_int_equal(list[1].nodes[0], 0);
    assert_int_equal(list[0].segment + list[1].segment, 1);
    assert_int_equal(list[2].nodes[0], 2);
    assert_int_equal(list[2].segment, 0);
    for (int k = 0; k < 3; k++) assert_close(list[k].force, 2.0 * g * sqrt(0.5), 1e-13);
}

/* With gravity along (1, -1) the right flank alone is pressed; along (1, 1)/2 none is, and what is left of the pair
 * goes too. */
TEST(a_held_node_lets_go_of_the_wall_that_would_pull)
{
    const double slope_points[6] = {-2.0, 2.0, 0.0, 0.0, 2.0, 2.0};
    const dem_obstacle groove = SIZED(dem_obstacle, .n_points = 3, .points = slope_points, .restitution = 0.0);
    CLEANUP(scene_close) scene s;
    open_scene(&s, 1, &groove, 1);
    scene_put(&s, 0, 0.0, 0.0, 0.0, 0.0);
    assert_ok(scene_take_up(&s));
    assert_int_equal(s.c.set.list[0].n_closed, 2);
    s.acting.gravity[0] = 1.1 * g;
    assert_ok(scene_resolve(&s, 0.1));
    assert_int_equal(s.c.set.list[0].n_closed, 1);
    assert_int_equal(s.c.set.list[0].closed[0].feature, 1);
    assert_false(s.c.set.list[0].closed[0].held);
    assert_int_equal(s.c.set.list[0].closed[0].slide, 1);
    assert_int_equal(s.c.set.ledger.counts.releases, 1);
    s.acting.gravity[0] = 0.0;
    s.acting.gravity[1] = g;
    assert_ok(scene_resolve(&s, 0.2));
    assert_int_equal(s.c.set.list[0].n_closed, 0);
    assert_int_equal(s.c.set.ledger.counts.releases, 2);
}

/* At the bottom of the groove, up its right flank: gravity's part along it, g sin 45, brings back what is slower than
 * sqrt(2 g sin 45 position_error), and that is at rest. */
TEST(a_corner_holds_only_what_is_at_rest_in_it)
{
    const double slope_points[6] = {-2.0, 2.0, 0.0, 0.0, 2.0, 2.0}, root = sqrt(0.5);
    const double limit = sqrt(2.0 * g * root * 1e-9), speed[2] = {0.99 * limit, 1.01 * limit};
    const dem_obstacle groove = SIZED(dem_obstacle, .n_points = 3, .points = slope_points, .restitution = 0.0);
    for (int k = 0; k < 2; k++) {
        CLEANUP(scene_close) scene s;
        const double u = k == 0 ? 0.0 : root * speed[k];
        open_scene(&s, 1, &groove, 1);
        scene_put(&s, 0, 0.0, 0.0, root * speed[k], root * speed[k]);
        assert_ok(scene_take_up(&s));
        assert_int_equal(s.c.set.list[0].n_closed, 2 - k);
        if (k == 1) assert_int_equal(s.c.set.list[0].closed[0].feature, 1);
        scene_check(&s, 0, 0.0, 0.0, u, u);
    }
}

TEST(a_closed_node_is_put_back_where_rounding_has_taken_it_from)
{
    CLEANUP(scene_close) scene s;
    open_scene(&s, 1, &plastic, 1);
    scene_put(&s, 0, 0.5, 0.0, 1.0, 0.0);
    assert_ok(scene_take_up(&s));
    scene_put(&s, 0, 0.5, 1e-9, 1.0, 0.0);
    assert_ok(scene_resolve(&s, 0.1));
    scene_check(&s, 0, 0.5, 0.0, 1.0, 0.0);
    assert_close(s.y[1], 0.0, 0.0);
    assert_close(exact_sum_value(&s.c.set.ledger.projection), -2.0 * g * 1e-9, 1e-20);
    assert_int_equal(s.n_impacts, 0);
}

/* ---- slip and stick ---- */

/* N = 20 N and 10 N of friction, which take 10 W from 1 m/s, and nothing where it sticks. */
TEST(forces_and_friction_power_are_reported_as_rates)
{
    const double u[3] = {1.0, -1.0, 0.0}, wind[3] = {0.0, 0.0, 0.3 * g}, T[3] = {-10.0, 10.0, -6.0};
    for (int k = 0; k < 3; k++) {
        CLEANUP(scene_close) scene s;
        double a[2] = {wind[k], -g}, rate[6] = {100.0, 100.0, 100.0, 100.0, 100.0, 100.0};
        rub(&s, u[k]);
        if (k == 2)
            scene_put(&s, 0, 0.5, 0.0, 1e-3, 0.0); /* what sticks takes nothing, whatever is left of its speed */
        automaton_constrain(&s.c, 0.0, s.y, a);
        scene_add_rates(&s, rate);
        const double expected[6] = {T[k], 20.0, T[k], 0.0, fabs(10.0 * u[k]), 0.0};
        for (int q = 0; q < 6; q++) assert_close(rate[q] - 100.0, expected[q], 1e-13);
    }
}

/* ---- edges on vertices ---- */

TEST(an_edge_may_touch_a_vertex_but_not_start_with_it_inside)
{
    CLEANUP(scene_close) scene s;
    open_side(&s, &roof, 0.25, -0.9 * penetration_tolerance, 0.0);
    assert_ok(automaton_check_start(&s.c, 0.0, s.y));
    scene_close(&s);
    open_side(&s, &roof, 0.25, -0.125, 0.0);
    assert_int_equal(automaton_check_start(&s.c, 0.0, s.y), DEM_ERROR_MODEL);
    assert_message_parts("vertex * (0, 0) m * obstacle 0 * 0.125 m inside * penetration tolerance * 1e-06 m");
}

/* The point of a needle is above the body's node 3, nodes and vertices are in the open. */
TEST(an_obstacle_may_not_start_through_an_edge)
{
    const double points[6] = {0.45, -4.0, 0.5, 3.0, 0.55, -4.0};
    const dem_obstacle needle = {.struct_size = sizeof(dem_obstacle), .n_points = 3, .points = points};
    CLEANUP(scene_close) scene s;
    open_side(&s, &needle, 0.0, 0.0, 0.0);
    assert_int_equal(automaton_check_start(&s.c, 0.0, s.y), DEM_ERROR_MODEL);
    assert_message_parts("obstacle 0 * across the edge between nodes 1 and 2 * penetration tolerance * 1e-06 m");
    scene_close(&s);
    open_side(&s, &needle, 0.0, 3.0 - 1e-7, 0.0); /* by less than the penetration tolerance */
    assert_ok(automaton_check_start(&s.c, 0.0, s.y));
}

/* At rest, sliding and falling on the ridge; and a nanometre above it. */
TEST(at_the_start_a_touching_edge_is_in_contact)
{
    const double u[4] = {0.0, 0.5, -0.5, 0.5}, v[4] = {0.0, 0.0, -1.0, 0.0}, y[4] = {0.0, 0.0, 0.0, 1e-9};
    for (int k = 0; k < 4; k++) {
        CLEANUP(scene_close) scene s;
        open_side(&s, &rough_roof, 0.25, y[k], 0.0);
        launch(&s, u[k], v[k]);
        assert_ok(scene_take_up(&s));
        const contact_candidate *edge = &s.c.set.list[scene_edge(&s, 0, 1)];
        assert_int_equal(edge->n_closed, k < 3);
        assert_int_equal(s.n_events, k < 3);
        if (k < 3)
            check_event(&s, 0, k < 2 ? DEM_EVENT_CLOSE : DEM_EVENT_IMPACT,
                        k == 1 ? DEM_CONTACT_SLIP : DEM_CONTACT_STICK);
        if (k == 1) assert_int_equal(edge->closed[0].slide, 1);
    }
}

/* Ridges at s = 1/4 and 3/4 share the weight of both nodes. */
TEST(at_the_start_an_edge_may_touch_two_vertices)
{
    const double points[10] = {-4.0, -4.0, 0.0, 0.0, 0.5, -0.5, 1.0, 0.0, 5.0, -4.0}, mass[3] = {2.0, 2.0, 2.0};
    const dem_obstacle ridges = {.struct_size = sizeof(dem_obstacle), .n_points = 5, .points = points};
    CLEANUP(scene_close) scene s;
    scene_open_triangle(&s, mass, -0.5, 0.0, &ridges, 1);
    assert_ok(scene_take_up(&s));
    const contact_candidate *edge = &s.c.set.list[scene_edge(&s, 0, 1)];
    assert_int_equal(edge->n_closed, 2);
    for (int q = 0; q < 2; q++) assert_close(edge->closed[q].force, 2.0 * g, 1e-12);
}

/* ---- what must not happen ---- */

TEST(events_that_change_nothing_end_the_run_after_a_while)
{
    CLEANUP(scene_close) scene s;
    open_scene(&s, 1, &half, 1);
    s.c.set.scene.rule.max_impacts = 2;
    assert_ok(scene_resolve(&s, 0.1));
    scene_put(&s, 0, 0.5, -penetration_tolerance, 0.0, -1.0); /* this one does */
    assert_ok(scene_resolve(&s, 0.2));
    assert_ok(scene_resolve(&s, 0.3));
    assert_ok(scene_resolve(&s, 0.4));
    assert_int_equal(scene_resolve(&s, 0.5), DEM_ERROR_CONTACT);
    assert_message_parts("2 contact events * t = 0.5 s");
    s.c.set.scene.rule.most_in_step = 4; /* where the step can be shorter, that counts */
    assert_ok(scene_resolve(&s, 0.6));
    assert_int_equal(scene_resolve(&s, 0.7), DEM_ERROR_CONTACT);
    assert_message_parts("4 contact events * t = 0.7 s");
}

static dem_status resolve_near(scene *s, dem_index k, double t)
{
    const event_listener listener = {scene_note, s};
    return automaton_resolve_near(&s->c, k, t, s->y, &listener);
}

/* Two nodes in the air, by turns. A change, or another step, lets a node begin anew. */
TEST(each_candidate_counts_its_own_events_that_change_nothing)
{
    CLEANUP(scene_close) scene s;
    open_scene(&s, 2, &half, 1);
    s.c.set.scene.rule.max_impacts = 3;
    scene_put(&s, 0, 0.5, 1.0, 0.0, -1.0);
    scene_put(&s, 1, -0.5, 1.0, 0.0, -1.0);
    for (int n = 0; n < 3; n++)
        for (dem_index k = 0; k < 2; k++) assert_ok(resolve_near(&s, k, 0.1));
    assert_int_equal(resolve_near(&s, 1, 0.1), DEM_ERROR_CONTACT);
    assert_message_parts("node 1 * 3 contact events in a row * nothing * t = 0.1 s");
    scene_put(&s, 0, 0.5, -penetration_tolerance, 0.0, -1.0);
    assert_ok(resolve_near(&s, 0, 0.2));
    assert_int_equal(s.n_impacts, 1);
    for (int n = 0; n < 3; n++) assert_ok(resolve_near(&s, 0, 0.2));
    assert_int_equal(resolve_near(&s, 0, 0.2), DEM_ERROR_CONTACT);
    s.c.set.step = 0.25;
    for (int n = 0; n < 3; n++) assert_ok(resolve_near(&s, 1, 0.3));
}

/* ---- the window ---- */

/* After an impact what would arrive within 0.1 s is reflected where it is; what comes later, or goes away, is not.
 * Without an impact nothing is. */
TEST(what_arrives_within_the_window_of_an_impact_is_reflected_with_it)
{
    for (int k = 0; k < 2; k++) {
        CLEANUP(scene_close) scene s;
        open_scene(&s, 3, &half, 1);
        s.c.set.scene.rule.window = 0.1;
        scene_put(&s, 0, 0.0, k == 0 ? -penetration_tolerance : 1.0, 0.0, -8.0);
        scene_put(&s, 1, 1.0, 0.099, 0.5, -1.0);
        scene_put(&s, 2, 2.0, 0.101, 0.5, -1.0);
        assert_ok(scene_resolve(&s, 0.25));
        scene_check(&s, 1, 1.0, 0.099, 0.5, k == 0 ? 0.5 : -1.0);
        scene_check(&s, 2, 2.0, 0.101, 0.5, -1.0);
        assert_int_equal(s.n_impacts, k == 0 ? 2 : 0);
        assert_int_equal(s.c.set.ledger.counts.early, k == 0 ? 1 : 0);
    }
}

TEST(an_edge_is_reflected_early_too)
{
    const dem_obstacle two[2] = {
        {.struct_size = sizeof(dem_obstacle), .n_points = 3, .points = roof_points, .restitution = 0.5},
        SIZED(dem_obstacle, .n_points = 2, .points = (double[]){-8.0, -4.0, -4.0, -4.0}, .restitution = 0.5)};
    const double x[8] = {-0.75, 0.099, 1.25, 0.099, 0.25, 1.0, -6.0, -4.0 - penetration_tolerance},
                 mass[4] = {2.0, 2.0, 2.0, 2.0};
    CLEANUP(scene_close) scene s;
    scene_open(&s, 4, x, mass, 1, (dem_index[]){0, 1, 2}, two, 2);
    s.c.set.scene.rule.window = 0.1;
    launch(&s, 0.0, -2.0);
    vec2_put(scene_v(&s), 1, (vec2){0.0, -0.5}); /* at s = 3/8 with 1.4375 m/s: there in 0.07 s */
    assert_ok(scene_resolve(&s, 0.25));
    const double J = 1.5 * 1.4375 / (0.5 * (0.625 * 0.625 + 0.375 * 0.375));
    scene_check(&s, 0, -0.75, 0.099, 0.0, -2.0 + 0.625 * J / 2.0);
    scene_check(&s, 1, 1.25, 0.099, 0.0, -0.5 + 0.375 * J / 2.0);
    assert_int_equal(s.c.set.ledger.counts.early, 1);
    assert_int_equal(s.c.set.ledger.counts.vertex_impacts, 1);
}

/* The node above the ridge nears it with 0.6 m/s and would be there in 0.083 s; it goes on with 8 m/s along, where the
 * roof falls away: it passes. Straight down it does not. */
TEST(what_passes_a_vertex_within_the_window_is_not_reflected)
{
    const dem_obstacle two[2] = {
        {.struct_size = sizeof(dem_obstacle), .n_points = 3, .points = roof_points, .restitution = 0.5},
        SIZED(dem_obstacle, .n_points = 2, .points = (double[]){-8.0, -4.0, -4.0, -4.0}, .restitution = 0.5)};
    for (int k = 0; k < 2; k++) {
        const double along = k == 0 ? 8.0 : 0.0;
        CLEANUP(scene_close) scene s;
        open_scene(&s, 2, two, 2);
        s.c.set.scene.rule.window = 0.1;
        scene_put(&s, 0, -6.0, -4.0 - penetration_tolerance, 0.0, -2.0);
        scene_put(&s, 1, 0.0, 0.05, along, -0.6);
        assert_ok(scene_resolve(&s, 0.25));
        scene_check(&s, 1, 0.0, 0.05, along, k == 0 ? -0.6 : 0.3);
        assert_int_equal(s.c.set.ledger.counts.early, k);
    }
}

/* The same three in any order, by both laws of friction: the same velocities, and the ledger closes. Of 2 kg that near
 * with (3, -4) m/s, eta = 1/2 and mu = 1/4 leave 1.5 m/s along by Coulomb's law and 0.75 by the paper's. */
TEST(an_early_reflection_takes_what_an_impact_takes_in_any_order)
{
    static const double height[3] = {-1e-6, 0.3, 0.35};
    for (int k = 0; k < 6; k++) {
        const bool paper = k >= 3;
        const dem_obstacle gritty =
            SIZED(dem_obstacle, .n_points = 2, .points = floor_points, .restitution = 0.5, .friction = 0.25,
                  .friction_law = paper ? DEM_FRICTION_PAPER : DEM_FRICTION_COULOMB);
        CLEANUP(scene_close) scene s;
        open_scene(&s, 3, &gritty, 1);
        s.c.set.scene.rule.window = 0.1;
        for (dem_index i = 0; i < 3; i++) scene_put(&s, i, (double)i, height[(i + k) % 3], 3.0, -4.0);
        assert_ok(scene_resolve(&s, 0.25));
        const double u = paper ? 0.75 : 1.5;
        for (dem_index i = 0; i < 3; i++) {
            const double y = height[(i + k) % 3];
            scene_check(&s, i, (double)i, fmax(y, 0.0), u, 2.0);
            assert_close(s.impacts[i].energy, 25.0 - u * u - 4.0, 1e-13);
        }
        assert_close(exact_sum_value(&s.c.set.ledger.impact), 3.0 * (25.0 - u * u - 4.0), 1e-12);
        assert_close(exact_sum_value(&s.c.set.ledger.impulse[1]), 3.0 * 12.0, 1e-13);
        assert_close(exact_sum_value(&s.c.set.ledger.friction_impulse[0]), 3.0 * 2.0 * (u - 3.0), 1e-13);
        assert_close(exact_sum_value(&s.c.set.ledger.projection), 2.0 * g * penetration_tolerance, 1e-15);
        assert_int_equal(s.c.set.ledger.counts.early, 2);
    }
}

/* An edge rests on the ridge. Its first node nears a floor below it within the window: it is left to the group. */
TEST(what_shares_a_node_with_a_lasting_contact_is_not_reflected_early)
{
    const double low_points[4] = {-3.0, -0.05, -0.5, -0.05};
    const dem_obstacle two[3] = {
        {.struct_size = sizeof(dem_obstacle), .n_points = 3, .points = roof_points, .restitution = 0.0},
        SIZED(dem_obstacle, .n_points = 2, .points = (double[]){-8.0, -4.0, -4.0, -4.0}, .restitution = 0.5),
        {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = low_points, .restitution = 0.5}};
    const double x[8] = {-1.0, 0.0, 1.0, 0.0, 0.0, 1.0, -6.0, 0.0}, mass[4] = {2.0, 2.0, 2.0, 2.0};
    for (int k = 0; k < 2; k++) {
        CLEANUP(scene_close) scene s;
        scene_open(&s, 4, x, mass, 1, (dem_index[]){0, 1, 2}, two, 3);
        s.c.set.scene.rule.window = 0.1;
        if (k == 0) {
            launch(&s, 0.0, 0.0);
            assert_ok(scene_take_up(&s));
            assert_int_equal(s.c.set.list[scene_edge(&s, 0, 1)].n_closed, 1);
        }
        vec2_put(scene_v(&s), 0, (vec2){0.0, -1.0});
        vec2_put(scene_v(&s), 1, (vec2){0.0, 1.0});
        scene_put(&s, 3, -6.0, -4.0 - penetration_tolerance, 0.0, -1.0);
        s.n_impacts = 0;
        assert_ok(scene_resolve(&s, 0.25));
        assert_int_equal(s.c.set.ledger.counts.early, k == 0 ? 0 : 1);
        assert_close(scene_v(&s)[1], k == 0 ? -1.0 : 0.5, 1e-14);
    }
}
