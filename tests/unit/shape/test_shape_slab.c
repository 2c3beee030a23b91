/* SPDX-License-Identifier: BSD-3-Clause */
/* shape_slab.c: slabs of a lattice whose rows are counted in several pieces, and what is refused;
 * tests/property/test_slabs.c compares slabs of small shapes with the whole. */
#include "unit/close.h"

#include <string.h>

#include <dem/dem.h>

#include "harness/message.h"
#include "shape/shape_slab.h"

static const dem_outline disc = {
    .struct_size = sizeof disc, .kind = DEM_OUTLINE_DISC, .centre = {1.0, -2.0}, .radius = 200.0};
/* Below the second one, which leans, there are nodes in each row that have no triangle above. */
static const dem_outline holes[] = {
    {.struct_size = sizeof disc, .kind = DEM_OUTLINE_DISC, .centre = {50.0, -60.0}, .radius = 40.0},
    {.struct_size = sizeof disc, .centre = {1.0, 10.0}, .size = {380.0, 8.0}, .angle = 0.5},
    /* Beside the body, but it takes some of it, in a few rows. */
    {.struct_size = sizeof disc, .kind = DEM_OUTLINE_DISC, .centre = {-205.0, 30.0}, .radius = 30.0}};

static dem_shape make_shape(void)
{
    return (dem_shape)SIZED(dem_shape, .outline = &disc, .spacing = 1.0, .n_voids = 2, .voids = holes);
}

/* 1.3e5 nodes, of which 6.6e4 are counted at a time. */
TEST(slabs_of_a_large_shape_follow_each_other_as_in_the_whole)
{
    const dem_shape shape = make_shape();
    CLEANUP(dem_lattice_free) dem_lattice whole = dem_lattice_empty();
    assert_int_equal(dem_shape_lattice(&whole, &shape, NULL), DEM_OK);
    assert_true(whole.n_nodes > 130000);
    dem_index next = 0;
    for (dem_index part = 0; part < 3; part++) {
        CLEANUP(dem_slab_free) dem_slab s = dem_slab_empty();
        assert_int_equal(dem_slab_shape(&s, &shape, part, 3), DEM_OK);
        assert_int_equal(s.n_nodes, whole.n_nodes);
        assert_int_equal(s.n_triangles, whole.n_triangles);
        assert_int_equal(s.first_node, next);
        assert_true(labs((long)(3 * s.n_own - whole.n_nodes)) < 3 * 401); /* a row */
        assert_memory_equal(s.lattice.x + 2 * s.first_own, whole.x + 2 * next, (size_t)s.n_own * 2 * sizeof(double));
        const dem_index *corner = whole.triangles + 3 * (s.first_triangle + s.lattice.n_triangles - 1);
        assert_true(corner[0] < next + s.n_own); /* the last one */
        next += s.n_own;
    }
    assert_int_equal(next, whole.n_nodes);
}

/* A row belongs to the range that has its first node. */
static void check_ranges(const dem_lattice *whole, const dem_shape *shape, dem_index step)
{
    CLEANUP(free_memory) dem_index *counts = NULL;
    dem_private_rows rows = {0};
    dem_index next = 0;
    for (dem_index begin = 0; begin < whole->n_nodes; begin += step) {
        CLEANUP(dem_slab_free) dem_slab s = dem_slab_empty();
        assert_int_equal(dem_private_slab_between(&s, shape, &rows, &counts, begin, begin + step), DEM_OK);
        assert_int_equal(s.n_nodes, whole->n_nodes);
        assert_int_equal(s.n_triangles, whole->n_triangles);
        if (s.n_own == 0) assert_int_equal(s.lattice.n_nodes, 0);
        if (s.n_own == 0) continue;
        assert_int_equal(s.first_node, next);
        assert_true(s.first_node >= begin && s.first_node < begin + step);
        assert_memory_equal(s.lattice.x + 2 * s.first_own, whole->x + 2 * next, (size_t)s.n_own * 2 * sizeof(double));
        next += s.n_own;
    }
    assert_int_equal(next, whole->n_nodes);
}

