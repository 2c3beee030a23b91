/* SPDX-License-Identifier: BSD-3-Clause */
/* chart.c: plots over time. */
#include "unit/drivers/plot/canvas_spy.h"

#include <stdlib.h>

#include "chart.h"

enum { ROWS = 20000 };

static const box place = {0, 20, 1200, 300};

typedef struct rows {
    double t[ROWS], y[ROWS];
} rows;

static chart make(const rows *r)
{
    return (chart){.label = "energy",
                   .unit = "J",
                   .n = ROWS,
                   .t = r->t,
                   .begin = 0.0,
                   .end = 1.0,
                   .n_lines = 1,
                   .line = {{"kinetic", {0, 0, 0}, 1, r->y}}};
}

static rows *fill(double (*of)(double t))
{
    rows *r = malloc(sizeof *r);
    assert_non_null(r);
    for (int k = 0; k < ROWS; k++) {
        r->t[k] = (double)k / (ROWS - 1);
        r->y[k] = of(r->t[k]);
    }
    return r;
}

static double wave(double t)
{
    return sin(700.0 * t);
}

/* In every column of pixels the thinned line reaches as far as the whole one. */
TEST(thinning_keeps_what_is_seen)
{
    enum { COLUMNS = 100 };
    CLEANUP(free_memory) rows *r = fill(wave);
    const chart c = make(r);
    double xy[8 * COLUMNS], least[COLUMNS], most[COLUMNS];
    const size_t n = chart_thin(&c, 0, COLUMNS, xy);
    assert_true(n <= 4 * COLUMNS && n >= 2 * COLUMNS);
    for (int k = 0; k < COLUMNS; k++) least[k] = 2.0, most[k] = -2.0;
    for (int k = 0; k < ROWS; k++) {
        const int column = (int)fmin(r->t[k] * COLUMNS, COLUMNS - 1);
        least[column] = fmin(least[column], r->y[k]);
        most[column] = fmax(most[column], r->y[k]);
    }
    for (size_t k = 0; k < n; k++) {
        const int column = (int)fmin(xy[2 * k] * COLUMNS, COLUMNS - 1);
        if (k > 0) assert_true(xy[2 * k] > xy[2 * k - 2]);
        if (xy[2 * k + 1] == least[column]) least[column] = -9.0;
        if (xy[2 * k + 1] == most[column]) most[column] = 9.0;
    }
    for (int k = 0; k < COLUMNS; k++) assert_true(least[k] == -9.0 && most[k] == 9.0);
}

static double spike(double t)
{
    return t == 0.0 ? (double)NAN : t > 0.5 && t < 0.5001 ? 1e3 : -1.0;
}

TEST(a_single_step_is_not_lost)
{
    CLEANUP(free_memory) rows *r = fill(spike);
    const chart c = make(r);
    double xy[8 * 40];
    const size_t n = chart_thin(&c, 0, 40, xy);
    double most = -2.0;
    for (size_t k = 0; k < n; k++) most = fmax(most, xy[2 * k + 1]);
    assert_close(most, 1e3, 0.0);
}

static canvas_spy draw(const chart *c, bool has_times)
{
    canvas_spy s = canvas_spy_new();
    assert_true(chart_draw(c, place, has_times, &s.face));
    assert_int_equal(s.depth, 0);
    canvas_spy_expect_legible(&s, (box){0, 0, 1200, 300});
    assert_true(s.stroked.x0 >= place.x0 && s.stroked.x1 <= place.x1);
    assert_true(s.stroked.y0 >= place.y0 && s.stroked.y1 <= place.y1);
    return s;
}

static bool has_text(const canvas_spy *s, const char *text)
{
    for (int k = 0; k < s->n_labels; k++)
        if (strcmp(s->text[k], text) == 0) return true;
    return false;
}

TEST(axes_have_numbers_units_and_names)
{
    CLEANUP(free_memory) rows *r = fill(wave);
    const chart c = make(r);
    const canvas_spy with = draw(&c, true), without = draw(&c, false);
    assert_true(has_text(&with, "kinetic") && has_text(&with, "energy, J"));
    assert_true(has_text(&with, "time, s") && has_text(&with, "−0.5") && has_text(&with, "0.2"));
    assert_false(has_text(&without, "time, s"));
}

/* As narrow as the command line lets it be. */
TEST(narrow_charts_are_legible)
{
    CLEANUP(free_memory) rows *r = fill(wave);
    const chart c = make(r);
    canvas_spy s = canvas_spy_new();
    assert_true(chart_draw(&c, (box){14, 14, 386, 150}, true, &s.face));
    canvas_spy_expect_legible(&s, (box){0, 0, 400, 150});
}

static double decay(double t)
{
    return t < 1e-4 ? 0.0 : pow(10.0, -3.0 - 6.0 * t);
}

TEST(decades_leave_out_what_has_no_logarithm)
{
    CLEANUP(free_memory) rows *r = fill(decay);
    chart c = make(r);
    c.by_decades = true, c.unit = "s", c.label = "step";
    const canvas_spy s = draw(&c, true);
    assert_true(has_text(&s, "step, ms") || has_text(&s, "step, µs"));
}

static double zero(double t)
{
    return 0.0 * t;
}

static double nothing(double t)
{
    return (double)NAN * t;
}

TEST(flat_and_empty_lines_have_axes_all_the_same)
{
    CLEANUP(free_memory) rows *flat = fill(zero), *none = fill(nothing);
    chart c = make(flat);
    (void)draw(&c, true);
    c = make(none);
    (void)draw(&c, true);
    c.by_decades = true;
    (void)draw(&c, true);
    c.n = 1, c.end = 0.0; /* a run that has not begun */
    (void)draw(&c, true);
}
