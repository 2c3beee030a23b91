/* SPDX-License-Identifier: BSD-3-Clause */
/* The namelist reader: place and words of every fault, and how reading goes on behind it. */
#include "unit/reading.h"

#include <stdlib.h>

TEST(columns_count_characters_not_bytes)
{
    assert_faults("&a t = '\xC3\xA9\xE2\x82\xAC', x = 1+2 /",
                  "1:18 * 'x' * '1+2' * exponent * letter * 1.5e+3 * 1.5+3");
}

TEST(infinite_numbers_are_refused)
{
    assert_faults("&a x = inf, -Infinity nan NaN(3) /", "1:8 * 'x' * 'inf' * finite\n"
                                                        "1:13 * 'x' * '-Infinity' * finite\n"
                                                        "1:23 * 'x' * 'nan' * finite\n"
                                                        "1:27 * 'x' * 'NaN(3)' * finite");
}

TEST(numbers_that_do_not_fit_are_refused)
{
    assert_faults("&a x = 9223372036854775808, 1e309, -1d999 /", "1:8 * 'x' * '9223372036854775808' * integer\n"
                                                                 "1:29 * 'x' * '1e309' * real\n"
                                                                 "1:36 * 'x' * '-1d999' * real");
}

TEST(a_number_of_many_digits_is_refused)
{
    char text[300] = "&a x = 0.";
    memset(text + 9, '1', 200);
    (void)snprintf(text + 209, 10, " /");
    assert_faults(text, "1:8 * 'x' * '0.11111111111111111111111111111111111111' * digits");
}

TEST(a_semicolon_does_not_separate)
{
    assert_faults("&a x = 1;2 /", "1:9 * values * ',' * blanks * ';'");
}

TEST(complex_numbers_are_not_understood)
{
    assert_faults("&a x = (1, 2) y = (3 /", "1:8 * complex\n"
                                            "1:19 * complex");
}

TEST(two_subscripts_are_not_understood)
{
    assert_faults("&a x(1, 2) = 3, y(:,1) = 4, 5 /", "1:4 * 'x' * subscript * only\n"
                                                     "1:17 * 'y' * subscript * only");
}

TEST(subscripts_outside_their_bounds_are_refused)
{
    assert_faults("&g a(0)=1 b(3:2)=1 c(1:9:0)=1 d(100001)=1 e(99999999999999999999)=1 f(-)=1 /",
                  "1:4 * subscript * 'a' * ascend * 1 * 100000\n"
                  "1:11 * subscript * 'b' * ascend * 1 * 100000\n"
                  "1:20 * subscript * 'c' * ascend * 1 * 100000\n"
                  "1:31 * subscript * 'd' * ascend * 1 * 100000\n"
                  "1:43 * subscript * 'e' * ascend * 1 * 100000\n"
                  "1:69 * subscript * 'f' * (i) * (i:j) * (i:j:k)");
}

TEST(a_section_has_room_for_so_many_values)
{
    assert_faults("&a x(2:3) = 1, 2, 3 y(1:5:2) = 4*1 /", "1:4 * subscript * 'x' * room * 2 * 3 * values\n"
                                                          "1:21 * subscript * 'y' * room * 3 * 4 * values");
}

TEST(a_subscript_that_is_none_is_named)
{
    assert_faults("&a x(n) = 3 /", "1:4 * subscript * 'x(n)' * (i) * (i:j) * (i:j:k)");
}

TEST(repeat_counts_have_bounds)
{
    assert_faults("&a x = 0*1, 100001*2, 99999999999*'x' /", "1:8 * repeat * '0' * 1 * 100000\n"
                                                             "1:13 * repeat * '100001' * 1 * 100000\n"
                                                             "1:23 * repeat * '99999999999' * 1 * 100000");
}

TEST(the_number_of_values_in_a_file_has_a_bound)
{
    assert_faults("&a x = 60000*1 /\n&b x = 60000*1, 2 y = 3 /", "2:8 * 100000 * values");
}

