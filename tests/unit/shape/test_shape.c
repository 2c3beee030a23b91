/* SPDX-License-Identifier: BSD-3-Clause */
/* shape.c: depth in the material, voids, pores, lattices. */
#include "unit/close.h"

#include <stdlib.h>

#include "harness/lattice_area.h"
#include "shape/shape.h"

static const dem_material rubber =
    SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 1050.0, .thickness = 1.0);
static const outline round_void = {.kind = DEM_OUTLINE_DISC, .centre = {1.0, 2.0}, .radius = 0.5};
static const outline square_void = {.centre = {-1.0, 4.0}, .size = {2.0, 1.0}};

static shape make_rectangle(void)
{
    const shape s = {.outline = {.centre = {0.0, 4.0}, .size = {6.0, 8.0}}, .spacing = 0.1};
    return s;
}

static void add(shape *s, outline hole)
{
    assert_true(shape_add_void(s, &hole));
}

/* The radius of the largest disc about a point is its depth. */
static void expect_depth(const shape *s, double x, double y, double depth)
{
    const double point[2] = {x, y};
    assert_true(shape_fits(s, point, depth - 1e-12));
    assert_false(shape_fits(s, point, depth + 1e-12));
}

TEST(depth_in_a_rectangle_is_the_distance_to_its_nearest_edge)
{
    const shape s = make_rectangle();
    expect_depth(&s, 0.0, 4.0, 3.0);
    expect_depth(&s, 2.5, 4.0, 0.5);
    expect_depth(&s, 0.0, 0.25, 0.25);
    expect_depth(&s, -6.0, -4.0, -5.0);
}

TEST(depth_in_a_disc_is_counted_from_its_rim)
{
    const shape s = {.outline = {.kind = DEM_OUTLINE_DISC, .radius = 2.0}, .spacing = 0.1};
    expect_depth(&s, 0.6, -0.8, 1.0);
    expect_depth(&s, 3.0, 0.0, -1.0);
}

TEST(voids_are_not_material)
{
    CLEANUP(shape_free) shape s = make_rectangle();
    add(&s, round_void);
    add(&s, square_void);
    expect_depth(&s, 1.0, 2.0, -0.5);
    expect_depth(&s, 1.0, 1.25, 0.25);
    expect_depth(&s, -1.0, 4.0, -0.5);
    expect_depth(&s, 0.3, 4.9, 0.5); /* corner of the square one at (0, 4.5): 3-4-5 */
}

TEST(the_nearest_edge_is_that_of_a_void_where_that_is_nearer)
{
    CLEANUP(shape_free) shape s = make_rectangle();
    add(&s, round_void);
    add(&s, square_void);
    assert_int_equal(shape_edge(&s, (double[2]){1.0, 0.5}), 0); /* 0.5 from the lower side, 1 from the void */
    assert_int_equal(shape_edge(&s, (double[2]){1.0, 1.2}), 1);
    assert_int_equal(shape_edge(&s, (double[2]){1.0, 2.0}), 1);
    assert_int_equal(shape_edge(&s, (double[2]){-1.0, 5.0}), 2);
    assert_true(shape_edge_at(&s, 0) == &s.outline && shape_edge_at(&s, 2) == &s.voids[1]);
    assert_close(shape_distance(&s, (double[2]){1.0, 1.2}), -0.3, 1e-15);
    assert_close(shape_distance(&s, (double[2]){1.0, 1.7}), 0.2, 1e-15);
    assert_close(shape_distance(&s, (double[2]){3.5, 4.0}), 0.5, 1e-15);
}

TEST(the_lattice_leaves_voids_out)
{
    CLEANUP(shape_free) shape s = make_rectangle();
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    double mass = 0.0;
    add(&s, round_void);
    add(&s, square_void);
    assert_int_equal(shape_mesh(&lattice, &s), DEM_OK);
    assert_int_equal(shape_cut(&lattice, &s), DEM_OK);
    assert_int_equal(dem_lattice_assemble(&lattice, &rubber), DEM_OK);
    for (dem_index i = 0; i < lattice.n_nodes; i++) {
        const double x = lattice.x[2 * i], y = lattice.x[2 * i + 1];
        assert_true(hypot(x - 1.0, y - 2.0) > 0.5 - 1e-9);
        assert_true(fabs(x + 1.0) > 1.0 - 1e-9 || fabs(y - 4.0) > 0.5 - 1e-9);
        mass += lattice.mass[i];
    }
    assert_close(mass / (1050.0 * (48.0 - 2.0 - 0.785398)), 1.0, 0.02); /* rims are jagged by a spacing */
    assert_true(lattice.n_springs > 0);
}

