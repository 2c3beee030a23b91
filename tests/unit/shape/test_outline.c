/* SPDX-License-Identifier: BSD-3-Clause */
/* outline.c: distances, slices and faults of plane figures. */
#include "unit/close.h"

#include <stdlib.h>
#include <string.h>

#include "shape/outline.h"

static const double tiny = 1e-15;

static const outline block = {.kind = DEM_OUTLINE_RECTANGLE, .centre = {1.0, 2.0}, .size = {6.0, 4.0}};
static const outline disc = {.kind = DEM_OUTLINE_DISC, .centre = {1.0, 2.0}, .radius = 5.0};
static const outline ring = {.kind = DEM_OUTLINE_RING, .centre = {1.0, 2.0}, .radius = 5.0, .inner = 3.0};

/* A square of side 4 with a notch from above down to (2, 1). */
static double notched_points[] = {0, 0, 4, 0, 4, 4, 3, 4, 2, 1, 1, 4, 0, 4};
static const outline notched = {.kind = DEM_OUTLINE_POLYGON, .n_points = 7, .points = notched_points};

TEST(a_rectangle_is_as_far_as_its_nearest_side_or_corner)
{
    assert_close(outline_distance(&block, 1.0, 2.0), -2.0, tiny);
    assert_close(outline_distance(&block, 3.5, 2.0), -0.5, tiny);
    assert_close(outline_distance(&block, 1.0, 5.0), 1.0, tiny);
    assert_close(outline_distance(&block, 4.0 + 3.0, 4.0 + 4.0), 5.0, tiny); /* 3-4-5 */
}

TEST(discs_and_rings_are_counted_from_their_rims)
{
    assert_close(outline_distance(&disc, 1.0 + 3.0, 2.0 - 4.0), 0.0, tiny);
    assert_close(outline_distance(&disc, 1.0, 2.0), -5.0, tiny);
    assert_close(outline_distance(&ring, 1.0, 2.0), 3.0, tiny);
    assert_close(outline_distance(&ring, 1.0, 2.0 + 3.5), -0.5, tiny);
    assert_close(outline_distance(&ring, 1.0 + 4.75, 2.0), -0.25, tiny);
    assert_close(outline_distance(&ring, 1.0 + 6.0, 2.0 + 8.0), 5.0, tiny);
}

/* The notch has slopes of 3: (2, 2) is 1 above its tip, 1/sqrt(10) from its sides. */
TEST(a_polygon_need_not_be_convex)
{
    assert_close(outline_distance(&notched, 2.0, 2.0), 1.0 / sqrt(10.0), tiny);
    assert_close(outline_distance(&notched, 2.0, 0.75), -0.25, tiny);
    assert_close(outline_distance(&notched, 0.5, 3.5), -0.5, tiny);
    assert_close(outline_distance(&notched, 2.0, 4.0), 1.0 * 3.0 / sqrt(10.0), tiny);
    assert_close(outline_distance(&notched, -3.0, -4.0), 5.0, tiny);
    assert_close(outline_distance(&notched, 0.0, 2.0), 0.0, 0.0);
}

/* A ray through corners must not count them twice or never. */
TEST(inside_is_found_right_at_the_height_of_a_corner)
{
    double points[] = {0, 0, 2, -1, 4, 0, 2, 1};
    const outline rhombus = {.kind = DEM_OUTLINE_POLYGON, .n_points = 4, .points = points};
    assert_true(outline_distance(&rhombus, 1.0, 0.0) < 0.0);
    assert_true(outline_distance(&rhombus, -1.0, 0.0) > 0.0);
    assert_true(outline_distance(&rhombus, 5.0, 0.0) > 0.0);
    assert_true(outline_distance(&rhombus, 0.0, 1.0) > 0.0);
    assert_true(outline_distance(&rhombus, 0.0, -1.0) > 0.0);
    assert_true(outline_distance(&notched, -1.0, 1.0) > 0.0);
    assert_true(outline_distance(&notched, 0.5, 1.0) < 0.0);
    assert_true(outline_distance(&notched, -1.0, 4.0) > 0.0);
}

