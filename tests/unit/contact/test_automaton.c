/* SPDX-License-Identifier: BSD-3-Clause */
/* automaton.c: every reset of the automaton on its own, without an integrator, and the books kept of it. Numbers are
 * worked out by hand; tolerances of 1e-15 to 1e-12 are rounding unless said otherwise. */
#include "unit/scene.h"

enum { most_nodes = SCENE_NODES };

static const double penetration_tolerance = scene_skin, g = scene_gravity;

/* n nodes of 2 kg, each a body of its own, somewhere above. */
static void open_scene(scene *s, dem_index n, const dem_obstacle *obstacles, dem_index n_obstacles)
{
    const double x[6] = {0.0, 5.0, 1.0, 5.0, 2.0, 5.0}, mass[3] = {2.0, 2.0, 2.0};
    scene_open(s, n, x, mass, 0, NULL, obstacles, n_obstacles);
}

static const double floor_points[4] = {-4.0, 0.0, 4.0, 0.0}, wall_points[4] = {2.0, -1.0, 2.0, 3.0};
static const dem_obstacle half = {.n_points = 2, .points = floor_points, .restitution = 0.5},
                          plastic = {.n_points = 2, .points = floor_points, .restitution = 0.0};

/* ---- the initial state ---- */

static void touching_is_admissible_and_deeper_than_the_skin_is_not(void **state)
{
    scene s;
    (void)state;
    open_scene(&s, 2, &half, 1);
    scene_put(&s, 0, 0.5, 0.0, 0.0, 0.0);
    scene_put(&s, 1, 1.5, -penetration_tolerance, 0.0, 0.0);
    assert_ok(automaton_check_start(&s.c, s.y));
    scene_put(&s, 1, 1.5, -0.25, 0.0, 0.0);
    assert_int_equal(automaton_check_start(&s.c, s.y), DEM_ERROR_MODEL);
    assert_string_equal(
        dem_status_message(),
        "node 1 at (1.5, -0.25) m starts 0.25 m inside obstacle 0, deeper than the penetration tolerance of 1e-06 m");
    scene_close(&s);
}

static void at_the_start_touching_is_enough_for_a_contact(void **state)
{
    scene s;
    dem_contact list[2 * most_nodes];
    (void)state;
    open_scene(&s, 3, &half, 1);
    scene_put(&s, 0, 0.0, 0.0, 3.0, 0.0);
    scene_put(&s, 1, 1.0, 0.0, 0.0, -2.0);
    scene_put(&s, 2, 2.0, 1e-9, 0.0, -2.0);
    assert_ok(scene_take_up(&s));
    scene_check(&s, 0, 0.0, 0.0, 3.0, 0.0);
    scene_check(&s, 1, 1.0, 0.0, 0.0, 1.0);
    scene_check(&s, 2, 2.0, 1e-9, 0.0, -2.0);
    assert_int_equal(automaton_list(&s.c, s.y, list), 1);
    assert_int_equal(list[0].nodes[0], 0);
    assert_int_equal(list[0].state, DEM_CONTACT_SLIP);
    assert_close(list[0].force, 2.0 * g, 0.0);
    assert_int_equal(s.n_impacts, 1); /* the resting node's velocity did not change */
    assert_int_equal(s.c.set.ledger.counts.closings, 1);
    scene_close(&s);
}

static void a_node_that_leaves_the_surface_at_the_start_is_free(void **state)
{
    scene s;
    (void)state;
    open_scene(&s, 1, &half, 1);
    scene_put(&s, 0, 0.0, 0.0, 0.0, 0.5);
    assert_ok(scene_take_up(&s));
    scene_check(&s, 0, 0.0, 0.0, 0.0, 0.5);
    assert_int_equal(s.c.set.list[0].n_closed, 0);
    assert_int_equal(s.n_impacts, 0);
    scene_close(&s);
}

/* ---- impacts ---- */

/* 2 kg at (3, -4) m/s on a floor of eta = 1/2: rises with 2 m/s, the floor gives 2 * 6 N s and takes 2/2 (16 - 4) =
 * 12 J; the lift by the penetration tolerance costs 2 g penetration tolerance. */
static void an_impact_is_reflected_reported_and_booked(void **state)
{
    scene s;
    (void)state;
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
    assert_close(s.c.set.ledger.impact, 12.0, 1e-14);
    assert_close(s.c.set.ledger.impulse[0], 0.0, 0.0);
    assert_close(s.c.set.ledger.impulse[1], 12.0, 1e-14);
    assert_close(s.c.set.ledger.projection, 2.0 * g * penetration_tolerance,
                 1e-14); /* a difference of energies of order 20 m g */
    assert_int_equal(s.c.set.ledger.counts.impacts, 1);
    assert_int_equal(s.c.set.ledger.counts.closings, 0);
    scene_close(&s);
}

static void a_plastic_impact_becomes_a_contact_with_the_weight_as_its_force(void **state)
{
    scene s;
    dem_contact list[2];
    (void)state;
    open_scene(&s, 1, &plastic, 1);
    scene_put(&s, 0, 0.25, -penetration_tolerance, 3.0, -4.0);
    assert_ok(scene_resolve(&s, 0.125));
    scene_check(&s, 0, 0.25, 0.0, 3.0, 0.0);
    assert_int_not_equal(s.impacts[0].state, DEM_CONTACT_FREE);
    assert_int_equal(s.c.set.ledger.counts.closings, 1);
    assert_int_equal(automaton_list(&s.c, s.y, list), 1);
    assert_int_equal(list[0].n_nodes, 1);
    assert_int_equal(list[0].obstacle, 0);
    assert_int_equal(list[0].segment, 0);
    assert_close(list[0].weights[0], 1.0, 0.0);
    assert_close(list[0].normal[1], 1.0, 0.0);
    assert_close(list[0].force, 2.0 * g, 0.0);
    scene_close(&s);
}

static void a_node_not_yet_as_deep_as_the_skin_is_left_alone(void **state)
{
    scene s;
    (void)state;
    open_scene(&s, 1, &half, 1);
    scene_put(&s, 0, 0.25, -0.98 * penetration_tolerance, 3.0, -4.0);
    assert_ok(scene_resolve(&s, 0.0));
    scene_check(&s, 0, 0.25, -0.98 * penetration_tolerance, 3.0, -4.0);
    assert_int_equal(s.n_impacts, 0);
    scene_close(&s);
}

static void land(double eta, double speed, double rest_speed, int closed)
{
    const dem_obstacle plane = {.n_points = 2, .points = floor_points, .restitution = eta};
    scene s;
    open_scene(&s, 1, &plane, 1);
    s.c.set.scene.rule.rest_speed = rest_speed;
    scene_put(&s, 0, 0.25, -penetration_tolerance, 1.0, -speed / eta);
    assert_ok(scene_resolve(&s, 0.0));
    assert_int_equal(s.impacts[0].state != DEM_CONTACT_FREE, closed);
    scene_check(&s, 0, 0.25, 0.0, 1.0, closed ? 0.0 : speed);
    scene_close(&s);
}

/* By the rule what rises no higher than the position error; or than twice the hop that impacts a penetration tolerance
 * deep keep up, penetration tolerance eta^2/(1 - eta^2), a third of it at eta = 1/2 and 1e-4 of it at 1/100. And what
 * is not faster than the speed given, which takes nothing from that. */
