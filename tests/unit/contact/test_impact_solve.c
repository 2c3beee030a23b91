/* SPDX-License-Identifier: BSD-3-Clause */
/* impact_solve.c: impacts of nodes by themselves, of edges on vertices and of groups of contacts, without an
 * integrator. Numbers are worked out by hand; tolerances of 1e-15 to 1e-12 are rounding unless said otherwise. */
#include "unit/scene.h"

#include <float.h>

#include "contact/impact_solve.h"

static const double penetration_tolerance = scene_skin, g = scene_gravity, masses[4] = {1.0, 3.0, 2.0, 2.0};

static const double floor_points[4] = {-8.0, 0.0, 8.0, 0.0}, wall_points[4] = {2.0, -1.0, 2.0, 3.0};
static const double roof_points[6] = {-4.0, -4.0, 0.0, 0.0, 4.0, -4.0}; /* its ridge is vertex 0, in the origin */

static dem_obstacle obstacle(dem_index n_points, const double *points, double eta, double mu)
{
    return (dem_obstacle){.n_points = n_points,
                          .points = points,
                          .restitution = eta,
                          .friction = mu,
                          .friction_law = DEM_FRICTION_COULOMB};
}

static contact_instant moment(scene *s, event_listener *listener)
{
    *listener = (event_listener){scene_note, s};
    return (contact_instant){.t = 0.5, .x = s->y, .v = scene_v(s), .listener = listener};
}

static void hit(scene *s, dem_index k, dem_index n, dem_index first, dem_index second)
{
    event_listener listener;
    contact_instant now = moment(s, &listener);
    assert_ok(impact_solve(&s->c.set, k, (impact_target){(int)n, {first, second}}, &now));
}

static vec2 velocity(scene *s, dem_index i)
{
    return vec2_at(scene_v(s), i);
}

static double kinetic(scene *s)
{
    double energy = 0.0;
    for (dem_index i = 0; i < s->model->lattice.n_nodes; i++)
        energy += 0.5 * s->model->lattice.mass[i] * vec2_dot(velocity(s, i), velocity(s, i));
    return energy;
}

static vec2 momentum(scene *s)
{
    vec2 p = {0.0, 0.0};
    for (dem_index i = 0; i < s->model->lattice.n_nodes; i++)
        p = vec2_along(p, s->model->lattice.mass[i], velocity(s, i));
    return p;
}

static void check_vec(vec2 actual, double x, double y, double tolerance)
{
    assert_close(actual.x, x, tolerance);
    assert_close(actual.y, y, tolerance);
}

/* ---- a node by itself ---- */

/* One node of 2 kg at (0.25, -penetration tolerance). */
static void open_node(scene *s, const dem_obstacle *obstacles, dem_index n, double u, double v)
{
    const double at[2] = {0.25, -penetration_tolerance};
    scene_open(s, 1, at, &masses[2], 0, NULL, obstacles, n);
    vec2_put(scene_v(s), 0, (vec2){u, v});
}

/* eta = 1/2, mu = 1/4: 4 m/s down give 2 * 6 N s, of which a quarter takes 1.5 m/s of the 3 along, or all of 1. */
static void coulomb_friction_takes_at_most_its_share_of_the_normal_impulse(void **state)
{
    const dem_obstacle rough = obstacle(2, floor_points, 0.5, 0.25);
    const double u[4] = {3.0, -3.0, 1.0, 1.5}, after[4] = {1.5, -1.5, 0.0, 0.0};
    (void)state;
    for (int k = 0; k < 4; k++) {
        scene s;
        open_node(&s, &rough, 1, u[k], -4.0);
        hit(&s, 0, 1, 0, 0);
        scene_check(&s, 0, 0.25, 0.0, after[k], 2.0);
        assert_int_equal(s.n_events, 1);
        assert_int_equal(s.events[0].kind, DEM_EVENT_IMPACT);
        assert_close(s.events[0].impulse[0], 2.0 * (after[k] - u[k]), 1e-15);
        assert_close(s.events[0].impulse[1], 12.0, 1e-15);
        assert_close(s.events[0].energy, u[k] * u[k] + 16.0 - after[k] * after[k] - 4.0, 1e-14);
        assert_close(s.c.set.ledger.friction_impulse[0], 2.0 * (after[k] - u[k]), 1e-15);
        assert_close(s.c.set.ledger.friction_impulse[1], 0.0, 1e-15);
        assert_close(s.c.set.ledger.impact, s.events[0].energy, 0.0);
        scene_close(&s);
    }
}

/* mu = 1/4 leaves 3 - 1 of 3 m/s when 4 m/s end in it, and nothing of 0.5. */
static void a_plastic_impact_closes_a_contact_that_slides_or_sticks(void **state)
{
    const dem_obstacle rough = obstacle(2, floor_points, 0.0, 0.25);
    const double u[3] = {3.0, -3.0, 0.5}, after[3] = {2.0, -2.0, 0.0};
    const int sign[3] = {1, -1, 0};
    (void)state;
    for (int k = 0; k < 3; k++) {
        scene s;
        open_node(&s, &rough, 1, u[k], -4.0);
        hit(&s, 0, 1, 0, 0);
        scene_check(&s, 0, 0.25, 0.0, after[k], 0.0);
        assert_int_equal(s.c.set.list[0].n_closed, 1);
        assert_int_equal(s.c.set.list[0].closed[0].slide, sign[k]);
        assert_int_equal(s.c.set.ledger.counts.closings, 1);
        assert_int_equal(s.n_events, 1);
        assert_int_equal(s.events[0].state, sign[k] == 0 ? DEM_CONTACT_STICK : DEM_CONTACT_SLIP);
        scene_close(&s);
    }
}

