/* SPDX-License-Identifier: BSD-3-Clause */
/* png.c: images written by another encoder, and damaged ones. Without cairo all are refused. */
#include "unit/close.h"

#include <string.h>

#include "harness/message.h"
#include "png.h"

static const unsigned char grey8[] = {
    137, 80, 78, 71, 13,  10, 26,  10,  0,  0,  0,  13, 73, 72, 68, 82, 0,   0,   0,  3,   0,   0,   0,   2,   8,
    0,   0,  0,  0,  184, 31, 57,  198, 0,  0,  0,  16, 73, 68, 65, 84, 120, 218, 99, 96,  104, 248, 207, 192, 200,
    196, 12, 0,  8,  13,  1,  134, 229, 72, 94, 53, 0,  0,  0,  0,  73, 69,  78,  68, 174, 66,  96,  130,
};

#ifdef DEM_CAIRO
static const unsigned char grey16[] = {
    137, 80,  78,  71, 13,  10,  26,  10,  0,  0,   0,   13,  73,  72,  68,  82,  0,  0,   0,  6,
    0,   0,   0,   1,  16,  0,   0,   0,   0,  136, 50,  92,  111, 0,   0,   0,   21, 73,  68, 65,
    84,  120, 156, 99, 96,  248, 207, 200, 80, 255, 191, 129, 225, 223, 255, 255, 12, 0,   33, 240,
    5,   251, 64,  1,  144, 2,   0,   0,   0,  0,   73,  69,  78,  68,  174, 66,  96, 130,
};

static const unsigned char colours[] = {
    137, 80, 78, 71, 13,  10, 26,  10,  0,  0,   0,   13, 73, 72, 68, 82, 0,   0,   0,  4,   0,   0,   0,   1, 8,
    2,   0,  0,  0,  118, 94, 152, 154, 0,  0,   0,   16, 73, 68, 65, 84, 120, 218, 99, 248, 207, 192, 192, 0, 198,
    64,  0,  0,  29, 239, 5,  251, 229, 69, 214, 208, 0,  0,  0,  0,  73, 69,  78,  68, 174, 66,  96,  130,
};

static const unsigned char clear[] = {
    137, 80, 78, 71, 13,  10, 26,  10,  0,  0,   0,   13, 73, 72, 68, 82, 0,   0,   0,  2,   0,   0,   0,   1, 8,
    6,   0,  0,  0,  244, 34, 127, 138, 0,  0,   0,   16, 73, 68, 65, 84, 120, 218, 99, 248, 255, 255, 63,  3, 16,
    255, 7,  0,  30, 234, 6,  250, 209, 42, 202, 229, 0,  0,  0,  0,  73, 69,  78,  68, 174, 66,  96,  130,
};
#endif

static const char *text_of(const unsigned char *bytes)
{
    return (const char *)bytes;
}

TEST(beginnings_are_known)
{
    assert_true(png_begins(text_of(grey8), sizeof grey8));
    assert_false(png_begins(text_of(grey8), 7));
    assert_false(png_begins("P5 1 1 255 ", 11));
}

#ifdef DEM_CAIRO
static void expect_grey(const unsigned char *bytes, size_t size, size_t width, const unsigned *grey)
{
    CLEANUP(image_free) image out;
    char fault[IMAGE_FAULT] = "";
    if (png_parse(&out, fault, text_of(bytes), size) != IMAGE_READ) fail_msg("%s", fault);
    assert_int_equal(out.width, width);
    assert_int_equal(out.white, 255);
    for (size_t k = 0; k < out.width * out.height; k++) assert_int_equal(out.grey[k], grey[k]);
}

/* Rec. 601: 0.299, 0.587 and 0.114 of 255. Of sixteen bits the upper eight count: 0x00ff, 0x0100, 0x7fff, ... */
TEST(images_become_grey)
{
    expect_grey(grey8, sizeof grey8, 3, (const unsigned[]){0, 128, 255, 1, 2, 3});
    expect_grey(grey16, sizeof grey16, 6, (const unsigned[]){0, 1, 127, 128, 254, 255});
    expect_grey(colours, sizeof colours, 4, (const unsigned[]){77, 149, 29, 255});
    expect_grey(clear, sizeof clear, 2, (const unsigned[]){0, 255});
}

static void expect_fault(const unsigned char *bytes, size_t size, const char *expected)
{
    image out;
    char fault[IMAGE_FAULT] = "";
    assert_int_equal(png_parse(&out, fault, text_of(bytes), size), IMAGE_REFUSED);
    assert_line_parts(fault, expected);
    assert_null(out.grey);
}

TEST(damaged_images_are_refused)
{
    unsigned char bytes[sizeof grey8];
    expect_fault(grey8, 23, "PNG * ends * early");
    for (size_t size = 24; size < sizeof grey8 - 12; size++) expect_fault(grey8, size, "PNG * damaged");
    memcpy(bytes, grey8, sizeof bytes);
    bytes[50] ^= 1; /* in the compressed data */
    expect_fault(bytes, sizeof bytes, "PNG * damaged");
}

TEST(stated_sizes_are_limited)
{
    unsigned char bytes[sizeof grey8];
    memcpy(bytes, grey8, sizeof bytes);
    bytes[16] = 0x7f;
    expect_fault(bytes, sizeof bytes, "PNG * 2130706435 x 2 * pixels * limit * 67108864");
    memcpy(bytes, grey8, sizeof bytes);
    bytes[18] = bytes[22] = 0x40; /* 16387 x 16386 */
    expect_fault(bytes, sizeof bytes, "PNG * 16387 x 16386 * pixels * limit * 67108864");
}

/* A chunk that libpng skips would state another size than the image has, and let any size pass. */
TEST(an_image_begins_with_its_header)
{
    static const unsigned char chunk[] = {0, 0, 0, 8, 'p', 'A', 'D', 'd', 0, 0, 0, 3, 0, 0, 0, 2, 0, 0, 0, 0};
    unsigned char bytes[sizeof grey8 + sizeof chunk];
    memcpy(bytes, grey8, 8);
    memcpy(bytes + 8, chunk, sizeof chunk);
    memcpy(bytes + 8 + sizeof chunk, grey8 + 8, sizeof grey8 - 8);
    expect_fault(bytes, sizeof bytes, "PNG * header");
}
#else
TEST(without_cairo_none_is_read)
{
    image out;
    char fault[IMAGE_FAULT] = "";
    assert_int_equal(png_parse(&out, fault, text_of(grey8), sizeof grey8), IMAGE_REFUSED);
    assert_string_equal(fault, "PNG images need cairo, which is not built in; PGM is always understood");
    assert_null(out.grey);
}
#endif
