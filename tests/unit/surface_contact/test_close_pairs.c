/* SPDX-License-Identifier: BSD-3-Clause */
/* close_pairs.c: which candidates are close, until when they hold, and that no step said to be without a crossing has
 * one. */
#include "surface_contact/close_pairs.h"

#include "curves.h"
#include "harness/cleanup_gsl.h"
#include "surface_contact/pair_list.h"
#include "verification/support.h"

static const double margin = 0.05, wide = 0.5; /* m */

/* Stars side by side with a random shift of all nodes, all their candidates, and those which are close. Candidates are
 * nearer than the thickness and `around`, m. */
typedef struct scene {
    dem_lattice lattice;
    contact_surface surface;
    pair_list list;
    close_pairs close;
    double *x, *x1;
} scene;

static void open_scene(scene *s, gsl_rng *rng, double around)
{
    *s = (scene){.lattice = curves_make(rng, 9, 24, 2.1)};
    assert_ok(contact_surface_compile(&s->surface, &s->lattice, 0.0, 1.0));
    assert_ok(pair_list_create(&s->list, &s->surface, true, around));
    close_pairs_create(&s->close, &s->surface, &s->list.pairs);
    s->x = curves_shift(rng, &s->lattice, 0.1);
    s->x1 = malloc(2 * (size_t)s->lattice.n_nodes * sizeof *s->x1);
    assert_false(close_pairs_hold(&s->close, s->x));
    assert_ok(pair_list_follow(&s->list, s->x, 0.0));
    assert_ok(close_pairs_choose(&s->close, margin, s->x));
}

static void close_scene(scene *s)
{
    close_pairs_destroy(&s->close);
    pair_list_destroy(&s->list);
    contact_surface_free(&s->surface);
    dem_lattice_free(&s->lattice);
    free(s->x);
    free(s->x1);
}

TEST(close_pairs_are_the_candidates_within_the_margin_in_their_order)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(close_scene) scene s;
    dem_index n = 0;
    open_scene(&s, rng, wide);
    double least = s.surface.least.thickness;
    for (dem_index k = 0; k < s.list.pairs.n; k++) {
        const contact_pair *p = &s.list.pairs.list[k];
        const double gap = contact_pair_gap(p, s.x);
        least = fmin(least, gap);
        if (gap > p->thickness + margin) continue;
        assert_true(n < s.close.n);
        assert_memory_equal(s.close.list[n++].nodes, p->nodes, sizeof p->nodes);
    }
    assert_int_equal(s.close.n, n);
    assert_true(n > 20 && n < s.list.pairs.n);
    assert_true(s.close.least == least);
}

/* That all move alike does not count. */
TEST(they_hold_until_two_nodes_have_moved_by_the_margin)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(close_scene) scene s;
    open_scene(&s, rng, wide);
    for (dem_index k = 0; k < 2 * s.lattice.n_nodes; k++) s.x[k] += 3.0;
    s.x[2 * 30] += 0.024;
    s.x[2 * 31] -= 0.024;
    assert_true(close_pairs_hold(&s.close, s.x));
    s.x[2 * 31] -= 0.003;
    assert_false(close_pairs_hold(&s.close, s.x));
}

/* Steps of all sizes, so that each answer comes often. */
TEST(no_node_crosses_an_edge_where_surfaces_are_said_to_stay_apart)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    int n_apart = 0, n_crossed = 0;
    for (int turn = 0; turn < 400; turn++) {
        CLEANUP(close_scene) scene s;
        open_scene(&s, rng, wide);
        const double size = 0.1 * pow(10.0, -4.0 * gsl_rng_uniform(rng));
        bool crosses = false;
        for (dem_index k = 0; k < 2 * s.lattice.n_nodes; k++) s.x1[k] = s.x[k] + size * (gsl_rng_uniform(rng) - 0.5);
        for (dem_index k = 0; k < s.list.pairs.n; k++) {
            double when;
            crosses = crosses || contact_pair_crosses(&s.list.pairs.list[k], s.x, s.x1, &when);
        }
        const bool apart = close_pairs_stay_apart(&s.close, s.x, s.x1);
        assert_false(apart && crosses);
        assert_true(apart == close_pairs_stay_apart(&s.close, s.x1, s.x)); /* the way back is the same */
        n_apart += apart;
        n_crossed += crosses;
    }
    assert_true(n_apart > 20 && n_crossed > 20);
}

/* Nodes are looked at in twos, so that a neighbour of what is in a pair counts, too. */
TEST(what_is_in_no_candidate_crosses_nothing)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(close_scene) scene s;
    dem_index n = 0;
    open_scene(&s, rng, margin);
    const pair_rows *pairs = &s.list.pairs;
    memcpy(s.x1, s.x, 2 * (size_t)s.lattice.n_nodes * sizeof *s.x);
    for (dem_index k = 1; k + 1 < s.lattice.n_nodes; k++) {
        if (pair_rows_has(pairs, k - 1) || pair_rows_has(pairs, k) || pair_rows_has(pairs, k + 1)) continue;
        s.x1[2 * k] += 0.5;
        n++;
    }
    assert_true(n > 2);
    assert_true(close_pairs_stay_apart(&s.close, s.x, s.x1));
    assert_false(close_pairs_hold(&s.close, s.x1));
    s.x1[2 * pairs->list[0].nodes[CONTACT_PAIR_NODE]] += 0.5;
    assert_false(close_pairs_stay_apart(&s.close, s.x, s.x1));
}

/* Other candidates have other nodes: the first star comes to where the third one is. */
TEST(nodes_of_new_candidates_are_looked_at_for_crossings)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(close_scene) scene s;
    dem_index n = 0;
    open_scene(&s, rng, margin);
    CLEANUP(free_memory) unsigned char *was = calloc((size_t)s.lattice.n_nodes, 1);
    for (dem_index i = 0; i < s.lattice.n_nodes; i++) was[i] = pair_rows_has(&s.list.pairs, i);
    for (dem_index i = 0; i < s.lattice.n_nodes; i++)
        if (s.lattice.body[i] == 0) s.x[2 * i] += 4.2;
    assert_ok(pair_list_follow(&s.list, s.x, 0.0));
    assert_ok(close_pairs_choose(&s.close, margin, s.x));
    for (dem_index i = 1; i + 1 < s.lattice.n_nodes; i++) {
        if (was[i - 1] || was[i] || was[i + 1] || !pair_rows_has(&s.list.pairs, i)) continue;
        memcpy(s.x1, s.x, 2 * (size_t)s.lattice.n_nodes * sizeof *s.x);
        s.x1[2 * i] += 0.5;
        assert_false(close_pairs_stay_apart(&s.close, s.x, s.x1));
        n++;
    }
    assert_true(n > 2);
}
