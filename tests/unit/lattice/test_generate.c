/* SPDX-License-Identifier: BSD-3-Clause */
/* generate.c and mesh_edges.c: shapes, holes in them, nodes moved at random. */
#include "unit/solids.h"
#include "base/random.h"
#include "harness/message.h"

#include <stdbool.h>

static const double spacing = 2.5e-3; /* m */

#define assert_refused(call, status, message)                                                                          \
    do {                                                                                                               \
        assert_int_equal(call, status);                                                                                \
        assert_message_parts(message);                                                                                 \
    } while (0)

/* ---- rectangle ---- */

TEST(the_papers_rectangle_has_1983_nodes_in_61_rows)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_rectangle(0.08, 0.13, spacing);
    dem_index rows = 1;
    for (dem_index i = 1; i < lattice.n_nodes; i++) rows += lattice.x[2 * i + 1] > lattice.x[2 * i - 1];
    assert_int_equal(lattice.struct_size, sizeof lattice);
    assert_int_equal(lattice.dim, 2);
    assert_int_equal(rows, 61);
    assert_int_equal(lattice.n_nodes, 1983); /* 31 rows of 33, 30 of 32 */
    assert_int_equal(lattice.n_triangles, 60 * 63);
    assert_int_equal(lattice.n_springs, 0);
    assert_close(lattice.x[0], -0.04, 0.0);
    assert_close(lattice.x[1], 0.0, 0.0);
    assert_close(lattice.x[2 * lattice.n_nodes - 1], 60.0 * sqrt(0.75) * spacing, 1e-16);
}

TEST(every_triangle_is_equilateral_and_counter_clockwise)
{
    const double expected = sqrt(3.0) / 4.0 * spacing * spacing;
    dem_lattice shapes[2] = {make_rectangle(0.04, 0.03, spacing), dem_lattice_empty()};
    assert_int_equal(dem_lattice_disc(&shapes[1], 0.03, spacing), DEM_OK);
    for (int s = 0; s < 2; s++) {
        for (dem_index t = 0; t < shapes[s].n_triangles; t++)
            assert_close(area_of(&shapes[s], t), expected, 1e-12 * expected); /* rounding of coordinates over spacing */
        for (dem_index k = 0; k < 3 * shapes[s].n_triangles; k++) {
            const dem_index i = shapes[s].triangles[k], j = shapes[s].triangles[k % 3 == 2 ? k - 2 : k + 1];
            const double dx = shapes[s].x[2 * j] - shapes[s].x[2 * i];
            const double dy = shapes[s].x[2 * j + 1] - shapes[s].x[2 * i + 1];
            assert_close(sqrt(dx * dx + dy * dy), spacing, 1e-13 * spacing);
        }
        dem_lattice_free(&shapes[s]);
    }
}

TEST(rows_are_mirror_symmetric_to_the_bit)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_rectangle(0.0811, 0.13, 1.7e-3);
    for (dem_index first = 0; first < lattice.n_nodes;) {
        dem_index end = first;
        while (end < lattice.n_nodes && lattice.x[2 * end + 1] == lattice.x[2 * first + 1]) end++;
        for (dem_index k = 0; k < end - first; k++)
            assert_true(lattice.x[2 * (first + k)] == -lattice.x[2 * (end - 1 - k)]);
        first = end;
    }
}

TEST(a_rectangle_of_one_spacing_is_one_triangle)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_rectangle(1.0, 1.0, 1.0);
    assert_int_equal(lattice.n_nodes, 3);
    assert_int_equal(lattice.n_triangles, 1);
}

