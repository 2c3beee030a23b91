/* SPDX-License-Identifier: BSD-3-Clause */
/* box_tree.c: boxes, what a window and a walk find among items in a row, and what they leave alone. */
#include "verification/support.h"

#include <gsl/gsl_rng.h>
#include <stdlib.h>

#include "harness/cleanup_gsl.h"
#include "obstacle/box_tree.h"

/* n boxes along a random walk; free items and tree. */
typedef struct row {
    box *items;
    box_tree tree;
} row;

static row random_row(gsl_rng *rng, dem_index n)
{
    row r = {.items = calloc((size_t)n + 1, sizeof *r.items)};
    vec2 at = {0.0, 0.0};
    assert_ok(box_tree_create(&r.tree, n));
    for (dem_index k = 0; k < n; k++) {
        const double dx = gsl_rng_uniform(rng) - 0.3;
        const vec2 next = {at.x + dx, at.y + gsl_rng_uniform(rng) - 0.5};
        r.items[k] = box_around(at, next, 0.1 * gsl_rng_uniform(rng));
        box_tree_cover(&r.tree, k, &r.items[k]);
        at = next;
    }
    return r;
}

static void free_row(row *r)
{
    free(r->items);
    box_tree_free(&r->tree);
    assert_null(r->tree.boxes);
}

static int overlap(const box *a, const box *b)
{
    return fmax(a->low.x, b->low.x) <= fmin(a->high.x, b->high.x) &&
           fmax(a->low.y, b->low.y) <= fmin(a->high.y, b->high.y);
}

static int contains(const box *a, const box *b)
{
    return a->low.x <= b->low.x && a->low.y <= b->low.y && a->high.x >= b->high.x && a->high.y >= b->high.y;
}

/* 1e-14 of the coordinates' sum of 10 and 11 m. */
TEST(a_box_holds_its_segment_with_its_reach_and_a_little_more)
{
    const vec2 a = {3.0, -2.0}, b = {1.0, 4.0};
    const box bare = box_around(a, b, 0.0), wide = box_around(b, a, 1.0);
    assert_true(bare.low.x < 1.0 && bare.low.y < -2.0 && bare.high.x > 3.0 && bare.high.y > 4.0);
    assert_close(bare.low.x, 1.0, 2e-13);
    assert_close(bare.high.y, 4.0, 2e-13);
    assert_true(wide.low.x < 0.0 && wide.low.y < -3.0 && wide.high.x > 4.0 && wide.high.y > 5.0);
    assert_close(wide.low.y, -3.0, 2e-13);
    assert_close(wide.high.x, 4.0, 2e-13);
}

TEST(leaves_deal_out_the_items_evenly_and_in_order)
{
    for (dem_index n = 0; n < 300; n++) {
        CLEANUP(box_tree_free) box_tree t;
        assert_ok(box_tree_create(&t, n));
        const dem_index leaf = (dem_index)1 << t.depth;
        assert_int_equal(box_tree_first(&t, leaf), 0);
        assert_int_equal(box_tree_first(&t, 2 * leaf), n);
        assert_false(box_tree_is_leaf(&t, leaf - 1));
        for (dem_index k = leaf; k < 2 * leaf; k++) {
            const dem_index count = box_tree_first(&t, k + 1) - box_tree_first(&t, k);
            assert_true(box_tree_is_leaf(&t, k));
            assert_true(count <= 4 && (count >= 2 || n < 2));
        }
    }
}

TEST(every_node_covers_its_items_and_its_children)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    for (dem_index n = 1; n < 100; n++) {
        CLEANUP(free_row) row r = random_row(rng, n);
        const dem_index leaf = (dem_index)1 << r.tree.depth;
        for (dem_index k = 1; k < leaf; k++) {
            assert_true(contains(&r.tree.boxes[k], &r.tree.boxes[2 * k]));
            assert_true(contains(&r.tree.boxes[k], &r.tree.boxes[2 * k + 1]));
        }
        for (dem_index k = leaf; k < 2 * leaf; k++)
            for (dem_index q = box_tree_first(&r.tree, k); q < box_tree_first(&r.tree, k + 1); q++)
                assert_true(contains(&r.tree.boxes[k], &r.items[q]));
    }
}

TEST(a_window_finds_all_items_that_it_meets_in_order)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    dem_index met = 0, found = 0, in_order = 0;
    for (dem_index n = 0; n < 200; n++) {
        CLEANUP(free_row) row r = random_row(rng, n);
        for (int k = 0; k < 50; k++) {
            const vec2 at = {0.3 * (double)n * gsl_rng_uniform(rng), 6.0 * gsl_rng_uniform(rng) - 3.0};
            const box window = box_around(at, at, gsl_rng_uniform(rng));
            for (dem_index i = 0; i < n; i++) {
                const int meets = overlap(&r.items[i], &window);
                const dem_index next = box_tree_seek(&r.tree, i, &window);
                assert_true(meets ? next == i : next >= i);
                met += meets;
            }
            for (dem_index i = 0; (i = box_tree_seek(&r.tree, i, &window)) < n; i++) {
                found++;
                in_order += overlap(&r.items[i], &window);
            }
            assert_int_equal(box_tree_seek(&r.tree, n, &window), n);
        }
    }
    assert_int_equal(in_order, met);
    assert_true(met > 1000 && found < 4 * met); /* it leaves most alone */
}

