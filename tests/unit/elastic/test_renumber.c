/* SPDX-License-Identifier: BSD-3-Clause */
/* renumber.c: a numbering by distance, on chains, where the best span is known. */
#include "unit/close.h"

#include <gsl/gsl_rng.h>
#include <stdlib.h>

#include "elastic/renumber.h"
#include "harness/cleanup_gsl.h"

enum { n = 60 };

typedef struct chain {
    double x[2 * n], mass[n], rest_length[n], stiffness[n];
    dem_index ends[2 * n];
    dem_lattice lattice;
    springs springs;
    int32_t order[n], place[n];
} chain;

/* Two chains of half the nodes each; node `at[k]` is number k along them. */
static void make_chains(chain *c, const dem_index *at)
{
    *c = (chain){.lattice = {.dim = 2, .n_nodes = n}};
    for (dem_index k = 0; k + 1 < n; k++) {
        if (k + 1 == n / 2) continue;
        const dem_index s = c->lattice.n_springs++;
        c->ends[2 * s] = at[k];
        c->ends[2 * s + 1] = at[k + 1];
        c->rest_length[s] = c->stiffness[s] = 1.0;
    }
    c->lattice.ends = c->ends;
    c->lattice.rest_length = c->rest_length;
    c->lattice.stiffness = c->stiffness;
    assert_int_equal(springs_compile(&c->springs, &c->lattice), DEM_OK);
}

static void shuffle(dem_index *at, unsigned long seed)
{
    CLEANUP(free_rng) gsl_rng *r = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_rng_set(r, seed);
    for (dem_index k = 0; k < n; k++) at[k] = k;
    for (dem_index k = n - 1; k > 0; k--) {
        const dem_index j = (dem_index)gsl_rng_uniform_int(r, (unsigned long)k + 1), kept = at[k];
        at[k] = at[j];
        at[j] = kept;
    }
}

/* Numbered along themselves, neighbours are next to each other: span 1; wherever the list of springs begins. */
TEST(shuffled_chains_are_numbered_along_themselves)
{
    for (unsigned long seed = 1; seed <= 20; seed++) {
        dem_index at[n];
        chain c;
        shuffle(at, seed);
        make_chains(&c, at);
        assert_true(renumber_span(&c.springs, NULL) > 10);
        renumber_by_distance(&c.springs, c.order, c.place);
        assert_int_equal(renumber_span(&c.springs, c.place), 1);
        for (dem_index q = 0; q < n; q++) assert_int_equal(c.place[c.order[q]], q);
        springs_free(&c.springs);
    }
}

TEST(nodes_without_springs_are_numbered_too)
{
    dem_index at[n];
    chain c;
    shuffle(at, 1);
    make_chains(&c, at);
    springs_free(&c.springs);
    c.lattice.n_springs = 0;
    assert_int_equal(springs_compile(&c.springs, &c.lattice), DEM_OK);
    renumber_by_distance(&c.springs, c.order, c.place);
    assert_int_equal(renumber_span(&c.springs, c.place), 0);
    for (dem_index q = 0; q < n; q++) assert_int_equal(c.place[c.order[q]], q);
    springs_free(&c.springs);
}

/* Along themselves, and in two rows between which they go to and fro; and without an order. */
TEST(chains_may_be_numbered_by_rows)
{
    dem_index at[n];
    chain c;
    for (int far = 0; far < 2; far++) {
        for (dem_index k = 0; k < n; k++) at[k] = far ? k % 2 * (n / 2) + k / 2 : k;
        make_chains(&c, at);
        assert_true(renumber_is_by_rows(&c.springs));
        springs_free(&c.springs);
    }
    shuffle(at, 1);
    make_chains(&c, at);
    assert_false(renumber_is_by_rows(&c.springs));
    springs_free(&c.springs);
}
