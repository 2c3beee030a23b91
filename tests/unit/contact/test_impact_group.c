/* SPDX-License-Identifier: BSD-3-Clause */
/* impact_group.c: impacts of edges on vertices, and of groups that share nodes. Numbers are worked out by hand;
 * tolerances of 1e-15 to 1e-12 are rounding unless said otherwise. */
#include "unit/contact/impacts.h"

/* ---- an edge on a vertex ---- */

static vec2 momentum(scene *s)
{
    vec2 p = {0.0, 0.0};
    for (dem_index i = 0; i < s->model->lattice.n_nodes; i++)
        p = vec2_along(p, s->model->lattice.mass[i], velocity(s, i));
    return p;
}

/* J = -(1 + eta) v_n/W, shared as 1 - s and s, W = (1 - s)^2/m_0 + s^2/m_1. */
TEST(an_edge_on_a_vertex_shares_its_impulse_by_the_place)
{
    const double fraction[3] = {0.25, 0.5, 1.0};
    const dem_obstacle roof = obstacle(3, roof_points, 0.5, 0.0);
    for (int k = 0; k < 3; k++) {
        CLEANUP(scene_close) scene s;
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
        assert_close(exact_sum_value(&s.c.set.ledger.impact), before - kinetic(&s), 1e-13);
        check_vec(ledger_vector(s.c.set.ledger.impulse, 0), 0.0, J, 1e-14);
        assert_int_equal(s.c.set.ledger.counts.vertex_impacts, 1);
        assert_int_equal(s.c.set.list[edge].n_closed, 0);
    }
}

/* Turned by 0.3: all along the edge's own normal and tangent. mu = 1/4 gives mu J against the sliding, or what stops
 * the point if that is less: v_t/W. */
TEST(friction_on_a_vertex_has_coulombs_limit)
{
    const double q = 0.25, angle = 0.3, vn = -2.0, W = mobility(q), J = 1.5 * 2.0 / W, along[3] = {2.0, -2.0, 0.5};
    const vec2 t = {cos(angle), sin(angle)}, n = {-t.y, t.x};
    const dem_obstacle roof = obstacle(3, roof_points, 0.5, 0.25);
    for (int k = 0; k < 3; k++) {
        CLEANUP(scene_close) scene s;
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
        check_vec(ledger_vector(s.c.set.ledger.impulse, 0), impulse.x, impulse.y, 1e-14);
        check_vec(ledger_vector(s.c.set.ledger.friction_impulse, 0), Jt * t.x, Jt * t.y, 1e-14);
        assert_close(exact_sum_value(&s.c.set.ledger.impact), before - kinetic(&s), 1e-13);
        assert_true(exact_sum_value(&s.c.set.ledger.impact) > 0.0);
    }
}

/* (10): mu v_t is left of the point's tangential velocity. */
TEST(the_papers_friction_on_a_vertex_leaves_its_share)
{
    const double q = 0.25, W = mobility(q);
    dem_obstacle roof = obstacle(3, roof_points, 1.0, 0.25);
    CLEANUP(scene_close) scene s;
    roof.friction_law = DEM_FRICTION_PAPER;
    const dem_index edge = open_edge(&s, &roof, q, 0.0);
    for (dem_index i = 0; i < 3; i++) vec2_put(scene_v(&s), i, (vec2){2.0, -1.0});
    hit(&s, edge, 1, 0, 0);
    check_vec(velocity(&s, 0), 2.0 - 0.75 * 1.5 / W, -1.0 + 0.75 * 2.0 / W, 1e-14);
    check_vec(velocity(&s, 1), 2.0 - 0.25 * 1.5 / W / 3.0, -1.0 + 0.25 * 2.0 / W / 3.0, 1e-14);
}

/* The edge is put back on the ridge, its nodes by their parts in it and their mobilities: the lift of node i is d
 * w_i/m_i/W, d the penetration tolerance. Falling at rest otherwise, it stays: a contact that slides or, with friction,
 * sticks at its place. */
