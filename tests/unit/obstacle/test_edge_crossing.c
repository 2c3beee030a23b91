/* SPDX-License-Identifier: BSD-3-Clause */
/* edge_crossing.c: which segment goes through an edge, and how deep. Tolerances of 1e-15 are the rounding of
 * coordinates of order 1 m. */
#include "obstacle/edge_crossing.h"

#include "harness/cleanup_gsl.h"
#include "unit/obstacle/landscape.h"

static const dem_index without_none[2] = {-1, -1};

static obstacle_crossing crossing_of(const obstacle_set *o, double ax, double ay, double bx, double by)
{
    return obstacles_crossing(o, 0.0, (vec2[2]){{ax, ay}, {bx, by}}, without_none);
}

TEST(the_depth_is_the_way_to_the_nearest_end_of_either)
{
    CLEANUP(obstacles_free) obstacle_set o = compile(valley, 4, 0.0);
    obstacle_crossing at = crossing_of(&o, -1.0, 1.0, -1.0, -0.25); /* its end is 0.25 below the first segment */
    assert_int_equal(at.segment, 0);
    assert_close(at.depth, 0.25, 1e-15);
    at = crossing_of(&o, -1.9, 5.0, -1.9, -5.0); /* the segment begins 0.1 beside it */
    assert_int_equal(at.segment, 0);
    assert_close(at.depth, 0.1, 1e-15);
    at = crossing_of(&o, -0.5, -0.125, 2.0, -0.125); /* through two segments, under their vertex */
    assert_int_equal(at.segment, 1);
    assert_close(at.depth, 0.125, 1e-15);
}

TEST(an_edge_that_only_touches_or_is_elsewhere_is_not_crossed)
{
    CLEANUP(obstacles_free) obstacle_set o = compile(valley, 4, 0.0);
    const double edges[][4] = {{-1.0, 1.0, -1.0, 0.0},  /* its end on a segment */
                               {-1.0, 0.0, 1.0, 0.0},   /* a vertex on it, along a segment */
                               {-2.5, 1.0, -2.5, -1.0}, /* beyond the free end */
                               {-1.0, 0.5, 1.0, 0.5}};
    for (int k = 0; k < 4; k++) {
        const obstacle_crossing at = crossing_of(&o, edges[k][0], edges[k][1], edges[k][2], edges[k][3]);
        assert_int_equal(at.segment, -1);
        assert_close(at.depth, 0.0, 0.0);
    }
}

TEST(obstacles_may_be_left_out)
{
    CLEANUP(obstacles_free) obstacle_set o = compile_both();
    const vec2 edge[2] = {{2.5, 0.25}, {5.5, 0.25}}, low[2] = {{-1.0, 1.0}, {-1.0, -1.0}};
    assert_int_equal(o.segments[obstacles_crossing(&o, 0.0, edge, without_none).segment].obstacle, 1);
    assert_int_equal(obstacles_crossing(&o, 0.0, edge, (dem_index[2]){-1, 1}).segment, -1);
    assert_int_equal(obstacles_crossing(&o, 0.0, low, (dem_index[2]){0, -1}).segment, -1);
    assert_int_equal(obstacles_crossing(&o, 0.0, low, (dem_index[2]){1, -1}).segment, 0);
}

/* Moved by its depth in the best of 720 directions an edge comes apart, and moved by less in none: 1e-3 of the depth
 * for directions that are a quarter of a degree beside the best one at most. */
TEST(no_shorter_way_takes_an_edge_off_the_segment)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    const double ridge[4] = {-1.0, 0.0, 1.0, 0.3};
    CLEANUP(obstacles_free) obstacle_set o = compile(ridge, 2, 0.0);
    int n = 0;
    while (n < 200) {
        const vec2 a = {uniform(rng, -2.0, 2.0), uniform(rng, -1.0, 1.0)},
                   b = {uniform(rng, -2.0, 2.0), uniform(rng, -1.0, 1.0)};
        const double depth = crossing_of(&o, a.x, a.y, b.x, b.y).depth;
        if (depth < 1e-3) continue;
        int n_apart = 0;
        for (int k = 0; k < 720; k++) {
            const vec2 way = {cos(k * M_PI / 360.0), sin(k * M_PI / 360.0)};
            const double less = 0.999 * depth, more = 1.001 * depth;
            assert_true(crossing_of(&o, a.x + less * way.x, a.y + less * way.y, b.x + less * way.x, b.y + less * way.y)
                            .segment == 0);
            n_apart += crossing_of(&o, a.x + more * way.x, a.y + more * way.y, b.x + more * way.x, b.y + more * way.y)
                           .segment < 0;
        }
        assert_true(n_apart > 0);
        n++;
    }
}

TEST(a_moving_obstacle_is_asked_where_it_is)
{
    CLEANUP(obstacles_free) obstacle_set o = compile_moving((vec2){2.0, 0.0}, (vec2){0.0, 0.0});
    const vec2 edge[2] = {{8.0, 0.25}, {6.5, 0.25}};
    assert_int_equal(obstacles_crossing(&o, 0.0, edge, without_none).segment, -1);
    const obstacle_crossing at = obstacles_crossing(&o, 0.5, edge, without_none);
    assert_int_equal(o.segments[at.segment].obstacle, 1);
    assert_close(at.depth, 0.25, 1e-15);
}
