/* SPDX-License-Identifier: BSD-3-Clause */
/* strip.c: panels lie beside each other and show what they have to. */
#include "unit/drivers/plot/canvas_spy.h"

#include "legend.h"
#include "strip.h"

static bool lies_in(box inner, box outer)
{
    const double rounding = 1e-9 * (1.0 + box_width(outer) + box_height(outer));
    const box o = box_grown(outer, rounding);
    return inner.x0 >= o.x0 && inner.y0 >= o.y0 && inner.x1 <= o.x1 && inner.y1 <= o.y1;
}

static void check(const strip *s, box view)
{
    const box picture = {0.0, 0.0, s->width, s->height};
    assert_true(lies_in(view, s->view));
    assert_close(fmod(s->width, 2.0), 0.0, 0.0);
    assert_close(fmod(s->height, 2.0), 0.0, 0.0);
    for (size_t k = 0; k < s->n; k++) {
        const panel p = strip_panel(s, k);
        assert_true(lies_in(p.place, picture));
        assert_close(box_height(p.place) / box_width(p.place), box_height(p.view) / box_width(p.view), 1e-12);
        assert_true(p.place.y1 < strip_colours(s).y0 - LEGEND_LETTERS);
        for (size_t i = 0; i < k; i++) assert_false(box_meets(p.place, strip_panel(s, i).place));
    }
    assert_true(lies_in(strip_colours(s), picture) && lies_in(strip_scale(s), picture));
    assert_true(strip_scale(s).x1 < strip_colours(s).x0);
}

TEST(panels_do_not_meet_whatever_their_number_and_shape)
{
    for (size_t n = 1; n <= 24; n++)
        for (double shape = 0.02; shape < 60.0; shape *= 2.7)
            for (size_t columns = 0; columns <= n; columns += 5) {
                const box view = {-0.1, 0.3, 0.5, 0.3 + 0.6 * shape};
                const strip s = strip_plan(n, view, 1200.0, columns);
                check(&s, view);
                if (columns > 0) assert_int_equal(s.columns, columns);
                if (columns == 0) assert_true(s.height <= 0.75 * s.width + 2.0);
            }
}

TEST(very_many_panels_have_more_rows)
{
    for (size_t n = 25; n < 3000; n = 3 * n / 2)
        for (size_t columns = 0; columns <= 100; columns += 50) {
            const strip s = strip_plan(n, (box){0, 0, 1, 1}, 400.0, columns);
            check(&s, (box){0, 0, 1, 1});
            assert_true(s.across >= 20.0 && s.down >= 20.0);
        }
}

TEST(widths_become_even)
{
    const strip s = strip_plan(2, (box){0, 0, 1, 1}, 777.0, 0);
    assert_close(s.width, 778.0, 0.0);
    check(&s, (box){0, 0, 1, 1});
}

TEST(six_square_panels_are_two_rows_of_three)
{
    const strip s = strip_plan(6, (box){0, 0, 1.1, 1}, 1200.0, 0);
    assert_int_equal(s.columns, 3);
    assert_int_equal(s.rows, 2);
}

static const double slope[] = {-9, -2, 9, -2, 9.1, 50};

TEST(a_view_has_the_ground_that_is_near)
{
    const dem_obstacle ground = {.struct_size = sizeof(dem_obstacle), .n_points = 3, .points = slope};
    const box far = {0, 0, 1, 1}, near = {0, -1.9, 1, -0.9};
    assert_true(lies_in(far, strip_view_with(strip_view(far), far, &ground)));
    assert_true(strip_view_with(strip_view(far), far, &ground).y0 > -0.1);
    assert_true(lies_in(near, strip_view_with(strip_view(near), near, &ground)));
    assert_true(strip_view_with(strip_view(near), near, &ground).y0 < -2.0);
    assert_true(strip_view_with(strip_view(near), near, &ground).x1 < 1.5);
}

TEST(a_point_has_a_view)
{
    const box b = strip_view((box){2, 3, 2, 3});
    assert_true(box_width(b) > 0.0 && box_height(b) > 0.0);
    assert_true(lies_in((box){2, 3, 2, 3}, b));
}
