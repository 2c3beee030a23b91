/* SPDX-License-Identifier: BSD-3-Clause */
/* contact_batch.c: what is found in reach against the forces of each pair, and these to the bit, for every number of
 * pairs that a machine may take together. */
#include "surface_contact/contact_batch.h"

#include <gsl/gsl_rng.h>

#include "harness/cleanup_gsl.h"
#include "verification/support.h"

enum { MOST = 3 * CONTACT_BATCH_MOST + 9, NODES = CONTACT_PAIR_NODES * MOST };

/* Pairs of nodes of their own, of thicknesses and sizes of about 1 m, at places at random. */
static void make(gsl_rng *rng, contact_pair *list, double *x)
{
    for (dem_index k = 0; k < MOST; k++) {
        list[k] = (contact_pair){.thickness = 0.5 + gsl_rng_uniform(rng), .weight = 1.0, .fills = k % 5 == 4};
        for (dem_index which = 0; which < CONTACT_PAIR_NODES; which++)
            list[k].nodes[which] = CONTACT_PAIR_NODES * k + which;
    }
    for (int c = 0; c < 2 * NODES; c++) x[c] = 3.0 * gsl_rng_uniform(rng);
}

/* Whether the pair pushes with a thickness that is smaller by a factor. */
static bool pushes(const contact_pair *pair, double part, const double *x)
{
    contact_pair thinner = *pair;
    contact_push push;
    thinner.thickness *= part;
    return contact_pair_push(&thinner, x, &push);
}

static bool are_equal(vec2 a, vec2 b)
{
    return a.x == b.x && a.y == b.y;
}

static void check_push(const contact_batch *b, int k, const double *x)
{
    contact_push push, expected;
    const bool any = contact_pair_push(contact_batch_pair(b, k), x, &expected);
    assert_true(contact_batch_push(b, k, x, &push) == any);
    assert_true(push.pair == contact_batch_pair(b, k) && push.share == expected.share);
    assert_true(are_equal(push.by_edge, expected.by_edge) && are_equal(push.by_vertex, expected.by_vertex));
    assert_true(are_equal(push.by_second, expected.by_second));
}

/* Far from the ends the edge does all. An edge that pushes is as near as its gap, but for rounding; what fills a crack
 * counts as far. */
static void check_edge(const contact_batch *b, int k, const double *x)
{
    const contact_pair *p = contact_batch_pair(b, k);
    const double u = contact_batch_nearness(b, k, x);
    if (p->fills) assert_true(u == 1.0);
    if (contact_batch_is_by_edge(b, k) && !p->fills)
        assert_true(fabs(u - contact_pair_gap(p, x) / p->thickness) < 1e-13);
    if (!contact_batch_is_edge_alone(b, k)) return;
    const contact_push push = contact_batch_edge_push(b, k);
    contact_push expected;
    assert_true(contact_pair_push(p, x, &expected) && b->u[k] == u);
    assert_true(push.pair == p && push.share == expected.share && are_equal(push.by_edge, expected.by_edge));
    assert_true(are_equal(expected.by_vertex, (vec2){0.0, 0.0}));
}

/* By its vertex a pair may be found and push nothing, but not beyond the thickness. */
static void check_found(const contact_pair *p, bool is_found, double part, const double *x)
{
    const vec2 r = vec2_sub(vec2_at(x, p->nodes[0]), vec2_at(x, p->nodes[1]));
    if (pushes(p, part, x)) assert_true(is_found);
    if (is_found && !pushes(p, part, x)) assert_true(vec2_norm(r) < part * p->thickness);
}

/* \return how many are found */
static dem_index check(const contact_pair *list, dem_index n, double part, const double *x)
{
    CLEANUP(compact_pairs_destroy) compact_pairs compact;
    contact_batch b;
    dem_index next = 0, n_found = 0;
    assert_ok(compact_pairs_create(&compact, NODES));
    assert_ok(compact_pairs_take(&compact, list, n));
    compact_pairs_read(&compact, x);
    contact_batch_begin(&b, &compact, part);
    while (contact_batch_next(&b)) {
        contact_batch_evaluate(&b);
        for (int k = 0; k < b.n; k++) {
            for (; next < contact_batch_place(&b, k); next++) check_found(&list[next], false, part, x);
            check_found(&list[next++], true, part, x);
            if (part == 1.0) check_push(&b, k, x);
            if (part == 1.0) check_edge(&b, k, x);
        }
        n_found += b.n;
    }
    for (; next < n; next++) check_found(&list[next], false, part, x);
    return n_found;
}

TEST(all_pairs_that_push_are_found_in_their_order_and_few_others)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    contact_pair list[MOST];
    double x[2 * NODES];
    dem_index n_found = 0;
    for (int turn = 0; turn < 20; turn++) {
        make(rng, list, x);
        for (dem_index n = 0; n <= MOST; n++) (void)check(list, n, turn % 2 == 0 ? 1.0 : 0.5, x);
        n_found += check(list, MOST, 1.0, x);
    }
    assert_true(n_found > 2 * MOST && n_found < 10 * MOST);
}

/* Where all push, batches are full. */
TEST(batches_go_on_where_the_last_one_ended)
{
    contact_pair list[MOST];
    const double x[8] = {0.5, -0.1, 0.0, 0.0, 1.0, 0.0, -1.0, 0.0};
    for (dem_index k = 0; k < MOST; k++)
        list[k] = (contact_pair){.nodes = {0, 1, 2, 3}, .thickness = 0.2, .weight = 1.0};
    assert_int_equal(check(list, MOST, 1.0, x), MOST);
}
