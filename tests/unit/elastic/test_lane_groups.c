/* SPDX-License-Identifier: BSD-3-Clause */
/* lane_groups.c: which items are taken together, in which order. */
#include "unit/close.h"

#include "elastic/lane_groups.h"

static void put(lane_groups *g, int lane, int32_t base)
{
    g->items[lane * g->most + g->n[lane]++] = (lane_item){.base = base, .last = base};
}

/* Takes a group, as the mask of its lanes. */
static unsigned take(lane_groups *g)
{
    return lane_groups_take(g) != NULL ? lane_groups_mask(g) : 0;
}

/* All nodes have a neighbour 5 further on, some of them one 3 further on before it: that one goes first. */
TEST(items_that_lie_side_by_side_go_together)
{
    CLEANUP(lane_groups_free) lane_groups g;
    assert_true(lane_groups_create(&g, 2));
    for (int lane = 0; lane < LAYOUT_LANES; lane++) {
        if (lane >= 6) put(&g, lane, 3);
        put(&g, lane, 5);
    }
    lane_groups_choose(&g);
    assert_int_equal(take(&g), 0xf000);
    assert_int_equal(lane_groups_item(&g, 7)->base, 3);
    const lane_item *leader = lane_groups_take(&g);
    assert_non_null(leader);
    assert_int_equal(leader->base, 5);
    assert_int_equal(lane_groups_mask(&g), 0xffff);
    assert_true(lane_groups_side_by_side(&g, leader));
    assert_null(lane_groups_take(&g));
}

/* Each lane's operand is elsewhere: eight groups where the fullest lane has one item. */
TEST(items_that_are_scattered_go_by_their_number)
{
    CLEANUP(lane_groups_free) lane_groups g;
    assert_true(lane_groups_create(&g, 2));
    for (int lane = 0; lane < LAYOUT_LANES; lane++) put(&g, lane, 10 * lane);
    put(&g, 2, 7);
    lane_groups_choose(&g);
    const lane_item *leader = lane_groups_take(&g);
    assert_int_equal(lane_groups_mask(&g), 0xffff);
    assert_false(lane_groups_side_by_side(&g, leader));
    assert_int_equal(take(&g), 0x0030);
    assert_int_equal(take(&g), 0);
    lane_groups_by_slot(&g);
    assert_int_equal(take(&g), 0xffff);
}

TEST(upper_ends_go_apart_and_are_marked)
{
    CLEANUP(lane_groups_free) lane_groups g;
    assert_true(lane_groups_create(&g, 1));
    for (int lane = 0; lane < LAYOUT_LANES; lane++) {
        put(&g, lane, 4);
        g.items[lane].negative = lane >= 4;
    }
    lane_groups_choose(&g);
    assert_int_equal(take(&g), 0x00ff);
    assert_int_equal(lane_groups_upper(&g), 0);
    assert_int_equal(take(&g), 0xff00);
    assert_int_equal(lane_groups_upper(&g), 0xff00);
}
