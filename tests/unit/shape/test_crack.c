/* SPDX-License-Identifier: BSD-3-Clause */
/* crack.c: which triangles a crack takes, and that it separates its faces. */
#include "unit/solids.h"

#include <stdlib.h>

#include <dem/shape.h>

#include "harness/message.h"

static const double row = 0.86602540378443864676, shift = 1e-6;

/* Cuts a lattice; returns the number of triangles crossed. */
static dem_index cut(dem_lattice *lattice, const double *points, dem_index n_points)
{
    bool *flags = malloc((size_t)lattice->n_triangles);
    dem_index n = 0;
    assert_non_null(flags);
    assert_int_equal(dem_lattice_crossed(lattice, points, n_points, shift, flags, NULL), DEM_OK);
    for (dem_index t = 0; t < lattice->n_triangles; t++) {
        n += flags[t];
        flags[t] = !flags[t];
    }
    if (n > 0) assert_int_equal(dem_lattice_trim(lattice, flags), DEM_OK);
    free(flags);
    return n;
}

static dem_index count_springs(bool *flags, const dem_lattice *lattice, const double *points)
{
    dem_index n = 0;
    assert_int_equal(dem_lattice_crossed(lattice, points, 2, shift, NULL, flags), DEM_OK);
    for (dem_index k = 0; k < lattice->n_springs; k++) n += flags[k];
    return n;
}

static dem_index count_pieces(const dem_lattice *lattice)
{
    dem_index n;
    assert_int_equal(dem_lattice_pieces(lattice, &n, NULL), DEM_OK);
    return n;
}

/* No node is of both pieces, so that no spring can join them. */
static void expect_separate(const dem_lattice *lattice)
{
    dem_index n, *piece = calloc((size_t)lattice->n_triangles, sizeof *piece);
    CLEANUP(free_memory) dem_index *of_node = calloc((size_t)lattice->n_nodes, sizeof *of_node);
    assert_true(piece != NULL && of_node != NULL);
    assert_int_equal(dem_lattice_pieces(lattice, &n, piece), DEM_OK);
    assert_int_equal(n, 2);
    for (dem_index k = 0; k < 3 * lattice->n_triangles; k++) {
        dem_index *of = &of_node[lattice->triangles[k]];
        if (*of != 0) assert_int_equal(*of, piece[k / 3] + 1);
        *of = piece[k / 3] + 1;
    }
    free(piece);
}

/* A strip of 8 x 7 rows; row 3 is at 3 sqrt(3)/2. */
TEST(a_crack_along_a_row_takes_the_triangles_on_its_left)
{
    const double right[4] = {-9.0, 3.0 * row, 9.0, 3.0 * row}, left[4] = {9.0, 3.0 * row, -9.0, 3.0 * row};
    CLEANUP(dem_lattice_free)
    dem_lattice up = make_rectangle(8.0, 6.0 * row, 1.0), down = make_rectangle(8.0, 6.0 * row, 1.0);
    assert_int_equal(cut(&up, right, 2), 15);
    assert_int_equal(cut(&down, left, 2), 15);
    expect_separate(&up);
    expect_separate(&down);
    for (dem_index t = 0; t < up.n_triangles; t++) {
        double y = 0.0, z = 0.0;
        for (int c = 0; c < 3; c++) {
            y += up.x[2 * up.triangles[3 * t + c] + 1] / 3.0;
            z += down.x[2 * down.triangles[3 * t + c] + 1] / 3.0;
        }
        assert_true(y < 3.0 * row || y > 4.0 * row);
        assert_true(z < 2.0 * row || z > 3.0 * row);
    }
}

/* Two triangles of each strip, on the left; the nodes that it passes through stay, on the right face. */
TEST(a_crack_through_nodes_leaves_them_to_its_right)
{
    const double up[4] = {0.0, -1.0, 0.0, 9.0};
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_rectangle(8.0, 6.0 * row, 1.0);
    dem_index passed = 0;
    assert_int_equal(cut(&lattice, up, 2), 12);
    for (dem_index i = 0; i < lattice.n_nodes; i++) passed += lattice.x[2 * i] == 0.0;
    assert_int_equal(passed, 4);
    expect_separate(&lattice);
}

