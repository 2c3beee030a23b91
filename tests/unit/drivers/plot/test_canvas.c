/* SPDX-License-Identifier: BSD-3-Clause */
/* canvas.c: what all canvases share. */
#include "unit/drivers/plot/fill_box.h"
#include "unit/drivers/plot/canvas_spy.h"

TEST(lengths_count_letters_not_bytes)
{
    assert_close(canvas_length("µµµ", 10.0), canvas_length("abc", 10.0), 0.0);
    assert_close(canvas_length("", 10.0), 0.0, 0.0);
    assert_close(canvas_length("abcdef", 20.0), 4.0 * canvas_length("abc", 10.0), 1e-12);
}

TEST(rectangles_have_their_corners)
{
    canvas_spy s = canvas_spy_new();
    const box b = {1, 2, 30, 40};
    canvas_outline(&s.face, (canvas_pen){canvas_black, 2.0}, b);
    fill_box(&s.face, canvas_grey, b);
    assert_memory_equal(&s.stroked, &b, sizeof b);
    assert_memory_equal(&s.filled, &b, sizeof b);
    assert_int_equal(s.strokes, 1);
    assert_int_equal(s.fills, 1);
}