/* A rebound of 2 m/s that counts as rest is none: the floor gives 2 * 4 N s, and friction a quarter of that. */
static void what_closes_has_not_rebounded_and_friction_goes_with_the_impulse_given(void **state)
{
    const dem_obstacle rough = obstacle(2, floor_points, 0.5, 0.25);
    scene s;
    (void)state;
    open_node(&s, &rough, 1, 3.0, -4.0);
    s.c.set.scene.rule.rest_speed = 10.0;
    hit(&s, 0, 1, 0, 0);
    scene_check(&s, 0, 0.25, 0.0, 2.0, 0.0);
    assert_int_equal(s.c.set.list[0].n_closed, 1);
    check_vec(vec2_at(s.c.set.ledger.impulse, 0), -2.0, 8.0, 1e-14);
    scene_close(&s);
}

/* A window of 1 ms takes hops of up to 2 ms for rest, which start with g times that. A smaller speed of rest does not
 * change that. */
static void a_hop_of_less_than_twice_the_window_is_rest(void **state)
{
    const dem_obstacle smooth = obstacle(2, floor_points, 0.5, 0.0);
    (void)state;
    for (int k = 0; k < 4; k++) {
        const bool rests = k % 2 == 0;
        scene s;
        open_node(&s, &smooth, 1, 0.0, rests ? -0.0198 : -0.0202);
        s.c.set.scene.rule.window = 1e-3;
        s.c.set.scene.rule.rest_speed = k < 2 ? 0.0 : 1e-3;
        hit(&s, 0, 1, 0, 0);
        scene_check(&s, 0, 0.25, 0.0, 0.0, rests ? 0.0 : 0.0101);
        assert_int_equal(s.c.set.list[0].n_closed, rests);
        scene_close(&s);
    }
}

/* At rest on the floor nothing is struck: the contact closes without an impact. */
static void a_node_that_is_laid_down_closes_without_an_impact(void **state)
{
    const dem_obstacle smooth = obstacle(2, floor_points, 0.5, 0.0);
    scene s;
    (void)state;
    open_node(&s, &smooth, 1, 2.0, 0.0);
    hit(&s, 0, 1, 0, 0);
    scene_check(&s, 0, 0.25, 0.0, 2.0, 0.0);
    assert_int_equal(s.n_events, 1);
    assert_int_equal(s.events[0].kind, DEM_EVENT_CLOSE);
    assert_int_equal(s.events[0].state, DEM_CONTACT_SLIP);
    assert_int_equal(s.c.set.ledger.counts.impacts, 0);
    assert_int_equal(s.c.set.ledger.counts.closings, 1);
    scene_close(&s);
}

/* Floor and wall, plastic: driven into both it is held; without a wind the wall does not press and the node stays on
 * the floor alone. */
static void a_corner_takes_both_velocities_and_holds_what_is_pressed_into_it(void **state)
{
    const dem_obstacle corner[2] = {obstacle(2, floor_points, 0.0, 0.0), obstacle(2, wall_points, 0.0, 0.0)};
    (void)state;
    for (int k = 0; k < 2; k++) {
        scene s;
        open_node(&s, corner, 2, 3.0, -4.0);
        s.c.set.scene.rule.load.gravity[0] = k == 0 ? 1.0 : 0.0;
        scene_put(&s, 0, 2.0 + 0.5 * penetration_tolerance, -0.5 * penetration_tolerance, 3.0, -4.0);
        hit(&s, 0, 2, 0, 1);
        scene_check(&s, 0, 2.0, 0.0, 0.0, 0.0);
        assert_int_equal(s.c.set.list[0].n_closed, k == 0 ? 2 : 1);
        assert_int_equal(s.c.set.list[0].closed[0].held, k == 0);
        assert_close(s.c.set.ledger.impulse[1], 8.0, 1e-15);
        assert_close(s.c.set.ledger.impulse[2], -6.0, 1e-15);
        scene_close(&s);
    }
}

/* The segment approached faster comes first; between two in line, or at a convex bend, there is only one. */
static void what_a_node_meets_is_the_segment_approached_fastest_and_what_makes_a_corner_with_it(void **state)
{
    const double bent_points[8] = {-4.0, -1.0, 0.0, 0.0, 2.0, 0.0, 4.0, 2.0}; /* convex at 0, concave at 2 */
    const dem_obstacle bent = obstacle(4, bent_points, 0.5, 0.0);
    const double x[5] = {1.0, 2.0, 2.0, 0.0, 0.0}, u[5] = {0.0, 0.2, 3.0, 2.0, -2.0};
    const int n[5] = {1, 2, 2, 1, 1};
    const dem_index first[5] = {1, 1, 2, 0, 1}; /* speeds -v.n at 0: (u/4 + 1)/1.03 of the slope and 1 of the level */
    scene s;
    event_listener listener;
    (void)state;
    open_node(&s, &bent, 1, 0.0, 0.0);
    for (int k = 0; k < 5; k++) {
        scene_put(&s, 0, x[k], -0.5 * penetration_tolerance, u[k], -1.0);
        const contact_instant now = moment(&s, &listener);
        const impact_target met = impact_target_of_node(&s.c.set, 0, &now);
        assert_int_equal(met.n, n[k]);
        assert_int_equal(met.feature[0], first[k]);
        if (n[k] == 2) assert_int_equal(met.feature[1], 3 - first[k]);
    }
    scene_close(&s);
}

