/* SPDX-License-Identifier: BSD-3-Clause */
/* setting.c: keys that join the groups of a deck. */
#include "unit/close.h"

#include <string.h>

#include "setting.h"

static const char deck[] = "&run t_end = 1, title = 'a' /\n&body x = 1 /\n&body x = 2, x(2) = 3 /\n";

typedef struct joined {
    namelist list;
    namelist_errors errors;
} joined;

static joined join(const char *text)
{
    joined j = {0};
    setting s;
    assert_true(setting_parse(&s, text));
    assert_true(namelist_parse(&j.list, deck, strlen(deck), &j.errors));
    assert_int_equal(j.errors.n, 0);
    assert_true(setting_apply(&s, -4, &j.list, &j.errors));
    return j;
}

static void part(joined *j)
{
    namelist_free(&j->list);
    namelist_errors_free(&j->errors);
}

TEST(texts_are_taken_apart)
{
    static const char *const bad[] = {"",         "a",       "a.b",     "a=1",     "a.=1",           ".b=1",
                                      "a(0).b=1", "a().b=1", "a(1.b=1", "a(1)b=1", "a(1234567).b=1", "a.b (1)=1",
                                      "a.b(1)=1", "1a.b=1",  "a .b=1"};
    setting s;
    assert_true(setting_parse(&s, "body(12).x_1=a=b"));
    assert_int_equal(s.name_length, 4);
    assert_int_equal(s.number, 12);
    assert_string_equal(s.assignment, "x_1=a=b");
    assert_true(setting_parse(&s, "run.t_end="));
    assert_int_equal(s.number, 0);
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++)
        if (setting_parse(&s, bad[k])) fail_msg("%s", bad[k]);
}

TEST(a_key_takes_the_place_of_its_name)
{
    joined j = join("RUN.T_End=2, 3");
    const namelist_group *run = &j.list.groups[0];
    assert_int_equal(j.errors.n, 0);
    assert_int_equal(j.list.n_groups, 3);
    assert_int_equal(run->n_keys, 2);
    assert_string_equal(run->keys[0].name, "title");
    assert_string_equal(run->keys[1].name, "t_end");
    assert_int_equal(run->keys[1].n_values, 2);
    assert_close(run->keys[1].values[1].real, 3.0, 0.0);
    assert_int_equal(run->keys[1].place.line, -4);
    assert_int_equal(run->keys[1].values[1].place.line, -4);
    assert_int_equal(run->place.line, 1);
    part(&j);
    j = join("body(2).x=5");
    assert_int_equal(j.list.groups[1].keys[0].values[0].integer, 1);
    assert_int_equal(j.list.groups[2].n_keys, 1); /* for both that it had */
    assert_int_equal(j.list.groups[2].keys[0].values[0].integer, 5);
    part(&j);
}

TEST(strings_need_no_quotes)
{
    static const char *const same[][2] = {
        {"run.title=slow", "slow"},
        {"run.title=r0.3, it's / new", "r0.3, it's / new"}, /* one value, whatever is in it */
        {"Run.TITLE= 5", "5"},
        {"run.title='a b'", "a b"},
        {"run.title=\"a\"", "a"},
    };
    for (size_t k = 0; k < sizeof same / sizeof *same; k++) {
        joined j = join(same[k][0]);
        const namelist_key *key = &j.list.groups[0].keys[1];
        assert_int_equal(j.errors.n, 0);
        assert_int_equal(key->n_values, 1);
        assert_int_equal(key->values[0].kind, NAMELIST_STRING);
        assert_string_equal(key->values[0].text, same[k][1]);
        part(&j);
    }
}

TEST(several_strings_are_parted_by_commas)
{
    joined j = join("output.fields=stress,  velocity");
    const namelist_key *key = &j.list.groups[3].keys[0];
    assert_int_equal(key->n_values, 2);
    assert_string_equal(key->values[0].text, "stress");
    assert_string_equal(key->values[1].text, "velocity");
    part(&j);
}

TEST(other_keys_get_no_quotes)
{
    joined j = join("run.t_end=abc");
    assert_int_equal(j.list.groups[0].keys[1].values[0].kind, NAMELIST_WORD);
    part(&j);
    j = join("run.no_key=abc");
    assert_int_equal(j.list.groups[0].keys[2].values[0].kind, NAMELIST_WORD);
    part(&j);
}

TEST(a_group_that_is_not_there_is_made)
{
    joined j = join("solver.rtol=1");
    assert_int_equal(j.errors.n, 0);
    assert_int_equal(j.list.n_groups, 4);
    assert_string_equal(j.list.groups[3].name, "solver");
    assert_int_equal(j.list.groups[3].place.line, -4);
    part(&j);
}

TEST(faults_are_at_the_settings_line)
{
    static const char *const bad[][2] = {
        {"body.x=1", "there are 2 groups &body; write body(1) to body(2)"},
        {"body(3).x=1", "there are only 2 &body"},
        {"run(2).x=1", "there is only 1 &run"},
        {"void(2).x=1", "there is no &void"},
        {"run.t_end=1, x = 2", "one key and its value are expected"},
        {"run.t_end='a", "the string is not closed"},
        {"run.t_end=1e999", "'t_end': '1e999' is too large for a real"},
    };
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        joined j = join(bad[k][0]);
        assert_int_equal(j.errors.n, 1);
        assert_string_equal(j.errors.list[0].text, bad[k][1]);
        assert_int_equal(j.errors.list[0].place.line, -4);
        assert_int_equal(j.list.n_groups, 3);
        assert_int_equal(j.list.groups[0].n_keys, 2);
        part(&j);
    }
}