TEST(the_way_round_does_not_matter)
{
    double points[14];
    for (int k = 0; k < 7; k++) memcpy(points + 2 * k, notched_points + 2 * (6 - k), 2 * sizeof *points);
    const outline back = {.kind = DEM_OUTLINE_POLYGON, .n_points = 7, .points = points};
    for (int k = 0; k < 100; k++) {
        const double x = 0.53 * (k % 10) - 0.5, y = 0.57 * (k / 10) - 0.5;
        assert_close(outline_distance(&back, x, y), outline_distance(&notched, x, y), 1e-14);
    }
}

/* What the nearest point must be: on the edge, as far as the distance says, and no point of the edge is nearer. */
static void expect_nearest(const outline *o, double x, double y)
{
    const double point[2] = {x, y}, distance = fabs(outline_distance(o, x, y));
    double near[2];
    outline_nearest(o, point, near);
    assert_close(outline_distance(o, near[0], near[1]), 0.0, 4e-15); /* a few roundings of coordinates up to 10 */
    assert_close(hypot(near[0] - x, near[1] - y), distance, 4e-15);
}

TEST(the_nearest_point_is_on_the_edge_and_as_far_as_the_distance_says)
{
    const outline *const kinds[] = {&block, &disc, &ring, &notched};
    for (int k = 0; k < 4; k++)
        for (int i = 0; i < 400; i++) expect_nearest(kinds[k], 0.61 * (i % 20) - 5.03, 0.59 * (i / 20) - 4.01);
}

TEST(the_nearest_point_of_a_centre_is_on_the_edge)
{
    expect_nearest(&block, 1.0, 2.0);
    expect_nearest(&disc, 1.0, 2.0);
    expect_nearest(&ring, 1.0, 2.0);
}

TEST(beyond_a_corner_the_corner_is_nearest)
{
    double near[2];
    outline_nearest(&block, (double[2]){7.0, 8.0}, near);
    assert_close(near[0], 4.0, 0.0);
    assert_close(near[1], 4.0, 0.0);
    outline_nearest(&notched, (double[2]){-3.0, -4.0}, near);
    assert_close(near[0], 0.0, 0.0);
    assert_close(near[1], 0.0, 0.0);
}

/* Mirrored points have mirrored nearest points to the bit, so that mirrored bodies stay so. */
TEST(nearest_points_are_mirror_symmetric)
{
    const outline kinds[] = {{.kind = DEM_OUTLINE_RECTANGLE, .centre = {0.0, 0.7}, .size = {0.3, 0.9}},
                             {.kind = DEM_OUTLINE_DISC, .centre = {0.0, 0.7}, .radius = 0.31},
                             {.kind = DEM_OUTLINE_RING, .centre = {0.0, 0.7}, .radius = 0.31, .inner = 0.17}};
    for (int k = 0; k < 3; k++)
        for (int i = 1; i < 50; i++) {
            const double x = 0.0123 * i, y = 0.7 + 0.0301 * (i % 17 - 8);
            double right[2], left[2];
            outline_nearest(&kinds[k], (double[2]){x, y}, right);
            outline_nearest(&kinds[k], (double[2]){-x, y}, left);
            assert_true(right[0] == -left[0] && right[1] == left[1]);
        }
}

TEST(corners_turn_by_their_angles)
{
    assert_int_equal(outline_corners(&disc), 0);
    assert_int_equal(outline_corners(&ring), 0);
    assert_int_equal(outline_corners(&block), 4);
    assert_int_equal(outline_corners(&notched), 7);
    const outline_corner upper_right = outline_corner_at(&block, 2), tip = outline_corner_at(&notched, 4);
    assert_true(upper_right.x[0] == 4.0 && upper_right.x[1] == 4.0 && upper_right.cosine == 0.0);
    assert_true(tip.x[0] == 2.0 && tip.x[1] == 1.0);
    assert_close(tip.cosine, -0.8, 1e-15); /* slopes of -3 and 3: (1 - 9)/10 */
    assert_close(outline_corner_at(&notched, 0).cosine, 0.0, 0.0);
}