static void a_rebound_too_slow_becomes_a_contact(void **state)
{
    const double error = sqrt(2.0 * g * 1e-9), kept_up = sqrt(2.0 * g * 2.0 * penetration_tolerance / 3.0);
    (void)state;
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

static void a_contact_does_not_last_where_nothing_presses(void **state)
{
    const double pull[4] = {0.1, 0.1, 0.0, 0.0}, rest_speed[4] = {0.0, 0.1, 0.0, 0.1};
    (void)state;
    for (int k = 0; k < 4; k++) {
        scene s;
        open_scene(&s, 1, &plastic, 1);
        s.c.set.scene.rule.load.gravity[1] = pull[k];
        s.c.set.scene.rule.rest_speed = rest_speed[k];
        scene_put(&s, 0, 0.25, -penetration_tolerance, 1.0, -1.0);
        assert_ok(scene_resolve(&s, 0.0));
        scene_check(&s, 0, 0.25, 0.0, 1.0, 0.0);
        assert_int_equal(s.impacts[0].state, DEM_CONTACT_FREE);
        assert_int_equal(s.c.set.list[0].n_closed, 0);
        scene_close(&s);
    }
}

static void simultaneous_hits_are_taken_in_one_batch_in_the_order_of_nodes(void **state)
{
    scene s;
    (void)state;
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
    assert_close(s.c.set.ledger.impulse[1], 2.0 * 1.5 * (1.0 + 2.0 + 3.0), 1e-14);
    scene_close(&s);
}

static void an_observer_that_stops_is_heard(void **state)
{
    scene s;
    (void)state;
    open_scene(&s, 1, &half, 1);
    s.value = DEM_STOPPED;
    scene_put(&s, 0, 0.25, -penetration_tolerance, 3.0, -4.0);
    assert_int_equal(scene_resolve(&s, 0.0), DEM_STOPPED);
    scene_close(&s);
}

/* Floor of eta 1/2 and wall of eta 1/4 as two obstacles; the wall's solid is on its right, x > 2. */
static void in_a_corner_each_obstacle_gets_the_impulse_along_its_normal(void **state)
{
    const dem_obstacle corner[2] = {{.n_points = 2, .points = wall_points, .restitution = 0.25},
                                    {.n_points = 2, .points = floor_points, .restitution = 0.5}};
    scene s;
    (void)state;
    open_scene(&s, 1, corner, 2);
    scene_put(&s, 0, 2.0 + penetration_tolerance, -penetration_tolerance, 4.0, -3.0);
    assert_ok(scene_resolve(&s, 0.0));
    scene_check(&s, 0, 2.0, 0.0, -1.0, 1.5);
    assert_close(s.c.set.ledger.impulse[0], -2.0 * 5.0, 1e-14);
    assert_close(s.c.set.ledger.impulse[1], 0.0, 1e-14);
    assert_close(s.c.set.ledger.impulse[2], 0.0, 1e-14);
    assert_close(s.c.set.ledger.impulse[3], 2.0 * 4.5, 1e-14);
    assert_int_equal(s.n_impacts, 1);
    assert_int_equal(s.impacts[0].obstacle, 0); /* approached faster */
    assert_close(s.c.set.ledger.impact, 25.0 - 1.0 - 2.25, 1e-13);
    scene_close(&s);
}

/* ---- lasting contacts ---- */

/* Node 0 on the floor, node 1 above it on a spring of 100 N and 1 m; 2 kg each. */
static void open_pair(scene *s)
{
    const double x[4] = {0.0, 0.0, 0.0, 1.0}, mass[2] = {2.0, 2.0};
    const dem_index ends[2] = {0, 1};
    dem_lattice lattice;
    support_lattice(&lattice, 2, x, mass, 1, ends, 1.0, 100.0, NULL);
    scene_start(s, &lattice, &plastic, 1);
    dem_lattice_free(&lattice);
    scene_put(s, 0, 0.0, 0.0, 0.5, 0.0);
    scene_put(s, 1, 0.0, 1.0, 0.5, 2.0);
    assert_ok(scene_take_up(s));
    assert_int_equal(s->c.set.list[0].n_closed, 1);
}

static void a_contact_that_would_have_to_pull_lets_go_and_changes_no_velocity(void **state)
{
    scene s;
    (void)state;
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
    scene_close(&s);
}

/* What the books add up: 20 N of weight less what the spring takes, 100 (y - 1); nothing of it is friction. */
static void a_followed_step_refreshes_the_force_and_tells_its_rate(void **state)
{
    scene s;
    double a[4] = {0.0, -g, 0.0, -g}, rate[6] = {0.0};
    scene_flight f;
    (void)state;
    open_pair(&s);
    scene_put(&s, 1, 0.0, 1.19, 0.5, 2.0);
    a[1] += 19.0 / 2.0;
    scene_fly(&s, (vec2){0.0, 0.0}, 0.0, 0.01, &f);
    automaton_end_step(&s.c, &f.path, s.y);
    assert_close(s.c.set.list[0].closed[0].force, 1.0, 1e-13);
    automaton_constrain(&s.c, s.y, a);
    automaton_add_rates(&s.c, s.y, rate);
    const double expected[6] = {0.0, 1.0, 0.0, 0.0, 0.0, 0.0};
    for (int k = 0; k < 6; k++) assert_close(rate[k], expected[k], 1e-13);
    scene_close(&s);
}

static void closed_contacts_hold_the_acceleration_along_their_normals(void **state)
{
    const double slope_points[6] = {-2.0, 2.0, 0.0, 0.0, 2.0, 2.0}; /* a groove of 90 degrees */
    const dem_obstacle groove = {.n_points = 3, .points = slope_points, .restitution = 0.0};
    scene s;
    (void)state;
    open_scene(&s, 3, &groove, 1);
    scene_put(&s, 0, 0.5, 3.0, 0.0, 0.0);
    scene_put(&s, 1, 1.0, 1.0, 0.0, 0.0);
    scene_put(&s, 2, 0.0, 0.0, 0.0, 0.0);
    assert_ok(scene_take_up(&s));
    double a[6] = {1.0, -g, 1.0, -g, 1.0, -g};
    automaton_constrain(&s.c, s.y, a);
    const double expected[6] = {1.0, -g, 0.5 * (1.0 - g), 0.5 * (1.0 - g), 0.0, 0.0};
    for (int k = 0; k < 6; k++) assert_close(a[k], expected[k], 1e-14);
    assert_int_equal(s.c.set.list[2].n_closed, 2);
    assert_true(s.c.set.list[2].closed[0].held && s.c.set.list[2].closed[1].held);
    scene_close(&s);
}

static void contacts_are_listed_in_the_order_of_nodes(void **state)
{
    const double slope_points[6] = {-2.0, 2.0, 0.0, 0.0, 2.0, 2.0};
    const dem_obstacle groove = {.n_points = 3, .points = slope_points, .restitution = 0.0};
    dem_contact list[2 * most_nodes];
    scene s;
    (void)state;
    open_scene(&s, 3, &groove, 1);
    scene_put(&s, 0, 0.0, 0.0, 0.0, 0.0);
    scene_put(&s, 1, 0.5, 3.0, 0.0, 0.0);
    scene_put(&s, 2, -1.0, 1.0, 0.0, 0.0);
    assert_ok(scene_take_up(&s));
    assert_int_equal(automaton_list(&s.c, s.y, list), 3);
    assert_int_equal(list[0].nodes[0], 0);
    assert_int_equal(list[1].nodes[0], 0);
    assert_int_equal(list[0].segment + list[1].segment, 1);
    assert_int_equal(list[2].nodes[0], 2);
    assert_int_equal(list[2].segment, 0);
    for (int k = 0; k < 3; k++) assert_close(list[k].force, 2.0 * g * sqrt(0.5), 1e-13);
    scene_close(&s);
}

/* With gravity along (1, -1) the right flank alone is pressed; along (1, 1)/2 none is, and what is left of the pair
 * goes too. */
static void a_held_node_lets_go_of_the_wall_that_would_pull(void **state)
{
    const double slope_points[6] = {-2.0, 2.0, 0.0, 0.0, 2.0, 2.0};
    const dem_obstacle groove = {.n_points = 3, .points = slope_points, .restitution = 0.0};
    scene s;
    (void)state;
    open_scene(&s, 1, &groove, 1);
    scene_put(&s, 0, 0.0, 0.0, 0.0, 0.0);
    assert_ok(scene_take_up(&s));
    assert_int_equal(s.c.set.list[0].n_closed, 2);
    s.c.set.scene.rule.load.gravity[0] = 1.1 * g;
    assert_ok(scene_resolve(&s, 0.1));
    assert_int_equal(s.c.set.list[0].n_closed, 1);
    assert_int_equal(s.c.set.list[0].closed[0].feature, 1);
    assert_false(s.c.set.list[0].closed[0].held);
    assert_int_equal(s.c.set.list[0].closed[0].slide, 1);
    assert_int_equal(s.c.set.ledger.counts.releases, 1);
    s.c.set.scene.rule.load.gravity[0] = 0.0;
    s.c.set.scene.rule.load.gravity[1] = g;
    assert_ok(scene_resolve(&s, 0.2));
    assert_int_equal(s.c.set.list[0].n_closed, 0);
    assert_int_equal(s.c.set.ledger.counts.releases, 2);
    scene_close(&s);
}

/* At the bottom of the groove, up its right flank: gravity's part along it, g sin 45, brings back what is slower than
 * sqrt(2 g sin 45 position_error), and that is at rest. */
static void a_corner_holds_only_what_is_at_rest_in_it(void **state)
{
    const double slope_points[6] = {-2.0, 2.0, 0.0, 0.0, 2.0, 2.0}, root = sqrt(0.5);
    const double limit = sqrt(2.0 * g * root * 1e-9), speed[2] = {0.99 * limit, 1.01 * limit};
    const dem_obstacle groove = {.n_points = 3, .points = slope_points, .restitution = 0.0};
    (void)state;
    for (int k = 0; k < 2; k++) {
        scene s;
        const double u = k == 0 ? 0.0 : root * speed[k];
        open_scene(&s, 1, &groove, 1);
        scene_put(&s, 0, 0.0, 0.0, root * speed[k], root * speed[k]);
        assert_ok(scene_take_up(&s));
        assert_int_equal(s.c.set.list[0].n_closed, 2 - k);
        if (k == 1) assert_int_equal(s.c.set.list[0].closed[0].feature, 1);
        scene_check(&s, 0, 0.0, 0.0, u, u);
        scene_close(&s);
    }
}

static void a_closed_node_is_put_back_where_rounding_has_taken_it_from(void **state)
{
    scene s;
    (void)state;
    open_scene(&s, 1, &plastic, 1);
    scene_put(&s, 0, 0.5, 0.0, 1.0, 0.0);
    assert_ok(scene_take_up(&s));
    scene_put(&s, 0, 0.5, 1e-9, 1.0, 0.0);
    assert_ok(scene_resolve(&s, 0.1));
    scene_check(&s, 0, 0.5, 0.0, 1.0, 0.0);
    assert_close(s.y[1], 0.0, 0.0);
    assert_close(s.c.set.ledger.projection, -2.0 * g * 1e-9, 1e-20);
    assert_int_equal(s.n_impacts, 0);
    scene_close(&s);
}

/* ---- ends of segments ---- */

/* Level, then straight on, then down by 45 degrees at x = 2. */
static const double terrace_points[8] = {-4.0, 0.0, 0.0, 0.0, 2.0, 0.0, 4.0, -2.0};
static const dem_obstacle terrace = {.n_points = 4, .points = terrace_points, .restitution = 0.0};

static void slide(scene *s, const dem_obstacle *obstacle, double x, double u)
{
    open_scene(s, 1, obstacle, 1);
    scene_put(s, 0, x, 0.0, u, 0.0);
    assert_ok(scene_take_up(s));
    assert_int_equal(s->c.set.list[0].n_closed, 1);
}

static void a_sliding_node_glides_on_where_the_line_goes_on(void **state)
{
    scene s;
    (void)state;
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
    scene_close(&s);
}

static void a_sliding_node_flies_off_a_convex_bend_and_off_a_free_end(void **state)
{
    scene s;
    (void)state;
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
    scene_close(&s);
}

/* A rise by 30 degrees: the plastic impact leaves the part of the speed along it, u cos 30. */
static void a_sliding_node_takes_its_impact_at_a_concave_bend(void **state)
{
    const double cosine = sqrt(0.75), ramp_points[6] = {-4.0, 0.0, 0.0, 0.0, 2.0 * cosine, 1.0};
    const dem_obstacle ramp = {.n_points = 3, .points = ramp_points, .restitution = 0.0};
    scene s;
    (void)state;
    slide(&s, &ramp, -1.0, 2.0);
    scene_put(&s, 0, 1.01 * penetration_tolerance, 0.0, 2.0, 0.0);
    assert_ok(scene_resolve(&s, 0.1));
    assert_int_equal(s.n_impacts, 1);
    scene_check(&s, 0, 0.0, 0.0, 2.0 * cosine * cosine, 2.0 * cosine * 0.5);
    assert_int_equal(s.c.set.list[0].n_closed, 1);
    assert_int_equal(s.c.set.list[0].closed[0].feature, 1);
    assert_int_equal(s.c.set.ledger.counts.passings, 1);
    scene_close(&s);
}

static void another_obstacle_stops_a_sliding_node(void **state)
{
    const dem_obstacle corner[2] = {{.n_points = 2, .points = floor_points, .restitution = 0.0},
                                    {.n_points = 2, .points = wall_points, .restitution = 0.5}};
    scene s;
    (void)state;
    open_scene(&s, 1, corner, 2);
    scene_put(&s, 0, 1.0, 0.0, 3.0, 0.0);
    assert_ok(scene_take_up(&s));
    scene_put(&s, 0, 2.0 + penetration_tolerance, 0.0, 3.0, 0.0);
    assert_ok(scene_resolve(&s, 0.1));
    scene_check(&s, 0, 2.0, 0.0, -1.5, 0.0);
    assert_int_equal(s.c.set.list[0].n_closed, 1);
    assert_int_equal(s.c.set.list[0].closed[0].feature, 0);
    assert_close(s.c.set.ledger.impulse[2], -2.0 * 4.5, 1e-14);
    assert_close(s.c.set.ledger.impulse[1], 0.0, 1e-14);
    scene_close(&s);
}

/* ---- slip and stick ---- */

static const dem_obstacle rough = {
    .n_points = 2, .points = floor_points, .friction = 0.5, .friction_law = DEM_FRICTION_COULOMB};

static void check_event(const scene *s, int k, dem_event_kind kind, dem_contact_state state)
{
    assert_true(k < s->n_events);
    assert_int_equal(s->events[k].kind, kind);
    assert_int_equal(s->events[k].state, state);
}

/* On the rough floor with speed u. */
static void rub(scene *s, double u)
{
    open_scene(s, 1, &rough, 1);
    scene_put(s, 0, 0.5, 0.0, u, 0.0);
    assert_ok(scene_take_up(s));
    assert_int_equal(s->c.set.list[0].n_closed, 1);
    check_event(s, 0, DEM_EVENT_CLOSE, u == 0.0 ? DEM_CONTACT_STICK : DEM_CONTACT_SLIP);
    assert_int_equal(s->c.set.list[0].closed[0].slide, (u > 0.0) - (u < 0.0));
}

static void set_wind(scene *s, double a)
{
    s->c.set.scene.rule.load.gravity[0] = a;
}

/* mu = 1/2 holds a wind of up to g/2. */
static void a_sliding_node_stops_and_starts_again_when_it_is_driven(void **state)
{
    scene s;
    (void)state;
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
    scene_close(&s);
}

/* A wind of 0.6 g brings it back: it stops and goes on the other way at once. */
static void a_sliding_node_turns_back_where_friction_cannot_hold_it(void **state)
{
    (void)state;
    for (int k = -1; k <= 1; k += 2) {
        scene s;
        rub(&s, 0.5 * k);
        set_wind(&s, -0.6 * g * k);
        scene_put(&s, 0, 0.5, 0.0, -1e-6 * k, 0.0);
        assert_ok(scene_resolve(&s, 0.2));
        assert_int_equal(s.n_events, 2);
        check_event(&s, 1, DEM_EVENT_STICK, DEM_CONTACT_SLIP);
        scene_check(&s, 0, 0.5, 0.0, 0.0, 0.0);
        assert_int_equal(s.c.set.list[0].closed[0].slide, -k);
        assert_close(s.c.set.list[0].closed[0].friction, 10.0 * k, 1e-14);
        scene_close(&s);
    }
}

/* What is not pressed any more goes, whatever else is due: no stick, no slip, and the velocity stays as it is. */
static void release_comes_before_stick_and_slip(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        scene s;
        rub(&s, k == 0 ? 0.5 : 0.0);
        set_wind(&s, 2.0 * g);
        s.c.set.scene.rule.load.gravity[1] = 0.1;
        scene_put(&s, 0, 0.5, 0.0, k == 0 ? -0.25 : 0.0, 0.0);
        assert_ok(scene_resolve(&s, 0.2));
        assert_int_equal(s.n_events, 2);
        check_event(&s, 1, DEM_EVENT_RELEASE, DEM_CONTACT_FREE);
        scene_check(&s, 0, 0.5, 0.0, k == 0 ? -0.25 : 0.0, 0.0);
        scene_close(&s);
    }
}

