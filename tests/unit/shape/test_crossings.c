/* SPDX-License-Identifier: BSD-3-Clause */
/* crossings.c: numbers of crossings, and that they are on both edges. */
#include "unit/close.h"

#include "shape/crossings.h"

typedef struct found {
    const outline *a, *b;
    int n;
} found;

static void take(void *context, const double x[2])
{
    found *f = context;
    assert_close(outline_distance(f->a, x[0], x[1]), 0.0, 1e-14);
    assert_close(outline_distance(f->b, x[0], x[1]), 0.0, 1e-14);
    f->n++;
}

static void expect(const outline *a, const outline *b, int n)
{
    found there = {a, b, 0}, back = {b, a, 0};
    crossings_find(a, b, take, &there);
    crossings_find(b, a, take, &back);
    assert_int_equal(there.n, n);
    assert_int_equal(back.n, n);
}

static const outline block = {.kind = DEM_OUTLINE_RECTANGLE, .centre = {0.0, 2.0}, .size = {6.0, 4.0}};

static outline disc_at(double x, double y, double radius)
{
    return (outline){.kind = DEM_OUTLINE_DISC, .centre = {x, y}, .radius = radius};
}

TEST(circles_cross_twice_or_not_at_all)
{
    const outline a = disc_at(1.0, 2.0, 1.5), near = disc_at(2.3, 2.4, 0.9), inside = disc_at(1.1, 2.0, 0.3);
    const outline far = disc_at(5.0, 2.0, 1.0), same = a;
    expect(&a, &near, 2);
    expect(&a, &inside, 0);
    expect(&a, &far, 0);
    expect(&a, &same, 0);
    const outline ring = {.kind = DEM_OUTLINE_RING, .centre = {1.0, 2.0}, .radius = 1.5, .inner = 1.0};
    expect(&ring, &near, 4);
}

TEST(a_circle_crosses_the_sides_that_it_reaches)
{
    const outline middle = disc_at(0.3, 2.1, 1.0), side = disc_at(3.0, 2.0, 1.0), corner = disc_at(3.0, 4.0, 1.0);
    const outline large = disc_at(0.0, 2.0, 3.2), around = disc_at(0.0, 2.0, 9.0);
    expect(&block, &middle, 0);
    expect(&block, &side, 2);
    expect(&block, &corner, 2);
    expect(&block, &large, 8);
    expect(&block, &around, 0);
}

TEST(sides_cross_where_both_are)
{
    double points[] = {-5, 1, 5, 1.5, 5, 2.5, 0, 3.7};
    const outline beam = {.kind = DEM_OUTLINE_POLYGON, .n_points = 4, .points = points};
    const outline beside = {.kind = DEM_OUTLINE_RECTANGLE, .centre = {9.0, 2.0}, .size = {1.0, 1.0}};
    expect(&block, &beam, 4);
    expect(&block, &beside, 0);
}
