/* SPDX-License-Identifier: BSD-3-Clause */
/* part_file.c: a file takes its place when it is whole. Faults of the device: test_picture.c. */
#include "unit/close.h"

#include <errno.h>
#include <string.h>

#include "part_file.h"
#include "unit/scratch.h"

static const char *path, *part;

static part_file begin(void)
{
    part_file p;
    outcome o = {0};
    file_put(path, "old", 3);
    assert_true(part_file_open(&p, path, &o));
    assert_true(fputs("new", p.file) >= 0);
    assert_int_equal(access(part, F_OK), 0);
    return p;
}

static void expect(char first)
{
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    assert_int_equal(fgetc(file), first);
    assert_int_equal(fclose(file), 0);
    assert_int_equal(access(part, F_OK), -1);
}

TEST(a_whole_one_replaces_an_older_one)
{
    part_file p = begin();
    outcome o = {0};
    assert_true(part_file_close(&p, true, "", &o));
    expect('n');
}

TEST(one_that_is_dropped_leaves_the_older_one)
{
    part_file p = begin();
    part_file_drop(&p);
    expect('o');
}

TEST(what_is_not_good_leaves_the_older_one_and_says_why)
{
    part_file p = begin();
    outcome o = {0};
    errno = 0;
    assert_false(part_file_close(&p, false, "the reason", &o));
    assert_int_equal(o.code, EXIT_IO);
    assert_non_null(strstr(o.message, "a.html: cannot be written (the reason)"));
    expect('o');
}

SCRATCH_GROUP({&path, "a.html"}, {&part, "a.html.part"});
