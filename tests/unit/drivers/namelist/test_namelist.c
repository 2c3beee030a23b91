/* SPDX-License-Identifier: BSD-3-Clause */
/* The namelist reader: what it takes. Its faults: test_namelist_faults.c. */
#include "unit/reading.h"

static reading read_clean(const char *text)
{
    reading r = read_text(text);
    if (r.errors.n > 0) fail_msg("'%s' gives '%s'", text, r.errors.list[0].text);
    return r;
}

static void assert_reals(const reading *r, size_t key, size_t n, const double *expected)
{
    const namelist_key *k = key_at(r, 0, key);
    assert_int_equal(k->n_values, n);
    for (size_t i = 0; i < n; i++) {
        assert_true(k->values[i].kind == NAMELIST_REAL || k->values[i].kind == NAMELIST_INTEGER);
        assert_close(k->values[i].real, expected[i], 0); /* strtod rounds correctly, as the compiler does */
    }
}

static void assert_string(const char *text, const char *expected)
{
    CLEANUP(drop) reading r = read_clean(text);
    const namelist_key *key = key_at(&r, 0, 0);
    assert_int_equal(key->n_values, 1);
    assert_int_equal(key->values[0].kind, NAMELIST_STRING);
    assert_string_equal(key->values[0].text, expected);
}

static void assert_kinds(const reading *r, size_t key, const char *expected)
{
    const namelist_key *k = key_at(r, 0, key);
    char got[64] = "";
    assert_true(k->n_values < sizeof got);
    for (size_t i = 0; i < k->n_values; i++) got[i] = "0irlswf"[k->values[i].kind];
    assert_string_equal(got, expected);
}

/* ---- groups and keys ------------------------------------------------------------------------------------------ */

TEST(names_are_case_insensitive_and_kept_in_lower_case)
{
    CLEANUP(drop) reading r = read_clean("&RUN T_End = 1, Gravity2 = 2 /");
    assert_string_equal(r.list.groups[0].name, "run");
    assert_string_equal(key_at(&r, 0, 0)->name, "t_end");
    assert_string_equal(key_at(&r, 0, 1)->name, "gravity2");
}

TEST(groups_and_keys_know_their_places)
{
    CLEANUP(drop) reading r = read_clean("\n  &run\n\tt_end =\n 1, 2 /");
    const namelist_key *key = key_at(&r, 0, 0);
    assert_int_equal(r.list.groups[0].place.line, 2);
    assert_int_equal(r.list.groups[0].place.column, 3);
    assert_int_equal(key->place.line, 3);
    assert_int_equal(key->place.column, 2);
    assert_int_equal(key->values[1].place.line, 4);
    assert_int_equal(key->values[1].place.column, 5);
}

TEST(text_between_groups_is_comment)
{
    CLEANUP(drop) reading r = read_clean("R&D x = 'open $5\n&a x=1/ y = 2 ' & so on\n! &c /\n&b /");
    assert_int_equal(r.list.n_groups, 2);
    assert_string_equal(r.list.groups[1].name, "b");
}

TEST(a_group_may_stand_right_behind_another)
{
    CLEANUP(drop) reading r = read_clean("&a x=1/&b y=2&end&c z=3/");
    assert_int_equal(r.list.n_groups, 3);
}

TEST(legacy_ends_and_dollar_groups_are_read)
{
    CLEANUP(drop) reading r = read_clean("$a x=1 $END\n&b x = 2 &end\n$c x = T$end");
    assert_int_equal(r.list.n_groups, 3);
    assert_int_equal(key_at(&r, 2, 0)->values[0].kind, NAMELIST_LOGICAL);
}

TEST(a_slash_as_last_byte_ends_the_file)
{
    CLEANUP(drop) reading r = read_clean("&a x=1/");
    assert_int_equal(r.list.n_groups, 1);
}

TEST(a_file_without_groups_is_empty)
{
    CLEANUP(drop) reading r = read_clean("");
    assert_int_equal(r.list.n_groups, 0);
}

TEST(byte_order_mark_and_crlf_are_taken)
{
    CLEANUP(drop) reading r = read_clean("\xEF\xBB\xBF&a x = 1\r\n y = 'b\r\nc'\r\n/\r\n");
    assert_int_equal(r.list.groups[0].place.column, 1);
    assert_string_equal(key_at(&r, 0, 1)->values[0].text, "bc");
}

TEST(components_are_joined_by_percent_signs)
{
    CLEANUP(drop) reading r = read_clean("&a M%Young = 1, m( 2 )%x%y(3) = 4 /");
    assert_string_equal(key_at(&r, 0, 0)->name, "m%young");
    assert_string_equal(key_at(&r, 0, 1)->name, "m(2)%x%y");
    assert_int_equal(key_at(&r, 0, 1)->first, 3);
}

TEST(subscripts_give_first_element_and_stride)
{
    static const int first[] = {1, 2, 2, 1, 2, 1, 1, 3}, stride[] = {1, 1, 1, 2, 1, 1, 1, 4};
    CLEANUP(drop)
    reading r = read_clean("&g a=0 a(2)=1 a(2:3)=1,2 a(1:6:2)=1,2,3 a(2:)=4 a(:)=5 a( : 3 )=1 a(3::4) = 6,7 /");
    for (size_t k = 0; k < 8; k++) {
        assert_int_equal(key_at(&r, 0, k)->first, first[k]);
        assert_int_equal(key_at(&r, 0, k)->stride, stride[k]);
        assert_int_equal(key_at(&r, 0, k)->subscript, k > 0);
    }
}