/* Segments 0 and 1 are neighbours, the wall's 2 stands across 1; the ceiling's 3 is parallel to 1. */
static void neighbours_make_a_corner_at_their_vertex_and_others_where_they_cross(void **state)
{
    const double bent_points[6] = {-4.0, 4.0, 0.0, 0.0, 4.0, 0.0}, ceiling_points[4] = {4.0, 2.0, -1.0, 2.0};
    const dem_obstacle three[3] = {obstacle(3, bent_points, 0.5, 0.0), obstacle(2, wall_points, 0.5, 0.0),
                                   obstacle(2, ceiling_points, 0.5, 0.0)};
    scene s;
    (void)state;
    open_node(&s, three, 3, 0.0, 0.0);
    const contact_set *c = &s.c.set;
    assert_true(impact_is_corner(c, 0, 1, (vec2){3.9 * penetration_tolerance, 0.0}, penetration_tolerance));
    assert_false(impact_is_corner(c, 0, 1, (vec2){4.1 * penetration_tolerance, 0.0}, penetration_tolerance));
    assert_true(impact_is_corner(c, 1, 2, (vec2){2.0, 0.0}, penetration_tolerance));
    assert_true(impact_is_corner(c, 2, 1, (vec2){2.0, 0.0}, penetration_tolerance));
    assert_false(impact_is_corner(c, 1, 3, (vec2){1.0, 0.0}, penetration_tolerance));
    scene_close(&s);
}

/* Twice the penetration tolerance, and the way in ten times 100 units of rounding of 0.5 s and a step of 0.01 s. */
static void an_impact_can_be_as_deep_as_events_are_located(void **state)
{
    const double located = 1000.0 * DBL_EPSILON * 0.51;
    const dem_obstacle roof = obstacle(3, roof_points, 0.5, 0.0);
    scene s;
    event_listener listener;
    (void)state;
    scene_open_triangle(&s, masses, -0.5, 0.0, &roof, 1);
    scene_put(&s, 0, -0.5, 0.0, 3e6, -4e6);
    scene_put(&s, 1, 1.5, 0.0, 6e6, 8e6);
    const contact_instant now = moment(&s, &listener);
    assert_close(impact_depth(&s.c.set, 0, &now), 2.0 * penetration_tolerance + 5e6 * located, 1e-19);
    assert_close(impact_depth(&s.c.set, scene_edge(&s, 0, 1), &now), 2.0 * penetration_tolerance + 1e7 * located,
                 1e-19);
    scene_close(&s);
}

/* ---- an edge on a vertex ---- */

/* Edge 0-1 of masses 1 and 3 kg, 2 m long and turned by `angle`, with the ridge at s of it. */
static dem_index open_edge(scene *s, const dem_obstacle *roof, double fraction, double angle)
{
    const vec2 t = {cos(angle), sin(angle)}, n = {-t.y, t.x};
    scene_open_triangle(s, masses, 0.0, 0.0, roof, 1);
    const vec2 start = vec2_scale(-2.0 * fraction, t);
    vec2_put(s->y, 0, start);
    vec2_put(s->y, 1, vec2_along(start, 2.0, t));
    vec2_put(s->y, 2, vec2_along(vec2_along(start, 1.0, t), 1.0, n));
    return scene_edge(s, 0, 1);
}

static double mobility(double fraction)
{
    return (1.0 - fraction) * (1.0 - fraction) / masses[0] + fraction * fraction / masses[1];
}

/* J = -(1 + eta) v_n/W, shared as 1 - s and s, W = (1 - s)^2/m_0 + s^2/m_1. */
static void an_edge_on_a_vertex_shares_its_impulse_by_the_place(void **state)
{
    const double fraction[3] = {0.25, 0.5, 1.0};
    const dem_obstacle roof = obstacle(3, roof_points, 0.5, 0.0);
    (void)state;
    for (int k = 0; k < 3; k++) {
        scene s;
        const double q = fraction[k], vn = -2.0 * (1.0 - q) - q, J = -1.5 * vn / mobility(q);
        const dem_index edge = open_edge(&s, &roof, q, 0.0);
        vec2_put(scene_v(&s), 0, (vec2){0.5, -2.0});
        vec2_put(scene_v(&s), 1, (vec2){0.5, -1.0});
        vec2_put(scene_v(&s), 2, (vec2){0.5, 0.25});
        const double before = kinetic(&s);
        const vec2 p = momentum(&s);
        hit(&s, edge, 1, 0, 0);
        check_vec(velocity(&s, 0), 0.5, -2.0 + (1.0 - q) * J, 1e-14);
        check_vec(velocity(&s, 1), 0.5, -1.0 + q * J / 3.0, 1e-14);
        check_vec(velocity(&s, 2), 0.5, 0.25, 0.0);
        check_vec(vec2_sub(momentum(&s), p), 0.0, J, 1e-12);
        assert_int_equal(s.n_events, 1);
        check_vec(vec2_at(s.events[0].impulse, 0), 0.0, J, 1e-14);
        check_vec(vec2_at(s.events[0].before, 0), 0.5, vn, 1e-15);
        check_vec(vec2_at(s.events[0].after, 0), 0.5, -0.5 * vn, 1e-14);
        assert_close(s.events[0].weight, q, 1e-15);
        assert_close(s.events[0].energy, before - kinetic(&s), 1e-13);
        assert_close(s.c.set.ledger.impact, before - kinetic(&s), 1e-13);
        check_vec(vec2_at(s.c.set.ledger.impulse, 0), 0.0, J, 1e-14);
        assert_int_equal(s.c.set.ledger.counts.vertex_impacts, 1);
        assert_int_equal(s.c.set.list[edge].n_closed, 0);
        scene_close(&s);
    }
}

