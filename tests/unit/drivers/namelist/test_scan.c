/* SPDX-License-Identifier: BSD-3-Clause */
/* scan.c: what stands ahead in a text, and where one is after moving on. */
#include "unit/close.h"

#include <stdio.h>
#include <string.h>

#include "scan.h"

#define LENGTH(array) (sizeof(array) / sizeof(array)[0])

static scanner at(const char *text, size_t offset)
{
    return (scanner){.text = text, .size = strlen(text), .at = offset, .line = 1, .column = 1 + (int)offset};
}

static scanner start(const char *text)
{
    return at(text, 0);
}

static void expect_place(const scanner *scan, size_t offset, int line, int column)
{
    if (scan->at != offset || scan->line != line || scan->column != column)
        fail_msg("at %zu, %d:%d in '%s', expected %zu, %d:%d", scan->at, scan->line, scan->column, scan->text, offset,
                 line, column);
}

/* What a length function says of a text. */
typedef struct length_case {
    const char *text;
    size_t length;
} length_case;

static void expect_lengths(size_t (*length)(const char *), const length_case *cases, size_t n)
{
    for (size_t k = 0; k < n; k++) {
        const size_t got = length(cases[k].text);
        if (got != cases[k].length)
            fail_msg("'%s' (case %zu): %zu, expected %zu", cases[k].text, k, got, cases[k].length);
    }
}

/* What a predicate says at the beginning of a text. */
typedef struct answer_case {
    const char *text;
    bool answer;
} answer_case;

static void expect_answers(bool (*is)(const scanner *), const answer_case *cases, size_t n)
{
    for (size_t k = 0; k < n; k++) {
        const scanner scan = start(cases[k].text);
        if (is(&scan) != cases[k].answer) fail_msg("'%s' (case %zu): not %d", cases[k].text, k, cases[k].answer);
        expect_place(&scan, 0, 1, 1);
    }
}

/* ---- characters ---- */

static void expect_rest(const char *text, const char *expected)
{
    char copy[64];
    (void)snprintf(copy, sizeof copy, "%s", text);
    scan_drop_broken(copy);
    assert_string_equal(copy, expected);
}

TEST(what_is_no_character_can_be_dropped)
{
    expect_rest("", "");
    expect_rest("na\xC3\xAFve \xE2\x82\xAC \xF0\x9F\x98\x80", "na\xC3\xAFve \xE2\x82\xAC \xF0\x9F\x98\x80");
    expect_rest("a\xFF\x80z", "az");
    expect_rest("cut \xE2\x82", "cut "); /* as snprintf leaves it */
    expect_rest("\xED\xA0\x80.\xC0\x80", ".");
}

/* ---- words ---- */

TEST(blanks_are_spaces_tabs_and_ends_of_lines)
{
    for (int c = 0; c < 256; c++) {
        const bool blank = c == ' ' || c == '\t' || c == '\n' || c == '\r';
        assert_int_equal(scan_is_blank((char)c), blank);
    }
}

TEST(a_word_ends_where_something_else_begins)
{
    static const length_case cases[] = {
        {"", 0},
        {"word", 4},
        {"1e-3,", 4},
        {"a b", 1},
        {"a\tb", 1},
        {"a\nb", 1},
        {"a;b", 1},
        {"a/", 1},
        {"a!b", 1},
        {"a=b", 1},
        {"a'b'", 1},
        {"a\"b\"", 1},
        {"a&b", 1},
        {"a$b", 1},
        {",a", 0},
        {"3*(1)", 5},
        {"x%y(2)#@?.:", 11},
        {"a\r\nb", 1},
        {"\xC3\xA9t\xC3\xA9 x", 5},
    };
    expect_lengths(scan_word_length, cases, LENGTH(cases));
}

TEST(a_name_begins_with_a_letter)
{
    static const length_case cases[] = {{"t_end = 1", 5}, {"A1_b2", 5}, {"_a", 0},     {"1a", 0},
                                        {"", 0},          {"x(1)", 1},  {"size%x", 4}, {"\xC3\xA9t", 0}};
    expect_lengths(scan_name_length, cases, LENGTH(cases));
}

