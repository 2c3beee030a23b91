/* SPDX-License-Identifier: BSD-3-Clause */
/* deck_numbers.c: messages with bodies counted from 1, and copies by their group. */
#include "unit/reading.h"

#include "deck_numbers.h"

#define BODY "&body shape = 'disc', radius = 1, spacing = 0.25"

static void expect(const char *message, const char *expected, size_t size)
{
    CLEANUP(drop_resolved)
    resolved r = resolve_clean("&run t_end = 1 /\n" BODY " /\n" BODY ", copies = 4, 2, pitch = 3, 3 /\n" BODY " /");
    char out[128];
    deck_numbers_translate(out, size, message, &r.deck);
    assert_string_equal(out, expected);
}

TEST(bodies_are_counted_from_one_and_nothing_else_is)
{
    expect("node 26 of body 0 at (1, 2) m is inside body 9", "node 26 of body 1 at (1, 2) m is inside body 3", 128);
    expect("body 0", "body 1", 128);
    expect("body 0 crosses obstacle 1 of obstacles 2", "body 1 crosses obstacle 2 of obstacles 2", 128);
    expect("the body, nobody 0, a body part 3", "the body, nobody 0, a body part 3", 128);
    expect("", "", 128);
}

TEST(copies_have_the_number_of_their_group)
{
    expect("body 1 meets body 8", "body 2 (copy 1) meets body 2 (copy 8)", 128);
}

TEST(what_is_too_long_is_cut)
{
    expect("of obstacle 99 and more", "of obst", 8);
    expect("body 8 and more", "body 2 ", 8);
}

TEST(a_message_is_about_the_group_of_the_first_body_that_it_names)
{
    CLEANUP(drop_resolved)
    resolved r = resolve_clean("&run t_end = 1 /\n" BODY " /\n" BODY ", copies = 4, 2, pitch = 3, 3 /\n" BODY " /");
    assert_ptr_equal(deck_numbers_body("triangle 7 of body 8 at", &r.deck), schema_get(&r.deck, "body", 1));
    assert_ptr_equal(deck_numbers_body("obstacle 1, body 9 and body 0", &r.deck), schema_get(&r.deck, "body", 2));
    assert_ptr_equal(deck_numbers_body("nobody 9", &r.deck), schema_get(&r.deck, "body", 0));
}