TEST(a_missing_equal_sign_is_reported_once)
{
    assert_faults("&a t_end 20e-3 'x = /' y = 1 /", "1:4 * '=' * missing * 't_end'");
    assert_faults("&a x = 1 ! one\n\ty 2\n z = 3 /", "2:2 * '=' * missing * 'y'");
    assert_faults("&a x = 1,\n y 2\n z = 3 /", "");
}

TEST(a_key_with_a_fault_is_kept_without_values)
{
    CLEANUP(drop) reading r = read_text("&a t_end 20e-3, y = 1 /");
    assert_string_equal(key_at(&r, 0, 0)->name, "t_end");
    assert_int_equal(key_at(&r, 0, 0)->n_values, 0);
    assert_string_equal(key_at(&r, 0, 1)->name, "y");
}

TEST(what_is_no_key_is_shown)
{
    assert_faults("&a 3 = 4, x = 1\n= 2 /", "1:4 * key * '3'\n"
                                            "2:1 * unexpected * '='");
}

TEST(a_hash_is_no_comment)
{
    assert_faults("&a # one\n x = 1 # two\n/", "1:4 * unexpected * '#' * comments * '!'\n"
                                               "2:8 * unexpected * '#' * comments * '!'");
}

TEST(a_value_right_behind_a_string_is_reported)
{
    assert_faults("&a x = 'a'b y = 1'c' z = 2 /", "1:11 * blank * comma * missing\n"
                                                  "1:18 * blank * comma * missing");
}

TEST(an_unclosed_string_does_not_swallow_the_next_key)
{
    assert_faults("&a x = 'abc, y = inf /\n&b z = nan /", "1:8 * string * closed\n"
                                                          "1:18 * 'y' * 'inf' * finite\n"
                                                          "2:8 * 'z' * 'nan' * finite");
}

TEST(an_unclosed_string_is_found_where_another_opens)
{
    CLEANUP(drop) reading r = read_text("&a x = 'abc /\n&b y = 'd' /");
    assert_int_equal(r.errors.n, 1);
    assert_string_equal(r.errors.list[0].text, "the string is not closed");
    assert_string_equal(key_at(&r, 1, 0)->values[0].text, "d");
}

TEST(a_long_string_is_refused)
{
    char text[5000] = "&a x = '";
    memset(text + 8, 'b', 4097);
    (void)snprintf(text + 4105, 10, "' /");
    assert_faults(text, "1:8 * string * longer * 4096 * bytes");
}

TEST(a_group_that_is_not_closed_ends_at_the_next)
{
    assert_faults("&a x = 1\n&b y = 2", "1:1 * &a * closed * '/' * missing * &b * line 2\n"
                                        "2:1 * &b * closed * '/' * missing * file");
}

TEST(an_end_without_group_is_reported)
{
    assert_faults("&a x=1 /\n&end", "2:1 * '&end' * group");
}

TEST(an_unquoted_path_does_not_silently_end_its_group)
{
    assert_faults("&a x = b/c y = 1 /", "1:10 * '/' * ends * &a * quotes");
}

TEST(bytes_that_are_not_text_are_reported_once)
{
    static const char text[] = "&a x\0=\001 1\n y = '\xC3\xA9\xE9' ! \xFF\n z = \x7F 3\r/";
    assert_faults_of(text, sizeof text - 1, "1:5 * byte * 0x00 * UTF-8 * 3");
    assert_faults("&a y = '\xE9' ! \xFF\n z = nan /", "1:9 * byte * 0xE9 * UTF-8\n"
                                                      "2:6 * 'z' * 'nan' * finite");
}

static void expect_unreadable(const char *text, size_t size, const char *expected)
{
    char got[256];
    CLEANUP(drop) reading r = read_bytes(text, size);
    list_faults(&r.errors, got, sizeof got);
    assert_line_parts(got, expected);
    assert_true(r.list.unreadable);
    assert_int_equal(r.list.n_groups, 0);
}