TEST(a_rectangle_refuses_impossible_sizes)
{
    dem_lattice lattice = {.struct_size = sizeof lattice, .n_nodes = 7};
    assert_refused(dem_lattice_rectangle(&lattice, 1.0, 1.0, 2.0), DEM_ERROR_ARGUMENT,
                   "rectangle * 1 m x 1 m * spacing 2 m");
    assert_refused(dem_lattice_rectangle(&lattice, 1.0, 1.0, 0.0), DEM_ERROR_ARGUMENT,
                   "rectangle * 1 m x 1 m * spacing 0 m");
    assert_int_equal(dem_lattice_rectangle(&lattice, (double)NAN, 1.0, 0.1), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_lattice_rectangle(&lattice, 1.0, (double)INFINITY, 0.1), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_lattice_rectangle(NULL, 1.0, 1.0, 0.1), DEM_ERROR_ARGUMENT);
    assert_refused(dem_lattice_rectangle(&lattice, 0.08, 0.13, 1e-12), DEM_ERROR_MODEL,
                   "rectangle * 0.08 m x 0.13 m * spacing 1e-12 m * 1.2e+22 nodes * 1.1e+12");
    assert_refused(dem_lattice_rectangle(&lattice, 1e300, 1e300, 1e-300), DEM_ERROR_MODEL,
                   "rectangle * 1e+300 m x 1e+300 m * spacing 1e-300 m * inf nodes * 1.1e+12");
    assert_int_equal(lattice.n_nodes, 7);
}

/* ---- disc ---- */

TEST(a_disc_fills_its_radius_and_has_a_node_at_the_centre)
{
    const double radius = 25.0 * spacing, cell = sqrt(0.75) * spacing * spacing;
    int at_centre = 0, on_rim = 0;
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    assert_int_equal(dem_lattice_disc(&lattice, radius, spacing), DEM_OK);
    for (dem_index i = 0; i < lattice.n_nodes; i++) {
        const double r = hypot(lattice.x[2 * i], lattice.x[2 * i + 1]);
        assert_true(r <= radius * (1.0 + 1e-9));
        at_centre += r == 0.0;
        on_rim += r > radius * (1.0 - 1e-9);
    }
    assert_int_equal(at_centre, 1);
    assert_int_equal(on_rim, 6); /* radius is whole spacings: one node in each direction of a spring */
    assert_close((double)lattice.n_nodes * cell / (3.14159265358979 * radius * radius), 1.0, 0.01);
}

TEST(a_disc_is_mirror_symmetric_about_both_axes)
{
    for (int k = 0; k < 20; k++) {
        CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
        dem_index mirrored = 0;
        assert_int_equal(dem_lattice_disc(&lattice, 0.01 * (1.0 + 0.05 * k), spacing), DEM_OK);
        for (dem_index i = 0; i < lattice.n_nodes; i++)
            for (dem_index j = 0; j < lattice.n_nodes; j++) {
                const double *a = lattice.x + 2 * i, *b = lattice.x + 2 * j;
                mirrored += a[0] == -b[0] && a[1] == b[1];
                mirrored += a[0] == b[0] && a[1] == -b[1];
            }
        assert_int_equal(mirrored, 2 * lattice.n_nodes);
    }
}

TEST(a_disc_of_one_spacing_is_a_hexagon)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    assert_int_equal(dem_lattice_disc(&lattice, spacing, spacing), DEM_OK);
    assert_int_equal(lattice.n_nodes, 7);
    assert_int_equal(lattice.n_triangles, 6);
}

TEST(a_disc_refuses_impossible_sizes)
{
    dem_lattice lattice = {.struct_size = sizeof lattice, .n_nodes = 7};
    assert_refused(dem_lattice_disc(&lattice, 1.0, 1.5), DEM_ERROR_ARGUMENT, "disc * radius 1 m * spacing 1.5 m");
    assert_int_equal(dem_lattice_disc(&lattice, 1.0, -1.0), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_lattice_disc(&lattice, (double)INFINITY, 1.0), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_lattice_disc(NULL, 1.0, 1.0), DEM_ERROR_ARGUMENT);
    assert_refused(dem_lattice_disc(&lattice, 0.065, 1e-12), DEM_ERROR_MODEL,
                   "disc * radius 0.065 m * spacing 1e-12 m * 1.95e+22 nodes * 1.1e+12");
    assert_int_equal(lattice.n_nodes, 7);
}

