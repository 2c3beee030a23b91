/* SPDX-License-Identifier: BSD-3-Clause */
/* image_file.c: images in files, by their first bytes. */
#include "unit/close.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/message.h"
#include "image_file.h"
#include "unit/scratch.h"

static const char *path;

static void put(const char *bytes, size_t size)
{
    file_put(path, bytes, size);
}

#define TEXT(text) (text), sizeof(text) - 1

TEST(an_image_is_read_the_top_row_first)
{
    image m;
    char fault[IMAGE_FAULT] = "";
    put(TEXT("P2\n3 2\n10\n10 9 8 1 2 3\n"));
    if (image_file_read(&m, fault, path) != IMAGE_READ) fail_msg("%s", fault);
    assert_true(m.width == 3 && m.height == 2 && m.white == 10 && m.grey[0] == 10 && m.grey[5] == 3);
    image_free(&m);
}

static void expect_fault(const char *name, const char *expected)
{
    image m;
    char fault[IMAGE_FAULT] = "";
    assert_int_equal(image_file_read(&m, fault, name), IMAGE_REFUSED);
    assert_line_parts(fault, expected);
}

TEST(files_at_fault_are_refused)
{
    expect_fault("/no/such/image.pgm", "No such file or directory");
    put(TEXT("GIF89a"));
    expect_fault(path, "PGM * PNG");
    put(TEXT("P2\n1 1\n255\n256\n"));
    expect_fault(path, "4 * pixel * [0, 255] * 256");
    put(TEXT("\x89PNG\r\n\x1a\n"));
    char fault[IMAGE_FAULT] = "";
    image m;
    assert_int_equal(image_file_read(&m, fault, path), IMAGE_REFUSED);
    assert_int_equal(fault[0], ' ');
    assert_non_null(strstr(fault, "PNG image"));
}

TEST(an_image_is_measured_by_its_first_bytes)
{
    double size[2];
    put(TEXT("P5\n# wide\n40 30\n255\n")); /* and no pixel */
    assert_true(image_file_measure(size, path, 0.5));
    assert_true(size[0] == 20.0 && size[1] == 15.0);
    put(TEXT("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\1\2\0\0\0\3"));
    assert_true(image_file_measure(size, path, 2.0));
    assert_true(size[0] == 516.0 && size[1] == 6.0);
    put(TEXT("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\1\2\0\0\0"));
    assert_false(image_file_measure(size, path, 2.0));
    put(TEXT("P2\n4 x\n"));
    assert_false(image_file_measure(size, path, 2.0));
    assert_false(image_file_measure(size, "/no/such/file", 2.0));
}

SCRATCH_GROUP({&path, "a"});