TEST(a_text_in_utf16_is_reported_and_not_read)
{
    const char *message = "1:1 * file * UTF-16 * UTF-8";
    expect_unreadable("\xFF\xFE&\0r\0\n\0", 8, message);
    expect_unreadable("\xFE\xFF\0&\0r\0\n", 8, message);
    expect_unreadable("&\0r\0\n\0", 6, message);
    expect_unreadable("\0&\0r\0\n", 6, message);
    expect_unreadable("! \xE9\n\n! \xE9\n&b x = nan", 19, "1:3 * byte * 0xE9 * UTF-8 * 2");
}

TEST(overlong_characters_and_surrogates_are_not_text)
{
    assert_faults("\xC0\x80\n", "1:1 * byte * 0xC0 * UTF-8");
    assert_faults("\xE0\x80\x80\n", "1:1 * byte * 0xE0 * UTF-8");
    assert_faults("\xED\xA0\x80\n", "1:1 * byte * 0xED * UTF-8");
    assert_faults("\xF4\x90\x80\x80\n", "1:1 * byte * 0xF4 * UTF-8");
    assert_faults("\xF0\x9F\x98\x80", "");
}

static char *filled(size_t size, char c)
{
    char *text = malloc(size);
    assert_non_null(text);
    memset(text, c, size);
    return text;
}

TEST(a_long_line_is_reported)
{
    CLEANUP(free_memory) char *text = filled(70000, ' ');
    text[65536] = '\n';
    assert_faults_of(text, 65600, "");
    text[65536] = ' ';
    assert_faults_of(text, 70000, "1:65537 * line * longer * 65536 * characters");
}

TEST(a_large_file_is_refused)
{
    CLEANUP(free_memory) char *text = filled(NAMELIST_MAX_FILE + 1, '\n');
    assert_faults_of(text, NAMELIST_MAX_FILE, "");
    expect_unreadable(text, NAMELIST_MAX_FILE + 1, "1:1 * file * larger * 4194304 * bytes");
}

TEST(many_groups_are_refused)
{
    CLEANUP(free_memory) char *text = filled(4 * 2002, ' ');
    for (size_t k = 0; k < 2002; k++) memcpy(text + 4 * k, "&a/\n", 4);
    assert_faults_of(text, 4 * 2000, "");
    assert_faults_of(text, 4 * 2001, "2001:1 * 2000 * groups");
}

TEST(errors_end_at_a_thousand)
{
    CLEANUP(free_memory) char *text = filled(2000, ';');
    memcpy(text, "&a x = ", 7);
    CLEANUP(drop) reading r = read_bytes(text, 2000);
    assert_int_equal(r.errors.n, 1000);
    assert_string_equal(r.errors.list[999].text, "too many errors");
}

TEST(a_long_word_is_cut_between_characters)
{
    CLEANUP(drop) reading r = read_text("&a 123456789012345678901234567890123456789\xE2\x82\xAC /");
    assert_string_equal(r.errors.list[0].text, "a key is expected, got '123456789012345678901234567890123456789'");
}

/* A text of 1 MiB that repeats a piece. Looking ahead must not make it slow: the time limit of the test is the
 * check. */
TEST(hostile_repetitions_take_linear_time)
{
    static const char *const pieces[] = {"a(1)",  "a%", "a % ", "a\n", "'",  "'\"", "'''\n", "\"x''\n", "a(1 ", "a=",
                                         "a='\n", "1*", "&a",   "&a ", "= ", ",",   "a=1,",  "(",       "!\n",  "a(1:"};
    for (size_t p = 0; p < sizeof pieces / sizeof pieces[0]; p++) {
        const size_t n = strlen(pieces[p]), size = 1 << 20;
        CLEANUP(free_memory) char *text = filled(size, ' ');
        memcpy(text, "&g x = ", 7);
        for (size_t at = 7; at + n <= size; at += n) memcpy(text + at, pieces[p], n);
        CLEANUP(drop) reading r = read_bytes(text, size);
    }
}
