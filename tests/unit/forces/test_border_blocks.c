/* SPDX-License-Identifier: BSD-3-Clause */
/* border_blocks.c: blocks of eight nodes with those that are sent or received, in ascending order. */
#include "verification/support.h"

#include "forces/border_blocks.h"

TEST(blocks_with_nodes_of_the_border_are_listed_once_each)
{
    dem_index sent[2][3] = {{3, 17, 23}, {40}}, received[2][2] = {{9, 51}, {41, 47}};
    domain_neighbour neighbours[2] = {
        {.rank = 1, .n_sent = 3, .n_received = 2, .sent = sent[0], .received = received[0]},
        {.rank = 4, .n_sent = 1, .n_received = 2, .sent = sent[1], .received = received[1]}};
    const domain d = {.n_nodes = 52, .n_neighbours = 2, .neighbours = neighbours};
    border_blocks b;
    /* Nodes 48 to 51 fill no block. */
    assert_ok(border_blocks_create(&b, &d, 6));
    assert_memory_equal(b.list, ((const dem_index[]){0, 1, 2, 5}), 4 * sizeof *b.list);
    assert_int_equal(b.n, 4);
    assert_memory_equal(b.is_in, ((const uint8_t[]){1, 1, 1, 0, 0, 1}), 6);
    border_blocks_free(&b);
}

TEST(where_nobody_has_other_nodes_there_is_no_border)
{
    const domain alone = {.n_nodes = 52};
    border_blocks b;
    assert_ok(border_blocks_create(&b, &alone, 6));
    assert_true(b.n == 0 && b.is_in == NULL);
    assert_ok(border_blocks_create(&b, NULL, 6));
    assert_true(b.n == 0 && b.is_in == NULL);
    border_blocks_free(&b);
}
