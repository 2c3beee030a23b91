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
    assert_true(bounds.speed == 5.0 && bounds.acceleration == 0.0 && bounds.step_rate == 0.0);
    assert_close(motion_law_bounds(&none).speed, 0.0, 0.0);
    assert_true(motion_law_is_same(&law, &other) && !motion_law_is_same(&law, &none));
    assert_near(pose_outside(&at, (vec2){1.0, 1.0}), (vec2){2.5, -1.0}, 0.0);
    assert_near(pose_velocity(&at, (vec2){7.0, 7.0}), (vec2){3.0, -4.0}, 0.0);
    assert_near(pose_acceleration(&at, (vec2){7.0, 7.0}), (vec2){0.0, 0.0}, 0.0);
    assert_near(pose_outside(&(pose){.axis = {1.0, 0.0}}, (vec2){1.0, 1.0}), (vec2){1.0, 1.0}, 0.0);
}

/* ---- kinds, their sum and the ramp ---- */

/* One that does all at once, with points up to 2 m from its pivot. */
static const double flag[6] = {1.0, 0.5, 1.0, -1.5, 2.2, -1.1};
static const dem_obstacle all_at_once = {.struct_size = sizeof(dem_obstacle),
                                         .n_points = 3,
                                         .points = flag,
                                         .velocity = {0.3, -0.2},
                                         .amplitude = {0.1, 0.2},
                                         .frequency = 1.7,
                                         .phase = 40.0,
                                         .pivot = {1.0, 0.5},
                                         .spin = -2.5,
                                         .ramp = 0.6};

TEST(an_oscillation_swings_about_the_points_given)
{
    const dem_obstacle table = {
        .struct_size = sizeof(dem_obstacle), .amplitude = {0.0, 2e-3}, .frequency = 50.0, .phase = 90.0};
    const motion_law law = motion_law_of(&table);
    const double omega = 100.0 * M_PI, amplitude = 2e-3;
    assert_close(motion_law_pose(&law, 0.0).centre.y, amplitude, 1e-18);
    assert_close(motion_law_pose(&law, 0.0).acceleration.y, -amplitude * omega * omega, 1e-12);
    assert_close(motion_law_pose(&law, 0.005).centre.y, 0.0, 1e-17);
    assert_close(motion_law_pose(&law, 0.005).velocity.y, -amplitude * omega, 1e-14);
    assert_close(motion_law_pose(&law, 0.01).centre.y, -amplitude, 1e-17);
    const motion_bounds bounds = motion_law_bounds(&law);
    assert_close(bounds.speed, amplitude * omega, 1e-15);
    assert_close(bounds.acceleration, amplitude * omega * omega, 1e-12);
    assert_close(bounds.step_rate, 1000.0, 0.0); /* 20 steps to a period */
}

TEST(a_rotation_turns_about_its_pivot)
{
    const dem_obstacle wheel = SIZED(dem_obstacle, .n_points = 3, .points = flag, .pivot = {1.0, 0.5}, .spin = 3.0);
    const motion_law law = motion_law_of(&wheel);
    const pose at = motion_law_pose(&law, M_PI / 6.0); /* a quarter turn */
    assert_near(pose_outside(&at, (vec2){1.0, 0.5}), (vec2){1.0, 0.5}, 0.0);
    assert_near(pose_outside(&at, (vec2){3.0, 0.5}), (vec2){1.0, 2.5}, 1e-15);
    assert_near(pose_velocity(&at, (vec2){1.0, 2.5}), (vec2){-6.0, 0.0}, 1e-15);
    assert_near(pose_acceleration(&at, (vec2){1.0, 2.5}), (vec2){0.0, -18.0}, 1e-14);
    assert_close(at.angle, 0.5 * M_PI, 1e-15);
    const motion_bounds bounds = motion_law_bounds(&law);
    assert_close(bounds.speed, 3.0 * 2.0, 1e-14); /* the point (2.2, -1.1) is 2 m from the pivot, as is (1, -1.5) */
    assert_close(bounds.acceleration, 9.0 * 2.0, 1e-13);
    assert_close(1.0 / bounds.step_rate, 0.05 / 3.0, 1e-17);
}

/* The pose is that of a turn about the pivot, which is carried by the other two. */
TEST(kinds_add_up)
{
    dem_obstacle alone = all_at_once;
    alone.ramp = 0.0;
    const double t = 0.37, swing = sin(2.0 * M_PI * 1.7 * t + 40.0 * M_PI / 180.0), angle = -2.5 * t;
    const motion_law law = motion_law_of(&alone);
    const pose at = motion_law_pose(&law, t);
    const vec2 x = {2.2, -1.1}, r = {1.2, -1.6};
    const vec2 expected = {1.0 + 0.3 * t + 0.1 * swing + cos(angle) * r.x - sin(angle) * r.y,
                           0.5 - 0.2 * t + 0.2 * swing + sin(angle) * r.x + cos(angle) * r.y};
    assert_near(pose_outside(&at, x), expected, 1e-15);
    assert_near(pose_inside(&at, expected), x, 1e-15);
}

/* Derivatives are those of the place by differences: the fourth derivative is 1e4, so that over h = 1e-4 the error is
 * 1e-6 of the velocity and 1e-5 of the acceleration, and rounding is below. */