TEST(a_window_on_one_side_finds_nothing)
{
    static const double sides[4][2] = {{-2.0, 0.0}, {2.0, 0.0}, {0.0, -2.0}, {0.0, 2.0}};
    const vec2 a = {-0.5, -0.5}, b = {0.5, 0.5};
    const box item = box_around(a, b, 0.0);
    CLEANUP(box_tree_free) box_tree t;
    assert_ok(box_tree_create(&t, 1));
    box_tree_cover(&t, 0, &item);
    for (int k = 0; k < 4; k++) {
        const vec2 at = {sides[k][0], sides[k][1]};
        const box near = box_around(at, at, 1.6), far = box_around(at, at, 1.4);
        assert_int_equal(box_tree_seek(&t, 0, &near), 0);
        assert_int_equal(box_tree_seek(&t, 0, &far), 1);
    }
}

/* Square of the distance to a box, a bound for all in it. */
static double bound_of(const box *b, vec2 x)
{
    const double dx = fmax(0.0, fmax(b->low.x - x.x, x.x - b->high.x)),
                 dy = fmax(0.0, fmax(b->low.y - x.y, x.y - b->high.y));
    return dx * dx + dy * dy;
}

/* The smallest bound of an item, by a walk; and how many nodes that took. */
static double walk_to_nearest(const row *r, vec2 x, int *visits)
{
    const box_tree *t = &r->tree;
    box_tree_walk walk;
    *visits = 0;
    for (dem_index node = box_tree_start(&walk, (double)INFINITY); node > 0; ++*visits) {
        if (!box_tree_is_leaf(t, node)) {
            node = box_tree_down(&walk, node, bound_of(&t->boxes[2 * node], x), bound_of(&t->boxes[2 * node + 1], x));
            continue;
        }
        for (dem_index k = box_tree_first(t, node); k < box_tree_first(t, node + 1); k++)
            walk.limit = fmin(walk.limit, bound_of(&r->items[k], x));
        node = box_tree_back(&walk);
    }
    return walk.limit;
}

TEST(a_walk_comes_to_the_item_with_the_smallest_bound)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    for (dem_index n = 0; n < 200; n++) {
        CLEANUP(free_row) row r = random_row(rng, n);
        for (int k = 0; k < 50; k++) {
            const vec2 x = {0.3 * (double)n * gsl_rng_uniform(rng), 6.0 * gsl_rng_uniform(rng) - 3.0};
            double nearest = (double)INFINITY;
            int visits;
            for (dem_index i = 0; i < n; i++) nearest = fmin(nearest, bound_of(&r.items[i], x));
            assert_true(walk_to_nearest(&r, x, &visits) == nearest);
        }
    }
}

/* 2^15 leaves along a line, points 0.3 to 10 items off it: down once and little more. */
TEST(a_walk_costs_little_more_than_the_depth_of_the_tree)
{
    const dem_index n = 65536;
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(free_row) row r = {.items = calloc((size_t)n, sizeof *r.items)};
    int most = 0;
    assert_ok(box_tree_create(&r.tree, n));
    assert_int_equal(r.tree.depth, 15);
    for (dem_index k = 0; k < n; k++) {
        r.items[k] = box_around((vec2){(double)k, 0.0}, (vec2){(double)k + 1.0, 0.0}, 0.0);
        box_tree_cover(&r.tree, k, &r.items[k]);
    }
    for (int k = 0; k < 10000; k++) {
        const vec2 x = {(double)n * gsl_rng_uniform(rng), 0.3 + 9.7 * gsl_rng_uniform(rng)};
        int visits;
        (void)walk_to_nearest(&r, x, &visits);
        most = visits > most ? visits : most;
    }
    assert_true(most <= 2 * 16);
}

TEST(siblings_are_visited_by_bound_and_not_above_the_limit)
{
    box_tree_walk walk;
    assert_int_equal(box_tree_start(&walk, 10.0), 1);
    assert_int_equal(box_tree_down(&walk, 1, 3.0, 2.0), 3);
    assert_int_equal(box_tree_down(&walk, 3, 11.0, (double)INFINITY), 2); /* nothing there: back */
    assert_int_equal(box_tree_back(&walk), 0);
    assert_int_equal(box_tree_start(&walk, 10.0), 1);
    assert_int_equal(box_tree_down(&walk, 1, 3.0, 3.0), 2); /* on a tie the first */
    walk.limit = 2.5;
    assert_int_equal(box_tree_back(&walk), 0);
    assert_int_equal(box_tree_start(&walk, 10.0), 1);
    assert_int_equal(box_tree_down(&walk, 1, 3.0, 3.0), 2);
    walk.limit = 3.0;
    assert_int_equal(box_tree_back(&walk), 3); /* an equal may be there */
    assert_int_equal(box_tree_start(&walk, 10.0), 1);
    assert_int_equal(box_tree_down(&walk, 1, 10.0, (double)NAN), 2); /* the limit itself is not above it */
    assert_int_equal(box_tree_back(&walk), 0);
}
