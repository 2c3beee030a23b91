/* SPDX-License-Identifier: BSD-3-Clause */
/* deck_numbers.c: messages with bodies counted from 1. */
#include "deck_numbers.h"

#include "unit/close.h"

static void expect(const char *message, const char *expected)
{
    char out[128];
    deck_numbers_translate(out, sizeof out, message);
    assert_string_equal(out, expected);
}

TEST(bodies_are_counted_from_one_and_nothing_else_is)
{
    expect("node 26 of body 0 at (1, 2) m is inside body 9", "node 26 of body 1 at (1, 2) m is inside body 10");
    expect("body 0", "body 1");
    expect("body 0 crosses obstacle 1 of obstacles 2", "body 1 crosses obstacle 2 of obstacles 2");
    expect("the body, nobody 0, a body part 3", "the body, nobody 0, a body part 3");
    expect("", "");
}

TEST(what_is_too_long_is_cut)
{
    char out[8];
    deck_numbers_translate(out, sizeof out, "of body 99 and more");
    assert_string_equal(out, "of body");
    deck_numbers_translate(out, sizeof out, "body 99 and more");
    assert_string_equal(out, "body 10");
}