/* Turned by 0.3: all along the edge's own normal and tangent. mu = 1/4 gives mu J against the sliding, or what stops
 * the point if that is less: v_t/W. */
static void friction_on_a_vertex_has_coulombs_limit(void **state)
{
    const double q = 0.25, angle = 0.3, vn = -2.0, W = mobility(q), J = 1.5 * 2.0 / W, along[3] = {2.0, -2.0, 0.5};
    const vec2 t = {cos(angle), sin(angle)}, n = {-t.y, t.x};
    const dem_obstacle roof = obstacle(3, roof_points, 0.5, 0.25);
    (void)state;
    for (int k = 0; k < 3; k++) {
        scene s;
        const double vt = along[k], Jt = k == 2 ? -vt / W : (k == 0 ? -0.25 * J : 0.25 * J);
        const vec2 v = vec2_along(vec2_scale(vn, n), vt, t), impulse = vec2_along(vec2_scale(J, n), Jt, t);
        const dem_index edge = open_edge(&s, &roof, q, angle);
        for (dem_index i = 0; i < 3; i++) vec2_put(scene_v(&s), i, v);
        const double before = kinetic(&s);
        const vec2 p = momentum(&s);
        hit(&s, edge, 1, 0, 0);
        const vec2 v0 = vec2_along(v, 0.75, impulse), v1 = vec2_along(v, 0.25 / 3.0, impulse);
        check_vec(velocity(&s, 0), v0.x, v0.y, 1e-14);
        check_vec(velocity(&s, 1), v1.x, v1.y, 1e-14);
        check_vec(vec2_sub(momentum(&s), p), impulse.x, impulse.y, 1e-12);
        check_vec(vec2_at(s.c.set.ledger.impulse, 0), impulse.x, impulse.y, 1e-14);
        check_vec(vec2_at(s.c.set.ledger.friction_impulse, 0), Jt * t.x, Jt * t.y, 1e-14);
        assert_close(s.c.set.ledger.impact, before - kinetic(&s), 1e-13);
        assert_true(s.c.set.ledger.impact > 0.0);
        scene_close(&s);
    }
}

/* (10): mu v_t is left of the point's tangential velocity. */
static void the_papers_friction_on_a_vertex_leaves_its_share(void **state)
{
    const double q = 0.25, W = mobility(q);
    dem_obstacle roof = obstacle(3, roof_points, 1.0, 0.25);
    scene s;
    (void)state;
    roof.friction_law = DEM_FRICTION_PAPER;
    const dem_index edge = open_edge(&s, &roof, q, 0.0);
    for (dem_index i = 0; i < 3; i++) vec2_put(scene_v(&s), i, (vec2){2.0, -1.0});
    hit(&s, edge, 1, 0, 0);
    check_vec(velocity(&s, 0), 2.0 - 0.75 * 1.5 / W, -1.0 + 0.75 * 2.0 / W, 1e-14);
    check_vec(velocity(&s, 1), 2.0 - 0.25 * 1.5 / W / 3.0, -1.0 + 0.25 * 2.0 / W / 3.0, 1e-14);
    scene_close(&s);
}

/* The edge is put back on the ridge, its nodes by their parts in it and their mobilities: the lift of node i is
 * penetration tolerance w_i/m_i/W. Falling at rest otherwise, it stays: a contact that slides or, with friction,
 * sticks at its place. */
static void a_plastic_impact_leaves_an_edge_closed_on_the_vertex(void **state)
{
    const double q = 0.25, W = mobility(q), mu[2] = {0.0, 2.0};
    (void)state;
    for (int k = 0; k < 2; k++) {
        scene s;
        const dem_obstacle roof = obstacle(3, roof_points, 0.0, mu[k]);
        const dem_index edge = open_edge(&s, &roof, q, 0.0);
        for (dem_index i = 0; i < 3; i++)
            scene_put(&s, i, s.y[2 * i], s.y[2 * i + 1] - penetration_tolerance, -0.5, -1.0);
        hit(&s, edge, 1, 0, 0);
        const contact_point *point = &s.c.set.list[edge].closed[0];
        assert_close(s.y[1], penetration_tolerance * (0.75 / W - 1.0), 1e-17);
        assert_close(s.y[3], penetration_tolerance * (0.25 / 3.0 / W - 1.0), 1e-17);
        const contact_frame f = contact_frame_at(&s.c.set.scene, &s.c.set.list[edge], 0, s.y, scene_v(&s));
        const double slid = vec2_dot((vec2){-0.5, -1.0}, f.tangent); /* the lift has turned it a little */
        assert_close(f.gap, 0.0, 1e-17);
        assert_close(vec2_dot(f.velocity, f.normal), 0.0, 1e-15);
        assert_close(vec2_dot(f.velocity, f.tangent), k == 0 ? slid : 0.0, 1e-15);
        assert_int_equal(s.c.set.list[edge].n_closed, 1);
        assert_int_equal(point->slide, k == 0 ? -1 : 0);
        if (k == 1) assert_close(point->place, q, 1e-12);
        assert_int_equal(s.c.set.ledger.counts.closings, 1);
        assert_int_equal(s.events[0].state, k == 0 ? DEM_CONTACT_SLIP : DEM_CONTACT_STICK);
        scene_close(&s);
    }
}