/* Through nodes, along edges, between them, bent at a node both ways, bent anywhere: two pieces, no common node. */
TEST(a_crack_through_the_whole_body_separates_it)
{
    static const double cracks[][8] = {
        {0.0, -1.0, 0.0, 0.1, 0.0, 3.0, 0.0, 9.0},                         /* upright, through nodes and edges */
        {-2.0, -1.0, -1.0, 0.0, 0.0, 2.0 * 0.86602540378443864676, 5, 9},  /* bends at nodes, to the right */
        {-9.0, 2.0, 0.0, 2.0 * 0.86602540378443864676, -1.0, 0.0, -1, -1}, /* at a node, to the right */
        {-9.0, 2.0, 0.0, 2.0 * 0.86602540378443864676, 1.0, 4.0, 1, 9},    /* at a node, to the left */
        {-9.0, 2.3, 0.3, 2.4, 0.7, 3.9, 9.0, 1.1},
        {-9.0, 2.0, 0.01, 2.01, 0.02, 2.02, 9.0, 2.03}, /* short segments within a triangle */
    };
    for (size_t k = 0; k < sizeof cracks / sizeof *cracks; k++)
        for (int back = 0; back < 2; back++) {
            double points[8];
            for (int i = 0; i < 8; i++) points[i] = back ? cracks[k][6 - i + 2 * (i % 2)] : cracks[k][i];
            CLEANUP(dem_lattice_free) dem_lattice lattice = make_rectangle(8.0, 6.0 * row, 1.0);
            assert_true(cut(&lattice, points, 4) > 5);
            if (count_pieces(&lattice) != 2)
                fail_msg("crack %zu leaves %lld pieces", k, (long long)count_pieces(&lattice));
            expect_separate(&lattice);
        }
}

/* Seeded random polylines from below the block to above it; small flakes between bends may come off as well. */
TEST(random_cracks_separate_left_from_right)
{
    unsigned random = 7;
    for (int k = 0; k < 200; k++) {
        double points[10];
        for (int i = 0; i < 5; i++) {
            random = 1664525U * random + 1013904223U;
            points[2 * i] = 4.0 * (random / 4294967296.0 - 0.5);
            points[2 * i + 1] = -1.0 + 2.0 * i;
        }
        CLEANUP(dem_lattice_free) dem_lattice lattice = make_rectangle(12.0, 6.0 * row, 1.0);
        assert_true(cut(&lattice, points, 5) > 5);
        dem_index n, *piece = calloc((size_t)lattice.n_triangles, sizeof *piece), left = -1, right = -1;
        assert_non_null(piece);
        assert_int_equal(dem_lattice_pieces(&lattice, &n, piece), DEM_OK);
        for (dem_index t = 0; t < lattice.n_triangles; t++) {
            const double x = lattice.x[2 * lattice.triangles[3 * t]];
            if (x < -5.0) left = piece[t];
            if (x > 5.0) right = piece[t];
        }
        assert_true(left >= 0 && right >= 0 && left != right);
        free(piece);
    }
}

TEST(a_crack_that_ends_inside_leaves_one_piece_with_two_faces)
{
    const double points[4] = {-9.0, 3.0 * row, 0.0, 3.0 * row};
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_rectangle(8.0, 6.0 * row, 1.0);
    dem_index upper = 0, lower = 0;
    assert_int_equal(cut(&lattice, points, 2), 8); /* seven up to the tip, and the one above it */
    assert_int_equal(count_pieces(&lattice), 1);
    assert_int_equal(dem_lattice_assemble(&lattice, &rubber), DEM_OK);
    CLEANUP(free_memory) dem_index *rims = calloc((size_t)lattice.n_nodes, sizeof *rims);
    assert_non_null(rims);
    assert_int_equal(dem_lattice_rims(&lattice, rims), DEM_OK);
    for (dem_index i = 0; i < lattice.n_nodes; i++) {
        const double x = lattice.x[2 * i], y = lattice.x[2 * i + 1];
        lower += rims[i] == 2 && fabs(x + 2.0) < 1.6 && fabs(y - 3.0 * row) < 1e-9;
        upper += rims[i] == 2 && fabs(x + 2.0) < 1.6 && fabs(y - 4.0 * row) < 1e-9;
    }
    assert_int_equal(lower, 4);
    assert_int_equal(upper, 3);
}