/* ---- cut ---- */

typedef struct hole {
    double x, y, radius;
} hole;

static bool outside_hole(void *context, const double *x)
{
    const hole *h = context;
    return hypot(x[0] - h->x, x[1] - h->y) > h->radius;
}

TEST(cutting_a_hole_leaves_the_triangles_outside_it)
{
    hole h = {.x = 0.002, .y = 0.03, .radius = 0.01};
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_rectangle(0.06, 0.06, spacing);
    const dem_index before = lattice.n_triangles;
    const double cell = sqrt(0.75) * spacing * spacing;
    assert_int_equal(dem_lattice_cut(&lattice, outside_hole, &h), DEM_OK);
    for (dem_index i = 0; i < lattice.n_nodes; i++) assert_true(outside_hole(&h, lattice.x + 2 * i));
    for (dem_index t = 0; t < lattice.n_triangles; t++) assert_close(area_of(&lattice, t), 0.5 * cell, 1e-12 * cell);
    const double lost = (double)(before - lattice.n_triangles) * 0.5 * cell;
    assert_true(lost > 3.1 * h.radius * h.radius && lost < 3.2 * pow(h.radius + spacing, 2.0));
}

static bool is_not_lower_left(void *context, const double *x)
{
    (void)context;
    return !(x[1] < 0.1 && x[0] < 0.1);
}

TEST(a_cut_drops_nodes_left_without_a_triangle)
{
    dem_lattice lattice =
        make_rectangle(1.0, 1.6, 1.0); /* two triangles: lower and upper edge of 2, one node between */
    assert_int_equal(lattice.n_nodes, 5);
    assert_int_equal(dem_lattice_cut(&lattice, is_not_lower_left, NULL), DEM_OK);
    assert_int_equal(lattice.n_nodes, 3); /* the other lower corner went too */
    assert_int_equal(lattice.n_triangles, 1);
    assert_close(area_of(&lattice, 0), sqrt(3.0) / 4.0, 1e-15);
    dem_lattice_free(&lattice);
}

static bool keep_nothing(void *context, const double *x)
{
    (void)context, (void)x;
    return 0;
}

TEST(a_cut_refuses_to_leave_nothing_and_to_cut_springs)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_rectangle(1.0, 1.6, 1.0);
    assert_refused(dem_lattice_cut(&lattice, keep_nothing, NULL), DEM_ERROR_MODEL, "none of 5 nodes is left");
    assert_int_equal(lattice.n_nodes, 5);
    assert_int_equal(lattice.n_triangles, 2);
    assert_refused(dem_lattice_cut(&lattice, NULL, NULL), DEM_ERROR_ARGUMENT, "keep is NULL");
    assert_int_equal(dem_lattice_assemble(&lattice, &rubber), DEM_OK);
    assert_refused(dem_lattice_cut(&lattice, keep_nothing, NULL), DEM_ERROR_MODEL, "cut: 6 springs");
}

/* ---- squares ---- */

TEST(squares_are_two_triangles_each_that_meet_along_turning_diagonals)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    assert_int_equal(dem_lattice_squares(&lattice, 0.031, 0.024, 0.01), DEM_OK); /* 3 x 2 cells */
    assert_int_equal(lattice.n_nodes, 12);
    assert_int_equal(lattice.n_triangles, 12);
    assert_int_equal(lattice.n_springs, 0);
    for (dem_index i = 0; i < 12; i++) {
        assert_close(lattice.x[2 * i], 0.01 * (double)(i % 4) - 0.015, 1e-18);
        assert_close(lattice.x[2 * i], -lattice.x[2 * (4 * (i / 4) + 3 - i % 4)], 0.0);
        const dem_index row = i / 4;
        assert_close(lattice.x[2 * i + 1], 0.01 * (double)row, 1e-18);
    }
    for (dem_index k = 0; k < 6; k++) {
        const dem_index *t = lattice.triangles + 6 * k, corner = k / 3 * 4 + k % 3;
        const bool rising = (k / 3 + k % 3) % 2 == 0;
        assert_close(area_of(&lattice, 2 * k), 5e-5, 1e-18);
        assert_close(area_of(&lattice, 2 * k + 1), 5e-5, 1e-18);
        assert_int_equal(t[0], corner); /* lower left */
        assert_int_equal(t[2], rising ? corner + 5 : corner + 4);
        assert_int_equal(t[3], rising ? corner : corner + 1);
    }
}