TEST(a_plastic_impact_leaves_an_edge_closed_on_the_vertex)
{
    const double q = 0.25, W = mobility(q), mu[2] = {0.0, 2.0};
    for (int k = 0; k < 2; k++) {
        CLEANUP(scene_close) scene s;
        const dem_obstacle roof = obstacle(3, roof_points, 0.0, mu[k]);
        const dem_index edge = open_edge(&s, &roof, q, 0.0);
        for (dem_index i = 0; i < 3; i++)
            scene_put(&s, i, s.y[2 * i], s.y[2 * i + 1] - penetration_tolerance, -0.5, -1.0);
        hit(&s, edge, 1, 0, 0);
        const contact_point *point = &s.c.set.list[edge].closed[0];
        assert_close(s.y[1], penetration_tolerance * (0.75 / W - 1.0), 1e-17);
        assert_close(s.y[3], penetration_tolerance * (0.25 / 3.0 / W - 1.0), 1e-17);
        const contact_frame f =
            contact_frame_at(&s.c.set.scene, &s.c.set.list[edge], 0, (scene_state){0.0, s.y, scene_v(&s)});
        const double slid = vec2_dot((vec2){-0.5, -1.0}, f.tangent); /* the lift has turned it a little */
        assert_close(f.gap, 0.0, 1e-17);
        assert_close(vec2_dot(f.velocity, f.normal), 0.0, 1e-15);
        assert_close(vec2_dot(f.velocity, f.tangent), k == 0 ? slid : 0.0, 1e-15);
        assert_int_equal(s.c.set.list[edge].n_closed, 1);
        assert_int_equal(point->slide, k == 0 ? -1 : 0);
        if (k == 1) assert_close(point->place, q, 1e-12);
        assert_int_equal(s.c.set.ledger.counts.closings, 1);
        assert_int_equal(s.events[0].state, k == 0 ? DEM_CONTACT_SLIP : DEM_CONTACT_STICK);
    }
}

/* As for a node: J = 1/W without the rebound, and 1/4 of it along. */
TEST(what_closes_on_a_vertex_has_not_rebounded)
{
    const double q = 0.25, J = 1.0 / mobility(q);
    const dem_obstacle roof = obstacle(3, roof_points, 0.5, 0.25);
    CLEANUP(scene_close) scene s;
    const dem_index edge = open_edge(&s, &roof, q, 0.0);
    s.c.set.scene.rule.rest_speed = 10.0;
    for (dem_index i = 0; i < 3; i++) vec2_put(scene_v(&s), i, (vec2){2.0, -1.0});
    const double before = kinetic(&s);
    hit(&s, edge, 1, 0, 0);
    check_vec(velocity(&s, 0), 2.0 - 0.75 * 0.25 * J, -1.0 + 0.75 * J, 1e-13);
    check_vec(velocity(&s, 1), 2.0 - 0.25 * 0.25 * J / 3.0, -1.0 + 0.25 * J / 3.0, 1e-13);
    check_vec(ledger_vector(s.c.set.ledger.impulse, 0), -0.25 * J, J, 1e-13);
    assert_close(exact_sum_value(&s.c.set.ledger.impact), before - kinetic(&s), 1e-13);
    assert_int_equal(s.c.set.list[edge].n_closed, 1);
    assert_int_equal(s.n_impacts, 1);
}

/* What was kept of one impact would make the contact of the next look new, or as if it had opened. */
TEST(nothing_is_left_of_an_impact_for_the_next)
{
    const dem_obstacle roof = obstacle(3, roof_points, 0.0, 0.0);
    CLEANUP(scene_close) scene s;
    const dem_index edge = open_edge(&s, &roof, 0.25, 0.0);
    hit(&s, edge, 1, 0, 0);
    assert_int_equal(s.c.set.list[edge].n_closed, 1);
    const candidate_impact *left = &s.c.set.impacts[edge];
    assert_int_equal(left->n, 0);
    assert_false(left->of[0].fresh || left->of[0].opens || left->of[0].approached || left->of[0].plastic);
}

/* Nothing presses but the edge's own turning: stopped at the ridge it turns with omega < 0, and sliding with v_t < 0
 * it would have to be accelerated by 2 omega v_t > 0 to keep its distance: it stays. The other way it leaves. */
TEST(a_turning_edge_that_slides_towards_the_vertex_stays_on_it)
{
    const dem_obstacle roof = obstacle(3, roof_points, 0.0, 0.0);
    for (int k = 0; k < 2; k++) {
        CLEANUP(scene_close) scene s;
        const dem_index edge = open_edge(&s, &roof, 0.25, 0.0);
        s.acting.gravity[1] = 0.0;
        for (dem_index i = 0; i < 3; i++) vec2_put(scene_v(&s), i, (vec2){k == 0 ? -0.9 : 0.9, -1.0});
        hit(&s, edge, 1, 0, 0);
        assert_int_equal(s.c.set.list[edge].n_closed, k == 0);
    }
}

/* ---- groups ---- */