TEST(a_void_takes_nodes_only_where_they_are)
{
    const outline between = {.kind = DEM_OUTLINE_DISC, .centre = {0.05, 0.03}, .radius = 0.04};
    const outline outside = {.kind = DEM_OUTLINE_DISC, .centre = {0.0, -1.0}, .radius = 0.5};
    const double edge[2] = {3.0, 8.0};
    shape s = make_rectangle();
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    assert_int_equal(shape_mesh(&lattice, &s), DEM_OK);
    assert_true(shape_takes(&s, &round_void, &lattice, NULL));
    assert_true(shape_takes(&s, &square_void, &lattice, NULL));
    assert_false(shape_takes(&s, &between, &lattice, NULL));
    assert_false(shape_takes(&s, &outside, &lattice, NULL));
    assert_true(shape_outline_has(&s, between.centre));
    assert_true(shape_outline_has(&s, edge));
    assert_false(shape_outline_has(&s, outside.centre));
}

TEST(a_void_of_everything_leaves_no_lattice)
{
    CLEANUP(shape_free) shape s = {.outline = {.kind = DEM_OUTLINE_DISC, .radius = 1.0}, .spacing = 0.5};
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    assert_int_equal(shape_mesh(&lattice, &s), DEM_OK);
    const dem_index n = lattice.n_nodes;
    assert_int_equal(shape_cut(&lattice, &s), DEM_OK);
    assert_int_equal(lattice.n_nodes, n);
    add(&s, (outline){.kind = DEM_OUTLINE_DISC, .radius = 50.0});
    assert_int_equal(shape_cut(&lattice, &s), DEM_ERROR_MODEL);
}

/* ---- lattices of other outlines ---- */

static dem_lattice make_lattice(const shape *s)
{
    dem_lattice lattice = dem_lattice_empty();
    assert_int_equal(shape_mesh(&lattice, s), DEM_OK);
    assert_int_equal(shape_cut(&lattice, s), DEM_OK);
    return lattice;
}

static void expect_inside(const dem_lattice *lattice, const outline *o, double spacing)
{
    for (dem_index i = 0; i < lattice->n_nodes; i++)
        assert_true(outline_distance(o, lattice->x[2 * i], lattice->x[2 * i + 1]) <= 1e-9 * spacing);
}

TEST(a_ring_is_hollow)
{
    const shape s = {.outline = {.kind = DEM_OUTLINE_RING, .radius = 2.0, .inner = 1.0}, .spacing = 0.05};
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_lattice(&s);
    expect_inside(&lattice, &s.outline, s.spacing);
    assert_close(lattice_area(&lattice) / (3.0 * 3.14159265), 1.0, 0.1); /* rims are jagged by a spacing */
}

/* Its lower edge stands on a row; its notch is free of triangles, whose middles are all inside. */
TEST(a_polygon_need_not_be_convex)
{
    double points[] = {10, 5, 14, 5, 14, 9, 13, 9, 12, 6, 11, 9, 10, 9};
    const shape s = {.outline = {.kind = DEM_OUTLINE_POLYGON, .n_points = 7, .points = points}, .spacing = 0.1};
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_lattice(&s);
    dem_index foot = 0;
    expect_inside(&lattice, &s.outline, s.spacing);
    for (dem_index i = 0; i < lattice.n_nodes; i++) foot += lattice.x[2 * i + 1] == 5.0;
    assert_int_equal(foot, 41);
    for (dem_index t = 0; t < lattice.n_triangles; t++) {
        double middle[2] = {0.0, 0.0};
        for (int c = 0; c < 6; c++) middle[c % 2] += lattice.x[2 * lattice.triangles[3 * t + c / 2] + c % 2] / 3.0;
        assert_true(outline_distance(&s.outline, middle[0], middle[1]) < 0.0);
    }
    assert_close(lattice_area(&lattice) / 13.0, 1.0, 0.07);
}

