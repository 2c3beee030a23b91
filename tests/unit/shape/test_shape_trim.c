/* SPDX-License-Identifier: BSD-3-Clause */
/* shape_trim.c: which triangles are kept. The spacing is 1. */
#include "unit/close.h"

#include <stdlib.h>
#include <string.h>

#include "shape/shape_trim.h"

static dem_lattice make_mesh(const shape *s)
{
    dem_lattice l = dem_lattice_empty();
    assert_int_equal(shape_mesh(&l, s), DEM_OK);
    return l;
}

/* The centre of a triangle. */
static void find_centre(double centre[2], const dem_lattice *l, dem_index t)
{
    const dem_index *corner = l->triangles + 3 * t;
    for (int c = 0; c < 2; c++)
        centre[c] = (l->x[2 * corner[0] + c] + l->x[2 * corner[1] + c] + l->x[2 * corner[2] + c]) / 3.0;
}

static dem_index count_inside(const dem_lattice *l, const shape *s)
{
    dem_index n = 0;
    for (dem_index t = 0; t < l->n_triangles; t++) {
        double centre[2];
        find_centre(centre, l, t);
        n += shape_distance(s, centre) < 0.0;
    }
    return n;
}

TEST(triangles_with_their_centres_in_the_material_are_kept)
{
    CLEANUP(shape_free)
    shape s = {.outline = {.kind = DEM_OUTLINE_DISC, .radius = 9.3}, .spacing = 1.0, .smooth = true};
    assert_true(shape_add_void(&s, (outline[]){{.kind = DEM_OUTLINE_DISC, .centre = {2.0, 1.0}, .radius = 3.0}}));
    CLEANUP(dem_lattice_free) dem_lattice l = make_mesh(&s);
    const dem_index n = count_inside(&l, &s);
    assert_int_equal(shape_trim(&l, &s, false), DEM_OK);
    assert_int_equal(l.n_triangles, n);
    assert_int_equal(count_inside(&l, &s), n);
}

/* In the tip of a triangle, narrower than a spacing for the last two, lie centres of single triangles. */
TEST(small_pieces_of_the_material_are_taken_out)
{
    double corners[] = {0.0, 0.0, 24.0, 0.0, 0.0, 4.0};
    const shape s = {
        .outline = {.kind = DEM_OUTLINE_POLYGON, .n_points = 3, .points = corners}, .spacing = 1.0, .smooth = true};
    CLEANUP(dem_lattice_free) dem_lattice l = make_mesh(&s);
    const dem_index n = count_inside(&l, &s);
    assert_int_equal(shape_trim(&l, &s, false), DEM_OK);
    assert_true(l.n_triangles < n && l.n_triangles > n - 4);
    dem_index n_pieces;
    CLEANUP(free_memory) dem_index *piece = calloc((size_t)l.n_triangles, sizeof *piece);
    assert_non_null(piece);
    assert_int_equal(dem_lattice_pieces(&l, &n_pieces, piece), DEM_OK);
    assert_int_equal(n_pieces, 1);
}

/* The tip of a void leaves single triangles that meet the rest of it in a node. */
TEST(small_pieces_of_a_void_are_filled)
{
    CLEANUP(shape_free)
    shape s = {.outline = {.centre = {0.0, 8.0}, .size = {20.0, 16.0}}, .spacing = 1.0, .smooth = true};
    const double tip[] = {2.0, 4.0, 6.0, 4.0, 4.0, 12.0};
    outline hole = {.kind = DEM_OUTLINE_POLYGON, .n_points = 3, .points = malloc(sizeof tip)};
    assert_non_null(hole.points);
    memcpy(hole.points, tip, sizeof tip);
    assert_true(shape_add_void(&s, &hole));
    CLEANUP(dem_lattice_free) dem_lattice l = make_mesh(&s);
    const dem_index n = count_inside(&l, &s);
    assert_int_equal(shape_trim(&l, &s, false), DEM_OK);
    assert_true(l.n_triangles > n);
    CLEANUP(free_memory) dem_index *n_edges = calloc((size_t)l.n_nodes, sizeof *n_edges);
    assert_non_null(n_edges);
    assert_int_equal(dem_lattice_rims(&l, n_edges), DEM_OK);
    for (dem_index i = 0; i < l.n_nodes; i++) assert_true(n_edges[i] <= 2);
}

TEST(a_shape_that_keeps_no_triangle_is_an_error)
{
    const shape s = {.outline = {.kind = DEM_OUTLINE_DISC, .radius = 0.1}, .spacing = 1.0, .smooth = true};
    CLEANUP(dem_lattice_free) dem_lattice l = make_mesh(&s);
    assert_int_equal(shape_trim(&l, &s, false), DEM_ERROR_MODEL);
}
