/* SPDX-License-Identifier: BSD-3-Clause */
/* obstacle.c: places along segments, and bends. Tolerances of 1e-15 are the rounding of coordinates of order 1 m. */
#include "unit/obstacle/landscape.h"

TEST(height_and_place_are_measured_from_the_start)
{
    const vec2 x = {0.5 + 0.1, -0.5 + 0.1};
    CLEANUP(obstacles_free) obstacle_set o = compile(valley, 4, 0.0);
    assert_close(segment_place(&o.segments[1], x), sqrt(0.5), 1e-15);
    assert_close(segment_height(&o.segments[1], x), 0.1 * sqrt(2.0), 1e-15);
}

static void check_bend(const obstacle_set *o, dem_index s, bool backwards, obstacle_bend bend, dem_index expected)
{
    dem_index beyond = 77;
    assert_int_equal(obstacles_bend(o, s, backwards, &beyond), bend);
    assert_int_equal(beyond, expected);
}

TEST(bends_are_reported_from_both_sides_alike)
{
    CLEANUP(obstacles_free) obstacle_set o = compile_both();
    check_bend(&o, 0, true, OBSTACLE_FREE_END, -1);
    check_bend(&o, 0, false, OBSTACLE_CONVEX, 1);
    check_bend(&o, 1, true, OBSTACLE_CONVEX, 0);
    check_bend(&o, 1, false, OBSTACLE_CONCAVE, 2);
    check_bend(&o, 2, true, OBSTACLE_CONCAVE, 1);
    check_bend(&o, 2, false, OBSTACLE_FREE_END, -1);
    check_bend(&o, 6, false, OBSTACLE_CONVEX, 3); /* where the ring closes */
    check_bend(&o, 3, true, OBSTACLE_CONVEX, 6);
}

/* Straight is a sine of the bend below 1e-9; a line that turns back is none, though its sine is 0. */
TEST(a_bend_below_1e_9_is_straight)
{
    const double points[10] = {0.0, 0.0, 1.0, 0.0, 2.0, 0.5e-9, 3.0, 3.0e-9, 4.0, 3.0e-9};
    CLEANUP(obstacles_free) obstacle_set o = compile(points, 5, 0.0);
    check_bend(&o, 0, false, OBSTACLE_STRAIGHT, 1);
    check_bend(&o, 1, true, OBSTACLE_STRAIGHT, 0);
    check_bend(&o, 1, false, OBSTACLE_CONCAVE, 2);
    check_bend(&o, 2, false, OBSTACLE_CONVEX, 3);
}

TEST(segments_and_vertices_are_where_their_obstacle_has_gone)
{
    const vec2 velocity = {-3.0, -0.5};
    segment moved;
    vec2 shared;
    CLEANUP(obstacles_free) obstacle_set o = compile_moving(velocity, (vec2){0.0, 0.0});
    assert_ptr_equal(obstacles_segment(&o, 1, 2.0, &moved), &o.segments[1]);
    const segment *left = obstacles_segment(&o, 3, 2.0, &moved);
    assert_ptr_equal(left, &moved);
    assert_true(left->start.x == -1.0 && left->start.y == -1.0 && left->end.x == -1.0 && left->end.y == 0.0);
    assert_true(left->normal.x == -1.0 && left->after == 4);
    assert_true(obstacles_vertex(&o, 0, 2.0).x == 0.0 && obstacles_vertex(&o, 1, 2.0).x == -1.0);
    assert_true(obstacles_share(&o, 2.0, 3, 4, &shared));
    assert_true(shared.x == -1.0 && shared.y == 0.0);
    const obstacle_motion rest = obstacles_motion(&o, 0, 2.0, shared), moves = obstacles_motion(&o, 1, 2.0, shared);
    assert_true(!rest.moves && rest.velocity.x == 0.0 && moves.moves && moves.velocity.x == -3.0);
    assert_close(o.bounds.speed, vec2_norm(velocity), 0.0);
}

/* The foot of a wall that stands on the valley's floor is buried in it only if both go the same way. */
TEST(ends_are_buried_in_what_goes_along)
{
    const double wall[4] = {2.0, 1.0, 2.0, -1.0};
    dem_obstacle list[2] = {{.struct_size = sizeof(dem_obstacle), .n_points = 4, .points = valley},
                            {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = wall}};
    for (int k = 0; k < 3; k++) {
        CLEANUP(obstacles_free) obstacle_set o;
        list[1].velocity[0] = k > 0 ? 1.0 : 0.0;
        list[0].velocity[0] = k > 1 ? 1.0 : 0.0;
        assert_ok(obstacles_compile(&o, list, 2));
        assert_true((o.segments[3].buried[1] > 0.0) == (k != 1));
    }
}

/* Both oscillate alike, and are off the place of their points at t = 0. */
TEST(ends_are_buried_wherever_an_oscillation_begins)
{
    const double wall[4] = {2.0, 1.0, 2.0, -1.0};
    dem_obstacle list[2] = {{.struct_size = sizeof(dem_obstacle), .n_points = 4, .points = valley},
                            {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = wall}};
    double still = 0.0;
    for (int k = 0; k < 2; k++) {
        CLEANUP(obstacles_free) obstacle_set o;
        for (int q = 0; q < 2 && k > 0; q++) {
            list[q].amplitude[0] = 0.7;
            list[q].frequency = 2.0;
            list[q].phase = 90.0;
        }
        assert_ok(obstacles_compile(&o, list, 2));
        if (k == 0) still = o.segments[3].buried[1];
        assert_true(still > 0.0);
        assert_close(o.segments[3].buried[1], still, 0.0);
    }
}

TEST(places_go_out_of_the_frame_of_an_obstacle_and_back)
{
    const dem_obstacle list[2] = {
        {.struct_size = sizeof(dem_obstacle), .n_points = 4, .points = valley},
        {.struct_size = sizeof(dem_obstacle), .n_points = 4, .points = valley, .spin = 2.0, .pivot = {3.0, 1.0}}};
    CLEANUP(obstacles_free) obstacle_set o;
    assert_ok(obstacles_compile(&o, list, 2));
    const vec2 x = {0.3, -0.4}, rest = obstacles_outside(&o, 0, 0.7, x), out = obstacles_outside(&o, 1, 0.7, x);
    const vec2 back = obstacles_inside(&o, 1, 0.7, out);
    assert_true(rest.x == x.x && rest.y == x.y && fabs(out.x - x.x) > 0.1);
    assert_close(back.x, x.x, 1e-15);
    assert_close(back.y, x.y, 1e-15);
}