static void a_sticking_node_does_not_move_in_any_wind_it_withstands(void **state)
{
    scene s;
    double a[2] = {0.3 * g, -g};
    (void)state;
    rub(&s, 0.0);
    automaton_constrain(&s.c, s.y, a);
    assert_close(a[0], 0.0, 0.0);
    assert_close(a[1], 0.0, 0.0);
    scene_close(&s);
    a[0] = 0.3 * g;
    a[1] = -g;
    rub(&s, 1.0);
    automaton_constrain(&s.c, s.y, a);
    assert_close(a[0], 0.3 * g - 0.5 * g, 1e-14);
    assert_close(a[1], 0.0, 0.0);
    scene_close(&s);
}

/* N = 20 N and 10 N of friction, which take 10 W from 1 m/s, and nothing where it sticks. */
static void forces_and_friction_power_are_told_as_rates(void **state)
{
    const double u[3] = {1.0, -1.0, 0.0}, wind[3] = {0.0, 0.0, 0.3 * g}, T[3] = {-10.0, 10.0, -6.0};
    (void)state;
    for (int k = 0; k < 3; k++) {
        scene s;
        double a[2] = {wind[k], -g}, rate[6] = {100.0, 100.0, 100.0, 100.0, 100.0, 100.0};
        rub(&s, u[k]);
        if (k == 2)
            scene_put(&s, 0, 0.5, 0.0, 1e-3, 0.0); /* what sticks takes nothing, whatever is left of its speed */
        automaton_constrain(&s.c, s.y, a);
        automaton_add_rates(&s.c, s.y, rate);
        const double expected[6] = {T[k], 20.0, T[k], 0.0, fabs(10.0 * u[k]), 0.0};
        for (int q = 0; q < 6; q++) assert_close(rate[q] - 100.0, expected[q], 1e-13);
        scene_close(&s);
    }
}