/* As for a node: J = 1/W without the rebound, and 1/4 of it along. */
static void what_closes_on_a_vertex_has_not_rebounded(void **state)
{
    const double q = 0.25, J = 1.0 / mobility(q);
    const dem_obstacle roof = obstacle(3, roof_points, 0.5, 0.25);
    scene s;
    (void)state;
    const dem_index edge = open_edge(&s, &roof, q, 0.0);
    s.c.set.scene.rule.rest_speed = 10.0;
    for (dem_index i = 0; i < 3; i++) vec2_put(scene_v(&s), i, (vec2){2.0, -1.0});
    const double before = kinetic(&s);
    hit(&s, edge, 1, 0, 0);
    check_vec(velocity(&s, 0), 2.0 - 0.75 * 0.25 * J, -1.0 + 0.75 * J, 1e-13);
    check_vec(velocity(&s, 1), 2.0 - 0.25 * 0.25 * J / 3.0, -1.0 + 0.25 * J / 3.0, 1e-13);
    check_vec(vec2_at(s.c.set.ledger.impulse, 0), -0.25 * J, J, 1e-13);
    assert_close(s.c.set.ledger.impact, before - kinetic(&s), 1e-13);
    assert_int_equal(s.c.set.list[edge].n_closed, 1);
    assert_int_equal(s.n_impacts, 1);
    scene_close(&s);
}

/* Nothing presses but the edge's own turning: stopped at the ridge it turns with omega < 0, and sliding with v_t < 0
 * it would have to be accelerated by 2 omega v_t > 0 to keep its distance: it stays. The other way it leaves. */
static void a_turning_edge_that_slides_towards_the_vertex_stays_on_it(void **state)
{
    const dem_obstacle roof = obstacle(3, roof_points, 0.0, 0.0);
    (void)state;
    for (int k = 0; k < 2; k++) {
        scene s;
        const dem_index edge = open_edge(&s, &roof, 0.25, 0.0);
        s.c.set.scene.rule.load.gravity[1] = 0.0;
        for (dem_index i = 0; i < 3; i++) vec2_put(scene_v(&s), i, (vec2){k == 0 ? -0.9 : 0.9, -1.0});
        hit(&s, edge, 1, 0, 0);
        assert_int_equal(s.c.set.list[edge].n_closed, k == 0);
        scene_close(&s);
    }
}

/* ---- groups ---- */

/* Node 0 at rest under a plate; the ridge is under s of edge 0-1, whose other end falls with 1 m/s. No weight. */
static dem_index open_clamp(scene *s, double fraction, double eta, double mu)
{
    static const double plate_points[4] = {8.0, 0.0, -8.0, 0.0}; /* faces down */
    const dem_obstacle clamp[2] = {obstacle(3, roof_points, eta, mu), obstacle(2, plate_points, eta, mu)};
    scene_open_triangle(s, masses, -2.0 * fraction, 0.0, clamp, 2);
    s->c.set.scene.rule.load.gravity[1] = 0.0;
    vec2_put(scene_v(s), 1, (vec2){0.0, -1.0});
    vec2_put(scene_v(s), 2, (vec2){0.0, -1.0});
    assert_ok(contact_set_close(&s->c.set, 0, (contact_point){.feature = 2, .slide = 1}));
    return scene_edge(s, 0, 1);
}

/* Each of the sweeps leaves (1 - s)^2/m_0/W of what was before, at s = 1/4 0.964: they do not come to an end. Nothing
 * moves on: the ridge gives J = m_1/s so that node 1 stops, the plate (1 - s) J down on node 0. */
static void a_plastic_group_stops_what_approaches(void **state)
{
    const double fraction[3] = {0.75, 0.5, 0.25};
    (void)state;
    for (int k = 0; k < 3; k++) {
        scene s;
        const dem_index edge = open_clamp(&s, fraction[k], 0.0, 0.0);
        const double J = 3.0 / fraction[k], before = kinetic(&s);
        hit(&s, edge, 1, 0, 0);
        check_vec(velocity(&s, 0), 0.0, 0.0, 1e-10); /* sweeps end at 1e-11 of 1 m/s at the point */
        check_vec(velocity(&s, 1), 0.0, 0.0, 1e-10);
        check_vec(velocity(&s, 2), 0.0, -1.0, 0.0);
        check_vec(vec2_at(s.c.set.ledger.impulse, 0), 0.0, J, 1e-9);
        check_vec(vec2_at(s.c.set.ledger.impulse, 1), 0.0, -(1.0 - fraction[k]) * J, 1e-9);
        assert_close(s.c.set.ledger.impact, before - kinetic(&s), 1e-12);
        assert_int_equal(s.n_impacts, 2); /* both struck, the node first */
        assert_int_equal(s.impacts[0].other, -1);
        assert_int_equal(s.impacts[1].other, 1);
        scene_close(&s);
    }
}

