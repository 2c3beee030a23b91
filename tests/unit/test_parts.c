/* SPDX-License-Identifier: BSD-3-Clause */
/* parts.c: which parts of a body are loose. */
#include "close.h"

#include "parts.h"

/* Nodes 0 to 8; springs 7-8-0, 1-2, 3-4-5; 6 alone. */
static double x[18], ones[5] = {1, 1, 1, 1, 1};
static dem_index ends[10] = {7, 8, 8, 0, 1, 2, 3, 4, 4, 5};

static dem_lattice make_lattice(int32_t *body)
{
    dem_lattice lattice;
    dem_lattice_init(&lattice);
    lattice.n_nodes = 9, lattice.n_springs = 5;
    lattice.x = x, lattice.ends = ends, lattice.rest_length = ones, lattice.stiffness = ones, lattice.body = body;
    return lattice;
}

static void the_largest_part_of_a_body_is_the_main_one(void **state)
{
    (void)state;
    const unsigned char expected[9] = {1, 0, 0, 0, 0, 0, 0, 1, 1}; /* of two with three nodes the one with node 0 */
    const dem_lattice lattice = make_lattice(NULL);
    unsigned char kept[9];
    parts_loose loose;
    assert_int_equal(parts_find(&loose, kept, &lattice), DEM_OK);
    assert_memory_equal(kept, expected, sizeof kept);
    assert_int_equal(loose.n, 3);
    assert_int_equal(loose.n_nodes[0], 3);
    assert_int_equal(loose.n_nodes[1], 2);
    assert_int_equal(loose.n_nodes[2], 1);
    assert_int_equal(loose.node, 3);
}

static void every_body_has_a_main_part(void **state)
{
    (void)state;
    const unsigned char expected[9] = {1, 1, 1, 1, 1, 1, 0, 1, 1};
    int32_t body[9] = {0, 5, 5, 2, 2, 2, 0, 0, 0};
    const dem_lattice lattice = make_lattice(body);
    unsigned char kept[9];
    parts_loose loose;
    assert_int_equal(parts_find(&loose, kept, &lattice), DEM_OK);
    assert_memory_equal(kept, expected, sizeof kept);
    assert_int_equal(loose.n, 1);
    assert_int_equal(loose.node, 6);
}

static void a_lattice_without_nodes_has_no_parts(void **state)
{
    (void)state;
    unsigned char kept[1];
    dem_lattice lattice;
    parts_loose loose;
    dem_lattice_init(&lattice);
    assert_int_equal(parts_find(&loose, kept, &lattice), DEM_OK);
    assert_int_equal(loose.n, 0);
}

static void more_parts_than_are_listed_are_counted(void **state)
{
    (void)state;
    dem_lattice lattice = make_lattice(NULL);
    unsigned char kept[9];
    parts_loose loose;
    lattice.n_springs = 0;
    assert_int_equal(parts_find(&loose, kept, &lattice), DEM_OK);
    assert_int_equal(loose.n, 8);
    assert_int_equal(loose.node, 1);
}

static void a_spring_to_nowhere_is_an_error(void **state)
{
    (void)state;
    dem_lattice lattice = make_lattice(NULL);
    unsigned char kept[9];
    parts_loose loose;
    lattice.n_nodes = 8;
    assert_int_equal(parts_find(&loose, kept, &lattice), DEM_ERROR_MODEL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_largest_part_of_a_body_is_the_main_one),
        cmocka_unit_test(every_body_has_a_main_part),
        cmocka_unit_test(a_lattice_without_nodes_has_no_parts),
        cmocka_unit_test(more_parts_than_are_listed_are_counted),
        cmocka_unit_test(a_spring_to_nowhere_is_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