/* ---- edges on vertices ---- */

static const double roof_points[6] = {-4.0, -4.0, 0.0, 0.0, 4.0, -4.0}; /* its ridge is in the origin */
static const dem_obstacle roof = {.n_points = 3, .points = roof_points, .restitution = 0.0};
static const dem_obstacle rough_roof = {
    .n_points = 3, .points = roof_points, .friction = 0.5, .friction_law = DEM_FRICTION_COULOMB};

/* A side of nodes 0, 1, 2, whose ends are 1 m from node 1 at (x, y) and higher by `bend`; node 3 above. */
static void open_side(scene *s, const dem_obstacle *obstacle, double x, double y, double bend)
{
    const double at[8] = {x - 1.0, y + bend, x, y, x + 1.0, y + bend, x, y + 1.0}, mass[4] = {1.0, 3.0, 2.0, 2.0};
    const dem_index corners[6] = {0, 1, 3, 1, 2, 3};
    scene_open(s, 4, at, mass, 2, corners, obstacle, 1);
}

static void launch(scene *s, double u, double v)
{
    for (dem_index i = 0; i < s->model->lattice.n_nodes; i++) vec2_put(scene_v(s), i, (vec2){u, v});
}

static void an_edge_may_touch_a_vertex_but_not_start_with_it_inside(void **state)
{
    scene s;
    (void)state;
    open_side(&s, &roof, 0.25, -0.9 * penetration_tolerance, 0.0);
    assert_ok(automaton_check_start(&s.c, s.y));
    scene_close(&s);
    open_side(&s, &roof, 0.25, -0.125, 0.0);
    assert_int_equal(automaton_check_start(&s.c, s.y), DEM_ERROR_MODEL);
    assert_string_equal(dem_status_message(), "the vertex at (0, 0) m of obstacle 0 starts 0.125 m inside the body, "
                                              "deeper than the penetration tolerance of 1e-06 m");
    scene_close(&s);
}

/* At rest, sliding and falling on the ridge; and a nanometre above it. */
static void at_the_start_a_touching_edge_is_in_contact(void **state)
{
    const double u[4] = {0.0, 0.5, -0.5, 0.5}, v[4] = {0.0, 0.0, -1.0, 0.0}, y[4] = {0.0, 0.0, 0.0, 1e-9};
    (void)state;
    for (int k = 0; k < 4; k++) {
        scene s;
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
        scene_close(&s);
    }
}

/* Ridges at s = 1/4 and 3/4 share the weight of both nodes. */
static void at_the_start_an_edge_may_touch_two_vertices(void **state)
{
    const double points[10] = {-4.0, -4.0, 0.0, 0.0, 0.5, -0.5, 1.0, 0.0, 5.0, -4.0}, mass[3] = {2.0, 2.0, 2.0};
    const dem_obstacle ridges = {.n_points = 5, .points = points};
    scene s;
    (void)state;
    scene_open_triangle(&s, mass, -0.5, 0.0, &ridges, 1);
    assert_ok(scene_take_up(&s));
    const contact_candidate *edge = &s.c.set.list[scene_edge(&s, 0, 1)];
    assert_int_equal(edge->n_closed, 2);
    for (int q = 0; q < 2; q++) assert_close(edge->closed[q].force, 2.0 * g, 1e-12);
    scene_close(&s);
}