/* E h A/|e| for the one triangle that an edge on a face has: half of that inside. */
TEST(the_faces_have_half_the_stiffness)
{
    const double points[4] = {-9.0, 3.0 * row, 9.0, 3.0 * row};
    const double half = rubber.youngs_modulus * rubber.thickness * 0.5 * row;
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_rectangle(8.0, 6.0 * row, 1.0);
    int faces = 0;
    (void)cut(&lattice, points, 2);
    assert_int_equal(dem_lattice_assemble(&lattice, &rubber), DEM_OK);
    for (dem_index k = 0; k < lattice.n_springs; k++) {
        const double *a = lattice.x + 2 * lattice.ends[2 * k], *b = lattice.x + 2 * lattice.ends[2 * k + 1];
        const double y = 0.5 * (a[1] + b[1]);
        assert_true(y < 3.0 * row + 1e-9 || y > 4.0 * row - 1e-9);
        if (fabs(y - 3.0 * row) > 1e-9 && fabs(y - 4.0 * row) > 1e-9) continue;
        assert_close(lattice.stiffness[k], half, 1e-9 * half);
        faces++;
    }
    assert_int_equal(faces, 7 + 8);
}

TEST(a_crack_elsewhere_takes_nothing)
{
    const double points[6] = {-9.0, -0.5, 9.0, -0.5, 4.5, 9.0};
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_rectangle(8.0, 6.0 * row, 1.0);
    assert_int_equal(cut(&lattice, points, 3), 0);
}

/* Along the rows it runs a little beside them, and so crosses none of their springs, but both others of each triangle
 * on its left: 15 triangles of one row have 16 between them. Across the rows it is counted by hand. */
TEST(springs_are_crossed_where_a_crack_goes_between_their_ends)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_solid(8.0, 6.0 * row, 1.0);
    const double along[4] = {-9.0, 3.0 * row, 9.0, 3.0 * row}, up[4] = {0.25, -1.0, 0.25, 0.5 * row};
    bool crossed[400];
    assert_true(lattice.n_springs <= 400);
    assert_int_equal(count_springs(crossed, &lattice, along), 16);
    for (dem_index k = 0; k < lattice.n_springs; k++) {
        const double a = lattice.x[2 * lattice.ends[2 * k] + 1], b = lattice.x[2 * lattice.ends[2 * k + 1] + 1];
        assert_int_equal(crossed[k], fmin(a, b) < 3.1 * row && fmax(a, b) > 3.1 * row);
    }
    /* The lowest row has the spring from (0, 0) to (1, 0), and one that leans from there to (1/2, row). */
    assert_int_equal(count_springs(crossed, &lattice, up), 2);
    assert_int_equal(count_springs(crossed, &lattice, (const double[]){20.0, 0.0, 30.0, 1.0}), 0);
}

TEST(what_is_no_crack_is_refused)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_solid(8.0, 6.0 * row, 1.0);
    const double points[6] = {0.0, 0.0, 1.0, 1.0, 1.0, 1.0};
    assert_int_equal(dem_lattice_crossed(&lattice, points, 1, shift, NULL, NULL), DEM_ERROR_ARGUMENT);
    assert_message_parts("at least 2 points * 1");
    assert_int_equal(dem_lattice_crossed(&lattice, points, 3, shift, NULL, NULL), DEM_ERROR_ARGUMENT);
    assert_message_parts("from point 2, (1, 1) m * no length");
    assert_int_equal(dem_lattice_crossed(&lattice, points, 2, -1.0, NULL, NULL), DEM_ERROR_ARGUMENT);
    assert_message_parts("aside * -1 m");
    assert_int_equal(dem_lattice_crossed(&lattice, NULL, 2, shift, NULL, NULL), DEM_ERROR_ARGUMENT);
    assert_message_parts("no points");
}
