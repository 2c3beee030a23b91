/* SPDX-License-Identifier: BSD-3-Clause */
/* obstacle_fill.c: the polygon holds what lies right of the segments, as far as one can see. */
#include "unit/close.h"

#include <stdlib.h>

#include "obstacle_fill.h"

static const box view = {-1.0, -1.0, 3.0, 3.0};

/* By the number of times that the outline winds round the point, as canvases fill it. */
static bool is_solid(const obstacle_fill *g, double x, double y)
{
    int winding = 0;
    for (size_t k = 0; k < g->n; k++) {
        const double *a = g->xy + 2 * k, *b = g->xy + 2 * ((k + 1) % g->n);
        const double side = (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
        if (a[1] <= y && b[1] > y && side > 0.0) winding++;
        if (a[1] > y && b[1] <= y && side < 0.0) winding--;
    }
    return winding != 0;
}

typedef struct probe {
    double x, y;
    bool solid;
} probe;

static void expect(dem_index n, const double *points, const probe *probes, size_t n_probes)
{
    const dem_obstacle obstacle = {.struct_size = sizeof(dem_obstacle), .n_points = n, .points = points};
    obstacle_fill g;
    assert_true(obstacle_fill_outline(&obstacle, view, &g));
    for (size_t k = 0; k < n_probes; k++)
        if (is_solid(&g, probes[k].x, probes[k].y) != probes[k].solid)
            fail_msg("(%g, %g) is%s solid", probes[k].x, probes[k].y, probes[k].solid ? " not" : "");
    free(g.xy);
}

#define EXPECT(points, probes)                                                                                         \
    expect((dem_index)(sizeof(points) / sizeof *(points) / 2), points, probes, sizeof(probes) / sizeof *(probes))

TEST(below_a_floor)
{
    const double points[] = {-2, 0.1, 0, 0, 1, 0.5, 2, 0, 4, -0.1};
    const probe probes[] = {{1, 0.6, false}, {1, 0.4, true}, {-0.9, -0.9, true}, {2.9, -0.9, true}, {0, 2.9, false}};
    EXPECT(points, probes);
}

TEST(above_a_ceiling)
{
    const double points[] = {4, 2, -2, 2};
    const probe probes[] = {{1, 2.1, true}, {1, 1.9, false}, {2.9, 2.9, true}};
    EXPECT(points, probes);
}

TEST(behind_a_wall)
{
    const double points[] = {1, -2, 1, 4};
    const probe probes[] = {{1.1, 0, true}, {0.9, 0, false}, {2.9, 2.9, true}, {2.9, -0.9, true}};
    EXPECT(points, probes);
}

/* Floor, then a wall at its right end: everything beyond either is solid. */
TEST(around_a_corner)
{
    const double points[] = {0, 0, 2, 0, 2, 2};
    const probe probes[] = {{1, 1, false}, {1, -0.5, true}, {2.9, 1, true}, {2.9, -0.9, true}, {-0.5, 1, false}};
    EXPECT(points, probes);
}

/* Open above: the bodies are inside. */
TEST(around_a_trough)
{
    const double points[] = {0, 2, 0, 0, 2, 0, 2, 2};
    const probe probes[] = {{1, 1, false}, {1, -0.5, true}, {-0.5, 1, true}, {2.5, 1, true}, {1, 2.9, false}};
    EXPECT(points, probes);
}

/* Rays to the right of its ends would cross. */
TEST(below_a_roof)
{
    const double points[] = {0, 0, 1, 2, 2, 0};
    const probe probes[] = {{1, 1, true}, {1, -0.9, true}, {0.2, 1.5, false}, {-0.5, -0.9, false}, {2.5, -0.9, false}};
    EXPECT(points, probes);
}

/* Three sides of a square from outside: the fourth is the line between its ends. */
TEST(inside_of_what_turns_back)
{
    const double points[] = {1, 0, 0, 0, 0, 2, 2, 2, 2, 0, 1.1, 0};
    const probe probes[] = {{1, 1, true}, {1, -0.5, false}, {2.5, 1, false}, {-0.5, 1, false}};
    EXPECT(points, probes);
}

TEST(inside_of_a_closed_block)
{
    const double points[] = {0, 0, 0, 2, 2, 2, 2, 0, 0, 0};
    const probe probes[] = {{1, 1, true}, {2.5, 1, false}, {-0.5, 1, false}, {1, 2.5, false}};
    EXPECT(points, probes);
}

TEST(outside_of_a_closed_container)
{
    const double points[] = {0, 0, 2, 0, 2, 2, 0, 2, 0, 0};
    const probe probes[] = {{1, 1, false}, {2.5, 1, true}, {-0.5, 1, true}, {1, 2.9, true}, {-0.9, -0.9, true}};
    EXPECT(points, probes);
}

/* Ground that sinks by 1 m/s. */
TEST(one_that_moves_is_where_it_is_then)
{
    static const double points[] = {-2.0, 0.0, 4.0, 0.0};
    const dem_obstacle ground = {
        .struct_size = sizeof(dem_obstacle), .n_points = 2, .points = points, .velocity = {0.0, -1.0}};
    for (int t = 0; t < 2; t++) {
        obstacle_fill g;
        assert_true(obstacle_fill_at(&ground, t, view, &g));
        assert_in_range(g.n, 3, 2 + OBSTACLE_FILL_MORE);
        assert_int_equal(is_solid(&g, 1.0, -0.5), t == 0);
        assert_true(is_solid(&g, 1.0, -1.5));
        free(g.xy);
    }
}
