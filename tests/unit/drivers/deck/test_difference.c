/* SPDX-License-Identifier: BSD-3-Clause */
/* difference.c: the first lines of two decks that are not the same. */
#include "unit/close.h"

#include "difference.h"

static const char deck[] = "&run\n    t_end = 1\n/\n&body\n    spacing = 0.5\n    shape = 'disc'\n/\n";

static void expect(const char *then, const char *now, const char *text)
{
    char found[DIFFERENCE];
    assert_true(difference_find(then, now, found));
    assert_string_equal(found, text);
}

TEST(the_same_texts_do_not_differ)
{
    char text[DIFFERENCE] = "as it was";
    assert_false(difference_find(deck, deck, text));
    assert_false(difference_find("", "", text));
    assert_string_equal(text, "as it was");
}

TEST(the_first_line_is_named_with_its_group)
{
    expect("&run\n    t_end = 1\n/\n&body\n    spacing = 0.25\n    shape = 'ring'\n/\n", deck,
           "spacing = 0.25 in &body, this one has spacing = 0.5");
    expect("&run\n    t_end = 2\n/\n", deck, "t_end = 2 in &run, this one has t_end = 1");
}

TEST(what_is_in_one_only_differs)
{
    expect("&run\n    t_end = 1\n/\n", deck, "nothing in &run, this one has &body");
    expect("&run\n    t_end = 1\n    residual = 1\n", "&run\n    t_end = 1",
           "residual = 1 in &run, this one has no residual");
    expect("", "&run", "nothing in &run, this one has &run");
}

/* The lines of a key that one text lacks are not compared with those of the next key. */
TEST(a_key_in_one_only_is_named)
{
    static const char without[] = "&contact\n    bodies = 'all'\n    overlap = 'warn'\n/\n";
    static const char with[] = "&contact\n    bodies = 'all'\n    thickness = 0.0004\n    overlap = 'warn'\n/\n";
    static const char short_one[] = "&contact\n    bodies = 'all'\n/\n";
    expect(without, with, "no thickness in &contact, this one has thickness = 0.0004");
    expect(with, without, "thickness = 0.0004 in &contact, this one has no thickness");
    expect(short_one, without, "no overlap in &contact, this one has overlap = 'warn'");
    expect(without, short_one, "overlap = 'warn' in &contact, this one has no overlap");
}
