/* SPDX-License-Identifier: BSD-3-Clause */
/* box.h: boxes round points, and which of them meet. */
#include "base/box.h"

#include "unit/close.h"

TEST(a_box_is_as_large_as_its_points)
{
    const box b = box_with(box_with(box_empty(), (vec2){3.0, -1.0}), (vec2){0.0, 3.0});
    assert_true(b.low.x == 0.0 && b.low.y == -1.0 && b.high.x == 3.0 && b.high.y == 3.0);
    assert_close(box_diagonal(b), 5.0, 0.0);
    const box same = box_with(b, (vec2){(double)NAN, 1.0});
    assert_true(same.low.x == b.low.x && same.high.x == b.high.x);
    const box both = box_join(box_empty(), b);
    assert_true(both.low.x == b.low.x && both.high.y == b.high.y);
}

TEST(boxes_that_share_an_edge_meet_and_an_empty_one_meets_nothing)
{
    const box a = {{0.0, 0.0}, {1.0, 1.0}}, beside = {{1.0, 0.0}, {2.0, 1.0}}, apart = {{0.0, 1.1}, {1.0, 2.0}};
    const box none = box_empty();
    assert_true(box_meets(&a, &beside) && box_meets(&beside, &a));
    assert_false(box_meets(&a, &apart) || box_meets(&apart, &a) || box_meets(&none, &a) || box_meets(&a, &none));
    assert_close(box_diagonal(none), 0.0, 0.0);
}

TEST(segments_cross_only_where_both_have_ends_on_both_sides)
{
    const vec2 a = {0.0, 0.0}, b = {2.0, 2.0}, c = {0.0, 2.0}, d = {2.0, 0.0}, e = {0.9, 1.1};
    assert_true(vec2_segments_cross(a, b, c, d));
    assert_false(vec2_segments_cross(a, b, c, e) || vec2_segments_cross(c, e, a, b)); /* ends before it */
    assert_false(vec2_segments_cross(a, b, b, d));                                    /* share an end */
}
