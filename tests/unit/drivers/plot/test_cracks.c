/* SPDX-License-Identifier: BSD-3-Clause */
/* cracks.c: a strip of four triangles, 0 1 2, 2 1 3, 2 3 4 and 4 3 5. */
#include "unit/close.h"

#include "cracks.h"

static dem_index triangles[12] = {0, 1, 2, 2, 1, 3, 2, 3, 4, 4, 3, 5};

TEST(sides_that_two_triangles_share_are_listed_once)
{
    const cracks_side expected[3] = {{{1, 2}, {0, 1}}, {{2, 3}, {1, 2}}, {{3, 4}, {2, 3}}};
    const dem_lattice strip = {.n_nodes = 6, .n_triangles = 4, .triangles = triangles};
    cracks c;
    assert_true(cracks_create(&c, &strip));
    assert_int_equal(c.n, 3);
    assert_memory_equal(c.side, expected, sizeof expected);
    cracks_free(&c);
}

TEST(a_crack_is_between_broken_and_whole)
{
    const cracks_side side = {{2, 3}, {1, 2}};
    assert_false(cracks_open(&side, (const unsigned char[]){1, 0, 0, 1}));
    assert_true(cracks_open(&side, (const unsigned char[]){0, 1, 0, 0}));
    assert_true(cracks_open(&side, (const unsigned char[]){0, 0, 1, 0}));
    assert_false(cracks_open(&side, (const unsigned char[]){0, 1, 1, 0}));
}

TEST(without_triangles_there_is_none)
{
    const dem_lattice chain = {.n_nodes = 2};
    cracks c;
    assert_true(cracks_create(&c, &chain));
    assert_int_equal(c.n, 0);
    cracks_free(&c);
}