/* The ridge under 3/4 of edge 0-1, of masses 1 and 3: W = 1/16 + 9/48 = 1/4, so that N = 40 N; mu = 1/2. A wind of
 * 0.6 g drives the point against friction with 0.6 g/W = 24 N. */
static void an_edge_slides_stops_and_slides_on_a_vertex(void **state)
{
    scene s;
    double rate[6] = {0.0};
    (void)state;
    open_side(&s, &rough_roof, 0.25, 0.0, 0.0);
    launch(&s, 0.5, 0.0);
    assert_ok(scene_take_up(&s));
    const contact_point *point = &s.c.set.list[scene_edge(&s, 0, 1)].closed[0];
    assert_close(point->force, 40.0, 1e-13);
    assert_close(point->friction, -20.0, 1e-13);
    automaton_add_rates(&s.c, s.y, rate);
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
    s.c.set.scene.rule.load.gravity[1] = 0.1;
    assert_ok(scene_resolve(&s, 0.4));
    check_event(&s, 3, DEM_EVENT_RELEASE, DEM_CONTACT_FREE);
    assert_int_equal(s.n_events, 4);
    scene_close(&s);
}

/* The edge 0-1 on the ridge, 30 penetration tolerances above it with 1 mm/s upwards at node 1: back it is put, and
 * slides on. Less than a quarter of the penetration tolerance is left alone. P has the mass 1/W = 4 kg and goes up
 * with 3/4 mm/s. */
static void a_closed_edge_that_has_opened_is_put_back(void **state)
{
    scene s;
    (void)state;
    open_side(&s, &rough_roof, 0.25, 0.0, 0.0);
    launch(&s, 0.5, 0.0);
    assert_ok(scene_take_up(&s));
    for (dem_index i = 0; i < 2; i++) s.y[2 * i + 1] = 0.2 * penetration_tolerance;
    scene_v(&s)[3] = 1e-3;
    assert_false(automaton_project(&s.c, 0.1, s.y));
    assert_close(s.y[1], 0.2 * penetration_tolerance, 0.0);
    assert_close(scene_v(&s)[3], 1e-3, 0.0);
    for (dem_index i = 0; i < 2; i++) s.y[2 * i + 1] = 30.0 * penetration_tolerance;
    assert_true(automaton_project(&s.c, 0.1, s.y));
    assert_close(0.25 * s.y[1] + 0.75 * s.y[3], 0.0, 1e-9 * penetration_tolerance);
    assert_close(0.25 * scene_v(&s)[1] + 0.75 * scene_v(&s)[3], 0.0, 1e-15);
    assert_close(scene_v(&s)[0], 0.5, 1e-7);
    assert_int_equal(s.c.set.list[scene_edge(&s, 0, 1)].n_closed, 1);
    const contact_ledger *books = &s.c.set.ledger;
    assert_close(books->impulse[1], -4.0 * 0.75e-3, 1e-8);
    assert_close(books->projection, -40.0 * 30.0 * penetration_tolerance, 1e-3 * penetration_tolerance);
    assert_close(books->impact, 0.5 * 4.0 * 0.75e-3 * 0.75e-3, 1e-9);
    assert_int_equal(s.n_events, 1);
    assert_close(s.c.set.straightened, 30.0 * penetration_tolerance, 1e-9 * penetration_tolerance);
    scene_close(&s);
}

/* The body goes right along edge 1-2 with u: the ridge, closed with that, comes over node 1 to edge 0-1. */
static void slide_on(scene *s, double bend, double u)
{
    open_side(s, &roof, 1.01 * penetration_tolerance, 1.01 * penetration_tolerance * bend, bend);
    launch(s, u, u * bend);
    assert_ok(contact_set_close(&s->c.set, scene_edge(s, 1, 2), (contact_point){.feature = 0, .slide = 1}));
}

static void a_vertex_glides_from_edge_to_edge_of_a_flat_side(void **state)
{
    scene s;
    (void)state;
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
    scene_close(&s);
}

/* The next edge falls away by 1/4 to the other side: nothing holds. */
static void a_vertex_leaves_a_convex_corner_of_the_body(void **state)
{
    scene s;
    (void)state;
    slide_on(&s, 0.25, 0.5);
    assert_ok(scene_resolve(&s, 0.1));
    assert_int_equal(s.n_events, 2);
    check_event(&s, 0, DEM_EVENT_PASS, DEM_CONTACT_SLIP);
    check_event(&s, 1, DEM_EVENT_RELEASE, DEM_CONTACT_FREE);
    scene_check(&s, 1, 0.0, 0.0, 0.5, 0.125);
    for (dem_index k = 4; k < s.c.set.n; k++) assert_int_equal(s.c.set.list[k].n_closed, 0);
    scene_close(&s);
}

/* The next edge, of normal n = (-1/4, 1)/L, stands in the way: the plastic impact takes v.n = -1/4/L from node 1, where
 * the vertex is, and the contact goes on with that edge. */
static void a_vertex_strikes_the_next_edge_where_the_body_bends_in(void **state)
{
    const double L = sqrt(1.0625), n[2] = {-0.25 / L, 1.0 / L}, vn = -0.25 / L;
    scene s;
    (void)state;
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
    scene_close(&s);
}

/* Too slow to rise above the position error: both edges hold the vertex, each with half the weight of node 1 over its
 * normal's cosine 1/L; and on, when that is pulled up. */
static void a_vertex_comes_to_rest_where_the_body_bends_in(void **state)
{
    const double L = sqrt(1.0625);
    scene s;
    (void)state;
    slide_on(&s, -0.25, 1e-5);
    assert_ok(scene_resolve(&s, 0.1));
    const contact_candidate *left = &s.c.set.list[scene_edge(&s, 0, 1)], *right = &s.c.set.list[scene_edge(&s, 1, 2)];
    assert_true(left->n_closed == 1 && left->closed[0].held);
    assert_true(right->n_closed == 1 && right->closed[0].held);
    scene_check(&s, 1, 0.0, 0.0, 0.0, 0.0);
    assert_close(left->closed[0].force, 15.0 * L, 3e-5); /* a penetration tolerance in 1 m of slope, of 15 N */
    assert_close(right->closed[0].force, 15.0 * L, 3e-5);
    s.c.set.scene.rule.load.gravity[1] = 0.1;
    assert_ok(scene_resolve(&s, 0.2));
    assert_int_equal(left->n_closed, 0);
    assert_int_equal(right->n_closed, 0);
    assert_int_equal(s.c.set.ledger.counts.releases, 2);
    scene_close(&s);
}

/* Held in a notch there is no friction; when the wind has lifted one side off, the vertex sticks to the other where it
 * is, at its start, and not where it stuck there before it slid into the notch. */
static void a_vertex_let_go_by_one_side_of_a_notch_sticks_to_the_other_where_it_is(void **state)
{
    (void)state;
    for (int k = 1; k < 8; k++) {
        scene s;
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
        scene_close(&s);
    }
}

/* The node strikes first, but it is the side that has come down on the ridge. */
static void a_flat_side_comes_down_on_an_apex_with_its_own_normal(void **state)
{
    const dem_obstacle springy = {.n_points = 3, .points = roof_points, .restitution = 0.5};
    const double x[3] = {0.0, 0.1 * penetration_tolerance, -0.1 * penetration_tolerance};
    (void)state;
    for (int k = 0; k < 3; k++) {
        scene s;
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
        scene_close(&s);
    }
}

