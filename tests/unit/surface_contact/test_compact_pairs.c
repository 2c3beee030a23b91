/* SPDX-License-Identifier: BSD-3-Clause */
/* compact_pairs.c: pairs and nodes against the list that they come from. */
#include "surface_contact/compact_pairs.h"

#include <gsl/gsl_rng.h>

#include "harness/cleanup_gsl.h"
#include "verification/support.h"

enum { NODES = 40, PAIRS = 60 };

/* Pairs of any nodes, most of which are in several. */
static void make(gsl_rng *rng, contact_pair *list)
{
    for (int k = 0; k < PAIRS; k++) {
        list[k] = (contact_pair){.thickness = gsl_rng_uniform(rng), .weight = gsl_rng_uniform(rng)};
        list[k].fills = gsl_rng_uniform_int(rng, 5) == 0;
        list[k].ends_at_second = gsl_rng_uniform_int(rng, 5) == 0;
        for (int which = 0; which < CONTACT_PAIR_NODES; which++)
            list[k].nodes[which] = (dem_index)gsl_rng_uniform_int(rng, NODES);
    }
}

static void check_pair(const compact_pairs *c, dem_index k, const double *x)
{
    const contact_pair *p = &c->list[k];
    for (int which = 0; which < CONTACT_PAIR_PUSHED; which++) {
        const unsigned row = c->pairs[k].rows[which];
        assert_int_equal(c->nodes[row / 2], p->nodes[which]);
        assert_true(c->x[row] == x[2 * p->nodes[which]] && c->x[row + 1] == x[2 * p->nodes[which] + 1]);
    }
    assert_true(c->pairs[k].thickness == p->thickness && c->pairs[k].weight == p->weight);
    assert_true(c->pairs[k].is_plain == (!p->fills && !p->ends_at_second));
}

static void check(compact_pairs *c, const contact_pair *list, dem_index n, const double *x)
{
    dem_index n_fillings = 0;
    assert_ok(compact_pairs_take(c, list, n));
    assert_int_equal(c->n, n);
    compact_pairs_read(c, x);
    for (dem_index k = 0; k < n; k++) {
        check_pair(c, k, x);
        n_fillings += list[k].fills;
    }
    assert_int_equal(c->n_fillings, n_fillings);
    for (dem_index k = 0; k < 2 * c->n_nodes; k++) assert_true(c->force[k] == 0.0);
    for (dem_index k = 0; k < c->n_nodes; k++) assert_int_equal(c->place_of[c->nodes[k]], k + 1);
}

/* Lists follow each other, and a node that no pair pushes has a place as soon as something asks for it. */
TEST(pairs_and_their_nodes_are_those_of_the_list)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(compact_pairs_destroy) compact_pairs c;
    contact_pair list[PAIRS];
    double x[2 * NODES];
    for (int k = 0; k < 2 * NODES; k++) x[k] = gsl_rng_uniform(rng);
    assert_ok(compact_pairs_create(&c, NODES));
    for (dem_index n = 0; n <= PAIRS; n += 5) {
        make(rng, list);
        check(&c, list, n, x);
        for (dem_index node = 0; node < NODES; node++) {
            const unsigned row = compact_pairs_row(&c, node);
            assert_true(c.nodes[row / 2] == node && compact_pairs_row(&c, node) == row);
            c.force[row] = c.force[row + 1] = 1.0;
        }
        assert_int_equal(c.n_nodes, NODES);
        compact_pairs_clear_forces(&c);
        for (dem_index k = 0; k < 2 * NODES; k++) assert_true(c.force[k] == 0.0);
    }
    compact_pairs_clear(&c);
    for (dem_index node = 0; node < NODES; node++) assert_int_equal(c.place_of[node], 0);
}
