/* SPDX-License-Identifier: BSD-3-Clause */
/* pose.h, motion_law.c: places and directions go in and out, velocities and accelerations are what differences say. */
#include "verification/support.h"

#include "harness/message.h"
#include "obstacle/motion_law.h"

/* c = (1 + 2 t - t^2, t^3), q = 0.3 + 0.7 t + 0.2 t^2. */
static pose turning(double t)
{
    const double angle = 0.3 + t * (0.7 + 0.2 * t);
    return (pose){.centre = {1.0 + t * (2.0 - t), t * t * t},
                  .velocity = {2.0 - 2.0 * t, 3.0 * t * t},
                  .acceleration = {-2.0, 6.0 * t},
                  .axis = {cos(angle), sin(angle)},
                  .spin = 0.7 + 0.4 * t,
                  .spin_rate = 0.4};
}

static void assert_near(vec2 actual, vec2 expected, double tolerance)
{
    assert_close(actual.x, expected.x, tolerance);
    assert_close(actual.y, expected.y, tolerance);
}

TEST(what_goes_in_comes_out_where_it_was)
{
    const pose at = turning(0.8);
    const vec2 x = {0.4, -1.7};
    assert_near(pose_outside(&at, pose_inside(&at, x)), x, 1e-15);
    assert_near(pose_inside(&at, at.centre), (vec2){0.0, 0.0}, 0.0);
    const vec2 turned = pose_turn(&at, (vec2){1.0, 0.0});
    assert_near(turned, at.axis, 0.0);
    assert_near(vec2_sub(pose_outside(&at, (vec2){2.0, 1.0}), pose_outside(&at, (vec2){1.0, 1.0})), turned, 1e-15);
}

/* A point of the body, followed over 2e-4 s; differences are of second order: 1e-8 of the third derivatives, rounding
 * 1e-16/1e-8 of the second. */
TEST(velocity_and_acceleration_are_those_of_a_point_of_the_body)
{
    const double t = 0.8, h = 1e-4;
    const vec2 of_body = {0.4, -1.7};
    const pose before = turning(t - h), at = turning(t), after = turning(t + h);
    const vec2 a = pose_outside(&before, of_body), b = pose_outside(&at, of_body), c = pose_outside(&after, of_body);
    assert_near(pose_velocity(&at, b), vec2_scale(0.5 / h, vec2_sub(c, a)), 1e-7);
    assert_near(pose_acceleration(&at, b), vec2_scale(1.0 / (h * h), vec2_sub(vec2_add(a, c), vec2_scale(2.0, b))),
                1e-6);
}

TEST(a_constant_velocity_carries_everything_along)
{
    const dem_obstacle obstacle = {.struct_size = sizeof(dem_obstacle), .velocity = {3.0, -4.0}},
                       rest = {.struct_size = sizeof(dem_obstacle), .n_points = 0},
                       same = {.struct_size = sizeof(dem_obstacle), .velocity = {3.0, -4.0}};
    const motion_law law = motion_law_of(&obstacle), none = motion_law_of(&rest), other = motion_law_of(&same);
    const pose at = motion_law_pose(&law, 0.5);
    assert_true(law.moves && !none.moves);
    const motion_bounds bounds = motion_law_bounds(&law);
    assert_true(bounds.speed == 5.0 && bounds.acceleration == 0.0 && bounds.rate == 0.0);
    assert_close(motion_law_bounds(&none).speed, 0.0, 0.0);
    assert_true(motion_law_is_same(&law, &other) && !motion_law_is_same(&law, &none));
    assert_near(pose_outside(&at, (vec2){1.0, 1.0}), (vec2){2.5, -1.0}, 0.0);
    assert_near(pose_velocity(&at, (vec2){7.0, 7.0}), (vec2){3.0, -4.0}, 0.0);
    assert_near(pose_acceleration(&at, (vec2){7.0, 7.0}), (vec2){0.0, 0.0}, 0.0);
    assert_near(pose_outside(&(pose){.axis = {1.0, 0.0}}, (vec2){1.0, 1.0}), (vec2){1.0, 1.0}, 0.0);
}

TEST(points_go_where_the_obstacle_has_gone_also_in_place)
{
    const double given[4] = {1.0, 2.0, -3.0, 4.0};
    double points[4] = {1.0, 2.0, -3.0, 4.0};
    const dem_obstacle obstacle = SIZED(dem_obstacle, .n_points = 2, .points = points, .velocity = {3.0, -4.0}),
                       rest = {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = given};
    dem_obstacle_points(&obstacle, 0.5, points);
    assert_true(points[0] == 2.5 && points[1] == 0.0 && points[2] == -1.5 && points[3] == 2.0);
    dem_obstacle_points(&rest, 0.5, points);
    assert_memory_equal(points, given, sizeof given);
}

TEST(fields_are_listed_one_by_one)
{
    const dem_obstacle moves = {.struct_size = sizeof(dem_obstacle), .velocity = {1.0, 0.0}},
                       rest = {.struct_size = sizeof(dem_obstacle), .n_points = 0};
    const dem_motion_field *field = dem_motion_field_at(0), copy = *field, other = {.n = 1, .offset = 0};
    dem_index k = 0;
    assert_true(field->n == 2 && field->offset == offsetof(dem_obstacle, velocity));
    assert_string_equal(field->name, "velocity");
    assert_string_equal(field->unit, "m/s");
    assert_true(dem_obstacle_moves(&moves, field) && dem_obstacle_moves(&moves, NULL));
    assert_true(dem_obstacle_moves(&moves, &copy));
    assert_true(!dem_obstacle_moves(&moves, &other) && !dem_obstacle_moves(&rest, field));
    assert_false(dem_obstacle_moves(&rest, NULL));
    while (dem_motion_field_at(k) != NULL) k++;
    assert_null(dem_motion_field_at(-1));
    assert_true(k >= 1);
}

TEST(a_motion_that_cannot_be_computed_with_is_refused)
{
    const dem_obstacle unknown = {.struct_size = sizeof(dem_obstacle), .velocity = {0.0, (double)NAN}},
                       fast = {.struct_size = sizeof(dem_obstacle), .velocity = {1e300, 1e300}},
                       rising = {.struct_size = sizeof(dem_obstacle), .velocity = {0.0, 0.0, 1.5}};
    assert_int_equal(motion_law_check(&unknown, 3), DEM_ERROR_MODEL);
    assert_message_parts("obstacle 3: velocity * nan m/s * not finite");
    assert_int_equal(motion_law_check(&fast, 3), DEM_ERROR_MODEL);
    assert_message_parts("obstacle 3: velocity * inf m/s * 0 m/s^2");
    assert_int_equal(motion_law_check(&rising, 3), DEM_ERROR_MODEL);
    assert_message_parts("obstacle 3: velocity * third component * 1.5");
}