TEST(a_designator_has_subscripts_and_components)
{
    static const length_case cases[] = {
        {"x", 1},
        {"x = 1", 1},
        {"x(2)", 4},
        {"x(1:6:2) =", 8},
        {"x( 1 , -2 )", 11},
        {"a%b", 3},
        {"a(1)%b(2)%c = 1", 11},
        {"a%", 1},     /* no name behind it */
        {"a%1", 1},    /* */
        {"a %b", 1},   /* blanks outside of subscripts */
        {"a (1)", 1},  /* */
        {"x()", 1},    /* no subscript in it */
        {"x(a)", 1},   /* */
        {"x(1", 1},    /* not closed */
        {"x(1)(2)", 4} /* one is enough */
    };
    expect_lengths(scan_designator_length, cases, LENGTH(cases));
}

/* It bounds how far one looks ahead. */
TEST(a_subscript_has_64_characters_at_most)
{
    char text[80] = "x(";
    memset(text + 2, '1', 64);
    memcpy(text + 66, ")", 2);
    assert_int_equal(scan_designator_length(text), 67);
    memset(text + 2, '1', 65);
    memcpy(text + 67, ")", 2);
    assert_int_equal(scan_designator_length(text), 1);
}

TEST(logicals_have_six_spellings)
{
    static const char *const yes[] = {".true.", "true", "t", ".TRUE.", "True", "T"};
    static const char *const no[] = {".false.", "false", "f", ".False.", "FALSE", "F"};
    static const char *const neither[] = {"", ".t.", ".true", "true.", "tr", "yes", "1", "0", "truey"};
    for (size_t k = 0; k < LENGTH(yes); k++) {
        bool a = false, b = true;
        assert_true(scan_is_logical(yes[k], &a));
        assert_true(scan_is_logical(no[k], &b));
        assert_true(a && !b);
    }
    for (size_t k = 0; k < LENGTH(neither); k++) {
        bool a;
        assert_false(scan_is_logical(neither[k], &a));
    }
}

TEST(what_is_not_finite_is_known_by_its_spelling)
{
    static const char *const infinite[] = {"inf", "+inf", "-INF", "Infinity", "-infinity", "nan", "NaN", "+nan(0x7)"};
    static const char *const finite[] = {"", "1e308", "in", "info", "infinit", "na", "--inf", "inf1", "-"};
    for (size_t k = 0; k < LENGTH(infinite); k++) assert_true(scan_is_infinite(infinite[k]));
    for (size_t k = 0; k < LENGTH(finite); k++) assert_false(scan_is_infinite(finite[k]));
}

/* ---- strings ---- */

TEST(a_string_is_as_long_as_its_quotes_say)
{
    static const length_case cases[] = {
        {"''", 2},     {"'a'", 3},          {"\"a\" b", 3},
        {"'a\"b'", 5}, {"'it''s'", 7},                   /* doubled quotes stand for one */
        {"''''", 4},   {"'/ ! & = ,'", 11}, {"'a'b", 3}, /* within its line whatever follows */
        {"'", 0},      {"'a", 0},           {"'a''", 0}, /* the last two stand for one */
        {"'a\"", 0},
    };
    expect_lengths(scan_string_length, cases, LENGTH(cases));
}

TEST(a_string_that_left_its_line_must_be_followed_by_a_separator)
{
    static const length_case cases[] = {{"'a\nb'", 5},   {"'a\nb' x", 5},      {"'a\nb',", 5},
                                        {"'a\nb'/", 5},  {"'a\nb'!", 5},       {"'a\nb';", 5},
                                        {"'a\nb'\n", 5}, {"'a,\n x = 'b'", 0}, {"'a\nb'(", 0}};
    expect_lengths(scan_string_length, cases, LENGTH(cases));
}

/* ---- what stands ahead ---- */

TEST(a_key_is_a_designator_before_an_equal_sign)
{
    static const answer_case cases[] = {{"a=1", true},    {"a = 1", true},     {"a\n\t=1", true}, {"a(1:2)%b =", true},
                                        {"a", false},     {"a b = 1", false},  {"=", false},      {"1 = 2", false},
                                        {"'a' =", false}, {"a ! =\n=", false}, {"", false},       {"a (1) = 2", false}};
    expect_answers(scan_at_key, cases, LENGTH(cases));
}

TEST(a_group_is_a_name_behind_its_sign)
{
    static const answer_case cases[] = {{"&run", true}, {"$run", true}, {"&end", true}, {"&", false}, {"& run", false},
                                        {"&1", false},  {"run", false}, {"", false},    {"&_", false}};
    expect_answers(scan_at_group, cases, LENGTH(cases));
}

