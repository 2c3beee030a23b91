/* SPDX-License-Identifier: BSD-3-Clause */
/* raster.c: what touches a pixel is seen in it. */
#include "unit/close.h"

#include <stdlib.h>

#include "raster.h"

static float at(const raster *r, int column, int row)
{
    return r->value[row * r->width + column];
}

static raster make(int width, int height)
{
    raster r;
    assert_true(raster_create(&r, width, height));
    assert_int_equal(raster_count(&r), 0);
    return r;
}

/* Every pixel that lies on the line, by going along it in small steps. */
TEST(lines_touch_all_along_them)
{
    for (int k = 0; k < 60; k++) {
        const double angle = 0.1 * k, xy[4] = {20.5, 20.5, 20.5 + 18.0 * cos(angle), 20.5 + 18.0 * sin(angle)};
        CLEANUP(raster_free) raster r = make(41, 41);
        raster_line(&r, xy, 2, 3.0);
        for (double u = 0.0; u <= 1.0; u += 1e-3) {
            const int column = (int)(xy[0] + u * (xy[2] - xy[0])), row = (int)(xy[1] + u * (xy[3] - xy[1]));
            bool near = false;
            for (int i = -1; i <= 1; i++)
                for (int j = -1; j <= 1; j++) near = near || at(&r, column + i, row + j) == 3.0F;
            assert_true(near);
        }
    }
}

TEST(a_line_shorter_than_a_pixel_is_seen)
{
    const double xy[4] = {3.2, 1.3, 3.25, 1.31};
    CLEANUP(raster_free) raster r = make(8, 4);
    raster_line(&r, xy, 1, -7.0);
    assert_int_equal(raster_count(&r), 1);
    assert_true(at(&r, 3, 1) == -7.0F);
}

TEST(the_larger_value_wins_whatever_the_order)
{
    const double xy[4] = {0.5, 0.5, 3.5, 0.5};
    for (int k = 0; k < 2; k++) {
        CLEANUP(raster_free) raster r = make(4, 1);
        raster_line(&r, xy, 1, k == 0 ? -2.0 : 1.0);
        raster_line(&r, xy, 1, k == 0 ? 1.0 : -2.0);
        for (int column = 0; column < 4; column++) assert_true(at(&r, column, 0) == -2.0F);
    }
}

TEST(what_lies_outside_is_left_out)
{
    const double lines[][4] = {{-50, 2, -4, 2}, {4, 9, 4, 1e300}, {-1e300, -1e300, -5, -5}, {6, 6, 1e9, 6}};
    const double triangle[6] = {-9, -9, -5, -9, -5, -5}, value[3] = {1, 1, 1};
    CLEANUP(raster_free) raster r = make(5, 5);
    for (int k = 0; k < 4; k++) raster_line(&r, lines[k], 3, 1.0);
    raster_triangle(&r, triangle, value);
    assert_int_equal(raster_count(&r), 0);
    const double across[4] = {-2e4, 2.5, 2e4, 2.5};
    raster_line(&r, across, 1, 1.0);
    assert_int_equal(raster_count(&r), 5);
}

/* A square of two triangles: as many pixels as its area has, and its values linear. */
TEST(triangles_cover_their_area_linearly)
{
    const double a[6] = {10, 10, 50, 10, 50, 40}, b[6] = {10, 10, 50, 40, 10, 40};
    const double of_a[3] = {10, 50, 50}, of_b[3] = {10, 50, 10}; /* x */
    CLEANUP(raster_free) raster r = make(64, 64);
    raster_triangle(&r, a, of_a);
    raster_triangle(&r, b, of_b);
    assert_int_equal(raster_count(&r), 40 * 30);
    for (int row = 10; row < 40; row++)
        for (int column = 10; column < 50; column++) assert_close(at(&r, column, row), column + 0.5, 1e-4);
}

TEST(thin_triangles_do_not_vanish)
{
    const double flat[6] = {1, 1.3, 9, 1.3, 5, 1.3}, value[3] = {1, 1, 1};
    CLEANUP(raster_free) raster r = make(10, 3);
    raster_triangle(&r, flat, value);
    assert_true(raster_count(&r) >= 8);
}

TEST(colours_are_those_of_the_palette)
{
    const palette p = palette_make(PALETTE_DIVERGING);
    canvas_image image;
    CLEANUP(raster_free) raster r = make(3, 1);
    r.value[0] = -1.0F, r.value[2] = 0.5F;
    assert_true(raster_render(&r, &p, -1.0, 1.0, &image));
    const colour first = p.of[0];
    assert_int_equal(image.argb[0], 0xff000000U | (unsigned)first.red << 16 | (unsigned)first.green << 8 | first.blue);
    assert_int_equal(image.argb[1], 0);
    assert_int_equal(image.argb[2] >> 24, 255);
    free(image.argb);
}
