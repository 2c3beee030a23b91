/* SPDX-License-Identifier: BSD-3-Clause */
/* given_motion.c: poses that a function gives, and what becomes of those that cannot be used. */
#include "verification/support.h"

#include "harness/message.h"
#include "obstacle/given_motion.h"
#include "obstacle/motion_law.h"

static const double points[4] = {3.0, 4.0, 0.0, 1.0}; /* the first is 5 m from the origin */

/* A copy of what the context points to. */
static dem_status give(void *context, double t, dem_pose *out)
{
    const dem_pose *given = context;
    assert_true(out->struct_size == sizeof *out && out->angle == 0.0 && out->place[1] == 0.0);
    (void)t;
    *out = *given;
    return DEM_OK;
}

static dem_status refuse_it(void *context, double t, dem_pose *out)
{
    (void)context, (void)t;
    out->place[0] = 7.0;
    return DEM_STOPPED;
}

static dem_obstacle moved_by(dem_motion function, dem_pose *given)
{
    return (dem_obstacle){.struct_size = sizeof(dem_obstacle),
                          .n_points = 2,
                          .points = points,
                          .motion = function,
                          .motion_context = given,
                          .most_speed = 13.0,
                          .most_acceleration = 130.0,
                          .longest_step = 0.25};
}

TEST(the_pose_is_what_the_function_says)
{
    dem_pose given = {.place = {1.0, 2.0}, .velocity = {3.0, 0.0}, .angle = 0.5 * M_PI, .spin = 2.0, .spin_rate = 4.0};
    const dem_obstacle obstacle = moved_by(give, &given);
    const motion_law law = motion_law_of(&obstacle);
    const pose at = motion_law_pose(&law, 9.0);
    const vec2 x = pose_outside(&at, (vec2){3.0, 4.0});
    assert_true(law.moves && !given_motion_failed());
    assert_close(x.x, 1.0 - 4.0, 1e-15);
    assert_close(x.y, 2.0 + 3.0, 1e-15);
    assert_true(at.velocity.x == 3.0 && at.spin == 2.0 && at.spin_rate == 4.0);
    const motion_bounds bounds = motion_law_bounds(&law);
    assert_true(bounds.speed == 13.0 && bounds.acceleration == 130.0 && bounds.step_rate == 4.0);
}

/* A failure stands for rest, is kept until it is asked for, and only the first one is reported. */
static void expect_failure(const dem_pose *bad, const char *message)
{
    dem_pose given = *bad;
    const dem_obstacle obstacle = moved_by(give, &given);
    const motion_law law = motion_law_of(&obstacle);
    const struct pose at = motion_law_pose(&law, 9.0);
    assert_true(given_motion_failed() && at.centre.x == 0.0 && at.spin == 0.0 && at.axis.x == 1.0);
    (void)motion_law_pose(&law, 10.0);
    assert_int_equal(given_motion_failure(), DEM_ERROR_INTEGRATOR);
    assert_message_parts(message);
    assert_false(given_motion_failed());
    assert_int_equal(given_motion_failure(), DEM_OK);
}

TEST(poses_that_cannot_be_used_are_failures)
{
    expect_failure(&(dem_pose){.velocity = {0.0, (double)NAN}}, "motion of an obstacle is not finite at t = 9 s");
    expect_failure(&(dem_pose){.spin_rate = (double)INFINITY}, "not finite");
    expect_failure(&(dem_pose){.place = {0.0, 0.0, 1.0}}, "third component");
    expect_failure(&(dem_pose){.velocity = {3.0, 0.0}, .spin = 2.01}, "faster than its most_speed"); /* 3 + 5 spin */
    expect_failure(&(dem_pose){.acceleration = {0.0, 131.0}}, "most_acceleration");
    expect_failure(&(dem_pose){.spin = 2.0, .spin_rate = 26.0}, "most_acceleration"); /* 5 hypot(26, 4) */
}

TEST(a_status_of_the_function_is_returned)
{
    dem_pose given = {0};
    const dem_obstacle obstacle = moved_by(refuse_it, &given);
    double place[4], velocity[2];
    const motion_law law = motion_law_of(&obstacle);
    assert_true(motion_law_pose(&law, 1.5).centre.x == 0.0);
    assert_int_equal(given_motion_failure(), DEM_STOPPED);
    assert_message_parts("motion of an obstacle was refused at t = 1.5 s");
    assert_int_equal(dem_obstacle_points(&obstacle, 1.0, place), DEM_STOPPED);
    assert_int_equal(dem_obstacle_velocity(&obstacle, 1.0, place, velocity), DEM_STOPPED);
}

TEST(two_obstacles_go_together_by_the_same_function_and_context)
{
    dem_pose given = {0}, same = {0};
    const dem_obstacle one = moved_by(give, &given), two = moved_by(give, &given), three = moved_by(give, &same);
    const motion_law a = motion_law_of(&one), b = motion_law_of(&two), c = motion_law_of(&three);
    assert_true(motion_law_is_same(&a, &b) && !motion_law_is_same(&a, &c));
}

static void refuse(const dem_obstacle *obstacle, const char *message)
{
    dem_index segments[2];
    assert_int_equal(dem_obstacle_check(obstacle, segments), DEM_ERROR_MODEL);
    assert_message_parts(message);
}

TEST(a_motion_by_a_function_needs_its_bounds_and_stands_alone)
{
    dem_pose given = {0}, bad = {.angle = (double)NAN};
    dem_obstacle o = moved_by(give, &given);
    dem_index segments[2];
    assert_ok(dem_obstacle_check(&o, segments));
    o.most_speed = 0.0;
    refuse(&o, "obstacle 0: * most_speed > 0");
    o = moved_by(give, &given);
    o.most_acceleration = -1.0;
    refuse(&o, "obstacle 0: * most_acceleration >= 0");
    o = moved_by(give, &given);
    o.longest_step = (double)NAN;
    refuse(&o, "obstacle 0: * longest_step");
    o = moved_by(give, &given);
    o.spin = 1.0;
    refuse(&o, "obstacle 0: * function * numbers");
    o = moved_by(give, &bad);
    refuse(&o, "obstacle 0: * not finite at t = 0 s");
    assert_false(given_motion_failed());
}