TEST(an_end_word_is_end_and_nothing_longer)
{
    static const answer_case cases[] = {{"&end", true},   {"$END", true}, {"&End /", true}, {"&ending", false},
                                        {"&end_", false}, {"end", false}, {"&en", false},   {"&end1", false}};
    expect_answers(scan_at_end_word, cases, LENGTH(cases));
}

TEST(keys_groups_slashes_and_the_end_stop)
{
    static const answer_case cases[] = {{"", true},        {"/", true},        {"&run", true}, {"a = 1", true},
                                        {" a = 1", false}, {"1 a = 1", false}, {"'/'", false}, {"&", false}};
    expect_answers(scan_at_stop, cases, LENGTH(cases));
}

TEST(a_lines_name_is_its_first_word)
{
    static const struct {
        const char *text;
        size_t offset;
        bool answer;
    } cases[] = {{"a b", 0, true},          {"a b", 2, false},    {" \t a", 3, true}, {"x\na", 2, true},
                 {"x\n  a", 4, true},       {"x\n  a", 2, false}, {"/a", 1, false},   {"a(1)", 0, false},
                 {"a%b", 0, false},         {"a, b", 0, true},    {"1", 0, false},    {"", 0, false},
                 {"x,\r\n name 5", 5, true}};
    for (size_t k = 0; k < LENGTH(cases); k++) {
        const scanner scan = at(cases[k].text, cases[k].offset);
        if (scan_at_line_name(&scan) != cases[k].answer) fail_msg("case %zu: not %d", k, cases[k].answer);
    }
}

/* ---- moving on ---- */

TEST(columns_count_characters_and_lines_begin_at_1)
{
    scanner scan = start("a\xC3\xA9\xF0\x9F\x98\x80z\n\tb");
    static const int columns[] = {1, 2, 3, 3, 4, 4, 4, 4, 5, 1, 2};
    static const size_t n = LENGTH(columns);
    for (size_t k = 0; k < n; k++) {
        if (k != 3 && !(k >= 5 && k <= 7)) expect_place(&scan, k, k < 9 ? 1 : 2, columns[k]);
        scan_step(&scan);
    }
    expect_place(&scan, 11, 2, 3);
}

TEST(nobody_steps_over_the_end)
{
    scanner scan = start("ab");
    scan_step_over(&scan, 1);
    expect_place(&scan, 1, 1, 2);
    scan_step_over(&scan, 100);
    expect_place(&scan, 2, 1, 3);
    scan_step(&scan);
    scan_skip_line(&scan);
    scan_skip_blanks(&scan);
    scan_skip_junk(&scan);
    expect_place(&scan, 2, 1, 3);
    assert_string_equal(scan_here(&scan), "");
}

TEST(a_line_is_skipped_up_to_its_end)
{
    scanner scan = start("a 'b\nc");
    scan_skip_line(&scan);
    expect_place(&scan, 4, 1, 5);
    scan_skip_line(&scan);
    expect_place(&scan, 4, 1, 5);
}

TEST(blanks_and_comments_are_skipped)
{
    scanner scan = start(" \t! a = 1\n\r\n  !x\n !\n  b ! c");
    scan_skip_blanks(&scan);
    assert_string_equal(scan_here(&scan), "b ! c");
    assert_int_equal(scan.line, 5);
    assert_int_equal(scan.column, 3);
    scan_skip_blanks(&scan);
    assert_string_equal(scan_here(&scan), "b ! c");
}

static void expect_junk(const char *text, const char *rest)
{
    scanner scan = start(text);
    scan_skip_junk(&scan);
    assert_string_equal(scan_here(&scan), rest);
    assert_true(scan_at_stop(&scan));
}

TEST(junk_is_skipped_up_to_what_can_be_read_again)
{
    expect_junk("", "");
    expect_junk("1, 2 ; word a = 3", "a = 3");
    expect_junk("a b = 3", "b = 3");
    expect_junk("'in a = 1 string /' /", "/");
    expect_junk("not 'closed a = 1", "a = 1"); /* only the quote is skipped */
    expect_junk("! a = 1\n x &run", "&run");
    expect_junk("= & $ ) 5 $x", "$x");
    expect_junk("x.y/z", "/z");
}
