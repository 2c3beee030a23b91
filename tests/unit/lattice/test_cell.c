/* SPDX-License-Identifier: BSD-3-Clause */
/* cell.c: which two triangles are a cell. */
#include <stdlib.h>

#include "lattice/cell.h"
#include "unit/solids.h"

/* \return how many triangles are halves of cells */
static dem_index count(const dem_lattice *l)
{
    dem_index n = 0;
    unsigned char *half = malloc((size_t)l->n_triangles);
    assert_non_null(half);
    assert_int_equal(cell_mark(half, l), DEM_OK);
    for (dem_index t = 0; t < l->n_triangles; t++) n += half[t];
    free(half);
    return n;
}

TEST(squares_are_cells_and_triangles_are_not)
{
    CLEANUP(dem_lattice_free) dem_lattice squares = dem_lattice_empty(), triangles = make_solid(0.05, 0.05, 0.01);
    assert_int_equal(dem_lattice_squares(&squares, 0.05, 0.04, 0.01), DEM_OK);
    assert_int_equal(dem_lattice_assemble_squares(&squares, &rubber, 0.5), DEM_OK);
    assert_int_equal(count(&squares), 40);
    assert_int_equal(count(&triangles), 0);
    assert_int_equal(dem_lattice_append(&triangles, &squares), DEM_OK);
    assert_int_equal(count(&triangles), 40);
}

/* Three triangles about a node: two of them share a side, and their far corners are ends of one of the third. */
TEST(a_node_of_three_triangles_makes_no_cells)
{
    double x[8] = {0.0, 0.0, 1.0, 0.0, 0.5, 1.0, 0.5, 0.4};
    dem_index corners[9] = {0, 1, 3, 1, 2, 3, 2, 0, 3}, ends[12] = {0, 1, 1, 2, 2, 0, 0, 3, 1, 3, 2, 3};
    const dem_lattice l = {.struct_size = sizeof l,
                           .n_nodes = 4,
                           .x = x,
                           .n_triangles = 3,
                           .triangles = corners,
                           .n_springs = 6,
                           .ends = ends};
    dem_index q[4];
    assert_int_equal(count(&l), 0);
    assert_true(cell_corners(&l, 0, 1, q));
    assert_true(q[0] == 0 && q[1] == 1 && q[2] == 2 && q[3] == 3);
    assert_false(cell_is_convex(&l, q));
    assert_false(cell_corners(&l, 0, 0, q));
}
