/* SPDX-License-Identifier: BSD-3-Clause */
/* local_cache.c: what is kept of a node is found as it was, until another node takes its slot or all are forgotten. */
#include "verification/support.h"

#include <stdlib.h>
#include <string.h>

#include "forces/local_cache.h"

enum { RINGS = 2, MOVING = 3, NODES = 5, BONDS = 500, PULLS = 7, GUARDED = 3 };

/* Lists of a node: some bonds, with numbers that are the node's own where it is `unlike` others. */
typedef struct lists {
    dem_index list[NODES];
    local_nodes nodes;
    local_places places[MOVING + 1];
    local_bond bonds[BONDS];
    int32_t pulls[PULLS];
    local_guarded guarded[GUARDED];
    double stiffness[BONDS], rest_length[BONDS], inverse_mass[MOVING], onset[GUARDED];
    local_lists of;
} lists;

static void fill(lists *l, dem_index node, bool unlike)
{
    *l = (lists){.places[MOVING] = {.bonds = BONDS, .pulls = PULLS, .corners = 4, .guarded = GUARDED}};
    for (int k = 0; k < NODES; k++) l->list[k] = node + k;
    for (int k = 0; k < BONDS; k++) l->bonds[k] = (local_bond){k % 4, k % 4 + 1};
    for (int k = 0; k < PULLS; k++) l->pulls[k] = 10 + k;
    for (int k = 0; k < GUARDED; k++) l->guarded[k] = (local_guarded){{k, k + 1, k + 2}};
    for (int k = 0; k < BONDS; k++) l->stiffness[k] = 3.0 + k;
    for (int k = 0; k < BONDS; k++) l->rest_length[k] = (unlike ? (double)node : 1.0) / (1.0 + k);
    for (int k = 0; k < MOVING; k++) l->inverse_mass[k] = 0.5 * k;
    for (int k = 0; k < GUARDED; k++) l->onset[k] = 0.25 * k;
    l->nodes = (local_nodes){.n_rings = RINGS, .n = NODES, .list = l->list, .end = {1, MOVING, NODES}};
    l->of = (local_lists){.by_node = true,
                          .places = l->places,
                          .bonds = l->bonds,
                          .pulls = l->pulls,
                          .guarded = l->guarded,
                          .pushed = l->stiffness,
                          .pulled = l->stiffness,
                          .rest_length = l->rest_length,
                          .inverse_mass = l->inverse_mass,
                          .onset = l->onset};
}

#define SAME(kept, expected) assert_memory_equal(kept, expected, sizeof(expected))

static void check_kept(const local_cache *c, dem_index node, bool unlike)
{
    lists expected;
    local_record r;
    fill(&expected, node, unlike);
    assert_true(local_cache_find(c, node, RINGS, &r));
    assert_int_equal(r.n, NODES);
    for (int k = 0; k < NODES; k++) assert_int_equal(r.list[k], node + k);
    assert_memory_equal(r.end, expected.nodes.end, sizeof expected.nodes.end);
    assert_true(r.lists.by_node);
    SAME(r.lists.places, expected.places);
    SAME(r.lists.bonds, expected.bonds);
    SAME(r.lists.pulls, expected.pulls);
    SAME(r.lists.guarded, expected.guarded);
    SAME(r.lists.pushed, expected.stiffness);
    SAME(r.lists.pulled, expected.stiffness);
    SAME(r.lists.rest_length, expected.rest_length);
    SAME(r.lists.inverse_mass, expected.inverse_mass);
    SAME(r.lists.onset, expected.onset);
}

static void keep(local_cache *c, dem_index node, bool unlike)
{
    lists l;
    fill(&l, node, unlike);
    local_cache_keep(c, node, &l.nodes, &l.of);
}

TEST(what_is_kept_is_found_for_its_node_and_rings_alone)
{
    CLEANUP(local_cache_destroy) local_cache c = {0};
    local_record r;
    assert_false(local_cache_find(&c, 4, RINGS, &r));
    keep(&c, 4, false);
    keep(&c, 7, true);
    check_kept(&c, 4, false);
    check_kept(&c, 7, true);
    assert_false(local_cache_find(&c, 5, RINGS, &r));
    assert_false(local_cache_find(&c, 4, RINGS + 1, &r));
    keep(&c, 4 + 512, true); /* the same slot */
    assert_false(local_cache_find(&c, 4, RINGS, &r));
    check_kept(&c, 4 + 512, true);
}

/* Equal lists add the nodes alone; lists of which none are equal soon use all numbers up. */
TEST(equal_lists_are_stored_once_and_memory_is_bounded)
{
    CLEANUP(local_cache_destroy) local_cache c = {0};
    keep(&c, 0, false);
    const dem_index n = c.items.n;
    for (dem_index node = 1; node < 500; node++) keep(&c, node, false);
    assert_int_equal(c.items.n, n + 499 * (NODES + 1) / 2);
    for (dem_index node = 1; node < 5000; node++) {
        keep(&c, node, true);
        check_kept(&c, node, true);
        assert_true(c.items.n < (1 << 18) + 2000);
    }
}
