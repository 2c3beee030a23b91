/* SPDX-License-Identifier: BSD-3-Clause */
/* legend.c: bars of colours and of lengths. */
#include "unit/drivers/plot/canvas_spy.h"

#include "legend.h"

static const dem_reader_array strain = {.name = "strain", .unit = "1"}, stress = {.name = "von_mises", .unit = "Pa"};

static void expect_unit(double largest, const char *base, double factor, const char *expected)
{
    char unit[LEGEND_UNIT];
    assert_close(legend_unit(unit, largest, base), factor, 1e-12 * factor);
    assert_string_equal(unit, expected);
}

TEST(units_have_prefixes_and_ratios_powers)
{
    expect_unit(3e6, "Pa", 1e6, "MPa");
    expect_unit(0.02, "m/s", 1e-3, "mm/s");
    expect_unit(0.4, "1", 1.0, "");
    expect_unit(3e-13, "1", 1e-13, "10⁻¹³");
    expect_unit(3e-14, "Pa", 1e-14, "10⁻¹⁴ Pa");
    expect_unit(40.0, "", 1.0, "");
    expect_unit(0.0, "1", 1.0, "");
}

static canvas_spy draw(const dem_reader_array *source, palette_kind kind, colour_range range, double width)
{
    canvas_spy paper = canvas_spy_new();
    const palette p = palette_make(kind);
    const quantity q = {.name = source->name, .label = "label", .source = source, .scale = kind};
    legend_draw_colours(&q, &p, range, (box){40, 30, 40 + width, 43}, &paper.face);
    assert_int_equal(paper.depth, 0);
    assert_int_equal(paper.images, 1);
    assert_int_equal(paper.image.width, PALETTE_SIZE);
    return paper;
}

TEST(both_sides_and_the_middle_are_numbered)
{
    static const char *const texts[] = {"−0.4", "−0.2", "0", "0.2", "0.4", "label"};
    const canvas_spy s = draw(&strain, PALETTE_DIVERGING, (colour_range){-0.4, 0.4, false, false}, 400.0);
    assert_int_equal(s.n_labels, 6);
    for (int k = 0; k < 6; k++) assert_string_equal(s.text[k], texts[k]);
    assert_close(s.label[0].x, 40.0, 1e-9);
    assert_close(s.label[2].x, 240.0, 1e-9);
    assert_close(s.label[4].x, 440.0, 1e-9);
    assert_int_equal(s.fills, 0);
}

TEST(arrows_tell_of_values_beyond)
{
    const canvas_spy both = draw(&strain, PALETTE_DIVERGING, (colour_range){-0.4, 0.4, true, true}, 400.0);
    const canvas_spy upper = draw(&stress, PALETTE_SEQUENTIAL, (colour_range){0.0, 3e6, false, true}, 400.0);
    assert_int_equal(both.fills, 2);
    assert_true(both.filled.x0 < 40.0 && both.filled.x1 > 440.0);
    assert_int_equal(upper.fills, 1);
    assert_true(upper.filled.x0 >= 440.0);
    assert_string_equal(upper.text[upper.n_labels - 1], "label, MPa");
}

TEST(numbers_do_not_meet)
{
    for (double width = 90.0; width < 450.0; width += 10.0)
        for (double limit = 1e-14; limit < 1e6; limit *= 1.7) {
            const canvas_spy s = draw(&strain, PALETTE_DIVERGING, (colour_range){-limit, limit, false, false}, width);
            const canvas_spy t = draw(&stress, PALETTE_SEQUENTIAL, (colour_range){0.0, limit, false, false}, width);
            const box picture = {-20, 0, 100 + width, 100};
            canvas_spy_expect_legible(&s, picture);
            canvas_spy_expect_legible(&t, picture);
        }
}

TEST(a_scale_bar_has_a_round_length)
{
    canvas_spy s = canvas_spy_new();
    legend_draw_scale(1000.0, 10.0, 50.0, 70.0, &s.face); /* 70 mm of room */
    assert_string_equal(s.text[0], "50 mm");
    assert_close(s.stroked.x0, 10.0, 1e-9);
    assert_close(s.stroked.x1, 60.0, 1e-9);
}
