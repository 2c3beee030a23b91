/* SPDX-License-Identifier: BSD-3-Clause */
/* obstacle_set.c: numbers, copies and vertices of what is compiled. Tolerances of 1e-15 are the rounding of
 * coordinates of order 1 m. */
#include "unit/obstacle/landscape.h"

TEST(segments_are_numbered_obstacle_by_obstacle)
{
    static const dem_index obstacle[7] = {0, 0, 0, 1, 1, 1, 1}, index[7] = {0, 1, 2, 0, 1, 2, 3};
    static const dem_index before[7] = {-1, 0, 1, 6, 3, 4, 5}, after[7] = {1, 2, -1, 4, 5, 6, 3};
    obstacle_set o = compile_both();
    assert_int_equal(o.n, 2);
    assert_int_equal(o.n_segments, 7);
    for (int k = 0; k < 7; k++) {
        const segment *s = &o.segments[k];
        assert_int_equal(s->obstacle, obstacle[k]);
        assert_int_equal(s->index, index[k]);
        assert_int_equal(s->before, before[k]);
        assert_int_equal(s->after, after[k]);

        assert_close(vec2_norm(vec2_sub(s->end, s->start)), s->length, 1e-15);
        assert_close(vec2_dot(vec2_sub(s->end, s->start), s->tangent), s->length, 1e-15);
        assert_close(vec2_cross(s->tangent, s->normal), 1.0, 1e-15); /* out of the solid is to the left */
        assert_close(vec2_dot(s->tangent, s->normal), 0.0, 0.0);
    }
    assert_close(o.segments[1].normal.x, sqrt(0.5), 1e-15);
    assert_close(o.segments[1].normal.y, sqrt(0.5), 1e-15);
    obstacles_free(&o);
    assert_null(o.segments);
}

TEST(the_set_keeps_copies_of_the_points)
{
    double points[4] = {0.0, 0.0, 1.0, 0.0};
    CLEANUP(obstacles_free) obstacle_set o = compile(points, 2, 0.0);
    points[1] = points[3] = 100.0;
    assert_close(o.list[0].points[1], 0.0, 0.0);
    assert_close(gap_at(&o, 0.5, 1.0).distance, 1.0, 0.0);
}

static void check_vertex(const obstacle_set *o, dem_index k, dem_index before, dem_index after, double x, double y)
{
    assert_int_equal(o->vertices[k].before, before);
    assert_int_equal(o->vertices[k].after, after);
    assert_true(o->vertices[k].at.x == x && o->vertices[k].at.y == y);
}

TEST(vertices_are_where_the_solid_sticks_out)
{
    const double points[14] = {0.0, 0.0, 1.0, 0.0, 2.0, 0.5e-9, 3.0, 3.0e-9, 4.0, 3.0e-9, 4.0, -1.0, 5.0, -1.0};
    CLEANUP(obstacles_free) obstacle_set o = compile_both();
    assert_int_equal(o.n_vertices, 5);
    check_vertex(&o, 0, 0, 1, 0.0, 0.0); /* of the valley; (1, -1) is a bay, the ends are free */
    check_vertex(&o, 1, 3, 4, 5.0, 1.0);
    check_vertex(&o, 2, 4, 5, 6.0, 1.0);
    check_vertex(&o, 3, 5, 6, 6.0, 0.0);
    check_vertex(&o, 4, 6, 3, 5.0, 0.0); /* where the ring closes */
    obstacles_free(&o);
    assert_null(o.vertices);
    assert_int_equal(o.n_vertices, 0);
    o = compile(points, 7, 0.0); /* straight, a bay, two corners, a bay */
    assert_int_equal(o.n_vertices, 2);
    check_vertex(&o, 0, 2, 3, 3.0, 3.0e-9);
    check_vertex(&o, 1, 3, 4, 4.0, 3.0e-9);
}

TEST(an_obstacle_is_checked_by_itself)
{
    static const double crossing[] = {0, 0, 2, 0, 2, -1, 1, 1}, back[] = {0, 0, 2, 0, 1, 0}, point[] = {1, 1, 1, 1};
    static const struct {
        dem_obstacle obstacle;
        dem_status status;
        dem_index pair[2];
    } cases[] = {{{.struct_size = sizeof(dem_obstacle), .n_points = 4, .points = valley}, DEM_OK, {-1, -1}},
                 {{.struct_size = sizeof(dem_obstacle), .n_points = 5, .points = block}, DEM_OK, {-1, -1}},
                 {{.struct_size = sizeof(dem_obstacle), .n_points = 4, .points = crossing}, DEM_ERROR_MODEL, {0, 2}},
                 {{.struct_size = sizeof(dem_obstacle), .n_points = 3, .points = back}, DEM_ERROR_MODEL, {0, 1}},
                 {{.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = point}, DEM_ERROR_MODEL, {-1, -1}},
                 {{.struct_size = sizeof(dem_obstacle), .n_points = 4, .points = valley, .restitution = 2.0},
                  DEM_ERROR_MODEL,
                  {-1, -1}}};
    dem_index pair[2];
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        assert_int_equal(dem_obstacle_check(&cases[k].obstacle, pair), cases[k].status);
        assert_int_equal(pair[0], cases[k].pair[0]);
        assert_int_equal(pair[1], cases[k].pair[1]);
    }
    assert_int_equal(dem_obstacle_check(NULL, pair), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_obstacle_check(&cases[0].obstacle, NULL), DEM_ERROR_ARGUMENT);
}