/* Node 0 at rest under a plate; the ridge is under s of edge 0-1, whose other end falls with 1 m/s. No weight. */
static dem_index open_clamp(scene *s, double fraction, double eta, double mu)
{
    static const double plate_points[4] = {8.0, 0.0, -8.0, 0.0}; /* faces down */
    const dem_obstacle clamp[2] = {obstacle(3, roof_points, eta, mu), obstacle(2, plate_points, eta, mu)};
    scene_open_triangle(s, masses, -2.0 * fraction, 0.0, clamp, 2);
    s->acting.gravity[1] = 0.0;
    vec2_put(scene_v(s), 1, (vec2){0.0, -1.0});
    vec2_put(scene_v(s), 2, (vec2){0.0, -1.0});
    assert_ok(contact_set_close(&s->c.set, 0, (contact_point){.feature = 2, .slide = 1}));
    return scene_edge(s, 0, 1);
}

/* Each of the sweeps leaves (1 - s)^2/m_0/W of what was before, at s = 1/4 0.964: they do not come to an end. Nothing
 * moves on: the ridge gives J = m_1/s so that node 1 stops, the plate (1 - s) J down on node 0. */
TEST(a_plastic_group_stops_what_approaches)
{
    const double fraction[3] = {0.75, 0.5, 0.25};
    for (int k = 0; k < 3; k++) {
        CLEANUP(scene_close) scene s;
        const dem_index edge = open_clamp(&s, fraction[k], 0.0, 0.0);
        const double J = 3.0 / fraction[k], before = kinetic(&s);
        hit(&s, edge, 1, 0, 0);
        check_vec(velocity(&s, 0), 0.0, 0.0, 1e-10); /* sweeps end at 1e-11 of 1 m/s at the point */
        check_vec(velocity(&s, 1), 0.0, 0.0, 1e-10);
        check_vec(velocity(&s, 2), 0.0, -1.0, 0.0);
        check_vec(ledger_vector(s.c.set.ledger.impulse, 0), 0.0, J, 1e-9);
        check_vec(ledger_vector(s.c.set.ledger.impulse, 1), 0.0, -(1.0 - fraction[k]) * J, 1e-9);
        assert_close(exact_sum_value(&s.c.set.ledger.impact), before - kinetic(&s), 1e-12);
        assert_int_equal(s.n_impacts, 2); /* both hit, the node first */
        assert_int_equal(s.impacts[0].other, -1);
        assert_int_equal(s.impacts[1].other, 1);
    }
}

TEST(an_elastic_group_keeps_its_energy_and_leaves_no_approach)
{
    const double fraction[3] = {0.75, 0.5, 0.25};
    for (int k = 0; k < 3; k++) {
        CLEANUP(scene_close) scene s;
        const double q = fraction[k];
        const dem_index edge = open_clamp(&s, q, 1.0, 0.0);
        const double before = kinetic(&s);
        const vec2 p = momentum(&s);
        hit(&s, edge, 1, 0, 0);
        assert_close(kinetic(&s), before, 1e-12);
        assert_close(exact_sum_value(&s.c.set.ledger.impact), 0.0, 1e-12);
        assert_true(velocity(&s, 0).y <= 1e-11);
        assert_true((1.0 - q) * velocity(&s, 0).y + q * velocity(&s, 1).y >= -1e-11);
        const vec2 given = vec2_add(ledger_vector(s.c.set.ledger.impulse, 0), ledger_vector(s.c.set.ledger.impulse, 1));
        check_vec(vec2_sub(momentum(&s), p), given.x, given.y, 1e-12);
    }
}

/* Between the two energy goes, momentum is what both gave, and nothing approaches. */
TEST(a_group_with_friction_enters_what_it_loses)
{
    CLEANUP(scene_close) scene s;
    const dem_index edge = open_clamp(&s, 0.6, 0.5, 0.3);
    for (dem_index i = 0; i < 3; i++) vec2_put(scene_v(&s), i, (vec2){0.4, i == 0 ? 0.0 : -1.0});
    const double before = kinetic(&s);
    const vec2 p = momentum(&s);
    hit(&s, edge, 1, 0, 0);
    const vec2 given = vec2_add(ledger_vector(s.c.set.ledger.impulse, 0), ledger_vector(s.c.set.ledger.impulse, 1));
    check_vec(vec2_sub(momentum(&s), p), given.x, given.y, 1e-12);
    assert_true(given.x < -0.01);
    assert_true(exact_sum_value(&s.c.set.ledger.impact) > 0.01);
    assert_close(exact_sum_value(&s.c.set.ledger.impact), before - kinetic(&s), 1e-12);
    assert_true(velocity(&s, 0).y <= 1e-11 && 0.4 * velocity(&s, 0).y + 0.6 * velocity(&s, 1).y >= -1e-11);
}
