/* SPDX-License-Identifier: BSD-3-Clause */
/* slab.c: what is refused, and what little a slab is; tests/property/test_slabs.c compares slabs with the whole. */
#include "unit/solids.h"

#include <stdlib.h>

#include "harness/message.h"

#define assert_refused(call, status, message)                                                                          \
    do {                                                                                                               \
        assert_int_equal(call, status);                                                                                \
        assert_message_parts(message);                                                                                 \
    } while (0)

/* 11 and 10 nodes a row by turns. */
static dem_slab make_slab(double height, dem_index part, dem_index n_parts)
{
    dem_slab s = dem_slab_empty();
    assert_int_equal(dem_slab_rectangle(&s, 10.0, height, 1.0, part, n_parts), DEM_OK);
    return s;
}

TEST(a_slab_has_its_rows_and_one_beside)
{
    CLEANUP(dem_slab_free) dem_slab s = make_slab(12.0, 1, 3); /* of 15 rows those from 5 to 9 */
    assert_int_equal(s.n_nodes, 15 * 10 + 8);
    assert_int_equal(s.n_triangles, 14 * 19);
    assert_int_equal(s.first_node, 42 + 11); /* of row 5, behind a wide one */
    assert_int_equal(s.first_triangle, 4 * 19);
    assert_int_equal(s.first_own, 11);
    assert_int_equal(s.n_own, 52);
    assert_int_equal(s.lattice.n_nodes, 11 + 52 + 11);
    for (dem_index k = 0; k < 22; k++) {
        assert_int_equal(s.rim[k], k < 11 ? 42 + k : 42 + 52 + k);
        assert_int_equal(s.rim_boundary[k], k % 11 == 0 || k % 11 == 10);
    }
    assert_int_equal(s.lattice.n_triangles, 6 * 19);
}

/* Of 10^9 nodes in rows of 1001 a slab has three rows. */
TEST(a_slab_takes_no_more_memory_than_its_rows)
{
    CLEANUP(dem_slab_free) dem_slab s = dem_slab_empty();
    assert_int_equal(dem_slab_squares(&s, 1000.0, 1e6, 1.0, 500000, 1000001), DEM_OK);
    assert_int_equal(s.n_nodes, 1001 * (dem_index)1000001);
    assert_int_equal(s.n_own, 1001);
    assert_int_equal(s.lattice.n_nodes, 3 * 1001);
    assert_int_equal(s.first_node, 500000 * (dem_index)1001);
    assert_close(s.lattice.x[1], 499999.0, 0.0);
}

TEST(one_slab_is_the_whole)
{
    CLEANUP(dem_slab_free) dem_slab s = make_slab(12.0, 0, 1);
    assert_int_equal(s.first_node, 0);
    assert_int_equal(s.first_own, 0);
    assert_int_equal(s.n_own, s.n_nodes);
    assert_int_equal(s.lattice.n_nodes, s.n_nodes);
    assert_int_equal(s.lattice.n_triangles, s.n_triangles);
}

static void make_turned(dem_lattice *lattice, double angle)
{
    assert_int_equal(dem_lattice_assemble(lattice, &rubber), DEM_OK);
    dem_lattice_move(lattice, angle, (const double[2]){0.1, 0.2});
}

/* The centre of mass of the whole, as it is summed up from one slab to the next. */
static void add_own(double sum[2], double *mass, const dem_slab *slab)
{
    const dem_lattice *l = &slab->lattice;
    for (dem_index i = slab->first_own; i < slab->first_own + slab->n_own; i++) {
        for (int c = 0; c < 2; c++) sum[c] += l->mass[i] * l->x[2 * i + c];
        *mass += l->mass[i];
    }
}

static void compare_turning(double angle)
{
    enum { n_parts = 3 };
    dem_slab slabs[n_parts];
    double sum[2] = {0.0, 0.0}, mass = 0.0;
    CLEANUP(dem_lattice_free) dem_lattice whole = make_rectangle(10.0, 12.0, 1.0);
    make_turned(&whole, angle);
    assert_int_equal(dem_lattice_spin(&whole, 3.7), DEM_OK);
    for (dem_index p = 0; p < n_parts; p++) {
        slabs[p] = make_slab(12.0, p, n_parts);
        make_turned(&slabs[p].lattice, angle);
        add_own(sum, &mass, &slabs[p]);
    }
    const double centre[2] = {1.0 / mass * sum[0], 1.0 / mass * sum[1]};
    for (dem_index p = 0; p < n_parts; p++) {
        assert_int_equal(dem_lattice_spin_about(&slabs[p].lattice, 3.7, centre), DEM_OK);
        assert_memory_equal(slabs[p].lattice.velocity + 2 * slabs[p].first_own,
                            whole.velocity + 2 * slabs[p].first_node,
                            2 * (size_t)slabs[p].n_own * sizeof *whole.velocity);
        dem_slab_free(&slabs[p]);
    }
}

/* By angles at which the last digits of the centre differ. */
TEST(slabs_turn_as_the_whole_does)
{
    for (int k = 1; k <= 8; k++) compare_turning(0.7 * k);
}