TEST(squares_refuse_impossible_sizes)
{
    dem_lattice lattice = dem_lattice_empty();
    assert_refused(dem_lattice_squares(&lattice, 1.0, 1.0, 1.5), DEM_ERROR_ARGUMENT,
                   "rectangle * 1 m x 1 m * spacing 1.5 m");
    assert_refused(dem_lattice_squares(NULL, 1.0, 1.0, 1.0), DEM_ERROR_ARGUMENT, "out is NULL");
    assert_refused(dem_lattice_squares(&lattice, 1.0, 1.0, 1e-9), DEM_ERROR_MODEL,
                   "rectangle * 1 m x 1 m * spacing 1e-09 m * 1e+18 nodes * 1.1e+12");
}

/* ---- jitter ---- */

static bool is_inside(const dem_lattice *lattice, dem_index i)
{
    const double *x = lattice->x + 2 * i;
    return fabs(x[0]) < 0.02 - 0.9 * spacing && x[1] > 0.5 * spacing && x[1] < 0.03 - 0.5 * spacing;
}

TEST(jitter_moves_the_nodes_inside_within_its_radius_and_no_other)
{
    const double radius = 0.2 * spacing;
    CLEANUP(dem_lattice_free)
    dem_lattice lattice = make_rectangle(0.04, 0.03, spacing), before = make_rectangle(0.04, 0.03, spacing);
    double mean[2] = {0.0, 0.0}, squares = 0.0;
    dem_index n_inside = 0;
    assert_int_equal(dem_lattice_jitter(&lattice, radius, 1), DEM_OK);
    for (dem_index i = 0; i < lattice.n_nodes; i++) {
        const double dx = lattice.x[2 * i] - before.x[2 * i], dy = lattice.x[2 * i + 1] - before.x[2 * i + 1];
        assert_true(hypot(dx, dy) <= radius * (1.0 + 1e-9));
        if (!is_inside(&before, i)) {
            assert_true(dx == 0.0 && dy == 0.0);
            continue;
        }
        n_inside++;
        mean[0] += dx, mean[1] += dy, squares += dx * dx + dy * dy;
    }
    const double n = (double)n_inside; /* uniform in a disc: mean square radius^2/2, means within 4 deviations */
    assert_true(n > 100.0);
    assert_close(squares / n, 0.5 * radius * radius, 4.0 * radius * radius / sqrt(12.0 * n));
    for (int c = 0; c < 2; c++) assert_close(mean[c] / n, 0.0, 4.0 * 0.5 * radius / sqrt(n));
}

TEST(jitter_depends_on_its_seed_alone)
{
    CLEANUP(dem_lattice_free)
    dem_lattice one = make_rectangle(0.04, 0.03, spacing), same = make_rectangle(0.04, 0.03, spacing),
                other = make_rectangle(0.04, 0.03, spacing);
    const size_t size = 2 * (size_t)one.n_nodes * sizeof *one.x;
    assert_int_equal(dem_lattice_jitter(&one, 1e-4, 7), DEM_OK);
    assert_int_equal(dem_lattice_jitter(&same, 1e-4, 7), DEM_OK);
    assert_int_equal(dem_lattice_jitter(&other, 1e-4, 8), DEM_OK);
    assert_memory_equal(one.x, same.x, size);
    assert_memory_not_equal(one.x, other.x, size);
}

