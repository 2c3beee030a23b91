/* SPDX-License-Identifier: BSD-3-Clause */
/* partition.c on rows and squares of nodes, whose sections are known, and on a disc. */
#include "unit/domain/shared_lattice.h"

TEST(ranks_get_the_same_number_of_nodes_but_for_one)
{
    CLEANUP(dem_lattice_free) dem_lattice l = shared_disc();
    for (int n = 1; n <= 9; n++) {
        CLEANUP(free_memory) int32_t *owner = shared_owners(&l, n);
        dem_index count[9] = {0};
        for (dem_index i = 0; i < l.n_nodes; i++) {
            assert_in_range(owner[i], 0, n - 1);
            count[owner[i]]++;
        }
        for (int k = 0; k < n; k++) assert_in_range(count[k], l.n_nodes / n, l.n_nodes / n + 1);
    }
}

static void check_four(const double (*place)[2], int n_ranks, const int32_t *expected)
{
    double x[8];
    int32_t owner[4];
    memcpy(x, place, sizeof x);
    const dem_lattice l = SIZED(dem_lattice, .dim = 2, .n_nodes = 4, .x = x);
    assert_ok(partition_bisect(&l, n_ranks, owner));
    assert_memory_equal(owner, expected, sizeof owner);
}

/* Four nodes at the corners of a rectangle that is wider than high: cut upright, then across. */
TEST(the_longer_side_is_cut_and_lower_coordinates_come_first)
{
    const double corners[4][2] = {{3.0, 1.0}, {0.0, 1.0}, {3.0, 0.0}, {0.0, 0.0}};
    check_four(corners, 4, (const int32_t[]){3, 1, 2, 0});
}

/* Two lattice rows of two nodes stay whole, though they are a little longer than they are apart. */
TEST(of_nearly_equal_sides_the_upright_one_is_cut)
{
    const double corners[4][2] = {{0.0, 0.0}, {1.0, 0.0}, {0.0, 0.95}, {1.0, 0.95}};
    check_four(corners, 2, (const int32_t[]){0, 0, 1, 1});
}

TEST(ties_go_by_number)
{
    double x[10] = {0.0}; /* all at one place */
    const dem_lattice l = SIZED(dem_lattice, .dim = 2, .n_nodes = 5, .x = x);
    int32_t owner[5];
    assert_ok(partition_bisect(&l, 2, owner));
    const int32_t expected[5] = {0, 0, 1, 1, 1};
    assert_memory_equal(owner, expected, sizeof owner);
}

/* Each rank has a node, though one weighs as much as all. */
TEST(shares_have_equal_weights_and_every_rank_a_node)
{
    double x[12] = {0.0};
    for (int i = 0; i < 6; i++) x[2 * i] = i;
    const dem_lattice l = SIZED(dem_lattice, .dim = 2, .n_nodes = 6, .x = x);
    const double light_first[6] = {1.0, 1.0, 1.0, 1.0, 2.0, 2.0}, heavy_last[6] = {0.0, 0.0, 0.0, 0.0, 0.0, 1.0};
    const int32_t halves[6] = {0, 0, 0, 0, 1, 1}, thirds[6] = {0, 0, 0, 0, 1, 2};
    int32_t owner[6];
    assert_ok(partition_bisect_weighted(&l, light_first, 2, owner));
    assert_memory_equal(owner, halves, sizeof owner);
    assert_ok(partition_bisect_weighted(&l, heavy_last, 3, owner));
    assert_memory_equal(owner, thirds, sizeof owner);
}

TEST(more_ranks_than_nodes_are_refused)
{
    double x[4] = {0.0, 0.0, 1.0, 0.0};
    const dem_lattice l = SIZED(dem_lattice, .dim = 2, .n_nodes = 2, .x = x);
    int32_t owner[2];
    assert_int_equal(partition_bisect(&l, 3, owner), DEM_ERROR_MODEL);
    assert_string_equal(dem_status_message(), "3 ranks are more than the 2 nodes that they are to share");
}
