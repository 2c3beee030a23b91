/* SPDX-License-Identifier: BSD-3-Clause */
/* impact_node.c: impacts of nodes by themselves. Numbers are worked out by hand; tolerances of
 * 1e-15 to 1e-12 are rounding unless said otherwise. */
#include "unit/contact/impacts.h"

/* ---- a node by itself ---- */

/* eta = 1/2, mu = 1/4: 4 m/s down give 2 * 6 N s, of which a quarter takes 1.5 m/s of the 3 along, or all of 1. */
TEST(coulomb_friction_takes_at_most_its_share_of_the_normal_impulse)
{
    const dem_obstacle rough = obstacle(2, floor_points, 0.5, 0.25);
    const double u[4] = {3.0, -3.0, 1.0, 1.5}, after[4] = {1.5, -1.5, 0.0, 0.0};
    for (int k = 0; k < 4; k++) {
        CLEANUP(scene_close) scene s;
        open_node(&s, &rough, 1, u[k], -4.0);
        hit(&s, 0, 1, 0, 0);
        scene_check(&s, 0, 0.25, 0.0, after[k], 2.0);
        assert_int_equal(s.n_events, 1);
        assert_int_equal(s.events[0].kind, DEM_EVENT_IMPACT);
        assert_close(s.events[0].impulse[0], 2.0 * (after[k] - u[k]), 1e-15);
        assert_close(s.events[0].impulse[1], 12.0, 1e-15);
        assert_close(s.events[0].energy, u[k] * u[k] + 16.0 - after[k] * after[k] - 4.0, 1e-14);
        assert_close(exact_sum_value(&s.c.set.ledger.friction_impulse[0]), 2.0 * (after[k] - u[k]), 1e-15);
        assert_close(exact_sum_value(&s.c.set.ledger.friction_impulse[1]), 0.0, 1e-15);
        assert_close(exact_sum_value(&s.c.set.ledger.impact), s.events[0].energy, 0.0);
    }
}

/* mu = 1/4 leaves 3 - 1 of 3 m/s when 4 m/s end in it, and nothing of 0.5. */
TEST(a_plastic_impact_closes_a_contact_that_slides_or_sticks)
{
    const dem_obstacle rough = obstacle(2, floor_points, 0.0, 0.25);
    const double u[3] = {3.0, -3.0, 0.5}, after[3] = {2.0, -2.0, 0.0};
    const int sign[3] = {1, -1, 0};
    for (int k = 0; k < 3; k++) {
        CLEANUP(scene_close) scene s;
        open_node(&s, &rough, 1, u[k], -4.0);
        hit(&s, 0, 1, 0, 0);
        scene_check(&s, 0, 0.25, 0.0, after[k], 0.0);
        assert_int_equal(s.c.set.list[0].n_closed, 1);
        assert_int_equal(s.c.set.list[0].closed[0].slide, sign[k]);
        assert_int_equal(s.c.set.ledger.counts.closings, 1);
        assert_int_equal(s.n_events, 1);
        assert_int_equal(s.events[0].state, sign[k] == 0 ? DEM_CONTACT_STICK : DEM_CONTACT_SLIP);
    }
}

/* A rebound of 2 m/s that counts as rest is none: the floor gives 2 * 4 N s, and friction a quarter of that. */
TEST(what_closes_has_not_rebounded_and_friction_goes_with_the_impulse_given)
{
    const dem_obstacle rough = obstacle(2, floor_points, 0.5, 0.25);
    CLEANUP(scene_close) scene s;
    open_node(&s, &rough, 1, 3.0, -4.0);
    s.c.set.scene.rule.rest_speed = 10.0;
    hit(&s, 0, 1, 0, 0);
    scene_check(&s, 0, 0.25, 0.0, 2.0, 0.0);
    assert_int_equal(s.c.set.list[0].n_closed, 1);
    check_vec(ledger_vector(s.c.set.ledger.impulse, 0), -2.0, 8.0, 1e-14);
}

/* A window of 1 ms takes hops of up to 2 ms for rest, which start with g times that. A smaller speed of rest does not
 * change that. */
