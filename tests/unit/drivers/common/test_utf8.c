/* SPDX-License-Identifier: BSD-3-Clause */
/* utf8.c: how many bytes a character has. */
#include "unit/close.h"

#include "utf8.h"

typedef struct length_case {
    const char *text;
    size_t length;
} length_case;

static void expect_lengths(const length_case *cases, size_t n)
{
    for (size_t k = 0; k < n; k++) {
        const size_t got = utf8_plain_length(cases[k].text);
        if (got != cases[k].length)
            fail_msg("'%s' (case %zu): %zu, expected %zu", cases[k].text, k, got, cases[k].length);
    }
}

TEST(a_character_has_one_to_four_bytes)
{
    static const length_case cases[] = {
        {"a", 1},
        {"~", 1},
        {"\xC2\x80", 2}, /* the least of two, three and four bytes and the largest */
        {"\xDF\xBF", 2},
        {"\xE0\xA0\x80", 3},
        {"\xEF\xBF\xBF", 3},
        {"\xF0\x90\x80\x80", 4},
        {"\xF4\x8F\xBF\xBF", 4},
        {"\xED\x9F\xBF", 3}, /* next to the surrogates */
        {"\xEE\x80\x80", 3},
    };
    expect_lengths(cases, sizeof cases / sizeof *cases);
}

TEST(bytes_that_make_no_character_have_no_length)
{
    static const length_case cases[] = {
        {"\x80", 0},             /* goes on from nothing */
        {"\xC3", 0},             /* ends early */
        {"\xC3x", 0},            /* is not gone on with */
        {"\xE2\x82", 0},         /* */
        {"\xF0\x9F\x98", 0},     /* */
        {"\xC0\x80", 0},         /* overlong: could be shorter */
        {"\xC1\xBF", 0},         /* */
        {"\xE0\x9F\xBF", 0},     /* */
        {"\xF0\x8F\xBF\xBF", 0}, /* */
        {"\xED\xA0\x80", 0},     /* the first and the last surrogate */
        {"\xED\xBF\xBF", 0},     /* */
        {"\xF4\x90\x80\x80", 0}, /* beyond U+10FFFF */
        {"\xF5\x80\x80\x80", 0}, /* */
        {"\xFF", 0},             /* */
    };
    expect_lengths(cases, sizeof cases / sizeof *cases);
}

TEST(control_characters_have_no_place_but_tab_and_ends_of_lines)
{
    for (int c = 1; c < 256; c++) {
        const char text[2] = {(char)c, '\0'};
        const bool plain = c == '\t' || c == '\n' || (c >= ' ' && c < 0x7F);
        assert_int_equal(utf8_plain_length(text), plain);
    }
    assert_int_equal(utf8_plain_length("\r\n"), 1);
    assert_int_equal(utf8_plain_length("\rx"), 0);
    assert_int_equal(utf8_plain_length(""), 0);
}
