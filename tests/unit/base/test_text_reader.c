/* SPDX-License-Identifier: BSD-3-Clause */
/* text_reader.c: words, numbers, lines and faults. */
#include "unit/close.h"

#include <string.h>

#include "base/text_reader.h"

static text_reader begin(const char *text, char comment)
{
    return text_reader_begin(text, strlen(text), comment);
}

TEST(text_reader_stand_between_blanks)
{
    static const char *const expected[] = {"a", "bc", "#d", "e"};
    static const size_t line[] = {1, 2, 2, 4};
    char word[TEXT_READER_LONGEST + 1];
    text_reader w = begin(" a\n\tbc\r\v\f#d\n\n e", '\0');
    for (int k = 0; k < 4; k++) {
        assert_true(text_reader_next(&w, word));
        assert_string_equal(word, expected[k]);
        assert_int_equal(w.last, line[k]);
    }
    assert_false(text_reader_next(&w, word));
    assert_string_equal(w.fault, "");
    assert_int_equal(text_reader_left(&w), 0);
}

TEST(comments_last_to_the_end_of_their_line)
{
    char word[TEXT_READER_LONGEST + 1];
    text_reader w = begin("# one\na#two\n#\nb#", '#');
    assert_true(text_reader_next(&w, word));
    assert_string_equal(word, "a");
    assert_int_equal(w.last, 2);
    assert_true(text_reader_next(&w, word));
    assert_string_equal(word, "b");
    assert_int_equal(w.last, 4);
    assert_false(text_reader_next(&w, word));
    assert_string_equal(w.fault, "");
}

TEST(numbers_are_read_as_such)
{
    int64_t n;
    double x;
    text_reader w = begin("-7 9223372036854775807 1.5e-3 .5 4", '\0');
    assert_true(text_reader_integer(&w, "n", -7, 7, &n));
    assert_int_equal(n, -7);
    assert_true(text_reader_integer(&w, "n", 0, INT64_MAX, &n));
    assert_true(n == INT64_MAX);
    assert_true(text_reader_real(&w, "x", &x));
    assert_close(x, 1.5e-3, 0.0);
    assert_true(text_reader_real(&w, "x", &x));
    assert_true(text_reader_real(&w, "x", &x));
    assert_close(x, 4.0, 0.0);
}

static void expect_integer_fault(const char *text, const char *fault)
{
    int64_t n;
    text_reader w = begin(text, '\0');
    assert_false(text_reader_integer(&w, "n", 1, 9, &n));
    assert_string_equal(w.fault, fault);
}

static void expect_real_fault(const char *text, const char *fault)
{
    double x;
    text_reader w = begin(text, '\0');
    assert_false(text_reader_real(&w, "x", &x));
    assert_string_equal(w.fault, fault);
}

TEST(what_is_no_number_is_reported)
{
    expect_integer_fault("", "the text ends where n is expected");
    expect_integer_fault("1.0", "n must be an integer, got '1.0'");
    expect_integer_fault("0x1", "n must be an integer, got '0x1'");
    expect_integer_fault("99999999999999999999", "n must be an integer, got '99999999999999999999'");
    expect_integer_fault("0", "n must be in [1, 9], got 0");
    expect_integer_fault("10", "n must be in [1, 9], got 10");
    expect_integer_fault("a\x01\xff", "n must be an integer, got 'a\?\?'");
    expect_real_fault(" \n", "the text ends where x is expected");
    expect_real_fault("nan", "x must be a finite number, got 'nan'");
    expect_real_fault("inf", "x must be a finite number, got 'inf'");
    expect_real_fault("1e999", "x must be a finite number, got '1e999'");
    expect_real_fault("0x10", "x must be a finite number, got '0x10'");
    expect_real_fault("1..2", "x must be a finite number, got '1..2'");
    expect_real_fault("+", "x must be a finite number, got '+'");
}

TEST(the_first_fault_stays)
{
    char word[TEXT_READER_LONGEST + 1], text[200];
    text_reader w = begin("a b", '\0');
    assert_true(text_reader_expect(&w, "a"));
    assert_false(text_reader_expect(&w, "c"));
    assert_false(text_reader_fail(&w, "later"));
    assert_string_equal(w.fault, "'c' is expected, got 'b'");
    memset(text, 'x', sizeof text);
    text[TEXT_READER_LONGEST] = '\0';
    w = begin(text, '\0');
    assert_true(text_reader_next(&w, word));
    text[TEXT_READER_LONGEST] = 'x';
    w = text_reader_begin(text, sizeof text, '\0');
    assert_false(text_reader_next(&w, word));
    assert_string_equal(w.fault, "a word of more than 63 bytes");
}

TEST(seeking_goes_behind_a_lines_beginning)
{
    char word[TEXT_READER_LONGEST + 1];
    text_reader w = begin("$A\n x $EndA\n$EndB\n$EndA\nnext", '\0');
    assert_true(text_reader_next(&w, word));
    assert_true(text_reader_seek(&w, "$EndA"));
    assert_true(text_reader_next(&w, word));
    assert_string_equal(word, "next");
    assert_int_equal(w.last, 5);
    assert_false(text_reader_seek(&w, "$EndA"));
    assert_string_equal(w.fault, "the text ends where a line '$EndA' is expected");
    w = begin("", '\0');
    assert_false(text_reader_seek(&w, "$EndA"));
}
