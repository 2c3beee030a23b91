/* SPDX-License-Identifier: BSD-3-Clause */
/* ramp.h: the value at its ends, and that each function is the derivative of the one before. */
#include "unit/close.h"

#include "base/ramp.h"

TEST(a_ramp_is_0_before_and_1_after)
{
    assert_true(ramp_value(2.0, -1.0) == 0.0 && ramp_value(2.0, 0.0) == 0.0 && ramp_value(2.0, 2.0) == 1.0);
    assert_true(ramp_area(2.0, -1.0) == 0.0 && ramp_area(2.0, 2.0) == 1.0 && ramp_area(2.0, 5.0) == 4.0);
    assert_true(ramp_slope(2.0, 0.0) == 0.0 && ramp_slope(2.0, 2.0) == 0.0 && ramp_slope(2.0, 9.0) == 0.0);
    assert_true(ramp_curvature(2.0, 0.0) == 0.0 && ramp_curvature(2.0, 2.0) == 0.0);
    assert_true(ramp_value(0.0, 1e-9) == 1.0 && ramp_area(0.0, 3.0) == 3.0 && ramp_slope(0.0, 3.0) == 0.0);
}

/* Central differences over h have the error h^2/6 times the third derivative, at most 60/T^3 here, and 1e-16/h of
 * rounding: below 1e-8. */
TEST(each_function_is_the_derivative_of_the_one_before)
{
    const double length = 2.0, h = 1e-5;
    for (double t = -0.3; t < 2.5; t += 0.17) {
        assert_close(ramp_value(length, t), (ramp_area(length, t + h) - ramp_area(length, t - h)) / (2.0 * h), 1e-8);
        assert_close(ramp_slope(length, t), (ramp_value(length, t + h) - ramp_value(length, t - h)) / (2.0 * h), 1e-8);
        assert_close(ramp_curvature(length, t), (ramp_slope(length, t + h) - ramp_slope(length, t - h)) / (2.0 * h),
                     1e-8);
    }
}

/* The steepest place is the middle; the most curved ones are 1/2 -+ sqrt(3)/6 of the length. */
TEST(bounds_of_the_derivatives_are_reached)
{
    assert_close(ramp_slope(2.0, 1.0), RAMP_STEEPEST / 2.0, 1e-15);
    assert_close(ramp_curvature(2.0, 1.0 - sqrt(1.0 / 3.0)), RAMP_MOST_CURVED / 4.0, 1e-14);
    assert_close(ramp_curvature(2.0, 1.0 + sqrt(1.0 / 3.0)), -RAMP_MOST_CURVED / 4.0, 1e-14);
}