/* ---- what must not happen ---- */

static void a_node_found_deep_inside_is_an_error(void **state)
{
    scene s;
    (void)state;
    open_scene(&s, 1, &half, 1);
    scene_put(&s, 0, 0.5, -0.125, 0.0, -1.0);
    assert_int_equal(scene_resolve(&s, 0.25), DEM_ERROR_CONTACT);
    assert_string_equal(dem_status_message(), "node 0 at (0.5, -0.125) m is 0.125 m inside obstacle 0 at t = 0.25 s");
    scene_close(&s);
}

static void too_many_changes_of_one_node_in_a_short_time_are_a_storm(void **state)
{
    scene s;
    (void)state;
    open_scene(&s, 1, &half, 1);
    s.c.set.scene.rule.max_impacts = 2;
    for (int k = 0; k < 3; k++) {
        scene_put(&s, 0, 0.5, -penetration_tolerance, 0.0, -1.0);
        assert_int_equal(scene_resolve(&s, 0.1 * (k + 1)), k < 2 ? DEM_OK : DEM_ERROR_CONTACT);
    }
    assert_string_equal(dem_status_message(),
                        "node 0 at (0.5, 0) m had more than 2 contact events within 0.5 s, at t = 0.3 s");
    scene_close(&s);
}

static void changes_further_apart_are_no_storm(void **state)
{
    scene s;
    (void)state;
    open_scene(&s, 1, &half, 1);
    s.c.set.scene.rule.max_impacts = 2;
    for (int k = 0; k < 20; k++) {
        scene_put(&s, 0, 0.5, -penetration_tolerance, 0.0, -1.0);
        assert_ok(scene_resolve(&s, 0.3 * (k + 1)));
    }
    scene_close(&s);
}

static void a_vertex_found_deep_inside_a_body_is_an_error(void **state)
{
    scene s;
    (void)state;
    open_side(&s, &roof, 0.25, -0.125, 0.0);
    assert_int_equal(scene_resolve(&s, 0.25), DEM_ERROR_CONTACT);
    assert_string_equal(dem_status_message(), "the vertex at (0, 0) m of obstacle 0 is 0.125 m inside the body, behind "
                                              "the edge from node 0 to 1, at t = 0.25 s");
    scene_close(&s);
}

static void too_many_changes_of_one_edge_in_a_short_time_are_a_storm(void **state)
{
    scene s;
    (void)state;
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
    scene_close(&s);
}

static void events_that_change_nothing_end_the_run_after_a_while(void **state)
{
    scene s;
    (void)state;
    open_scene(&s, 1, &half, 1);
    s.c.set.scene.rule.max_impacts = 2;
    assert_ok(scene_resolve(&s, 0.1));
    scene_put(&s, 0, 0.5, -penetration_tolerance, 0.0, -1.0); /* this one does */
    assert_ok(scene_resolve(&s, 0.2));
    assert_ok(scene_resolve(&s, 0.3));
    assert_ok(scene_resolve(&s, 0.4));
    assert_int_equal(scene_resolve(&s, 0.5), DEM_ERROR_CONTACT);
    assert_string_equal(dem_status_message(), "more than 2 contact events in a row changed nothing, at t = 0.5 s");
    scene_close(&s);
}

/* ---- the window ---- */

/* After an impact what would arrive within 0.1 s is reflected where it is; what comes later, or goes away, is not.
 * Without an impact nothing is. */
static void what_arrives_within_the_window_of_an_impact_is_reflected_with_it(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        scene s;
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
        scene_close(&s);
    }
}

static void an_edge_is_reflected_early_too(void **state)
{
    const dem_obstacle two[2] = {{.n_points = 3, .points = roof_points, .restitution = 0.5},
                                 {.n_points = 2, .points = (double[]){-8.0, -4.0, -4.0, -4.0}, .restitution = 0.5}};
    const double x[8] = {-0.75, 0.099, 1.25, 0.099, 0.25, 1.0, -6.0, -4.0 - penetration_tolerance},
                 mass[4] = {2.0, 2.0, 2.0, 2.0};
    scene s;
    (void)state;
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
    scene_close(&s);
}

/* The node above the ridge nears it with 0.6 m/s and would be there in 0.083 s; it goes on with 8 m/s along, where the
 * roof falls away: it passes. Straight down it does not. */
static void what_passes_a_vertex_within_the_window_is_not_reflected(void **state)
{
    const dem_obstacle two[2] = {{.n_points = 3, .points = roof_points, .restitution = 0.5},
                                 {.n_points = 2, .points = (double[]){-8.0, -4.0, -4.0, -4.0}, .restitution = 0.5}};
    (void)state;
    for (int k = 0; k < 2; k++) {
        const double along = k == 0 ? 8.0 : 0.0;
        scene s;
        open_scene(&s, 2, two, 2);
        s.c.set.scene.rule.window = 0.1;
        scene_put(&s, 0, -6.0, -4.0 - penetration_tolerance, 0.0, -2.0);
        scene_put(&s, 1, 0.0, 0.05, along, -0.6);
        assert_ok(scene_resolve(&s, 0.25));
        scene_check(&s, 1, 0.0, 0.05, along, k == 0 ? -0.6 : 0.3);
        assert_int_equal(s.c.set.ledger.counts.early, k);
        scene_close(&s);
    }
}

/* The same three in any order, by both laws of friction: the same velocities, and the books close. Of 2 kg that near
 * with (3, -4) m/s, eta = 1/2 and mu = 1/4 leave 1.5 m/s along by Coulomb's law and 0.75 by the paper's. */
static void an_early_reflection_takes_what_an_impact_takes_in_any_order(void **state)
{
    static const double height[3] = {-1e-6, 0.3, 0.35};
    (void)state;
    for (int k = 0; k < 6; k++) {
        const bool paper = k >= 3;
        const dem_obstacle gritty = {.n_points = 2,
                                     .points = floor_points,
                                     .restitution = 0.5,
                                     .friction = 0.25,
                                     .friction_law = paper ? DEM_FRICTION_PAPER : DEM_FRICTION_COULOMB};
        scene s;
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
        assert_close(s.c.set.ledger.impact, 3.0 * (25.0 - u * u - 4.0), 1e-12);
        assert_close(s.c.set.ledger.impulse[1], 3.0 * 12.0, 1e-13);
        assert_close(s.c.set.ledger.friction_impulse[0], 3.0 * 2.0 * (u - 3.0), 1e-13);
        assert_close(s.c.set.ledger.projection, 2.0 * g * penetration_tolerance, 1e-15);
        assert_int_equal(s.c.set.ledger.counts.early, 2);
        scene_close(&s);
    }
}

/* An edge rests on the ridge. Its first node nears a floor below it within the window: it is left to the group. */
static void what_shares_a_node_with_a_lasting_contact_is_not_reflected_early(void **state)
{
    const double low_points[4] = {-3.0, -0.05, -0.5, -0.05};
    const dem_obstacle two[3] = {{.n_points = 3, .points = roof_points, .restitution = 0.0},
                                 {.n_points = 2, .points = (double[]){-8.0, -4.0, -4.0, -4.0}, .restitution = 0.5},
                                 {.n_points = 2, .points = low_points, .restitution = 0.5}};
    const double x[8] = {-1.0, 0.0, 1.0, 0.0, 0.0, 1.0, -6.0, 0.0}, mass[4] = {2.0, 2.0, 2.0, 2.0};
    (void)state;
    for (int k = 0; k < 2; k++) {
        scene s;
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
        scene_close(&s);
    }
}