TEST(slabs_between_nodes_follow_each_other_whatever_the_ranges)
{
    dem_shape shape = make_shape();
    shape.spacing = 16.0;
    shape.n_voids = 3;
    CLEANUP(dem_lattice_free) dem_lattice whole = dem_lattice_empty();
    CLEANUP(dem_slab_free) dem_slab none = dem_slab_empty();
    CLEANUP(free_memory) dem_index *counts = NULL;
    dem_private_rows rows = {0};
    assert_int_equal(dem_shape_lattice(&whole, &shape, NULL), DEM_OK);
    for (dem_index step = 5; step <= whole.n_nodes + 9; step += step / 2) check_ranges(&whole, &shape, step);
    assert_int_equal(dem_private_slab_between(&none, &shape, &rows, &counts, 0, 0), DEM_OK);
    assert_int_equal(none.n_own, 0);
    assert_int_equal(none.n_nodes, whole.n_nodes);
}

/* ---- what is found of the whole ---- */

/* Takes what is right of the middle of the disc. */
static dem_status cut_right(void *program, const dem_lattice *rows, bool *keep, dem_index begin, dem_index end)
{
    dem_index *n = program;
    for (dem_index t = 0; t < rows->n_triangles; t++) {
        const bool is_right = rows->x[2 * rows->triangles[3 * t]] > 1.0;
        *n += is_right && keep[t] && t >= begin && t < end;
        keep[t] = keep[t] && !is_right;
    }
    return DEM_OK;
}

TEST(rows_that_are_counted_tell_of_the_whole)
{
    dem_shape shape = make_shape();
    shape.edge = DEM_EDGE_SMOOTH;
    dem_shape_report report = {.struct_size = sizeof report};
    dem_index n_right = 0;
    dem_private_rows rows = {.cut = cut_right, .program = &n_right};
    CLEANUP(free_memory) dem_index *counts = NULL;
    CLEANUP(dem_lattice_free) dem_lattice whole = dem_lattice_empty();
    CLEANUP(dem_slab_free) dem_slab none = dem_slab_empty();
    assert_int_equal(dem_shape_lattice(&whole, &shape, &report), DEM_OK);
    assert_int_equal(dem_private_slab_between(&none, &shape, &rows, &counts, 0, 0), DEM_OK);
    assert_int_equal(rows.report.n_rim, report.n_rim);
    assert_int_equal(rows.report.n_off, report.n_off);
    assert_int_equal(rows.report.n_cut, report.n_cut);
    assert_close(rows.report.farthest, report.farthest, 0.0);
    assert_int_equal(rows.n_taken, n_right);
    assert_int_equal(none.n_triangles, whole.n_triangles - n_right);
    assert_true(report.n_rim > 1000 && n_right > whole.n_triangles / 3);
}

/* ---- refusals ---- */

static void expect_refusal(const dem_shape *shape, dem_index n_parts, dem_status status, const char *message)
{
    CLEANUP(dem_slab_free) dem_slab s = dem_slab_empty();
    assert_int_equal(dem_slab_shape(&s, shape, 0, n_parts), status);
    assert_message_parts(message);
    assert_int_equal(s.n_own, 0);
    assert_null(s.lattice.x);
}

TEST(slabs_of_shapes_refuse_what_needs_the_whole)
{
    dem_shape s = make_shape();
    s.numbered = true;
    expect_refusal(&s, 1, DEM_ERROR_ARGUMENT, "numbered in the whole");
}

TEST(slabs_of_shapes_refuse_what_the_whole_refuses)
{
    const dem_outline far = {.struct_size = sizeof far, .kind = DEM_OUTLINE_DISC, .centre = {9e3, 0.0}, .radius = 1.0},
                      all = {.struct_size = sizeof all, .kind = DEM_OUTLINE_DISC, .radius = 9e3};
    dem_shape s = make_shape();
    s.spacing = 300.0;
    expect_refusal(&s, 1, DEM_ERROR_ARGUMENT, "the shape of 200 m x 200 m * spacing 300 m");
    s.spacing = 1e-9;
    expect_refusal(&s, 1, DEM_ERROR_ARGUMENT, "the shape would have more nodes than 2^40");
    s.spacing = 20.0;
    expect_refusal(&s, 24, DEM_ERROR_MODEL, "23 rows of nodes * 24 slabs");
    s.n_voids = 1;
    s.voids = &far;
    s.name = "body 7";
    expect_refusal(&s, 1, DEM_ERROR_MODEL, "void 0 takes no node of body 7 * (9000, 0) m");
    s.voids = &all;
    expect_refusal(&s, 1, DEM_ERROR_MODEL, "none of * nodes is left");
    expect_refusal(NULL, 1, DEM_ERROR_ARGUMENT, "shape is NULL");
    expect_refusal(&s, 0, DEM_ERROR_ARGUMENT, "no part 0 of 0");
    assert_int_equal(dem_slab_shape(NULL, &s, 0, 1), DEM_ERROR_ARGUMENT);
}
