/* SPDX-License-Identifier: BSD-3-Clause */
/* file.c: whole files, and what is none to read. */
#include "unit/close.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file.h"
#include "unit/scratch.h"

static const char *path;

static void put(const char *bytes, size_t size)
{
    file_put(path, bytes, size);
}

static void expect_refused(const char *name, size_t most, const char *expected)
{
    char untouched, *bytes = &untouched, why[FILE_WHY];
    size_t size;
    assert_int_equal(file_read(&bytes, &size, name, most, why), FILE_REFUSED);
    assert_string_equal(why, expected);
    assert_null(bytes);
}

TEST(all_bytes_are_read_with_a_nul_behind)
{
    char *bytes, why[FILE_WHY];
    size_t size;
    put("a\0b", 3);
    assert_int_equal(file_read(&bytes, &size, path, 3, why), FILE_READ);
    assert_int_equal(size, 3);
    assert_memory_equal(bytes, "a\0b", 4);
    free(bytes);
}

TEST(what_is_too_large_or_empty_is_refused)
{
    CLEANUP(free_memory) char *large = calloc((1 << 20) + 1, 1);
    assert_non_null(large);
    put(large, (1 << 20) + 1);
    expect_refused(path, 1 << 20, "the file is larger than 1 MiB");
    put("", 0);
    expect_refused(path, 1 << 20, "the file is empty");
}

TEST(what_is_no_file_is_refused)
{
    char fifo[SCRATCH_PATH + 8];
    expect_refused("/tmp", 1 << 20, "not a regular file");
    expect_refused("/no/such/file", 1 << 20, "No such file or directory");
    (void)snprintf(fifo, sizeof fifo, "%s.pipe", path);
    assert_int_equal(mkfifo(fifo, 0600), 0);
    expect_refused(fifo, 1 << 20, "not a regular file");
    assert_int_equal(unlink(fifo), 0);
}

TEST(the_beginning_and_the_size_of_a_file_are_reported)
{
    char bytes[4] = "";
    put("abcdef", 6);
    assert_int_equal(file_begin(bytes, 4, path), 4);
    assert_memory_equal(bytes, "abcd", 4);
    assert_true(file_size(path) == 6.0);
    put("x", 1);
    assert_int_equal(file_begin(bytes, 4, path), 1);
    static const char *const none[] = {"/tmp", "/no/such/file", "/dev/zero"};
    for (size_t k = 0; k < sizeof none / sizeof *none; k++) {
        assert_int_equal(file_begin(bytes, 4, none[k]), 0);
        assert_true(file_size(none[k]) == 0.0);
    }
}

SCRATCH_GROUP({&path, "a"});