TEST(slabs_refuse_impossible_sizes_and_parts)
{
    CLEANUP(dem_slab_free) dem_slab s = dem_slab_empty();
    dem_slab bare = {0};
    assert_refused(dem_slab_rectangle(&s, 1.0, 1.0, 2.0, 0, 1), DEM_ERROR_ARGUMENT, "rectangle * spacing 2 m");
    assert_refused(dem_slab_squares(&s, 1.0, 1.0, 1e-9, 0, 1), DEM_ERROR_MODEL, "1e+18 nodes");
    assert_refused(dem_slab_squares(&s, 1.0, 1.0, 0.1, 3, 3), DEM_ERROR_ARGUMENT, "no part 3 of 3");
    assert_refused(dem_slab_squares(&s, 1.0, 1.0, 0.1, -1, 3), DEM_ERROR_ARGUMENT, "no part -1 of 3");
    assert_refused(dem_slab_squares(&s, 1.0, 1.0, 0.1, 0, 0), DEM_ERROR_ARGUMENT, "no part 0 of 0");
    assert_refused(dem_slab_squares(&s, 1.0, 1.0, 0.1, 0, 12), DEM_ERROR_MODEL, "11 rows * 12 slabs");
    assert_refused(dem_slab_rectangle(NULL, 1.0, 1.0, 0.1, 0, 1), DEM_ERROR_ARGUMENT, "out is NULL");
    assert_refused(dem_slab_rectangle(&bare, 1.0, 1.0, 0.1, 0, 1), DEM_ERROR_ARGUMENT, "dem_slab: struct_size");
    assert_int_equal(s.lattice.n_nodes, 0);
    assert_int_equal(s.n_own, 0);
}

TEST(slabs_refuse_more_jitter_than_triangles_bear_alone)
{
    CLEANUP(dem_slab_free) dem_slab s = make_slab(12.0, 1, 3);
    const double before = s.lattice.x[2 * s.first_own + 2];
    assert_refused(dem_slab_jitter(&s, 0.31, 1), DEM_ERROR_ARGUMENT, "0.3 of * 1 m * 0.31 m");
    assert_refused(dem_slab_jitter(&s, -0.1, 1), DEM_ERROR_ARGUMENT, "radius * jitter * >= 0: -0.1 m");
    assert_int_equal(dem_slab_jitter(&s, (double)NAN, 1), DEM_ERROR_ARGUMENT);
    assert_close(s.lattice.x[2 * s.first_own + 2], before, 0.0);
    assert_int_equal(dem_slab_jitter(&s, 0.3, 1), DEM_OK);
    assert_true(s.lattice.x[2 * s.first_own + 2] != before);
}

TEST(slabs_refuse_to_be_moved_without_a_place_in_a_whole)
{
    CLEANUP(dem_slab_free) dem_slab s = make_slab(12.0, 1, 3);
    assert_refused(dem_slab_jitter(NULL, 0.1, 1), DEM_ERROR_ARGUMENT, "slab is NULL");
    s.n_own += 100;
    assert_refused(dem_slab_jitter(&s, 0.1, 1), DEM_ERROR_ARGUMENT, "74 nodes * no 152 own ones from 11 on");
    s.n_own -= 100;
    s.n_nodes = 100;
    assert_refused(dem_slab_jitter(&s, 0.1, 1), DEM_ERROR_ARGUMENT, "52 nodes from 53 on * 100 nodes");
    s.n_nodes = 158;
    s.rim[11]--;
    assert_refused(dem_slab_jitter(&s, 0.1, 1), DEM_ERROR_ARGUMENT, "number 104 of node 11 of the rim * 105 to 157");
    s.rim[11] = s.rim[12];
    assert_refused(dem_slab_jitter(&s, 0.1, 1), DEM_ERROR_ARGUMENT, "number 106 of node 12 of the rim * 107 to 157");
    s.rim[11]--;
    s.rim[10] = 53;
    assert_refused(dem_slab_jitter(&s, 0.1, 1), DEM_ERROR_ARGUMENT, "number 53 of node 10 of the rim * 52 to 52");
    s.rim[10] = 52;
    free(s.rim_boundary);
    s.rim_boundary = NULL;
    assert_refused(dem_slab_jitter(&s, 0.1, 1), DEM_ERROR_ARGUMENT, "no rim_boundary");
    free(s.rim);
    s.rim = NULL;
    assert_refused(dem_slab_jitter(&s, 0.1, 1), DEM_ERROR_ARGUMENT, "no numbers of 22 nodes");
}

TEST(slabs_with_springs_are_not_moved)
{
    CLEANUP(dem_slab_free) dem_slab s = make_slab(12.0, 1, 3);
    assert_int_equal(dem_lattice_assemble(&s.lattice, &rubber), DEM_OK);
    assert_refused(dem_slab_jitter(&s, 0.1, 1), DEM_ERROR_MODEL, "springs cannot be jittered");
}

TEST(what_is_freed_is_empty)
{
    dem_slab s = make_slab(12.0, 1, 3), bare = {0};
    dem_slab_free(&s);
    assert_int_equal(s.lattice.n_nodes, 0);
    assert_int_equal(s.n_own, 0);
    assert_null(s.lattice.x);
    assert_true(s.rim == NULL && s.rim_boundary == NULL);
    dem_slab_free(NULL);
    dem_slab_free(&bare);
}