static void an_elastic_group_keeps_its_energy_and_leaves_no_approach(void **state)
{
    const double fraction[3] = {0.75, 0.5, 0.25};
    (void)state;
    for (int k = 0; k < 3; k++) {
        scene s;
        const double q = fraction[k];
        const dem_index edge = open_clamp(&s, q, 1.0, 0.0);
        const double before = kinetic(&s);
        const vec2 p = momentum(&s);
        hit(&s, edge, 1, 0, 0);
        assert_close(kinetic(&s), before, 1e-12);
        assert_close(s.c.set.ledger.impact, 0.0, 1e-12);
        assert_true(velocity(&s, 0).y <= 1e-11);
        assert_true((1.0 - q) * velocity(&s, 0).y + q * velocity(&s, 1).y >= -1e-11);
        const vec2 given = vec2_add(vec2_at(s.c.set.ledger.impulse, 0), vec2_at(s.c.set.ledger.impulse, 1));
        check_vec(vec2_sub(momentum(&s), p), given.x, given.y, 1e-12);
        scene_close(&s);
    }
}

/* Between the two energy goes, momentum is what both gave, and nothing approaches. */
static void a_group_with_friction_books_what_it_loses(void **state)
{
    scene s;
    (void)state;
    const dem_index edge = open_clamp(&s, 0.6, 0.5, 0.3);
    for (dem_index i = 0; i < 3; i++) vec2_put(scene_v(&s), i, (vec2){0.4, i == 0 ? 0.0 : -1.0});
    const double before = kinetic(&s);
    const vec2 p = momentum(&s);
    hit(&s, edge, 1, 0, 0);
    const vec2 given = vec2_add(vec2_at(s.c.set.ledger.impulse, 0), vec2_at(s.c.set.ledger.impulse, 1));
    check_vec(vec2_sub(momentum(&s), p), given.x, given.y, 1e-12);
    assert_true(given.x < -0.01);
    assert_true(s.c.set.ledger.impact > 0.01);
    assert_close(s.c.set.ledger.impact, before - kinetic(&s), 1e-12);
    assert_true(velocity(&s, 0).y <= 1e-11 && 0.4 * velocity(&s, 0).y + 0.6 * velocity(&s, 1).y >= -1e-11);
    scene_close(&s);
}

/* Node 0 slides on a ledge left of the ridge and the edge comes down on it: J = -(1 + eta) v_n/W lifts the node off
 * the ledge; both are put back on their surfaces, and what has opened is told after the impact. */
static void a_node_on_a_floor_is_lifted_off_by_the_edge_beside_it(void **state)
{
    const double q = 0.75, W = mobility(q), J = 1.5 * q / W, ledge_points[4] = {-8.0, 0.0, -0.5, 0.0};
    const dem_obstacle both[2] = {obstacle(3, roof_points, 0.5, 0.0), obstacle(2, ledge_points, 0.5, 0.0)};
    scene s;
    (void)state;
    scene_open_triangle(&s, masses, -1.5, 0.0, both, 2);
    scene_put(&s, 0, -1.5, 0.3 * penetration_tolerance, 0.5, 0.0);
    scene_put(&s, 1, 0.5, -1.5 * penetration_tolerance, 0.5, -1.0);
    assert_ok(contact_set_close(&s.c.set, 0, (contact_point){.feature = 2, .slide = 1}));
    hit(&s, scene_edge(&s, 0, 1), 1, 0, 0);
    check_vec(velocity(&s, 0), 0.5, 0.25 * J, 1e-11); /* the square of the slope that putting them back leaves, 1e-6 */
    check_vec(velocity(&s, 1), 0.5, -1.0 + 0.75 * J / 3.0, 1e-11);
    assert_close(s.y[1], 0.0, 1e-15);
    assert_close(0.25 * s.y[1] + 0.75 * s.y[3], 0.0, 1e-15);
    assert_int_equal(s.c.set.list[0].n_closed, 0);
    assert_int_equal(s.n_events, 2);
    assert_int_equal(s.events[0].kind, DEM_EVENT_RELEASE); /* in the order of sites */
    assert_int_equal(s.events[0].node, 0);
    assert_int_equal(s.events[0].other, -1);
    assert_int_equal(s.events[1].kind, DEM_EVENT_IMPACT);
    assert_int_equal(s.events[1].other, 1);
    assert_int_equal(s.c.set.ledger.counts.releases, 1);
    scene_close(&s);
}

/* ---- early reflection ---- */

