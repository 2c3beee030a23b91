/* SPDX-License-Identifier: BSD-3-Clause */
/* run_log.c: lines and warnings, as they are printed and kept. */
#include "run_log.h"

#include "unit/close.h"

#include <string.h>

static char text[1 << 16];

static void read_log(run_log *l)
{
    rewind(l->out);
    text[fread(text, 1, sizeof text - 1, l->out)] = '\0';
    assert_int_equal(fclose(l->out), 0);
}

TEST(a_line_begins_behind_one_of_progress)
{
    run_log l = {.out = tmpfile()};
    assert_non_null(l.out);
    run_log_tell(&l, "a %d\n", 1);
    (void)fprintf(l.out, "50 %%");
    l.inside = true;
    run_log_tell(&l, "b\n");
    run_log_begin(&l);
    read_log(&l);
    assert_string_equal(text, "a 1\n50 %\nb\n");
}

TEST(warnings_are_printed_and_kept)
{
    run_log l = {.out = tmpfile()};
    assert_non_null(l.out);
    run_log_warn(&l, "%s is long", "it");
    l.quiet = true;
    run_log_warn(&l, "again");
    read_log(&l);
    assert_string_equal(text, "warning    it is long\n");
    assert_int_equal(l.n_warnings, 2);
    assert_string_equal(l.warnings[0], "it is long");
    assert_string_equal(l.warnings[1], "again");
}

TEST(more_warnings_than_are_kept_are_printed)
{
    char longer[2 * RUN_LOG_TEXT];
    run_log l = {.out = tmpfile()};
    assert_non_null(l.out);
    memset(longer, 'x', sizeof longer);
    longer[sizeof longer - 1] = '\0';
    for (int k = 0; k < RUN_LOG_WARNINGS + 3; k++) run_log_warn(&l, "%s", longer);
    read_log(&l);
    assert_int_equal(l.n_warnings, RUN_LOG_WARNINGS);
    assert_int_equal(strlen(l.warnings[RUN_LOG_WARNINGS - 1]), RUN_LOG_TEXT - 1);
    assert_int_equal(strlen(text), (RUN_LOG_WARNINGS + 3) * (strlen("warning    ") + RUN_LOG_TEXT));
}
