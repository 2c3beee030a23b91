/* SPDX-License-Identifier: BSD-3-Clause */
/* pgm.c: what the format's description allows is read, the rest refused with its line. */
#include "unit/close.h"

#include <string.h>

#include "harness/message.h"
#include "pgm.h"

static image read_good(const char *bytes, size_t size)
{
    image out;
    char fault[IMAGE_FAULT] = "";
    if (pgm_parse(&out, fault, bytes, size) != IMAGE_READ) fail_msg("%s", fault);
    return out;
}

static void expect_grey(image *got, size_t width, size_t height, unsigned white, const unsigned *grey)
{
    assert_int_equal(got->width, width);
    assert_int_equal(got->height, height);
    assert_int_equal(got->white, white);
    for (size_t k = 0; k < width * height; k++) assert_int_equal(got->grey[k], grey[k]);
    image_free(got);
    assert_null(got->grey);
}

static void expect_fault(const char *bytes, size_t size, const char *expected)
{
    image out;
    char fault[IMAGE_FAULT] = "";
    assert_int_equal(pgm_parse(&out, fault, bytes, size), IMAGE_REFUSED);
    assert_line_parts(fault, expected);
    assert_null(out.grey);
}

#define TEXT(text) (text), sizeof(text) - 1

TEST(text_of_8_and_16_bits_is_read)
{
    image small = read_good(TEXT("P2\n# by hand\n3 2 # size\n255\n0 128 255\n1 2 3\n"));
    image deep = read_good(TEXT("P2 1 2 65535 65535\n258"));
    image bits = read_good(TEXT("P2 2 1 1 0 1"));
    expect_grey(&small, 3, 2, 255, (const unsigned[]){0, 128, 255, 1, 2, 3});
    expect_grey(&deep, 1, 2, 65535, (const unsigned[]){65535, 258});
    expect_grey(&bits, 2, 1, 1, (const unsigned[]){0, 1});
}

/* A blank ends the header; the first pixel may look like one, or like a comment. */
TEST(bytes_of_8_and_16_bits_are_read)
{
    image small = read_good(TEXT("P5 3 1 255\n\n#\xff"));
    image deep = read_good(TEXT("P5\n# deep\n2 1\n256\n\x01\x00\x00\xff"));
    expect_grey(&small, 3, 1, 255, (const unsigned[]){10, 35, 255});
    expect_grey(&deep, 2, 1, 256, (const unsigned[]){256, 255});
}

TEST(headers_at_fault_are_refused)
{
    expect_fault(TEXT(""), "1 * 'P2' * 'P5' * beginning");
    expect_fault(TEXT("P6 1 1 255 x"), "1 * 'P2' * 'P5' * beginning");
    expect_fault(TEXT("P25 1 1"), "1 * 'P2' * 'P5' * beginning");
    expect_fault(TEXT("P2\n"), "2 * ends * width");
    expect_fault(TEXT("P2\n0 1 255"), "2 * width * [1, 32768] * 0");
    expect_fault(TEXT("P5\n1\n32769\n255\n"), "3 * height * [1, 32768] * 32769");
    expect_fault(TEXT("P5 1 1 65536 "), "1 * largest * [1, 65535] * 65536");
    expect_fault(TEXT("P5 1 1 255"), "1 * 1 x 1 * pixels * 1 * bytes * 0 * header");
    expect_fault(TEXT("P5 1 1 255#x\ny"), "1 * comment * largest");
}

/* Before anything of that size is asked for. */
TEST(pixels_that_the_bytes_cannot_hold_are_refused)
{
    expect_fault(TEXT("P5 32768 32768 65535\nxyz"), "1 * 32768 x 32768 * pixels * 2147483648 * bytes * 3 * header");
    expect_fault(TEXT("P2 32768 32768 65535\n1 2"), "1 * 4 * bytes * 32768 x 32768 * pixels");
    expect_fault(TEXT("P5 2 1 255\nabc"), "1 * 2 x 1 * pixels * 2 * bytes * 3 * header");
}

TEST(pixels_at_fault_are_refused)
{
    expect_fault(TEXT("P2 2 2 9\n1 2\n3 10"), "3 * pixel * [0, 9] * 10");
    expect_fault(TEXT("P2 2 2 9\n1 2\n-3 1"), "3 * pixel * [0, 9] * -3");
    expect_fault(TEXT("P2 2 2 9\n1 2\n3x 1"), "3 * pixel * integer * '3x'");
    expect_fault(TEXT("P2 2 2 9\n1 2\n3      "), "3 * ends * pixel");
    expect_fault(TEXT("P2 2 1 9\n1 2\n3"), "3 * 2 x 1 * pixels");
    expect_fault(TEXT("P5 2 2 9 \x01\x02\x03\x0a"), "1 * pixel * column 2 * row 2 * 10 * larger * 9");
}

TEST(beginnings_are_known)
{
    assert_true(pgm_begins(TEXT("P2 ")));
    assert_true(pgm_begins(TEXT("P5\n")));
    assert_false(pgm_begins(TEXT("P6\n")));
    assert_false(pgm_begins(TEXT("P5")));
}
