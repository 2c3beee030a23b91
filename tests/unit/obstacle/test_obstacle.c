/* SPDX-License-Identifier: BSD-3-Clause */
/* obstacle.c: places along segments, and bends. Tolerances of 1e-15 are the rounding of coordinates of order 1 m. */
#include "unit/obstacle/landscape.h"

static void height_and_place_are_measured_from_the_start(void **state)
{
    const vec2 x = {0.5 + 0.1, -0.5 + 0.1};
    (void)state;
    obstacle_set o = compile(valley, 4, 0.0);
    assert_close(segment_place(&o.segments[1], x), sqrt(0.5), 1e-15);
    assert_close(segment_height(&o.segments[1], x), 0.1 * sqrt(2.0), 1e-15);
    obstacles_free(&o);
}

static void check_bend(const obstacle_set *o, dem_index s, bool backwards, obstacle_bend bend, dem_index expected)
{
    dem_index beyond = 77;
    assert_int_equal(obstacles_bend(o, s, backwards, &beyond), bend);
    assert_int_equal(beyond, expected);
}

static void bends_are_told_from_both_sides_alike(void **state)
{
    (void)state;
    obstacle_set o = compile_both();
    check_bend(&o, 0, true, OBSTACLE_FREE_END, -1);
    check_bend(&o, 0, false, OBSTACLE_CONVEX, 1);
    check_bend(&o, 1, true, OBSTACLE_CONVEX, 0);
    check_bend(&o, 1, false, OBSTACLE_CONCAVE, 2);
    check_bend(&o, 2, true, OBSTACLE_CONCAVE, 1);
    check_bend(&o, 2, false, OBSTACLE_FREE_END, -1);
    check_bend(&o, 6, false, OBSTACLE_CONVEX, 3); /* where the ring closes */
    check_bend(&o, 3, true, OBSTACLE_CONVEX, 6);
    obstacles_free(&o);
}

/* Straight is a sine of the bend below 1e-9; a line that turns back is none, though its sine is 0. */
static void a_bend_below_1e_9_is_straight(void **state)
{
    const double points[10] = {0.0, 0.0, 1.0, 0.0, 2.0, 0.5e-9, 3.0, 3.0e-9, 4.0, 3.0e-9};
    (void)state;
    obstacle_set o = compile(points, 5, 0.0);
    check_bend(&o, 0, false, OBSTACLE_STRAIGHT, 1);
    check_bend(&o, 1, true, OBSTACLE_STRAIGHT, 0);
    check_bend(&o, 1, false, OBSTACLE_CONCAVE, 2);
    check_bend(&o, 2, false, OBSTACLE_CONVEX, 3);
    obstacles_free(&o);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(height_and_place_are_measured_from_the_start),
        cmocka_unit_test(bends_are_told_from_both_sides_alike),
        cmocka_unit_test(a_bend_below_1e_9_is_straight),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
