/* SPDX-License-Identifier: BSD-3-Clause */
/* element_state.c: flags, and the nodes beside what is broken. Two triangles, 0 1 2 and 1 3 2, and their springs. */
#include "verification/support.h"

#include <string.h>

#include "elastic/element_state.h"

static dem_index ends[10] = {0, 1, 1, 2, 2, 0, 1, 3, 3, 2}, corners[6] = {0, 1, 2, 1, 3, 2};
static const dem_lattice lattice = {
    .dim = 2, .n_nodes = 4, .n_springs = 5, .n_triangles = 2, .ends = ends, .triangles = corners};

TEST(all_are_whole_at_first)
{
    element_state s;
    assert_ok(element_state_create(&s, &lattice));
    assert_int_equal(s.n_damaged, 0);
    for (dem_index k = 0; k < 5; k++) assert_int_equal(s.spring[k], 0);
    for (dem_index k = 0; k < 2; k++) assert_int_equal(s.triangle[k], 0);
    for (dem_index i = 0; i < 4; i++) assert_null(element_state_at(&s, i));
    element_state_destroy(&s);
    element_state_destroy(&s);
    assert_null(s.spring);
}

TEST(no_state_is_one_of_whole_elements)
{
    assert_null(element_state_at(NULL, 3));
    assert_null(element_state_springs(NULL));
    assert_null(element_state_triangles(NULL));
}

TEST(a_node_beside_what_is_broken_is_listed_once)
{
    const dem_index expected[4] = {1, 3, 2, 0};
    CLEANUP(element_state_destroy) element_state s;
    assert_ok(element_state_create(&s, &lattice));
    element_state_break_spring(&s, &lattice, 3); /* 1 - 3 */
    assert_int_equal(s.n_damaged, 2);
    assert_null(element_state_at(&s, 0));
    assert_ptr_equal(element_state_at(&s, 3), &s);
    element_state_break_triangle(&s, &lattice, 1); /* 1 3 2 */
    element_state_break_spring(&s, &lattice, 3);
    assert_int_equal(s.n_damaged, 3);
    element_state_break_spring(&s, &lattice, 2); /* 2 - 0 */
    assert_int_equal(s.n_damaged, 4);
    assert_memory_equal(s.damaged, expected, sizeof expected);
    assert_ptr_equal(element_state_springs(&s), s.spring);
    assert_memory_equal(s.spring, ((const unsigned char[5]){0, 0, 1, 1, 0}), 5);
    assert_ptr_equal(element_state_triangles(&s), s.triangle);
    assert_memory_equal(s.triangle, ((const unsigned char[2]){0, 1}), 2);
}