/* ---- behind a free end ---- */

static void a_node_that_comes_round_a_free_end_is_behind_until_it_is_in_front(void **state)
{
    scene s;
    double guards[CANDIDATE_ROOTS];
    scene_flight f;
    (void)state;
    open_scene(&s, 1, &half, 1);
    scene_put(&s, 0, -4.0, -0.5, 1.0, 2.0); /* right below the end: from in front to 0.5 m inside */
    assert_ok(scene_resolve(&s, 0.1));
    assert_int_equal(s.c.set.ledger.counts.behind, 1);
    assert_int_equal(s.c.set.list[0].behind[0], 0);
    automaton_root_functions(&s.c, 0.2, s.y, guards);
    assert_close(guards[0], 1.0, 0.0); /* it sleeps */
    scene_put(&s, 0, -3.0, -0.01, 1.0, 2.0);
    scene_fly(&s, (vec2){0.0, 0.0}, 0.0, 0.01, &f);
    automaton_end_step(&s.c, &f.path, s.y);
    assert_int_equal(s.c.set.ledger.counts.behind, 1);
    scene_put(&s, 0, -3.0, 0.01, 1.0, 2.0);
    scene_fly(&s, (vec2){0.0, 0.0}, 0.0, 0.01, &f);
    automaton_end_step(&s.c, &f.path, s.y);
    assert_int_equal(s.c.set.ledger.counts.behind, 0);
    assert_int_equal(s.c.set.list[0].behind[0], -1);
    assert_int_equal(s.n_impacts, 0);
    scene_close(&s);
}

/* ---- the check after a step ---- */

static void a_step_is_cut_at_the_first_contact_that_was_overlooked(void **state)
{
    scene s;
    scene_flight f;
    (void)state;
    open_scene(&s, 3, &half, 1);
    scene_put(&s, 0, 0.0, 3.0, 0.0, 0.0);
    scene_put(&s, 1, 1.0, 0.3, 0.0, -1.0);
    scene_put(&s, 2, 2.0, 0.2, 0.0, -1.0);
    scene_fly(&s, (vec2){0.0, 0.0}, 0.0, 1.0, &f);
    assert_true(automaton_check_step(&s.c, &f.path, false, f.scratch));
    assert_close(f.path.end, 0.2 + penetration_tolerance,
                 1e-13); /* to which times are located: 100 units of rounding */
    assert_int_equal(s.c.set.ledger.counts.late, 1);
    scene_close(&s);
}

/* To the resolution of times: it is that of the root. */
static void a_contact_at_the_root_that_ends_a_step_is_no_other(void **state)
{
    scene s;
    scene_flight f;
    (void)state;
    open_scene(&s, 1, &half, 1);
    scene_put(&s, 0, 1.0, 0.2, 0.0, -1.0);
    scene_fly(&s, (vec2){0.0, 0.0}, 0.0, 1.0, &f);
    f.path.end = (0.2 + penetration_tolerance) * (1.0 + 1e-14);
    const double end = f.path.end;
    assert_false(automaton_check_step(&s.c, &f.path, true, f.scratch));
    assert_close(f.path.end, end, 0.0);
    assert_true(automaton_check_step(&s.c, &f.path, false, f.scratch));
    assert_close(f.path.end, 0.2 + penetration_tolerance, 1e-13);
    f.path.end = 0.21;
    assert_true(automaton_check_step(&s.c, &f.path, true, f.scratch)); /* well before a root */
    assert_close(f.path.end, 0.2 + penetration_tolerance, 1e-13);
    scene_close(&s);
}

static void a_step_without_contacts_is_left_as_it_is(void **state)
{
    scene s;
    scene_flight f;
    (void)state;
    open_scene(&s, 1, &half, 1);
    scene_put(&s, 0, 0.0, 1.5, 0.0, -1.0);
    scene_fly(&s, (vec2){0.0, 0.0}, 0.0, 1.0, &f);
    assert_false(automaton_check_step(&s.c, &f.path, false, f.scratch));
    assert_close(f.path.end, 1.0, 0.0);
    assert_int_equal(s.c.set.ledger.counts.late, 0);
    scene_close(&s);
}

static void a_closed_contact_that_should_have_ended_cuts_the_step(void **state)
{
    scene s;
    scene_flight f;
    (void)state;
    slide(&s, &half, 3.0, 2.0);
    scene_fly(&s, (vec2){0.0, 0.0}, 0.0, 1.0, &f);
    assert_true(automaton_check_step(&s.c, &f.path, true, f.scratch)); /* though it ends at the root of another site */
    assert_close(f.path.end, 0.5 * (1.0 + penetration_tolerance), 1e-13);
    scene_close(&s);
}

/* What the guards at the end of the step have told, the check does not ask again: that all is quiet, or not. */
static void the_check_goes_by_the_guards_at_the_end_of_the_step(void **state)
{
    (void)state;
    for (int ends = 0; ends <= 1; ends++) {
        scene s;
        scene_flight f;
        double guards[CANDIDATE_ROOTS];
        slide(&s, &half, 3.0, ends ? 2.0 : 0.5);
        scene_fly(&s, (vec2){0.0, 0.0}, 0.0, 1.0, &f);
        automaton_root_functions(&s.c, 1.0, f.y1, guards);
        assert_int_equal(s.c.quiet, !ends);
        assert_int_equal(automaton_check_step(&s.c, &f.path, false, f.scratch), ends);
        if (ends) assert_close(f.path.end, 0.5 * (1.0 + penetration_tolerance), 1e-13);
        scene_close(&s);
    }
}

/* The first may reach the floor in a step of 0.01 s, the third is asleep. */
static void the_guards_of_all_sites_stand_one_after_the_other(void **state)
{
    scene s;
    double guards[3 * CANDIDATE_ROOTS];
    (void)state;
    open_scene(&s, 3, &half, 1);
    scene_put(&s, 0, 1.0, 0.25, 0.0, -20.0);
    scene_put(&s, 1, 3.5, 0.0, 0.0, 0.0);
    scene_put(&s, 2, 1.0, 0.75, 0.0, 0.0);
    assert_ok(scene_take_up(&s));
    for (int k = 0; k < 3; k++) s.c.set.list[k].clear = 0.0; /* else a lower bound would do for their gaps */
    automaton_root_functions(&s.c, 0.2, s.y, guards);
    const double expected[3 * CANDIDATE_ROOTS] = {0.25 + penetration_tolerance,
                                                  1.0,
                                                  1.0,
                                                  1.0,
                                                  1.0 + penetration_tolerance,
                                                  2.0 * g,
                                                  0.5 + penetration_tolerance,
                                                  1.0,
                                                  1.0,
                                                  1.0,
                                                  1.0,
                                                  1.0};
    for (int k = 0; k < 3 * CANDIDATE_ROOTS; k++) assert_close(guards[k], expected[k], 1e-15);
    scene_close(&s);
}