TEST(a_hop_of_less_than_twice_the_window_is_rest)
{
    const dem_obstacle smooth = obstacle(2, floor_points, 0.5, 0.0);
    for (int k = 0; k < 4; k++) {
        const bool rests = k % 2 == 0;
        CLEANUP(scene_close) scene s;
        open_node(&s, &smooth, 1, 0.0, rests ? -0.0198 : -0.0202);
        s.c.set.scene.rule.window = 1e-3;
        s.c.set.scene.rule.rest_speed = k < 2 ? 0.0 : 1e-3;
        hit(&s, 0, 1, 0, 0);
        scene_check(&s, 0, 0.25, 0.0, 0.0, rests ? 0.0 : 0.0101);
        assert_int_equal(s.c.set.list[0].n_closed, rests);
    }
}

/* At rest on the floor nothing is hit: the contact closes without an impact. */
TEST(a_node_that_is_laid_down_closes_without_an_impact)
{
    const dem_obstacle smooth = obstacle(2, floor_points, 0.5, 0.0);
    CLEANUP(scene_close) scene s;
    open_node(&s, &smooth, 1, 2.0, 0.0);
    hit(&s, 0, 1, 0, 0);
    scene_check(&s, 0, 0.25, 0.0, 2.0, 0.0);
    assert_int_equal(s.n_events, 1);
    assert_int_equal(s.events[0].kind, DEM_EVENT_CLOSE);
    assert_int_equal(s.events[0].state, DEM_CONTACT_SLIP);
    assert_int_equal(s.c.set.ledger.counts.impacts, 0);
    assert_int_equal(s.c.set.ledger.counts.closings, 1);
}

/* The paper's law with coefficient 0 stops a node that a wind drives from a floor on to a slope of 1 in 1000. What is
 * left of its speed, 5e-5 m/s along the normal of the slope, is rest; then it stays on what it presses, the slope, and
 * not on the floor, along which its speed is smaller: there the wind would drive it on to the slope again, without
 * end. */
TEST(a_node_that_comes_to_rest_in_a_bend_stays_on_the_side_that_it_presses)
{
    const double points[6] = {-8.0, 0.0, 0.0, 0.0, 8.0, 8e-3};
    dem_obstacle bend = obstacle(3, points, 0.5, 0.0);
    bend.friction_law = DEM_FRICTION_PAPER;
    CLEANUP(scene_close) scene s;
    open_node(&s, &bend, 1, 0.1, 0.0);
    s.acting.gravity[0] = 5.0;
    scene_put(&s, 0, penetration_tolerance, 0.0, 0.1, 0.0);
    hit(&s, 0, 2, 1, 0);
    scene_check(&s, 0, 0.0, 0.0, 0.0, 0.0);
    assert_int_equal(s.c.set.list[0].n_closed, 1);
    assert_int_equal(s.c.set.list[0].closed[0].feature, 1);
}

/* Floor and wall, plastic: driven into both it is held; without a wind the wall does not press and the node stays on
 * the floor alone. */
TEST(a_corner_takes_both_velocities_and_holds_what_is_pressed_into_it)
{
    const dem_obstacle corner[2] = {obstacle(2, floor_points, 0.0, 0.0), obstacle(2, wall_points, 0.0, 0.0)};
    for (int k = 0; k < 2; k++) {
        CLEANUP(scene_close) scene s;
        open_node(&s, corner, 2, 3.0, -4.0);
        s.acting.gravity[0] = k == 0 ? 1.0 : 0.0;
        scene_put(&s, 0, 2.0 + 0.5 * penetration_tolerance, -0.5 * penetration_tolerance, 3.0, -4.0);
        hit(&s, 0, 2, 0, 1);
        scene_check(&s, 0, 2.0, 0.0, 0.0, 0.0);
        assert_int_equal(s.c.set.list[0].n_closed, k == 0 ? 2 : 1);
        assert_int_equal(s.c.set.list[0].closed[0].held, k == 0);
        assert_close(exact_sum_value(&s.c.set.ledger.impulse[1]), 8.0, 1e-15);
        assert_close(exact_sum_value(&s.c.set.ledger.impulse[2]), -6.0, 1e-15);
    }
}
