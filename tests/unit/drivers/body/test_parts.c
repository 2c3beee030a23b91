/* SPDX-License-Identifier: BSD-3-Clause */
/* parts.c: which parts of a body are loose, where it has hinges. */
#include "unit/close.h"

#include <string.h>

#include "parts.h"

/* Nodes 0 to 8, node i at (i, -i); springs 7-8-0, 1-2, 3-4-5; 6 alone. */
static double x[18] = {0, 0, 1, -1, 2, -2, 3, -3, 4, -4, 5, -5, 6, -6, 7, -7, 8, -8}, ones[5] = {1, 1, 1, 1, 1};
static dem_index ends[10] = {7, 8, 8, 0, 1, 2, 3, 4, 4, 5};

static dem_lattice make_lattice(int32_t *body)
{
    dem_lattice lattice = dem_lattice_empty();
    lattice.n_nodes = 9, lattice.n_springs = 5;
    lattice.x = x, lattice.ends = ends, lattice.rest_length = ones, lattice.stiffness = ones, lattice.body = body;
    return lattice;
}

TEST(the_largest_part_of_a_body_is_the_main_one)
{
    const unsigned char expected[9] = {1, 0, 0, 0, 0, 0, 0, 1, 1}; /* of two with three nodes the one with node 0 */
    const dem_lattice lattice = make_lattice(NULL);
    bool kept[9];
    parts_loose loose;
    assert_int_equal(parts_find(&loose, kept, &lattice), DEM_OK);
    assert_memory_equal(kept, expected, sizeof kept);
    assert_int_equal(loose.n, 3);
    assert_int_equal(loose.size[0], 3);
    assert_int_equal(loose.size[1], 2);
    assert_int_equal(loose.size[2], 1);
    assert_close(loose.x[0][0], 3.0, 0.0);
    assert_close(loose.x[0][1], -3.0, 0.0);
}

TEST(every_body_has_a_main_part)
{
    const unsigned char expected[9] = {1, 1, 1, 1, 1, 1, 0, 1, 1};
    int32_t body[9] = {0, 5, 5, 2, 2, 2, 0, 0, 0};
    const dem_lattice lattice = make_lattice(body);
    bool kept[9];
    parts_loose loose;
    assert_int_equal(parts_find(&loose, kept, &lattice), DEM_OK);
    assert_memory_equal(kept, expected, sizeof kept);
    assert_int_equal(loose.n, 1);
    assert_close(loose.x[0][0], 6.0, 0.0);
}

TEST(a_lattice_without_nodes_has_no_parts)
{
    bool kept[1];
    dem_lattice lattice = dem_lattice_empty();
    parts_loose loose;
    lattice = dem_lattice_empty();
    assert_int_equal(parts_find(&loose, kept, &lattice), DEM_OK);
    assert_int_equal(loose.n, 0);
}

TEST(more_parts_than_are_listed_are_counted)
{
    dem_lattice lattice = make_lattice(NULL);
    bool kept[9];
    parts_loose loose;
    lattice.n_springs = 0;
    assert_int_equal(parts_find(&loose, kept, &lattice), DEM_OK);
    assert_int_equal(loose.n, 8);
    assert_close(loose.x[0][0], 1.0, 0.0);
    char text[PARTS_LIST];
    parts_print(text, &loose, "node");
    assert_string_equal(text,
                        "1 node at (1, -1), 1 at (2, -2), 1 at (3, -3), 1 at (4, -4), 1 at (5, -5), 1 at (6, -6), ...");
}

TEST(a_spring_to_nowhere_is_an_error)
{
    dem_lattice lattice = make_lattice(NULL);
    bool kept[9];
    parts_loose loose;
    lattice.n_nodes = 8;
    assert_int_equal(parts_find(&loose, kept, &lattice), DEM_ERROR_MODEL);
}

/* ---- triangulations ---- */

/* Three triangles: two that share the edge 0-2, one on node 2 alone. */
static double fan_x[12] = {0, 0, 1, 0, 1, 1, 0, 1, 2, 1, 2, 2};
static dem_index fan[9] = {2, 4, 5, 0, 1, 2, 0, 2, 3};

static dem_lattice make_fan(void)
{
    dem_lattice lattice = dem_lattice_empty();
    lattice.n_nodes = 6, lattice.n_triangles = 3;
    lattice.x = fan_x, lattice.triangles = fan;
    return lattice;
}

TEST(triangles_that_share_but_a_node_are_parts_of_their_own)
{
    const unsigned char expected[3] = {0, 1, 1};
    const dem_lattice lattice = make_fan();
    bool kept[3];
    char text[PARTS_LIST];
    parts_loose loose;
    assert_int_equal(parts_find(&loose, kept, &lattice), DEM_OK);
    assert_memory_equal(kept, expected, sizeof kept);
    assert_int_equal(loose.n, 1);
    parts_print(text, &loose, "triangle");
    assert_string_equal(text, "1 triangle at (1, 1)");
    loose.size[0] = 5;
    parts_print(text, &loose, "triangle");
    assert_string_equal(text, "5 triangles at (1, 1)");
    loose.n = 0;
    parts_print(text, &loose, "triangle");
    assert_string_equal(text, "");
}

TEST(the_longest_list_has_room)
{
    char text[PARTS_LIST];
    parts_loose loose = {.n = 99};
    for (int k = 0; k < PARTS_LISTED; k++) {
        loose.size[k] = INT64_MAX;
        loose.x[k][0] = loose.x[k][1] = -1.23456e-300;
    }
    parts_print(text, &loose, "triangle");
    assert_string_equal(text + strlen(text) - 5, ", ...");
}

TEST(a_node_with_two_fans_is_a_hinge)
{
    const dem_lattice lattice = make_fan();
    dem_lattice two = make_fan();
    parts_hinges hinges;
    assert_int_equal(parts_find_hinges(&hinges, &lattice), DEM_OK);
    assert_int_equal(hinges.n, 1);
    assert_close(hinges.x[0], 1.0, 0.0);
    assert_close(hinges.x[1], 1.0, 0.0);
    two.n_triangles = 2;
    two.triangles = fan + 3;
    assert_int_equal(parts_find_hinges(&hinges, &two), DEM_OK);
    assert_int_equal(hinges.n, 0);
    two.n_nodes = 2;
    assert_int_equal(parts_find_hinges(&hinges, &two), DEM_ERROR_MODEL);
}