TEST(velocities_and_accelerations_of_the_sum_follow_from_its_places)
{
    const motion_law law = motion_law_of(&all_at_once);
    const double h = 1e-4;
    for (double t = 0.013; t < 1.0; t += 0.0617) {
        const pose before = motion_law_pose(&law, t - h), at = motion_law_pose(&law, t),
                   after = motion_law_pose(&law, t + h);
        const vec2 x = {2.2, -1.1};
        const vec2 a = pose_outside(&before, x), b = pose_outside(&at, x), c = pose_outside(&after, x);
        assert_near(pose_velocity(&at, b), vec2_scale(0.5 / h, vec2_sub(c, a)), 1e-5);
        assert_near(pose_acceleration(&at, b), vec2_scale(1.0 / (h * h), vec2_sub(vec2_add(a, c), vec2_scale(2.0, b))),
                    1e-4);
        assert_close(at.spin, (after.angle - before.angle) / (2.0 * h), 1e-6);
        assert_close(at.spin_rate, (after.spin - before.spin) / (2.0 * h), 1e-5);
        assert_near(at.axis, (vec2){cos(at.angle), sin(at.angle)}, 0.0);
    }
}

/* At t = 0 everything is at rest where it was given, and stays continuous up to accelerations. */
TEST(with_a_ramp_all_begins_at_rest)
{
    const motion_law law = motion_law_of(&all_at_once);
    const pose at = motion_law_pose(&law, 0.0), soon = motion_law_pose(&law, 1e-6);
    const vec2 x = {2.2, -1.1};
    assert_near(pose_outside(&at, x), x, 1e-15);
    assert_near(pose_velocity(&at, x), (vec2){0.0, 0.0}, 0.0);
    assert_near(pose_acceleration(&at, x), (vec2){0.0, 0.0}, 0.0);
    assert_near(pose_acceleration(&soon, x), (vec2){0.0, 0.0}, 1e-3);
}

TEST(no_point_exceeds_the_bounds)
{
    dem_obstacle sudden = all_at_once;
    sudden.ramp = 0.0;
    const dem_obstacle *const both[2] = {&all_at_once, &sudden};
    for (int k = 0; k < 2; k++) {
        const motion_law law = motion_law_of(both[k]);
        const motion_bounds bounds = motion_law_bounds(&law);
        double speed = 0.0, acceleration = 0.0;
        for (double t = 0.0; t < 3.0; t += 1e-3) {
            const pose at = motion_law_pose(&law, t);
            const vec2 x = pose_outside(&at, (vec2){2.2, -1.1});
            speed = fmax(speed, vec2_norm(pose_velocity(&at, x)));
            acceleration = fmax(acceleration, vec2_norm(pose_acceleration(&at, x)));
        }
        assert_true(speed <= bounds.speed && acceleration <= bounds.acceleration);
        assert_true(speed > 0.5 * bounds.speed && acceleration > 0.3 * bounds.acceleration); /* not far off */
    }
}

TEST(equal_motions_are_those_with_equal_numbers)
{
    dem_obstacle other = all_at_once;
    const motion_law law = motion_law_of(&all_at_once), same = motion_law_of(&other);
    assert_true(motion_law_is_same(&law, &same));
    other.ramp = 0.7;
    assert_false(motion_law_is_same(&law, &same));
    other = all_at_once;
    other.pivot[1] = 0.6;
    assert_false(motion_law_is_same(&law, &same));
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
    assert_int_equal(k, 7);
}

/* The ramp is of all kinds; without one it is not a field of the motion. */
TEST(a_field_is_of_the_kinds_that_use_it)
{
    static const char *const names[7] = {"velocity", "amplitude", "frequency", "phase", "pivot", "spin", "ramp"};
    dem_obstacle wheel = SIZED(dem_obstacle, .n_points = 3, .points = flag, .spin = 3.0, .ramp = 0.1);
    for (dem_index k = 0; k < 7; k++) {
        const dem_motion_field *field = dem_motion_field_at(k);
        assert_string_equal(field->name, names[k]);
        assert_true(dem_obstacle_moves(&wheel, field) == (k >= 4));
    }
    wheel.ramp = 0.0;
    assert_false(dem_obstacle_moves(&wheel, dem_motion_field_at(6)));
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

static void refuse(const dem_obstacle *obstacle, const char *message)
{
    assert_int_equal(motion_law_check(obstacle, 3), DEM_ERROR_MODEL);
    assert_message_parts(message);
}

TEST(an_amplitude_needs_a_frequency_and_no_time_is_negative)
{
    const dem_obstacle still = {.struct_size = sizeof(dem_obstacle), .amplitude = {0.0, 1.0}},
                       back = {.struct_size = sizeof(dem_obstacle), .frequency = -1.0},
                       ramp = {.struct_size = sizeof(dem_obstacle), .ramp = -0.5},
                       high = {.struct_size = sizeof(dem_obstacle), .pivot = {0.0, 0.0, 1.0}};
    refuse(&still, "obstacle 3: an amplitude * without a frequency");
    refuse(&back, "obstacle 3: * frequency * below 0");
    refuse(&ramp, "obstacle 3: ramp * -0.5 s");
    refuse(&high, "obstacle 3: pivot has a third component");
}
