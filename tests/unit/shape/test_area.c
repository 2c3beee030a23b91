/* SPDX-License-Identifier: BSD-3-Clause */
/* area.c: areas of outlines less voids, against formulas and counting. */
#include "unit/close.h"

#include "shape/area.h"

static const double pi = 3.14159265358979323846;

static double less(outline o, outline *voids, size_t n)
{
    const shape s = {.outline = o, .n_voids = n, .voids = voids};
    return area_of(&s);
}

static const outline block = {.kind = DEM_OUTLINE_RECTANGLE, .centre = {0.0, 2.0}, .size = {6.0, 4.0}};
static const outline disc = {.kind = DEM_OUTLINE_DISC, .radius = 5.0};

TEST(straight_edges_are_exact)
{
    double points[] = {0, 0, 4, 0, 4, 4, 3, 4, 2, 1, 1, 4, 0, 4}, tilted[] = {-1, 1.5, 0, 0.5, 1, 1.5, 0, 2.5};
    const outline notched = {.kind = DEM_OUTLINE_POLYGON, .n_points = 7, .points = points};
    outline voids[] = {
        {.kind = DEM_OUTLINE_RECTANGLE, .centre = {0.5, 1.0}, .size = {1.0, 1.0}},
        {.kind = DEM_OUTLINE_RECTANGLE, .centre = {3.0, 4.0}, .size = {1.0, 1.0}}, /* a quarter is inside */
        {.kind = DEM_OUTLINE_POLYGON, .n_points = 4, .points = tilted}};           /* a square of area 2 */
    assert_close(less(block, NULL, 0), 24.0, 1e-13);
    assert_close(less(notched, NULL, 0), 16.0 - 3.0, 1e-13);
    assert_close(less(block, voids, 1), 24.0 - 1.0, 1e-13);
    assert_close(less(block, voids, 2), 24.0 - 1.25, 1e-13);
    /* Of the first void half is in the tilted square too. */
    assert_close(less(block, voids, 3), 24.0 - 1.25 - 2.0 + 0.5, 1e-13);
}

TEST(circles_are_near_to_their_formulas)
{
    const outline ring = {.kind = DEM_OUTLINE_RING, .radius = 5.0, .inner = 4.9};
    outline hole = {.kind = DEM_OUTLINE_DISC, .centre = {1.0, 0.5}, .radius = 2.0};
    assert_close(less(disc, NULL, 0), 25.0 * pi, 1e-5 * 25.0 * pi);
    assert_close(less(ring, NULL, 0), 0.99 * pi, 1e-4 * 25.0 * pi);
    assert_close(less(disc, &hole, 1), 21.0 * pi, 1e-5 * 25.0 * pi);
}

/* Two discs of radius 1 whose centres are 1 apart share 2 pi/3 - sqrt(3)/2; a ring's void leaves its core. */
TEST(what_voids_share_counts_once)
{
    outline two[] = {{.kind = DEM_OUTLINE_DISC, .centre = {0.0, 0.0}, .radius = 1.0},
                     {.kind = DEM_OUTLINE_DISC, .centre = {0.6, 0.8}, .radius = 1.0}};
    outline moat = {.kind = DEM_OUTLINE_RING, .centre = {0.0, 2.0}, .radius = 1.5, .inner = 1.0};
    outline all = {.kind = DEM_OUTLINE_DISC, .radius = 50.0};
    assert_close(less(disc, two, 2), 25.0 * pi - 2.0 * pi + 2.0 * pi / 3.0 - 0.5 * sqrt(3.0), 1e-4 * 25.0 * pi);
    assert_close(less(block, &moat, 1), 24.0 - 1.25 * pi, 1e-4 * 24.0);
    assert_close(less(disc, &all, 1), 0.0, 1e-12);
}

/* Forty discs at random places, against the share of a grid of points that lies in the material. */
TEST(many_overlapping_voids_agree_with_counted_points)
{
    enum { n = 40, side = 1500 };
    outline voids[n];
    unsigned random = 1;
    long count = 0;
    for (int k = 0; k < n; k++) {
        double u[3];
        for (int c = 0; c < 3; c++) u[c] = (random = 1664525U * random + 1013904223U) / 4294967296.0;
        voids[k] =
            (outline){.kind = DEM_OUTLINE_DISC, .centre = {10.0 * u[0] - 5.0, 10.0 * u[1] - 5.0}, .radius = 0.3 + u[2]};
    }
    for (int k = 0; k < side * side; k++) {
        const double x = 10.0 * (k % side + 0.5) / side - 5.0, y = 10.0 * (k / side + 0.5) / side - 5.0; /* NOLINT */
        double depth = -outline_distance(&disc, x, y);
        for (int v = 0; v < n && depth > 0.0; v++) depth = fmin(depth, outline_distance(&voids[v], x, y));
        count += depth > 0.0;
    }
    const double counted = 100.0 * (double)count / side / side;
    assert_true(counted > 10.0 && counted < 60.0);
    assert_close(less(disc, voids, n), counted, 5e-4 * 78.5); /* counting has a random error of 1e-4 */
}

/* 3 x 2 pixels, of which 4 are solid: the upper row all, of the lower row the right one. */
TEST(pixels_are_counted)
{
    unsigned char solid[] = {0, 0, 1, 1, 1, 1};
    outline hole = {.kind = DEM_OUTLINE_RECTANGLE, .centre = {0.5, 1.0}, .size = {1.0, 1.0}};
    const outline frame = {.kind = DEM_OUTLINE_RECTANGLE, .centre = {0.0, 1.0}, .size = {3.0, 2.0}};
    shape s = {.outline = frame, .mask = {.width = 3, .height = 2, .n_solid = 4, .scale = 1.0, .solid = solid}};
    assert_close(area_of(&s), 4.0, 0.0);
    s.n_voids = 1;
    s.voids = &hole; /* takes a half of the upper middle, a quarter of each on the right; x from 0 to 1 */
    assert_close(area_of(&s), 4.0 - 0.25 - 0.25 - 0.25, 1e-13);
}
