/* SPDX-License-Identifier: BSD-3-Clause */
/* impact_target.c: what a candidate that touches hits. Numbers are worked out by hand; tolerances of
 * 1e-15 to 1e-12 are rounding unless said otherwise. */
#include "unit/contact/impacts.h"

/* ---- a node by itself ---- */

/* The segment approached faster comes first; between two in line, or at a convex bend, there is only one. */
TEST(what_a_node_meets_is_the_segment_approached_fastest_and_what_makes_a_corner_with_it)
{
    const double bent_points[8] = {-4.0, -1.0, 0.0, 0.0, 2.0, 0.0, 4.0, 2.0}; /* convex at 0, concave at 2 */
    const dem_obstacle bent = obstacle(4, bent_points, 0.5, 0.0);
    const double x[5] = {1.0, 2.0, 2.0, 0.0, 0.0}, u[5] = {0.0, 0.2, 3.0, 2.0, -2.0};
    const int n[5] = {1, 2, 2, 1, 1};
    const dem_index first[5] = {1, 1, 2, 0, 1}; /* speeds -v.n at 0: (u/4 + 1)/1.03 of the slope and 1 of the level */
    CLEANUP(scene_close) scene s;
    event_listener listener;
    open_node(&s, &bent, 1, 0.0, 0.0);
    for (int k = 0; k < 5; k++) {
        scene_put(&s, 0, x[k], -0.5 * penetration_tolerance, u[k], -1.0);
        const contact_instant now = moment(&s, &listener);
        const impact_target met = impact_target_of_node(&s.c.set, 0, &now);
        assert_int_equal(met.n, n[k]);
        assert_int_equal(met.feature[0], first[k]);
        if (n[k] == 2) assert_int_equal(met.feature[1], 3 - first[k]);
    }
}

/* Segments 0 and 1 are neighbours, the wall's 2 stands across 1; the ceiling's 3 is parallel to 1. */
TEST(neighbours_make_a_corner_at_their_vertex_and_others_where_they_cross)
{
    const double bent_points[6] = {-4.0, 4.0, 0.0, 0.0, 4.0, 0.0}, ceiling_points[4] = {4.0, 2.0, -1.0, 2.0};
    const dem_obstacle three[3] = {obstacle(3, bent_points, 0.5, 0.0), obstacle(2, wall_points, 0.5, 0.0),
                                   obstacle(2, ceiling_points, 0.5, 0.0)};
    CLEANUP(scene_close) scene s;
    open_node(&s, three, 3, 0.0, 0.0);
    const contact_set *c = &s.c.set;
    assert_true(impact_target_is_corner(c, 0, 1, (surface_query){0.0, (vec2){3.9 * penetration_tolerance, 0.0}},
                                        penetration_tolerance));
    assert_false(impact_target_is_corner(c, 0, 1, (surface_query){0.0, (vec2){4.1 * penetration_tolerance, 0.0}},
                                         penetration_tolerance));
    assert_true(impact_target_is_corner(c, 1, 2, (surface_query){0.0, (vec2){2.0, 0.0}}, penetration_tolerance));
    assert_true(impact_target_is_corner(c, 2, 1, (surface_query){0.0, (vec2){2.0, 0.0}}, penetration_tolerance));
    assert_false(impact_target_is_corner(c, 1, 3, (surface_query){0.0, (vec2){1.0, 0.0}}, penetration_tolerance));
}

/* Twice the penetration tolerance, and the way in ten times 100 units of rounding of 0.5 s and a step of 0.01 s. */
TEST(an_impact_can_be_as_deep_as_events_are_located)
{
    const double located = 1000.0 * DBL_EPSILON * 0.51;
    const dem_obstacle roof = obstacle(3, roof_points, 0.5, 0.0);
    CLEANUP(scene_close) scene s;
    event_listener listener;
    scene_open_triangle(&s, masses, -0.5, 0.0, &roof, 1);
    scene_put(&s, 0, -0.5, 0.0, 3e6, -4e6);
    scene_put(&s, 1, 1.5, 0.0, 6e6, 8e6);
    const contact_instant now = moment(&s, &listener);
    assert_close(impact_target_depth(&s.c.set, 0, &now), 2.0 * penetration_tolerance + 5e6 * located, 1e-19);
    assert_close(impact_target_depth(&s.c.set, scene_edge(&s, 0, 1), &now), 2.0 * penetration_tolerance + 1e7 * located,
                 1e-19);
}

/* ---- a node right on an apex ---- */

/* Right on the ridge the side's normal, up, lies between those of the flanks; two penetration tolerances beside it, or
 * when the side's nodes recede, it is not the side that meets it. */
TEST(a_flat_side_with_a_node_right_on_an_apex_meets_it_as_a_side)
{
    const double x[5] = {0.0, 0.5 * penetration_tolerance, -0.5 * penetration_tolerance, 6.0 * penetration_tolerance,
                         -6.0 * penetration_tolerance},
                 y[3] = {0.0, -0.5 * penetration_tolerance, -penetration_tolerance};
    const dem_obstacle roof = obstacle(3, roof_points, 0.5, 0.0);
    for (int k = 0; k < 15; k++) {
        CLEANUP(scene_close) scene s;
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
    }
}

/* The body's corner is sharper than the roof: neither side's normal lies between those of the flanks. */
TEST(a_sharp_corner_of_the_body_on_an_apex_is_a_node)
{
    const dem_obstacle roof = obstacle(3, roof_points, 0.5, 0.0);
    CLEANUP(scene_close) scene s;
    event_listener listener;
    dem_index at;
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
}