static void a_nearly_straight_concave_bend_moves_the_node_by_no_more_than_rounding(void **state)
{
    const double c = cos(0.3), s = sin(0.3), ox = 0.37, oy = 0.21, turn = 2e-9, t = 0.35;
    const double points[6] = {ox - 2.0 * c, oy - 2.0 * s, ox, oy, ox + 2.0 * (c - turn * s), oy + 2.0 * (s + turn * c)};
    const double x[2] = {ox + 0.5 * (c - turn * s), oy + 0.5 * (s + turn * c)}, v[2] = {-c, -s};
    support_run run;
    (void)state;
    support_point(&run, 1.0, x, v, points, 3, 0.0);
    const dem_state now = support_at(&run, t);
    const double along = (now.x[0] - ox) * c + (now.x[1] - oy) * s, lift = now.energy.projection;
    support_close(&run);
    assert_close(lift, 0.0, 1e-11);
    assert_close(along, 0.5 - t - 0.5 * 9.81 * s * t * t, 1e-8);
}

/* Above and behind the free end of a wall, 2.1 mm from it: 0.6 mm further down a node is inside the wall by its gap,
 * but has touched nothing. That goes unnoticed while nothing is near; at the start of the next step it is behind. */
static void what_goes_round_a_free_end_at_a_distance_is_behind_it(void **state)
{
    const double points[4] = {0.0, -1.0, 0.0, 0.0}, x[2] = {2e-3, 5e-4}, m = 1.0;
    const dem_obstacle wall = {.n_points = 2, .points = points, .restitution = 0.5};
    scene s;
    scene_flight f;
    (void)state;
    scene_open(&s, 1, x, &m, 0, NULL, &wall, 1);
    scene_put(&s, 0, x[0], x[1], 0.01, -0.06);
    assert_ok(scene_take_up(&s));
    s.c.set.list[0].inactive = false;
    for (int k = 0; k < 2; k++) {
        scene_fly(&s, (vec2){0.0, 0.0}, 0.01 * k, 0.01, &f);
        automaton_begin_step(&s.c, &f.path, f.scratch);
        assert_true(isinf(automaton_next_change(&s.c, &f.path, 0, f.path.t0, f.scratch)) != 0);
        assert_int_equal(s.c.set.list[0].behind[0], k - 1);
        memcpy(s.y, f.y1, sizeof s.y);
    }
    assert_int_equal(s.c.set.ledger.counts.behind, 1);
    assert_int_equal(s.n_events, 0);
    scene_close(&s);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(touching_is_admissible_and_deeper_than_the_skin_is_not),
    cmocka_unit_test(at_the_start_touching_is_enough_for_a_contact),
    cmocka_unit_test(a_node_that_leaves_the_surface_at_the_start_is_free),
    cmocka_unit_test(an_impact_is_reflected_reported_and_booked),
    cmocka_unit_test(a_plastic_impact_becomes_a_contact_with_the_weight_as_its_force),
    cmocka_unit_test(a_node_not_yet_as_deep_as_the_skin_is_left_alone),
    cmocka_unit_test(a_rebound_too_slow_becomes_a_contact),
    cmocka_unit_test(a_contact_does_not_last_where_nothing_presses),
    cmocka_unit_test(simultaneous_hits_are_taken_in_one_batch_in_the_order_of_nodes),
    cmocka_unit_test(an_observer_that_stops_is_heard),
    cmocka_unit_test(in_a_corner_each_obstacle_gets_the_impulse_along_its_normal),
    cmocka_unit_test(a_contact_that_would_have_to_pull_lets_go_and_changes_no_velocity),
    cmocka_unit_test(a_followed_step_refreshes_the_force_and_tells_its_rate),
    cmocka_unit_test(closed_contacts_hold_the_acceleration_along_their_normals),
    cmocka_unit_test(contacts_are_listed_in_the_order_of_nodes),
    cmocka_unit_test(a_held_node_lets_go_of_the_wall_that_would_pull),
    cmocka_unit_test(a_corner_holds_only_what_is_at_rest_in_it),
    cmocka_unit_test(a_closed_node_is_put_back_where_rounding_has_taken_it_from),
    cmocka_unit_test(a_sliding_node_glides_on_where_the_line_goes_on),
    cmocka_unit_test(a_sliding_node_flies_off_a_convex_bend_and_off_a_free_end),
    cmocka_unit_test(a_sliding_node_takes_its_impact_at_a_concave_bend),
    cmocka_unit_test(another_obstacle_stops_a_sliding_node),
    cmocka_unit_test(a_sliding_node_stops_and_starts_again_when_it_is_driven),
    cmocka_unit_test(a_sliding_node_turns_back_where_friction_cannot_hold_it),
    cmocka_unit_test(release_comes_before_stick_and_slip),
    cmocka_unit_test(a_sticking_node_does_not_move_in_any_wind_it_withstands),
    cmocka_unit_test(forces_and_friction_power_are_told_as_rates),
    cmocka_unit_test(an_edge_may_touch_a_vertex_but_not_start_with_it_inside),
    cmocka_unit_test(at_the_start_a_touching_edge_is_in_contact),
    cmocka_unit_test(at_the_start_an_edge_may_touch_two_vertices),
    cmocka_unit_test(a_closed_edge_that_has_opened_is_put_back),
    cmocka_unit_test(an_edge_slides_stops_and_slides_on_a_vertex),
    cmocka_unit_test(a_vertex_glides_from_edge_to_edge_of_a_flat_side),
    cmocka_unit_test(a_vertex_leaves_a_convex_corner_of_the_body),
    cmocka_unit_test(a_vertex_strikes_the_next_edge_where_the_body_bends_in),
    cmocka_unit_test(a_vertex_comes_to_rest_where_the_body_bends_in),
    cmocka_unit_test(a_vertex_let_go_by_one_side_of_a_notch_sticks_to_the_other_where_it_is),
    cmocka_unit_test(a_flat_side_comes_down_on_an_apex_with_its_own_normal),
    cmocka_unit_test(a_node_found_deep_inside_is_an_error),
    cmocka_unit_test(too_many_changes_of_one_node_in_a_short_time_are_a_storm),
    cmocka_unit_test(changes_further_apart_are_no_storm),
    cmocka_unit_test(a_vertex_found_deep_inside_a_body_is_an_error),
    cmocka_unit_test(too_many_changes_of_one_edge_in_a_short_time_are_a_storm),
    cmocka_unit_test(events_that_change_nothing_end_the_run_after_a_while),
    cmocka_unit_test(what_arrives_within_the_window_of_an_impact_is_reflected_with_it),
    cmocka_unit_test(an_edge_is_reflected_early_too),
    cmocka_unit_test(what_passes_a_vertex_within_the_window_is_not_reflected),
    cmocka_unit_test(an_early_reflection_takes_what_an_impact_takes_in_any_order),
    cmocka_unit_test(what_shares_a_node_with_a_lasting_contact_is_not_reflected_early),
    cmocka_unit_test(a_node_that_comes_round_a_free_end_is_behind_until_it_is_in_front),
    cmocka_unit_test(what_goes_round_a_free_end_at_a_distance_is_behind_it),
    cmocka_unit_test(a_step_is_cut_at_the_first_contact_that_was_overlooked),
    cmocka_unit_test(a_contact_at_the_root_that_ends_a_step_is_no_other),
    cmocka_unit_test(a_step_without_contacts_is_left_as_it_is),
    cmocka_unit_test(a_closed_contact_that_should_have_ended_cuts_the_step),
    cmocka_unit_test(the_check_goes_by_the_guards_at_the_end_of_the_step),
    cmocka_unit_test(the_guards_of_all_sites_stand_one_after_the_other),
    cmocka_unit_test(a_nearly_straight_concave_bend_moves_the_node_by_no_more_than_rounding),
};

int main(void)
{
    return cmocka_run_group_tests(tests, NULL, NULL);
}