static void an_early_reflection_leaves_a_node_where_it_is(void **state)
{
    const dem_obstacle rough = obstacle(2, floor_points, 0.5, 0.25);
    const contact_gap gap = {0.1, 0, 0.0, {0.0, 1.0}};
    event_listener listener;
    scene s;
    (void)state;
    open_node(&s, &rough, 1, 3.0, -4.0);
    scene_put(&s, 0, 0.25, 0.1, 3.0, -4.0);
    contact_instant now = moment(&s, &listener);
    impact_early(&s.c.set, 0, &gap, &now);
    scene_check(&s, 0, 0.25, 0.1, 1.5, 2.0);
    assert_int_equal(s.c.set.list[0].n_closed, 0);
    assert_int_equal(s.c.set.ledger.counts.early, 1);
    assert_int_equal(s.c.set.ledger.counts.impacts, 1);
    check_vec(vec2_at(s.c.set.ledger.impulse, 0), -3.0, 12.0, 1e-14);
    check_vec(vec2_at(s.impacts[0].impulse, 0), -3.0, 12.0, 1e-14);
    check_vec(vec2_at(s.impacts[0].after, 0), 1.5, 2.0, 1e-15);
    assert_close(s.impacts[0].energy, 25.0 - 6.25, 1e-14);
    assert_close(s.c.set.ledger.projection, 0.0, 0.0);
    scene_close(&s);
}

/* Near a vertex the gap's normal is no segment's: 5 m/s down are 4 m/s along (0.6, 0.8), and 6 n more turn that. */
static void an_early_reflection_goes_along_the_normal_of_the_gap(void **state)
{
    const dem_obstacle smooth = obstacle(2, floor_points, 0.5, 0.0);
    const contact_gap gap = {0.1, 0, 0.0, {0.6, 0.8}};
    event_listener listener;
    scene s;
    (void)state;
    open_node(&s, &smooth, 1, 0.0, -5.0);
    contact_instant now = moment(&s, &listener);
    impact_early(&s.c.set, 0, &gap, &now);
    check_vec(velocity(&s, 0), 3.6, -0.2, 1e-14);
    check_vec(vec2_at(s.impacts[0].normal, 0), 0.6, 0.8, 0.0);
    check_vec(vec2_at(s.c.set.ledger.friction_impulse, 0), 0.0, 0.0, 1e-14);
    scene_close(&s);
}

static void an_early_reflection_of_an_edge_shares_its_impulse_too(void **state)
{
    const double q = 0.25, J = 1.5 / mobility(q);
    const dem_obstacle roof = obstacle(3, roof_points, 0.5, 0.0);
    const contact_gap gap = {0.1, 0, q, {0.0, 1.0}};
    event_listener listener;
    scene s;
    (void)state;
    const dem_index edge = open_edge(&s, &roof, q, 0.0);
    for (dem_index i = 0; i < 3; i++) scene_put(&s, i, s.y[2 * i], s.y[2 * i + 1] + 0.1, 0.5, -1.0);
    const double before = kinetic(&s);
    contact_instant now = moment(&s, &listener);
    impact_early(&s.c.set, edge, &gap, &now);
    check_vec(velocity(&s, 0), 0.5, -1.0 + 0.75 * J, 1e-14);
    check_vec(velocity(&s, 1), 0.5, -1.0 + 0.25 * J / 3.0, 1e-14);
    assert_close(s.impacts[0].energy, before - kinetic(&s), 1e-13);
    assert_close(s.impacts[0].weight, q, 1e-14);
    assert_int_equal(s.c.set.ledger.counts.vertex_impacts, 1);
    scene_close(&s);
}

/* ---- a node right on an apex ---- */

/* Nodes 0, 1, 2 in a line, 1 m apart, the body's flat side; node 3 above. Node 1 is at (x, y). */
static void open_side(scene *s, const dem_obstacle *roof, double x, double y, double bend)
{
    const double at[8] = {x - 1.0, y + bend, x, y, x + 1.0, y + bend, x, y + 1.0};
    const dem_index corners[6] = {0, 1, 3, 1, 2, 3};
    scene_open(s, 4, at, masses, 2, corners, roof, 1);
    for (dem_index i = 0; i < 4; i++) vec2_put(scene_v(s), i, (vec2){0.0, -1.0});
}

/* Right on the ridge the side's normal, up, lies between those of the flanks; two penetration tolerances beside it, or
 * when the side's nodes recede, it is not the side that meets it. */
static void a_flat_side_with_a_node_right_on_an_apex_meets_it_as_a_side(void **state)
{
    const double x[5] = {0.0, 0.5 * penetration_tolerance, -0.5 * penetration_tolerance, 6.0 * penetration_tolerance,
                         -6.0 * penetration_tolerance},
                 y[3] = {0.0, -0.5 * penetration_tolerance, -penetration_tolerance};
    const dem_obstacle roof = obstacle(3, roof_points, 0.5, 0.0);
    (void)state;
    for (int k = 0; k < 15; k++) {
        scene s;
        event_listener listener;
        dem_index at = -7;
        open_side(&s, &roof, x[k % 5], y[k / 5], 0.0);
        const contact_instant now = moment(&s, &listener);
        const dem_index side = impact_target_edge(&s.c.set, 1, &now, &at);
        if (k % 5 < 3) {
            assert_true(side == scene_edge(&s, 0, 1) || side == scene_edge(&s, 1, 2));
            assert_int_equal(at, 0);
            vec2_put(scene_v(&s), 1, (vec2){0.0, 0.5});
            assert_int_equal(impact_target_edge(&s.c.set, 1, &now, &at), -1);
        } else {
            assert_int_equal(side, -1);
        }
        scene_close(&s);
    }
}

