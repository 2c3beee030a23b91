/* SPDX-License-Identifier: BSD-3-Clause */
/* paint.c: what is drawn comes out in the pixels. */
#include "unit/close.h"
#include "unit/drivers/plot/fill_box.h"

#include <cairo.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "paint.h"

enum { WIDTH = 60, HEIGHT = 40 };

static cairo_status_t take(void *file, unsigned char *bytes, unsigned size)
{
    return fread(bytes, 1, size, file) == size ? CAIRO_STATUS_SUCCESS : CAIRO_STATUS_READ_ERROR;
}

/* Closes a canvas and reads its picture back. */
static cairo_surface_t *picture_of(canvas *c, FILE *file)
{
    assert_true(c->close(c, ""));
    rewind(file);
    cairo_surface_t *surface = cairo_image_surface_create_from_png_stream(take, file);
    (void)fclose(file);
    assert_int_equal(cairo_image_surface_get_width(surface), WIDTH);
    assert_int_equal(cairo_image_surface_get_height(surface), HEIGHT);
    return surface;
}

static uint32_t pixel(cairo_surface_t *surface, int column, int row)
{
    const unsigned char *data = cairo_image_surface_get_data(surface);
    uint32_t argb;
    memcpy(&argb, data + (ptrdiff_t)row * cairo_image_surface_get_stride(surface) + (ptrdiff_t)4 * column, sizeof argb);
    return argb & 0xffffffU;
}

static const colour red = {255, 0, 0}, blue = {0, 0, 255};

TEST(shapes_lie_where_they_are_drawn)
{
    FILE *file = tmpfile();
    canvas *c = paint_open_png(file, WIDTH, HEIGHT);
    const double line[] = {5.0, 5.5, 25.0, 5.5}, dot[] = {40.5, 20.5, 40.5, 20.5};
    const box clip = {30, 0, WIDTH, HEIGHT};
    c->strokes(c, (canvas_pen){red, 3.0}, 2, 1, line);
    c->strokes(c, (canvas_pen){blue, 9.0}, 2, 1, dot);
    fill_box(c, blue, (box){10, 20, 20, 30});
    c->begin(c, "", &clip);
    fill_box(c, red, (box){20, 32, 50, 38});
    c->end(c);
    cairo_surface_t *s = picture_of(c, file);
    assert_int_equal(pixel(s, 0, 0), 0xffffff);
    assert_int_equal(pixel(s, 15, 5), 0xff0000);
    assert_int_equal(pixel(s, 40, 20), 0x0000ff);
    assert_int_equal(pixel(s, 43, 20), 0x0000ff);
    assert_int_equal(pixel(s, 15, 25), 0x0000ff);
    assert_int_equal(pixel(s, 25, 35), 0xffffff);
    assert_int_equal(pixel(s, 35, 35), 0xff0000);
    cairo_surface_destroy(s);
}

/* Two triangles of a square: no seam between them. */
TEST(neighbours_leave_no_seam)
{
    FILE *file = tmpfile();
    canvas *c = paint_open_png(file, WIDTH, HEIGHT);
    const double halves[] = {5, 5, 50, 5, 50, 35, 5, 5, 50, 35, 5, 35};
    c->fills(c, blue, 3, 1, halves);
    c->fills(c, blue, 3, 1, halves + 6);
    cairo_surface_t *s = picture_of(c, file);
    for (int column = 6; column < 49; column++)
        for (int row = 6; row < 34; row++) assert_true((pixel(s, column, row) >> 8) <= 0x2020);
    cairo_surface_destroy(s);
}

/* Eight times as large, with full colour up to its edges. */
TEST(images_are_stretched)
{
    FILE *file = tmpfile();
    canvas *c = paint_open_png(file, WIDTH, HEIGHT);
    uint32_t argb[4] = {0xffff0000U, 0xffff0000U, 0xffff0000U, 0xffff0000U};
    c->image(c, (box){10, 10, 26, 26}, &(canvas_image){2, 2, argb});
    cairo_surface_t *s = picture_of(c, file);
    assert_int_equal(pixel(s, 10, 10), 0xff0000);
    assert_int_equal(pixel(s, 25, 25), 0xff0000);
    assert_int_equal(pixel(s, 26, 26), 0xffffff);
    cairo_surface_destroy(s);
}

/* How many pixels are not white in a box. */
static int ink_in(cairo_surface_t *s, int x0, int y0, int x1, int y1)
{
    int n = 0;
    for (int column = x0; column < x1; column++)
        for (int row = y0; row < y1; row++) n += pixel(s, column, row) != 0xffffff;
    return n;
}

TEST(letters_stand_on_their_anchors)
{
    FILE *file = tmpfile();
    canvas *c = paint_open_png(file, WIDTH, HEIGHT);
    c->write(c, &(canvas_label){20, 16, 12, CANVAS_END, false, {0, 0, 0}, "H"});
    c->write(c, &(canvas_label){40, 36, 12, CANVAS_START, true, {0, 0, 0}, "H"});
    cairo_surface_t *s = picture_of(c, file);
    assert_true(ink_in(s, 8, 4, 20, 17) > 10);
    assert_true(ink_in(s, 28, 24, 41, 37) > 10);
    assert_int_equal(ink_in(s, 0, 0, WIDTH, HEIGHT), ink_in(s, 8, 4, 21, 17) + ink_in(s, 28, 24, 41, 37));
    cairo_surface_destroy(s);
}

TEST(pages_are_of_the_size_of_the_picture)
{
    static char text[65536];
    FILE *file = tmpfile();
    canvas *c = paint_open_pdf(file, 400.0, 200.0);
    assert_true(c->close(c, "data 1"));
    rewind(file);
    const size_t n = fread(text, 1, sizeof text - 1, file);
    bool found = false;
    for (size_t k = 0; k + 64 < n && !found; k++) found = memcmp(text + k, "/MediaBox [ 0 0 300 150 ]", 25) == 0;
    assert_true(n > 64 && memcmp(text, "%PDF", 4) == 0);
    assert_true(found); /* 72 to the inch */
    (void)fclose(file);
}

TEST(a_full_disk_is_reported)
{
    for (int paged = 0; paged < 2; paged++) {
        FILE *file = fopen("/dev/full", "w");
        if (file == NULL) skip();
        canvas *c = (paged != 0 ? paint_open_pdf : paint_open_png)(file, WIDTH, HEIGHT);
        assert_false(c->close(c, ""));
        (void)fclose(file);
    }
}
