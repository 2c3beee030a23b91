/* SPDX-License-Identifier: BSD-3-Clause */
/* shape_batch.c: every shape is drawn once, in its colour, the larger values last. */
#include "unit/drivers/plot/canvas_spy.h"

#include "shape_batch.h"

static shape_batch lines_of(size_t n, const unsigned char *shades)
{
    shape_batch s;
    assert_true(shape_batch_create(&s, n, 2));
    for (; s.n < n; s.n++) {
        s.shade[s.n] = shades[s.n];
        for (int k = 0; k < 4; k++) s.xy[4 * s.n + (size_t)k] = (double)s.n;
    }
    return s;
}

static void draw(const shape_batch *s, const palette *p, double width, size_t n, const unsigned char *order)
{
    canvas_spy paper = canvas_spy_new();
    assert_true(shape_batch_draw(s, p, width, &paper.face));
    assert_int_equal(width > 0.0 ? paper.strokes : paper.fills, s->n);
    assert_int_equal(paper.n_inks, n);
    for (size_t k = 0; k < n; k++) assert_memory_equal(&paper.inks[k], &p->of[order[k]], sizeof(colour));
}

TEST(the_ends_of_diverging_lie_on_top)
{
    const palette p = palette_make(PALETTE_DIVERGING);
    const unsigned char shades[] = {254, 127, 0, 130, 127}, order[] = {127, 130, 0, 254};
    CLEANUP(shape_batch_free) shape_batch s = lines_of(5, shades);
    draw(&s, &p, 1.0, 4, order);
}

TEST(the_end_of_sequential_lies_on_top)
{
    const palette p = palette_make(PALETTE_SEQUENTIAL);
    const unsigned char shades[] = {254, 127, 0}, order[] = {0, 127, 254};
    CLEANUP(shape_batch_free) shape_batch s = lines_of(3, shades);
    draw(&s, &p, 0.0, 3, order);
}

TEST(the_coloured_end_of_a_half_lies_on_top)
{
    const palette upper = palette_make(PALETTE_UPPER), lower = palette_make(PALETTE_LOWER);
    const unsigned char shades[] = {254, 127, 0}, up[] = {0, 127, 254}, down[] = {254, 127, 0};
    CLEANUP(shape_batch_free) shape_batch s = lines_of(3, shades);
    draw(&s, &upper, 1.0, 3, up);
    draw(&s, &lower, 1.0, 3, down);
}

TEST(nothing_draws_nothing)
{
    const palette p = palette_make(PALETTE_SEQUENTIAL);
    CLEANUP(shape_batch_free) shape_batch s = lines_of(0, NULL);
    draw(&s, &p, 1.0, 0, NULL);
}