static void expect_box(const outline *o, double left, double bottom, double right, double top)
{
    double box[4];
    outline_box(o, box);
    assert_close(box[0], left, tiny);
    assert_close(box[1], bottom, tiny);
    assert_close(box[2], right, tiny);
    assert_close(box[3], top, tiny);
}

TEST(boxes_touch_all_sides)
{
    expect_box(&block, -2.0, 0.0, 4.0, 4.0);
    expect_box(&disc, -4.0, -3.0, 6.0, 7.0);
    expect_box(&ring, -4.0, -3.0, 6.0, 7.0);
    expect_box(&notched, 0.0, 0.0, 4.0, 4.0);
}

static void expect_slice(const outline *o, double y, size_t n, const double *expected)
{
    double x[7];
    assert_true(n <= outline_cuts(o));
    assert_int_equal(outline_slice(o, y, x), n);
    for (size_t k = 0; k < n; k++) assert_close(x[k], expected[k], 4 * tiny);
}

TEST(slices_enter_and_leave)
{
    expect_slice(&block, 3.9, 2, (const double[]){-2.0, 4.0});
    expect_slice(&block, 4.1, 0, NULL);
    expect_slice(&disc, 2.0 + 3.0, 2, (const double[]){-3.0, 5.0});
    expect_slice(&disc, 8.0, 0, NULL);
    expect_slice(&ring, 2.0 - 4.0, 2, (const double[]){-2.0, 4.0});
    expect_slice(&ring, 2.0, 4, (const double[]){-4.0, -2.0, 4.0, 6.0});
    expect_slice(&notched, 0.5, 2, (const double[]){0.0, 4.0});
    expect_slice(&notched, 2.5, 4, (const double[]){0.0, 1.5, 2.5, 4.0});
}

TEST(levels_are_where_slices_change)
{
    double y[7];
    assert_int_equal(outline_levels(&block, y), 2);
    assert_close(y[0] + y[1], 4.0, tiny);
    assert_int_equal(outline_levels(&ring, y), 4);
    assert_close(y[0], -3.0, tiny);
    assert_close(y[1], 7.0, tiny);
    assert_close(y[2], -1.0, tiny);
    assert_close(y[3], 5.0, tiny);
    assert_int_equal(outline_levels(&notched, y), 7);
    assert_close(y[4], 1.0, tiny);
}

TEST(placing_turns_and_then_shifts)
{
    outline o = {.size = {4.0, 2.0}};
    const double quarter[2] = {0.0, 1.0}, shift[2] = {10.0, 20.0};
    assert_true(outline_place(&o, quarter, shift));
    assert_int_equal(o.kind, DEM_OUTLINE_POLYGON);
    expect_box(&o, 9.0, 18.0, 11.0, 22.0);
    assert_close(outline_distance(&o, 10.0, 20.0), -1.0, tiny);
    assert_close(o.points[0], 11.0, tiny); /* (-2, -1) */
    assert_close(o.points[1], 18.0, tiny);
    outline_free(&o);
    assert_null(o.points);
}

static void expect_crossing(double *points, size_t n, size_t first, size_t second)
{
    const outline o = {.kind = DEM_OUTLINE_POLYGON, .n_points = n, .points = points};
    size_t edges[2];
    assert_true(outline_crossing(&o, edges));
    assert_int_equal(edges[0], first);
    assert_int_equal(edges[1], second);
}

TEST(polygons_that_meet_themselves_are_found)
{
    size_t edges[2];
    double bow[] = {0, 0, 1, 1, 1, 0, 0, 1}, back[] = {0, 0, 2, 0, 1, 0, 1, 1}, spike[] = {0, 0, 2, 0, 2, 2, 1, 0};
    double hair[] = {0, 0, 1, 0, 1, 1, 0, 1, 0, -1}, flat[] = {0, 0, 1, 0, 2, 0};
    expect_crossing(bow, 4, 0, 2);
    expect_crossing(back, 4, 0, 1);  /* folds back */
    expect_crossing(spike, 4, 0, 2); /* touches with a corner */
    expect_crossing(hair, 5, 0, 3);  /* passes the first point */
    expect_crossing(flat, 3, 0, 2);
    assert_false(outline_crossing(&notched, edges));
}
