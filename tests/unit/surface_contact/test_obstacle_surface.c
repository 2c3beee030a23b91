/* SPDX-License-Identifier: BSD-3-Clause */
/* obstacle_surface.c: vertices and edges of polylines, where they are and how they move. */
#include "surface_contact/obstacle_surface.h"

#include <string.h>

#include "harness/cleanup_gsl.h"
#include "verification/support.h"

static const double open_points[6] = {0.0, 0.0, 1.0, 0.0, 1.0, 2.0};
static const double closed_points[8] = {0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0};

static dem_obstacle make_obstacle(dem_index n, const double *points)
{
    const dem_obstacle obstacle = SIZED(dem_obstacle, .n_points = n, .points = points);
    return obstacle;
}

static dem_model *make_model(const dem_obstacle *obstacles, dem_index n)
{
    const double x[2] = {5.0, 5.0}, mass = 1.0;
    CLEANUP(dem_lattice_free) dem_lattice l = support_lattice(1, x, &mass, 0, NULL, 1.0, 1.0, NULL);
    return support_model(&l, obstacles, n);
}

static void expect_edges(const obstacle_surface *s, dem_index first, dem_index n, const surface_edge *expected)
{
    for (dem_index e = 0; e < n; e++) {
        assert_int_equal(s->edges[first + e].first, expected[e].first);
        assert_int_equal(s->edges[first + e].second, expected[e].second);
        assert_int_equal(s->edges[first + e].before, expected[e].before);
        assert_int_equal(s->edges[first + e].after, expected[e].after);
    }
}

/* Backwards along its segments, and of an open polyline forwards, too; beyond an edge at a free end is its other
 * side. */
TEST(edges_go_round_a_wall_and_along_a_closed_outline)
{
    const dem_obstacle obstacles[2] = {make_obstacle(3, open_points), make_obstacle(4, closed_points)};
    CLEANUP(free_model) dem_model *model = make_model(obstacles, 2);
    CLEANUP(obstacle_surface_free) obstacle_surface s;
    assert_ok(obstacle_surface_compile(&s, &model->obstacles));
    assert_int_equal(s.n_vertices, 6);
    assert_int_equal(s.n_edges, 7);
    assert_int_equal(s.first_vertex[1], 3);
    assert_int_equal(s.first_vertex[2], 6);
    expect_edges(&s, 0, 4, (surface_edge[4]){{1, 0, 2, 1}, {2, 1, 1, 0}, {0, 1, 1, 2}, {1, 2, 0, 1}});
    expect_edges(&s, 4, 3, (surface_edge[3]){{4, 3, 5, 5}, {5, 4, 3, 3}, {3, 5, 4, 4}});
    const double half[6] = {0.25, 0.75, 0.5, 0.5, 0.25 * (1.0 + sqrt(2.0)), 0.25 * (1.0 + sqrt(2.0))};
    for (int v = 0; v < 6; v++) {
        assert_int_equal(s.obstacle[v], v / 3);
        assert_close(s.half_length[v], half[v], 1e-15);
        const double *points = v < 3 ? open_points + 2 * v : closed_points + 2 * (v - 3);
        assert_close(obstacle_surface_place(&s, v).x, points[0], 0.0);
        assert_close(obstacle_surface_place(&s, v).y, points[1], 0.0);
    }
}

/* Turned by a right angle about the first point, while it moves along. */
TEST(vertices_are_where_the_motion_has_them)
{
    dem_obstacle obstacle = make_obstacle(3, open_points);
    obstacle.spin = 0.5;
    obstacle.velocity[0] = 0.1;
    CLEANUP(free_model) dem_model *model = make_model(&obstacle, 1);
    CLEANUP(obstacle_surface_free) obstacle_surface s;
    assert_ok(obstacle_surface_compile(&s, &model->obstacles));
    const double t = M_PI, expected[6] = {0.1 * t, 0.0, 0.1 * t, 1.0, 0.1 * t - 2.0, 1.0};
    obstacle_surface_follow(&s, t);
    for (int v = 0; v < 3; v++) {
        assert_close(obstacle_surface_place(&s, v).x, expected[2 * v], 1e-14);
        assert_close(obstacle_surface_place(&s, v).y, expected[2 * v + 1], 1e-14);
    }
    assert_close(obstacle_surface_corner(&s, 0, 1).y, 1.0, 1e-14);
    assert_close(obstacle_surface_corner(&s, 0, 2).x, 0.1 * t - 2.0, 1e-14);
    const vec2 velocity = obstacle_surface_velocity(&s, 2);
    assert_close(velocity.x, 0.1 - 0.5, 1e-14);
    assert_close(velocity.y, -1.0, 1e-14);
}
