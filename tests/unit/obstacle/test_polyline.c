/* SPDX-License-Identifier: BSD-3-Clause */
/* polyline.c: what is no obstacle, and which segments of one meet. */
#include "harness/message.h"
#include "unit/obstacle/landscape.h"

TEST(an_obstacle_of_one_point_or_none_is_refused)
{
    const dem_obstacle list[2] =
        {{.struct_size = sizeof(dem_obstacle), .n_points = 4, .points = valley, .restitution = 0.0},
         {.struct_size = sizeof(dem_obstacle), .n_points = 1, .points = valley, .restitution = 0.0}},
                       none = {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = NULL, .restitution = 0.0};
    refuse(list, 2, "obstacle 1 * 1 points * 2");
    refuse(&none, 1, "obstacle 0 * 2 points * 2");
}

TEST(restitution_must_lie_between_0_and_1)
{
    const dem_obstacle
        above = {.struct_size = sizeof(dem_obstacle), .n_points = 4, .points = valley, .restitution = 1.5},
        below = {.struct_size = sizeof(dem_obstacle), .n_points = 4, .points = valley, .restitution = -0.25},
        nan = {.struct_size = sizeof(dem_obstacle), .n_points = 4, .points = valley, .restitution = fabs((double)NAN)};
    refuse(&above, 1, "obstacle 0: restitution * [0, 1] * 1.5");
    refuse(&below, 1, "obstacle 0: restitution * [0, 1] * -0.25");
    refuse(&nan, 1, "obstacle 0: restitution * [0, 1] * nan");
}

TEST(a_point_that_is_not_finite_is_named)
{
    const double infinite[6] = {0.0, 0.0, 1.0, 0.0, 2.0, (double)INFINITY}, nan[4] = {0.0, 0.0, (double)NAN, 0.0};
    const dem_obstacle first = SIZED(dem_obstacle, .n_points = 3, .points = infinite, .restitution = 0.0),
                       second = {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = nan, .restitution = 0.0};
    refuse(&first, 1, "obstacle 0: point 2 * not finite");
    refuse(&second, 1, "obstacle 0: point 1 * not finite");
}

TEST(a_segment_without_length_is_named)
{
    const double twice[6] = {0.0, 0.0, 1.0, 0.0, 1.0, 0.0}, far[4] = {-1e308, 0.0, 1e308, 0.0},
                 near[4] = {0.0, 0.0, 0.0, 1e-160}; /* its square has lost its digits */
    const dem_obstacle
        list[2] = {{.struct_size = sizeof(dem_obstacle), .n_points = 4, .points = valley, .restitution = 0.0},
                   {.struct_size = sizeof(dem_obstacle), .n_points = 3, .points = twice, .restitution = 0.0}},
        wide = {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = far, .restitution = 0.0},
        narrow = {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = near, .restitution = 0.0};
    refuse(list, 2, "obstacle 1: segment 1 * length 0 m");
    refuse(&wide, 1, "obstacle 0: segment 0 * length inf m");
    refuse(&narrow, 1, "obstacle 0: segment 0 * length 1e-160 m");
}

TEST(a_polyline_that_meets_itself_is_refused)
{
    static const double crossing[8] = {0.0, 0.0, 2.0, 0.0, 2.0, 1.0, 1.0, -1.0},
                        back[6] = {0.0, 0.0, 2.0, 0.0, 1.0, 0.0};
    static const double six[10] = {-1.0, 0.0, 3.0, 0.0, 3.0, 2.0, 1.0, 2.0, 1.0, 0.0};
    const dem_obstacle list[3] = {
        {.struct_size = sizeof(dem_obstacle), .n_points = 4, .points = crossing, .restitution = 0.0},
        {.struct_size = sizeof(dem_obstacle), .n_points = 3, .points = back, .restitution = 0.0},
        {.struct_size = sizeof(dem_obstacle), .n_points = 5, .points = six, .restitution = 0.0}};
    static const char *const messages[3] = {"obstacle 0: segments 0 and 2 meet",
                                            "obstacle 0: segment 1 goes back over segment 0",
                                            "obstacle 0: segments 0 and 3 meet"};
    for (int k = 0; k < 3; k++) {
        obstacle_set o;
        assert_int_equal(obstacles_compile(&o, &list[k], 1), DEM_ERROR_MODEL);
        assert_message_parts(messages[k]);
    }
}

/* Equal steps in one direction that is none of the axes': segments far apart on a line do not meet, although rounding
 * makes the lines cross. */
TEST(segments_in_line_do_not_meet)
{
    enum { n = 201 };
    double points[2 * n];
    for (int slope = 1; slope < 100; slope++) {
        for (int k = 0; k < n; k++) vec2_put(points, k, (vec2){0.001 * k, 0.001 * k * slope / 100.0});
        CLEANUP(obstacles_free) obstacle_set o = compile(points, n, 0.0);
    }
}

/* The refused pair is the first one with the smallest first segment. */
TEST(of_10000_segments_the_pair_that_meets_is_named)
{
    enum { n = 10001 };
    static double points[2 * n];
    const dem_obstacle obstacle = SIZED(dem_obstacle, .n_points = n, .points = points, .restitution = 0.0);
    for (int k = 0; k < n; k++) vec2_put(points, k, (vec2){1e-4 * k, k % 2 == 0 ? 0.0 : 1e-3});
    CLEANUP(obstacles_free) obstacle_set o = compile(points, n, 0.0);
    assert_int_equal(obstacles_gap(&o, 0.0, (vec2){0.77770001, 2e-3}, 0.0, -1, -1).segment, 7776);
    vec2_put(points, n - 1, (vec2){0.5, 0.9e-3});
    refuse(&obstacle, 1, "obstacle 0: segments 5000 and 9999 meet");
}