/* Two spacings would fold nearly all of them. */
TEST(no_triangle_keeps_less_than_a_tenth_of_its_area)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_rectangle(0.04, 0.03, spacing);
    const double before = area_of(&lattice, 0);
    double least = 1.0;
    assert_int_equal(dem_lattice_jitter(&lattice, 2.0 * spacing, 3), DEM_OK);
    for (dem_index t = 0; t < lattice.n_triangles; t++) least = fmin(least, area_of(&lattice, t) / before);
    assert_true(least >= 0.1 && least < 0.5);
}

/* Drawn here from the last node to the first: a process that has some of the nodes needs no draw of another's. */
TEST(the_shift_of_a_node_is_drawn_by_its_number_alone)
{
    const double radius = 0.2 * spacing;
    CLEANUP(dem_lattice_free)
    dem_lattice lattice = make_rectangle(0.04, 0.03, spacing), before = make_rectangle(0.04, 0.03, spacing);
    assert_int_equal(dem_lattice_jitter(&lattice, radius, 5), DEM_OK);
    for (dem_index i = lattice.n_nodes - 1; i >= 0; i--) {
        if (!is_inside(&before, i)) continue;
        uint64_t state = random_state_of(5, UINT64_MAX, (uint64_t)i);
        double shift[2];
        do
            for (int c = 0; c < 2; c++) shift[c] = random_next(&state);
        while (shift[0] * shift[0] + shift[1] * shift[1] > 1.0);
        for (int c = 0; c < 2; c++) assert_close(lattice.x[2 * i + c], before.x[2 * i + c] + radius * shift[c], 0.0);
    }
}

/* Two spacings: most triangles have to get their area back. */
TEST(jitter_does_not_depend_on_the_order_of_triangles)
{
    CLEANUP(dem_lattice_free)
    dem_lattice one = make_rectangle(0.04, 0.03, spacing), other = make_rectangle(0.04, 0.03, spacing);
    for (dem_index t = 0; t < one.n_triangles; t++)
        memcpy(other.triangles + 3 * t, one.triangles + 3 * (one.n_triangles - 1 - t), 3 * sizeof *one.triangles);
    assert_int_equal(dem_lattice_jitter(&one, 2.0 * spacing, 3), DEM_OK);
    assert_int_equal(dem_lattice_jitter(&other, 2.0 * spacing, 3), DEM_OK);
    assert_memory_equal(one.x, other.x, 2 * (size_t)one.n_nodes * sizeof *one.x);
}

TEST(jitter_refuses_what_it_cannot_move)
{
    dem_lattice lattice = make_rectangle(1.0, 1.6, 1.0);
    assert_refused(dem_lattice_jitter(&lattice, -0.1, 1), DEM_ERROR_ARGUMENT, "radius * jitter * >= 0: -0.1 m");
    assert_refused(dem_lattice_jitter(NULL, 0.1, 1), DEM_ERROR_ARGUMENT, "lattice is NULL");
    lattice.x[0] += 2.0; /* beyond node 1 */
    assert_refused(dem_lattice_jitter(&lattice, 0.1, 1), DEM_ERROR_MODEL,
                   "triangle 0 * area -0.433013 m^2 * > 0 * jittered");
    lattice.x[0] -= 2.0;
    assert_int_equal(dem_lattice_assemble(&lattice, &rubber), DEM_OK);
    assert_refused(dem_lattice_jitter(&lattice, 0.1, 1), DEM_ERROR_MODEL, "jittered: 6 springs");
    dem_lattice_free(&lattice);
    assert_refused(dem_lattice_jitter(&lattice, 0.1, 1), DEM_ERROR_MODEL,
                   "a lattice without triangles cannot be jittered");
}
