/* SPDX-License-Identifier: BSD-3-Clause */
/* export.c: a command line. What is printed of faults is tested in tests/deck/test_export.py. */
#include "unit/close.h"

#include <stdlib.h>
#include <string.h>

#include "csv.h"
#include "export.h"
#include "vtu.h"

enum { MOST = 12 };

static exit_code parse(export *out, const char *words)
{
    static char text[256];
    char *list[MOST + 1] = {NULL};
    (void)strncpy(text, words, sizeof text - 1);
    int n = 0;
    for (char *word = strtok(text, " "); word != NULL && n < MOST; word = strtok(NULL, " ")) list[n++] = word;
    return export_parse(out, list);
}

TEST(words_are_taken_in_any_order)
{
    export e;
    assert_int_equal(parse(&e, "--to csv run.vtkhdf"), EXIT_DONE);
    assert_string_equal(e.input, "run.vtkhdf");
    assert_true(e.action == EXPORT_FILES && e.write == csv_export && !e.overwrite);
    assert_true(e.output == NULL && e.frames == NULL);
    assert_int_equal(parse(&e, "run.vtkhdf --overwrite --frames 0,-1 -o a/b --to vtu"), EXIT_DONE);
    assert_true(e.write == vtu_export && e.overwrite);
    assert_string_equal(e.output, "a/b");
    assert_string_equal(e.frames, "0,-1");
}

TEST(help_and_version_need_no_run)
{
    export e;
    assert_int_equal(parse(&e, "--help"), EXIT_DONE);
    assert_int_equal(e.action, EXPORT_HELP);
    assert_int_equal(parse(&e, "--version"), EXIT_DONE);
    assert_int_equal(e.action, EXPORT_VERSION);
}

TEST(the_rest_is_refused)
{
    static const char *const words[] = {"",
                                        "run.vtkhdf",
                                        "--to csv",
                                        "a --to png",
                                        "a --to",
                                        "a --to csv b",
                                        "a --to csv --frames",
                                        "a --to csv -x",
                                        "a --to csv -o"};
    export e;
    for (size_t k = 0; k < sizeof words / sizeof *words; k++) assert_int_equal(parse(&e, words[k]), EXIT_USAGE);
}

TEST(the_help_names_formats_and_codes)
{
    char text[4096];
    FILE *out = tmpfile();
    assert_non_null(out);
    export_help(out);
    rewind(out);
    text[fread(text, 1, sizeof text - 1, out)] = '\0';
    (void)fclose(out);
    assert_non_null(strstr(text, "usage: dem_export RUN.vtkhdf --to lammps|vtu|csv"));
    assert_non_null(strstr(text, "7 a file is there already"));
}
