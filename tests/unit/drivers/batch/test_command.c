/* SPDX-License-Identifier: BSD-3-Clause */
/* command.c: what the words mean. Those that are refused are in tests/deck/test_refused.py. */
#include "unit/close.h"

#include "command.h"

static requests none;

TEST(words_come_in_any_order)
{
    char *words[] = {"dem_batch", "b.nml",   "--set", "run.t_end=1", "--check", "--outdir",    "f",
                     "@list",     "--index", "3",     "--set",       "a(2).b=", "--overwrite", NULL};
    CLEANUP(command_free) command c;
    const host h = {.out = stdout, .err = stderr, .requests = &none};
    assert_int_equal(command_parse(&c, &h, 13, words), EXIT_DONE);
    assert_int_equal(c.action, COMMAND_CHECK);
    assert_string_equal(c.outdir, "f");
    assert_int_equal(c.index, 3);
    assert_true(c.overwrite);
    assert_int_equal(c.n_decks, 2);
    assert_string_equal(c.decks[0], "b.nml");
    assert_string_equal(c.decks[1], "@list");
    assert_int_equal(c.n_settings, 2);
    assert_string_equal(c.settings[0].text, "run.t_end=1");
    assert_int_equal(c.settings[1].number, 2);
}

TEST(without_words_it_runs_here)
{
    char *words[] = {"dem_batch", "a", NULL};
    CLEANUP(command_free) command c;
    const host h = {.out = stdout, .err = stderr, .requests = &none};
    assert_int_equal(command_parse(&c, &h, 2, words), EXIT_DONE);
    assert_int_equal(c.action, COMMAND_RUN);
    assert_string_equal(c.outdir, ".");
    assert_int_equal(c.index, 0);
    assert_false(c.overwrite);
}

TEST(what_is_wrong_is_usage)
{
    char *words[] = {"dem_batch", "a", "--index", "0", NULL};
    CLEANUP(command_free) command c;
    const host h = {.out = stdout, .err = stderr, .requests = &none};
    assert_int_equal(command_parse(&c, &h, 4, words), EXIT_USAGE);
}
