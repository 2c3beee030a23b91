/* SPDX-License-Identifier: BSD-3-Clause */
/* picture.c: a file takes its place when it is whole. */
#include "unit/close.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "picture.h"
#include "unit/scratch.h"

static const char *path, *part;

TEST(the_end_of_the_name_tells_the_format)
{
    assert_int_equal(picture_format_of("a.png"), PICTURE_PNG);
    assert_int_equal(picture_format_of("a.b/c.SVG"), PICTURE_SVG);
    assert_int_equal(picture_format_of("a.pdf"), PICTURE_PDF);
    assert_int_equal(picture_format_of("png"), PICTURE_NONE);
    assert_int_equal(picture_format_of("a.png.gz"), PICTURE_NONE);
    assert_int_equal(picture_format_of(""), PICTURE_NONE);
}

static void write_old(void)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    (void)fputs("old", file);
    (void)fclose(file);
}

static char first_of(const char *name)
{
    FILE *file = fopen(name, "r");
    if (file == NULL) return '\0';
    const int c = fgetc(file);
    (void)fclose(file);
    return (char)c;
}

TEST(an_old_one_stays_until_the_new_one_is_whole)
{
    picture p;
    outcome o = {0};
    write_old();
    assert_true(picture_open(&p, path, 10, 10, &o));
    assert_int_equal(first_of(path), 'o');
    assert_true(picture_close(&p, "", &o));
    assert_int_equal(first_of(path), '<');
    assert_int_equal(access(part, F_OK), -1);
}

TEST(a_dropped_one_leaves_nothing)
{
    picture p;
    outcome o = {0};
    write_old();
    assert_true(picture_open(&p, path, 10, 10, &o));
    picture_drop(&p);
    assert_int_equal(first_of(path), 'o');
    assert_int_equal(access(part, F_OK), -1);
}

TEST(a_full_disk_leaves_the_old_one)
{
    picture p;
    outcome o = {0};
    write_old();
    assert_int_equal(symlink("/dev/full", part), 0);
    assert_true(picture_open(&p, path, 10, 10, &o));
    assert_false(picture_close(&p, "", &o));
    assert_int_equal(o.code, EXIT_IO);
    assert_non_null(strstr(o.message, path));
    assert_int_equal(first_of(path), 'o');
    assert_int_equal(access(part, F_OK), -1);
}

TEST(a_folder_that_is_not_there_is_reported)
{
    picture p;
    outcome o = {0};
    assert_false(picture_open(&p, "no/where.svg", 10, 10, &o));
    assert_int_equal(o.code, EXIT_IO);
}

SCRATCH_GROUP({&path, "a.svg"}, {&part, "a.svg.part"});