/* ---- values --------------------------------------------------------------------------------------------------- */

TEST(numbers_have_fortran_spellings)
{
    static const double expected[] = {1, 1, .5, 1e3, 1e-3, 1e3, -2.5, 7, 0.1, -4e-5};
    CLEANUP(drop) reading r = read_clean("&a x = 1 1. .5 1e3 1d-3 1D3 -2.5 +7 0.1d0 -4.E-05 /");
    assert_reals(&r, 0, 10, expected);
    assert_kinds(&r, 0, "irrrrrrirr");
}

TEST(integers_keep_all_their_digits)
{
    CLEANUP(drop) reading r = read_clean("&a x = 9223372036854775807, -9223372036854775808 /");
    assert_true(key_at(&r, 0, 0)->values[0].integer == INT64_MAX);
    assert_true(key_at(&r, 0, 0)->values[1].integer == INT64_MIN);
}

TEST(minus_zero_keeps_its_sign)
{
    CLEANUP(drop) reading r = read_clean("&a x = -0, -0. /");
    assert_true(signbit(key_at(&r, 0, 0)->values[0].real));
    assert_true(signbit(key_at(&r, 0, 0)->values[1].real));
}

TEST(logicals_have_six_spellings_in_any_case)
{
    static const bool expected[] = {true, true, true, false, false, false};
    CLEANUP(drop) reading r = read_clean("&a x = .TRUE. t True .false. F fAlse /");
    assert_kinds(&r, 0, "llllll");
    for (size_t k = 0; k < 6; k++) assert_int_equal(key_at(&r, 0, 0)->values[k].logical, expected[k]);
}

TEST(what_only_begins_like_a_logical_is_a_word)
{
    CLEANUP(drop) reading r = read_clean("&a x = fish, .true, .tRuE_oops. /");
    assert_kinds(&r, 0, "www");
    assert_string_equal(key_at(&r, 0, 0)->values[0].text, "fish");
}

TEST(a_logical_before_an_equal_sign_is_a_key)
{
    CLEANUP(drop) reading r = read_clean("&a x = T f = F t\n= 1 /");
    assert_int_equal(r.list.groups[0].n_keys, 3);
    assert_string_equal(key_at(&r, 0, 2)->name, "t");
}

TEST(doubled_quotes_stand_for_one)
{
    assert_string("&a x='it''s \"so\"'/", "it's \"so\"");
    assert_string("&a x=\"say \"\"hi\"\" 'you'\"/", "say \"hi\" 'you'");
    assert_string("&a x=''/", "");
    assert_string("&a x=''''/", "'");
}

TEST(strings_may_hold_what_is_syntax_outside)
{
    assert_string("&a x = '/ ! &end $b, y = 2' /", "/ ! &end $b, y = 2");
}

TEST(a_string_goes_on_in_the_next_line)
{
    assert_string("&a x = 'one \ntwo'\n/", "one two");
}

TEST(blanks_newlines_and_one_comma_separate)
{
    static const double expected[] = {1, 2, 3, 4, 5};
    CLEANUP(drop) reading r = read_clean("&a x = 1,2\n\t,3 ! , 9\n4 , 5, y = 6,/");
    assert_reals(&r, 0, 5, expected);
    assert_int_equal(key_at(&r, 0, 1)->n_values, 1);
}

TEST(nothing_behind_the_equals_sign_is_a_null_value)
{
    CLEANUP(drop) reading r = read_text("&a x = y = 1 z =/");
    assert_int_equal(r.errors.n, 0);
    assert_int_equal(key_at(&r, 0, 0)->n_values, 1);
    assert_int_equal(key_at(&r, 0, 0)->values[0].kind, NAMELIST_NULL);
    assert_int_equal(key_at(&r, 0, 1)->values[0].integer, 1);
    assert_int_equal(key_at(&r, 0, 2)->values[0].kind, NAMELIST_NULL);
}

TEST(two_commas_leave_a_null_value)
{
    CLEANUP(drop) reading r = read_clean("&a w = , x = 1,,2 y = ,1, z = 1, , /");
    assert_kinds(&r, 0, "0");
    assert_kinds(&r, 1, "i0i");
    assert_kinds(&r, 2, "0i");
    assert_kinds(&r, 3, "i0");
}

TEST(repeat_counts_are_expanded)
{
    CLEANUP(drop) reading r = read_clean("&a x = 2*1.5, 3*, 2*'a b' 1*T z = 2* /");
    assert_kinds(&r, 0, "rr000ssl");
    assert_string_equal(key_at(&r, 0, 0)->values[6].text, "a b");
    assert_kinds(&r, 1, "00");
}

TEST(comments_begin_outside_quotes)
{
    CLEANUP(drop) reading r = read_clean("&a ! it's one\n x = '!'! two /\n y = 1!three\n/");
    assert_int_equal(r.list.groups[0].n_keys, 2);
    assert_string_equal(key_at(&r, 0, 0)->values[0].text, "!");
}

TEST(unquoted_text_is_left_to_the_caller_as_a_word)
{
    CLEANUP(drop) reading r = read_clean("&a x = 3mm, rubber, 1e, 1.0_8, - /");
    assert_kinds(&r, 0, "wwwww");
    assert_string_equal(key_at(&r, 0, 0)->values[0].text, "3mm");
}