/* The body's corner is sharper than the roof: neither side's normal lies between those of the flanks. */
static void a_sharp_corner_of_the_body_on_an_apex_is_a_node(void **state)
{
    const dem_obstacle roof = obstacle(3, roof_points, 0.5, 0.0);
    scene s;
    event_listener listener;
    dem_index at;
    (void)state;
    open_side(&s, &roof, 0.0, 0.0, 0.9);
    const contact_instant now = moment(&s, &listener);
    assert_true(impact_target_edge(&s.c.set, 1, &now, &at) >= 0); /* sides at 42 degrees, flanks at 45 */
    scene_close(&s);
    open_side(&s, &roof, 0.0, 0.0, 0.99);
    const contact_instant later = moment(&s, &listener);
    assert_true(impact_target_edge(&s.c.set, 1, &later, &at) >= 0);
    scene_close(&s);
    const double flat_points[6] = {-4.0, -3.0, 0.0, 0.0, 4.0, -3.0};
    const dem_obstacle flat = obstacle(3, flat_points, 0.5, 0.0);
    open_side(&s, &flat, 0.0, 0.0, 0.9);
    const contact_instant last = moment(&s, &listener);
    assert_int_equal(impact_target_edge(&s.c.set, 1, &last, &at), -1);
    scene_close(&s);
}

/* ---- notches ---- */

/* The side bends in at node 1 by 1/4 to either side. Pressed down by the weight it comes to rest in the notch if it
 * would not rise by more than eight penetration tolerances; what weighs up, or flies fast, does not. */
static void a_vertex_comes_to_rest_in_a_notch_it_would_not_leave(void **state)
{
    const double limit = sqrt(2.0 * g * 8.0 * penetration_tolerance), v[4] = {0.0, 0.99 * limit, 1.01 * limit, 0.0};
    const bool rests[4] = {true, true, false, false};
    const dem_obstacle roof = obstacle(3, roof_points, 0.0, 0.0);
    (void)state;
    for (int k = 0; k < 4; k++) {
        scene s;
        event_listener listener;
        open_side(&s, &roof, 0.0, 0.0, -0.25);
        if (k == 3) s.c.set.scene.rule.load.gravity[1] = g;
        vec2_put(scene_v(&s), 1, (vec2){0.0, v[k]});
        const contact_instant now = moment(&s, &listener);
        const dem_index left = scene_edge(&s, 0, 1), right = scene_edge(&s, 1, 2);
        assert_int_equal(impact_rests_in_notch(&s.c.set, left, right, &now), rests[k]);
        assert_int_equal(impact_rests_in_notch(&s.c.set, right, left, &now), rests[k]);
        scene_close(&s);
        open_side(&s, &roof, 0.0, 0.0, 0.0); /* a side that does not bend in is no notch */
        const contact_instant flat = moment(&s, &listener);
        vec2_put(scene_v(&s), 1, (vec2){0.0, 0.0});
        s.c.set.scene.rule.load.gravity[0] = 5.0;
        assert_false(impact_rests_in_notch(&s.c.set, scene_edge(&s, 0, 1), scene_edge(&s, 1, 2), &flat));
        scene_close(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(coulomb_friction_takes_at_most_its_share_of_the_normal_impulse),
        cmocka_unit_test(a_plastic_impact_closes_a_contact_that_slides_or_sticks),
        cmocka_unit_test(what_closes_has_not_rebounded_and_friction_goes_with_the_impulse_given),
        cmocka_unit_test(a_hop_of_less_than_twice_the_window_is_rest),
        cmocka_unit_test(a_node_that_is_laid_down_closes_without_an_impact),
        cmocka_unit_test(a_corner_takes_both_velocities_and_holds_what_is_pressed_into_it),
        cmocka_unit_test(what_a_node_meets_is_the_segment_approached_fastest_and_what_makes_a_corner_with_it),
        cmocka_unit_test(neighbours_make_a_corner_at_their_vertex_and_others_where_they_cross),
        cmocka_unit_test(an_impact_can_be_as_deep_as_events_are_located),
        cmocka_unit_test(an_edge_on_a_vertex_shares_its_impulse_by_the_place),
        cmocka_unit_test(friction_on_a_vertex_has_coulombs_limit),
        cmocka_unit_test(the_papers_friction_on_a_vertex_leaves_its_share),
        cmocka_unit_test(a_plastic_impact_leaves_an_edge_closed_on_the_vertex),
        cmocka_unit_test(what_closes_on_a_vertex_has_not_rebounded),
        cmocka_unit_test(a_turning_edge_that_slides_towards_the_vertex_stays_on_it),
        cmocka_unit_test(a_plastic_group_stops_what_approaches),
        cmocka_unit_test(an_elastic_group_keeps_its_energy_and_leaves_no_approach),
        cmocka_unit_test(a_group_with_friction_books_what_it_loses),
        cmocka_unit_test(a_node_on_a_floor_is_lifted_off_by_the_edge_beside_it),
        cmocka_unit_test(an_early_reflection_leaves_a_node_where_it_is),
        cmocka_unit_test(an_early_reflection_goes_along_the_normal_of_the_gap),
        cmocka_unit_test(an_early_reflection_of_an_edge_shares_its_impulse_too),
        cmocka_unit_test(a_flat_side_with_a_node_right_on_an_apex_meets_it_as_a_side),
        cmocka_unit_test(a_sharp_corner_of_the_body_on_an_apex_is_a_node),
        cmocka_unit_test(a_vertex_comes_to_rest_in_a_notch_it_would_not_leave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
