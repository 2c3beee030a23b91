/* SPDX-License-Identifier: BSD-3-Clause */
/* mask.c: from an image in a file to pixels that are material, and where they are. */
#include "unit/close.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "harness/message.h"
#include "mask.h"
#include "unit/scratch.h"

static const char *path;

static void put(const char *bytes, size_t size)
{
    file_put(path, bytes, size);
}

#define TEXT(text) (text), sizeof(text) - 1

/* 4 x 3 pixels of 0.5 m: x from -1 to 1, y from 0 to 1.5. The upper row has the pixels 0, 1 and 3. */
static mask read_steps(double threshold)
{
    mask m;
    char fault[IMAGE_FAULT] = "";
    put(TEXT("P2\n4 3\n10\n10 10 0 6\n5 10 4 0\n9 9 9 9\n"));
    if (mask_read(&m, fault, path, 0.5, threshold, false) != IMAGE_READ) fail_msg("%s", fault);
    return m;
}

TEST(bright_pixels_are_material_and_the_top_row_comes_first)
{
    static const unsigned char expected[12] = {1, 1, 1, 1, 1, 1, 0, 0, 1, 1, 0, 1};
    mask m = read_steps(0.5);
    assert_memory_equal(m.solid, expected, sizeof expected);
    assert_int_equal(m.n_solid, 9);
    mask_free(&m);
    m = read_steps(0.51); /* 5 of 10 is no longer enough */
    assert_int_equal(m.n_solid, 8);
    mask_free(&m);
    assert_null(m.solid);
}

TEST(inverted_the_dark_pixels_are_material)
{
    CLEANUP(mask_free) mask bright = read_steps(0.5), dark;
    char fault[IMAGE_FAULT] = "";
    assert_int_equal(mask_read(&dark, fault, path, 0.5, 0.5, true), IMAGE_READ);
    assert_int_equal(bright.n_solid + dark.n_solid, 12);
    for (size_t k = 0; k < 12; k++) assert_int_equal(bright.solid[k] + dark.solid[k], 1);
}

static bool has(const mask *m, double x, double y)
{
    return mask_has(m, (const double[]){x, y}, 1e-9);
}

TEST(edges_of_pixels_belong_to_the_material)
{
    CLEANUP(mask_free) mask m = read_steps(0.5);
    assert_true(has(&m, 0.25, 0.25) && has(&m, -0.75, 1.25) && has(&m, 0.75, 1.25));
    assert_false(has(&m, 0.25, 0.75) || has(&m, 0.25, 1.25) || has(&m, 0.75, 0.75));
    assert_true(has(&m, 0.0, 0.75) && has(&m, 0.5, 1.25) && has(&m, 0.75, 1.0)); /* between bright and dark */
    assert_true(has(&m, -1.0, 0.0) && has(&m, 1.0, 1.5) && has(&m, 1.0 + 5e-10, 0.0) && has(&m, 0.0, -5e-10));
    assert_false(has(&m, 1.0 + 2e-9, 0.0) || has(&m, 0.0, -2e-9) || has(&m, -1e300, 0.0) || has(&m, 0.0, (double)NAN));
}

static bool fits(const mask *m, double x, double y, double radius)
{
    return mask_fits(m, (const double[]){x, y}, radius);
}

TEST(a_disc_fits_as_far_as_the_nearest_dark_pixel)
{
    CLEANUP(mask_free) mask m = read_steps(0.5);
    assert_true(fits(&m, -0.5, 0.75, 0.4999));
    assert_false(fits(&m, -0.5, 0.75, 0.5001)); /* the edge at x = 0, and that of the image */
    assert_true(fits(&m, -0.3, 0.1, 0.0999));
    assert_false(fits(&m, -0.3, 0.1, 0.1001));
    assert_true(fits(&m, -0.3, 0.45, 0.304)); /* the corner (0, 0.5) is 0.30414 away */
    assert_false(fits(&m, -0.3, 0.45, 0.3042));
    assert_false(fits(&m, 0.25, 0.75, 0.01));
}

TEST(rows_are_sliced_into_runs)
{
    double x[5];
    CLEANUP(mask_free) mask m = read_steps(0.5);
    assert_int_equal(mask_slice(&m, 0, x), 2);
    assert_close(x[0], -1.0, 0.0);
    assert_close(x[1], 1.0, 0.0);
    assert_int_equal(mask_slice(&m, 1, x), 2);
    assert_close(x[1], 0.0, 0.0);
    assert_int_equal(mask_slice(&m, 2, x), 4);
    assert_close(x[1], 0.0, 0.0);
    assert_close(x[2], 0.5, 0.0);
    assert_close(x[3], 1.0, 0.0);
}

static void expect_fault(const char *name, const char *expected)
{
    mask m;
    char fault[IMAGE_FAULT] = "";
    assert_int_equal(mask_read(&m, fault, name, 1.0, 0.5, false), IMAGE_REFUSED);
    assert_line_parts(fault, expected);
    assert_null(m.solid);
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
    mask m;
    assert_int_equal(mask_read(&m, fault, path, 1.0, 0.5, false), IMAGE_REFUSED);
    assert_int_equal(fault[0], ' ');
    assert_non_null(strstr(fault, "PNG image"));
}

TEST(an_image_is_measured_by_its_first_bytes)
{
    double size[2];
    put(TEXT("P5\n# wide\n40 30\n255\n")); /* and no pixel */
    assert_true(mask_measure(size, path, 0.5));
    assert_true(size[0] == 20.0 && size[1] == 15.0);
    put(TEXT("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\1\2\0\0\0\3"));
    assert_true(mask_measure(size, path, 2.0));
    assert_true(size[0] == 516.0 && size[1] == 6.0);
    put(TEXT("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\1\2\0\0\0"));
    assert_false(mask_measure(size, path, 2.0));
    put(TEXT("P2\n4 x\n"));
    assert_false(mask_measure(size, path, 2.0));
    assert_false(mask_measure(size, "/no/such/file", 2.0));
}

SCRATCH_GROUP({&path, "a"});
