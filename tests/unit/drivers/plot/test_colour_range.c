/* SPDX-License-Identifier: BSD-3-Clause */
/* colour_range.c: limits of colours. */
#include "unit/close.h"

#include <stdlib.h>

#include "colour_range.h"

enum { MANY = 1000 };

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Random numbers, many of them equal, against qsort. */
TEST(the_kth_is_that_of_a_sorted_array)
{
    uint64_t bits = UINT64_C(88172645463325252);
    for (size_t n = 1; n < 40; n++)
        for (size_t k = 0; k < n; k++) {
            double value[40], sorted[40];
            for (size_t i = 0; i < n; i++) {
                bits ^= bits << 13, bits ^= bits >> 7, bits ^= bits << 17;
                value[i] = sorted[i] = (double)(bits % 12);
            }
            qsort(sorted, n, sizeof *sorted, compare);
            assert_close(colour_range_kth(n, value, k), sorted[k], 0.0);
        }
}

TEST(a_few_extremes_do_not_matter)
{
    double value[MANY], size[MANY];
    for (int k = 0; k < MANY; k++) value[k] = (k % 2 == 0 ? 1e-3 : -1e-3) * k;
    value[7] = -5.0;
    const colour_range_extent reach = colour_range_extent_of(MANY, value, size);
    assert_close(reach.least, -5.0, 0.0);
    assert_close(reach.most, 0.998, 1e-15);
    assert_close(reach.usual, 0.995, 1.1e-3);
    const colour_range s = colour_range_around(reach, true);
    assert_close(s.hi, 1.0, 1e-15);
    assert_close(s.lo, -s.hi, 0.0);
    assert_true(s.below && !s.above);
}

/* Nearly all springs are at rest: those that are not must not all have the last colour. */
TEST(a_tenth_of_the_largest_is_within)
{
    double value[MANY] = {0}, size[MANY];
    value[3] = 0.12;
    const colour_range s = colour_range_around(colour_range_extent_of(MANY, value, size), true);
    assert_close(s.hi, 0.015, 1e-15);
    assert_true(s.above && !s.below);
}

TEST(frames_are_joined_by_the_larger)
{
    const colour_range_extent a = {-1.0, 2.0, 1.5}, b = {-3.0, 1.0, 2.5}, both = colour_range_extent_join(a, b);
    assert_close(both.least, -3.0, 0.0);
    assert_close(both.most, 2.0, 0.0);
    assert_close(both.usual, 2.5, 0.0);
    assert_close(colour_range_around(both, false).lo, 0.0, 0.0);
    assert_close(colour_range_around(both, false).hi, 3.0, 1e-15);
}

static void expect_limits(double least, double most, double lo, double hi)
{
    const colour_range s = colour_range_around((colour_range_extent){least, most, fmax(most, -least)}, true);
    assert_close(s.lo, lo, 0.0);
    assert_close(s.hi, hi, 0.0);
    assert_int_equal(s.below, least < lo);
    assert_int_equal(s.above, most > hi);
}

/* 1.9 and 2 of 40 are on either side of a twentieth. */
TEST(a_side_with_next_to_nothing_is_left_out)
{
    expect_limits(0.0, 40.0, 0.0, 40.0);
    expect_limits(-1.9, 40.0, 0.0, 40.0);
    expect_limits(-2.1, 40.0, -40.0, 40.0);
    expect_limits(-40.0, 0.0, -40.0, 0.0);
    expect_limits(-40.0, 1.9, -40.0, 0.0);
    expect_limits(-40.0, 2.1, -40.0, 40.0);
    expect_limits(3.0, 40.0, 0.0, 40.0);
}

TEST(without_values_there_are_limits_all_the_same)
{
    double value[2] = {0.0, (double)NAN}, size[2];
    const colour_range none = colour_range_around(colour_range_extent_none(), true),
                       zero = colour_range_around(colour_range_extent_of(2, value, size), true);
    assert_close(none.hi, 1.0, 0.0);
    assert_false(none.above || none.below);
    assert_close(zero.hi, 1.0, 0.0);
    assert_close(none.lo, -1.0, 0.0);
    assert_close(zero.lo, -1.0, 0.0);
}

TEST(given_limits_are_taken_as_they_are)
{
    const colour_range s = colour_range_given(0.1, 0.7, (colour_range_extent){0.2, 0.8, 0.7});
    assert_close(s.lo, 0.1, 0.0);
    assert_close(s.hi, 0.7, 0.0);
    assert_true(s.above && !s.below);
}
