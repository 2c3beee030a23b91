/* SPDX-License-Identifier: BSD-3-Clause */
/* ticks.c: round numbers. */
#include "unit/close.h"

#include <string.h>

#include "ticks.h"

static void expect_prefix(double largest, double factor, const char *name)
{
    const ticks_prefix found = ticks_prefix_of(largest);
    assert_close(found.factor, factor, 1e-12 * factor);
    assert_string_equal(found.name, name);
}

TEST(prefixes_leave_one_to_three_digits)
{
    expect_prefix(0.02, 1e-3, "m");
    expect_prefix(1e-3, 1e-3, "m");
    expect_prefix(9.99e-4, 1e-6, "µ");
    expect_prefix(999.0, 1.0, "");
    expect_prefix(1000.0, 1e3, "k");
    expect_prefix(3e6, 1e6, "M");
    expect_prefix(0.0, 1.0, "");
    expect_prefix(1e-30, 1.0, "");
    expect_prefix(1e30, 1.0, "");
    expect_prefix((double)NAN, 1.0, "");
    expect_prefix((double)INFINITY, 1.0, "");
}

TEST(round_numbers_enclose)
{
    for (double x = 1e-7; x < 1e7; x *= 1.0372) {
        const double above = ticks_above(x), below = ticks_below(x);
        assert_true(above >= x * (1.0 - 1e-8) && above <= 1.51 * x);
        assert_true(below <= x * (1.0 + 1e-8) && below >= 0.39 * x);
    }
    assert_close(ticks_above(0.3), 0.3, 1e-15);
    assert_close(ticks_above(0.1 + 0.2), 0.3, 1e-15);
    assert_close(ticks_above(8.1), 10.0, 1e-15);
    assert_close(ticks_below(0.5), 0.5, 1e-15);
    assert_close(ticks_below(4.99), 2.0, 1e-15);
}

TEST(ticks_are_even_and_inside)
{
    for (double lo = -3.0; lo < 3.0; lo += 0.37)
        for (double size = 1e-3; size < 1e3; size *= 2.3)
            for (int most = 2; most <= TICKS_MOST; most++) {
                const ticks t = ticks_linear(lo, lo + size, most);
                assert_true(t.n >= 2 && t.n <= (most > 5 ? most : 5));
                assert_true(t.n >= (2 * most - 2) / 5); /* a step is no more than 2.5 times too long */
                for (int k = 0; k < t.n; k++)
                    assert_true(t.at[k] >= lo - 1e-8 * size && t.at[k] <= lo + size * (1 + 1e-8));
                for (int k = 2; k < t.n; k++)
                    assert_close(t.at[k] - t.at[k - 1], t.at[1] - t.at[0], 1e-12 * (1.0 + size));
            }
}

TEST(both_ends_are_ticks_where_they_are_round)
{
    const ticks t = ticks_linear(0.0, 3.0, 7);
    assert_int_equal(t.n, 7);
    assert_close(t.at[0], 0.0, 0.0);
    assert_close(t.at[6], 3.0, 1e-15);
    assert_int_equal(t.decimals, 1);
}

TEST(decades_are_no_more_than_asked_for)
{
    const ticks few = ticks_decades(1e-9, 1e-5, 8), many = ticks_decades(2e-12, 3e9, 6);
    assert_int_equal(few.n, 5);
    assert_close(few.at[0], 1e-9, 1e-20);
    assert_true(many.n <= 6 && many.n >= 3);
    assert_int_equal(ticks_decades(2.0, 9.0, 4).n, 0);
}

static void expect_text(double value, int decimals, const char *expected)
{
    char text[TICKS_TEXT];
    ticks_print(text, value, decimals);
    assert_string_equal(text, expected);
}

TEST(numbers_are_written_as_in_books)
{
    char text[TICKS_TEXT];
    expect_text(-0.25, 2, "−0.25");
    expect_text(-0.001, 1, "0.0"); /* no minus before nothing */
    expect_text(1e3, 0, "1000");
    ticks_print_power(text, 1e-13);
    assert_string_equal(text, "10⁻¹³");
    ticks_print_power(text, 1.0);
    assert_string_equal(text, "10⁰");
}

TEST(decimals_are_those_needed)
{
    assert_int_equal(ticks_decimals(20.0), 0);
    assert_int_equal(ticks_decimals(0.5), 1);
    assert_int_equal(ticks_decimals(0.125), 3);
    assert_int_equal(ticks_decimals(0.1 + 0.2), 1);
    assert_int_equal(ticks_decimals(1e-20), 9);
}