/* Six pixels of 1 m, the lower left one is empty. */
TEST(a_mask_has_nodes_in_its_bright_pixels_only)
{
    unsigned char solid[] = {0, 1, 1, 1, 1, 1};
    const shape s = {.outline = {.centre = {0.0, 1.0}, .size = {3.0, 2.0}},
                     .mask = {.width = 3, .height = 2, .n_solid = 5, .scale = 1.0, .solid = solid},
                     .spacing = 0.05};
    const double in_hole[2] = {-1.0, 0.5}, in_body[2] = {1.0, 0.5};
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_lattice(&s);
    for (dem_index i = 0; i < lattice.n_nodes; i++) {
        const double x = lattice.x[2 * i], y = lattice.x[2 * i + 1];
        assert_true(fabs(x) <= 1.5 + 1e-9 && y >= 0.0 && y <= 2.0 + 1e-9);
        assert_true(x >= -0.5 - 1e-9 || y >= 1.0 - 1e-9);
    }
    assert_close(lattice_area(&lattice) / 5.0, 1.0, 0.03);
    assert_false(shape_outline_has(&s, in_hole));
    assert_true(shape_outline_has(&s, in_body));
    expect_depth(&s, 1.0, 0.5, 0.5);
}

/* ---- squares ---- */

TEST(a_rectangle_of_squares_has_its_size)
{
    const shape s = {.outline = {.centre = {0.0, 0.5}, .size = {2.0, 1.0}}, .spacing = 0.1, .squares = true};
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_lattice(&s);
    assert_int_equal(lattice.n_nodes, 21 * 11);
    assert_int_equal(lattice.n_triangles, 2 * 20 * 10);
    assert_close(lattice_area(&lattice), 2.0, 1e-12);
}

/* Whole cells: all four of their corners are inside, none in a void. */
TEST(a_disc_of_squares_has_whole_cells_about_its_centre)
{
    CLEANUP(shape_free)
    shape s = {.outline = {.kind = DEM_OUTLINE_DISC, .radius = 0.5}, .spacing = 0.1, .squares = true};
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_lattice(&s);
    dem_index n_cells = 0;
    for (int i = -5; i < 5; i++)
        for (int j = -5; j < 5; j++) {
            const int x = i < 0 ? -i : i + 1, y = j < 0 ? -j : j + 1; /* the corner farthest out */
            n_cells += x * x + y * y <= 25;
        }
    assert_int_equal(lattice.n_triangles, 2 * n_cells);
    for (dem_index k = 0; k < 2 * lattice.n_nodes; k++)
        assert_close(lattice.x[k], 0.1 * round(10.0 * lattice.x[k]), 1e-14);
    for (dem_index k = 0; k < n_cells; k++) { /* which make up squares */
        double low[2] = {1.0, 1.0}, high[2] = {-1.0, -1.0};
        for (int c = 0; c < 12; c++) {
            const double x = lattice.x[2 * lattice.triangles[6 * k + c / 2] + c % 2];
            low[c % 2] = fmin(low[c % 2], x);
            high[c % 2] = fmax(high[c % 2], x);
        }
        for (int c = 0; c < 2; c++) assert_close(high[c] - low[c], 0.1, 1e-14);
    }
    dem_lattice_free(&lattice);
    add(&s, (outline){.kind = DEM_OUTLINE_DISC, .radius = 0.02});
    lattice = make_lattice(&s);
    assert_int_equal(lattice.n_triangles, 2 * n_cells - 8); /* the four about the node that is gone */
}

TEST(of_a_cell_both_triangles_are_kept_or_none)
{
    bool keep[8] = {1, 1, 0, 1, 1, 0, 0, 0};
    static const unsigned char expected[8] = {1, 1, 0, 0, 0, 0, 0, 0};
    shape_keep_cells(keep, 8);
    assert_memory_equal(keep, expected, 8);
}
