/* SPDX-License-Identifier: BSD-3-Clause */
/* joined_nodes.c: which nodes are of one fragment whatever breaks, in the whole and in a domain. */
#include "model/joined_nodes.h"

#include <stdlib.h>

#include <dem/dem.h>

#include "harness/test.h"

/* A ring of eight nodes, of which springs may break between 2 and 3, 3 and 4, and between 6 and 7: 3 is by itself, and
 * so are 0, 1, 2 and 7, and 4, 5, 6. */
enum { N = 8 };

static dem_index ends[2 * N] = {0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6, 7, 7, 0};
static const unsigned char breakable[N] = {0, 0, 1, 1, 1, 0, 1, 1};

TEST(springs_that_cannot_break_join_nodes)
{
    const dem_index expected[N] = {0, 0, 0, 3, 4, 4, 4, 0};
    const dem_lattice l = SIZED(dem_lattice, .dim = 2, .n_nodes = N, .n_springs = N, .ends = ends);
    dem_index joined[N];
    joined_nodes_find(&l, breakable, joined);
    assert_memory_equal(joined, expected, sizeof expected);
}

/* A domain of nodes 1, 3, 5, 6 and 7: node 0, which joins 1 and 7, and 4, are not there. */
TEST(nodes_of_a_domain_are_joined_by_others)
{
    dem_index joined[] = {0, 3, 4, 4, 0};
    const dem_index expected[] = {0, 1, 2, 2, 0};
    domain d = {.n_nodes = 5, .joined = joined};
    assert_int_equal(joined_nodes_place(&d), DEM_OK);
    assert_memory_equal(d.joined_to, expected, sizeof expected);
    free(d.joined_to);
}
