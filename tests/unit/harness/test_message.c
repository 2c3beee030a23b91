/* SPDX-License-Identifier: BSD-3-Clause */
/* harness/message.c: which parts a message has. */
#include "harness/message.h"

TEST(parts_are_found_in_their_order)
{
    static const char text[] = "node 0 at (0.5, -0.125) m starts 0.125 m inside obstacle 3";
    assert_true(message_has_parts(text, text));
    assert_true(message_has_parts(text, "node 0 * (0.5, -0.125) m * 0.125 m * obstacle 3"));
    assert_false(message_has_parts(text, "obstacle 3 * node 0"));
    assert_false(message_has_parts(text, "node 0 * node 0"));
    assert_false(message_has_parts(text, "node 1"));
}

TEST(parts_are_whole_words_and_numbers)
{
    static const char text[] = "rtol is 1e-05, must be in [0.25, 10], got -3.5.";
    assert_true(message_has_parts(text, "rtol * 1e-05 * [0.25, 10] * -3.5"));
    assert_false(message_has_parts(text, "1e-0"));
    assert_false(message_has_parts(text, "05"));
    assert_false(message_has_parts(text, "25"));
    assert_false(message_has_parts(text, "3.5"));
    assert_false(message_has_parts(text, "-3"));
    assert_false(message_has_parts(text, "tol"));
    assert_true(message_has_parts("has 2, 0, 3", "2 * 0 * 3"));
}

TEST(lines_have_parts_of_their_own)
{
    static const char text[] = "3:41 'x' is 0.5 m\n4:1 &body lacks 'y'\n";
    assert_true(message_lines_have_parts(text, "3:41 * 'x' * 0.5 m\n4:1 * 'y'"));
    assert_true(message_lines_have_parts(text, "'x'\n&body * 'y'\n"));
    assert_false(message_lines_have_parts(text, "3:41 * 'x'"));
    assert_false(message_lines_have_parts(text, "3:41 * 'x'\n4:1 * 'y'\n5:1"));
    assert_false(message_lines_have_parts(text, "3:41 * 'y'\n4:1 * 'x'"));
    assert_true(message_lines_have_parts("", ""));
    assert_false(message_lines_have_parts("", "4:1"));
    assert_false(message_lines_have_parts("4:1 x", ""));
}

TEST(a_place_is_at_the_beginning_of_its_line)
{
    assert_false(message_lines_have_parts("23:41 'x'", "3:41 * 'x'"));
    assert_false(message_lines_have_parts("3:411 'x'", "3:41 * 'x'"));
    assert_false(message_lines_have_parts("2:1 'x' at 3:41", "3:41"));
    assert_false(message_lines_have_parts("1: 22 pixels", "22 * pixels"));
}
