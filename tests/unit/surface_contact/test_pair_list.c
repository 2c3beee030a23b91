/* SPDX-License-Identifier: BSD-3-Clause */
/* pair_list.c, pair_rows.c, contact_surface.c: the candidates against a look at every node and edge; when the list is
 * made anew. */
#include "surface_contact/pair_list.h"

#include "curves.h"
#include "harness/cleanup_gsl.h"
#include "harness/message.h"
#include "verification/support.h"

/* A list with what it stands on, moved from rest by random ways. */
typedef struct scene {
    dem_lattice lattice;
    contact_surface surface;
    pair_list list;
    double *x;
} scene;

static void open_scene(scene *s, gsl_rng *rng, double margin, bool within_bodies)
{
    *s = (scene){.lattice = curves_make(rng, 9, 24, 2.1)};
    assert_ok(contact_surface_compile(&s->surface, &s->lattice, 0.0, 1.0));
    assert_ok(pair_list_create(&s->list, &s->surface, within_bodies, margin));
    s->x = curves_shift(rng, &s->lattice, 0.1);
}

static void close_scene(scene *s)
{
    pair_list_destroy(&s->list);
    contact_surface_free(&s->surface);
    dem_lattice_free(&s->lattice);
    free(s->x);
}

static double distance(const double *x, dem_index i, const dem_index *ends)
{
    return contact_pair_distance(vec2_at(x, i), vec2_at(x, ends[0]), vec2_at(x, ends[1]));
}

/* Whether a pair belongs into the list, from the lattice alone: edge k of body b is side k of its outline. */
static bool is_candidate(const scene *s, dem_index i, dem_index edge, bool within_bodies)
{
    const dem_index *ends = &s->surface.surface.ends[2 * edge], n = 24;
    const double thickness =
        fmin(s->surface.laws[s->lattice.body[i]].thickness, s->surface.laws[s->lattice.body[ends[0]]].thickness);
    if (i % (n + 1) == 0 || i == ends[0] || i == ends[1]) return false; /* a middle, or an end */
    if (distance(s->x, i, ends) > thickness + s->list.margin) return false;
    if (s->lattice.body[i] != s->lattice.body[ends[0]]) return true;
    return within_bodies && distance(s->lattice.x, i, ends) >= thickness;
}

/* Whether an edge of a node's own body is one that the node never touches: its own, or one near it at rest. */
static bool is_never_touched(const scene *s, dem_index i, dem_index edge)
{
    const dem_index *ends = &s->surface.surface.ends[2 * edge];
    return s->lattice.body[i] == s->lattice.body[ends[0]] &&
           (i == ends[0] || i == ends[1] ||
            distance(s->lattice.x, i, ends) < s->surface.laws[s->lattice.body[i]].thickness);
}

static void check_list(const scene *s, bool within_bodies)
{
    const pair_rows *r = &s->list.pairs;
    dem_index k = 0;
    for (dem_index i = 0; i < s->lattice.n_nodes; i++)
        for (dem_index edge = 0; edge < s->surface.surface.n_edges; edge++) {
            if (!is_candidate(s, i, edge, within_bodies)) continue;
            assert_true(k < r->n);
            assert_int_equal(r->list[k].nodes[CONTACT_PAIR_NODE], i);
            assert_int_equal(r->list[k].nodes[CONTACT_PAIR_FIRST], s->surface.surface.ends[2 * edge]);
            assert_int_equal(r->list[k].nodes[CONTACT_PAIR_SECOND], s->surface.surface.ends[2 * edge + 1]);
            assert_int_equal(r->list[k].nodes[CONTACT_PAIR_BEFORE],
                             s->surface.surface.ends[2 * s->surface.surface.previous[edge]]);
            assert_int_equal(r->list[k].nodes[CONTACT_PAIR_AFTER],
                             s->surface.surface.ends[2 * s->surface.surface.next[edge] + 1]);
            assert_int_equal(r->list[k].ends_at_first, is_never_touched(s, i, s->surface.surface.previous[edge]));
            assert_int_equal(r->list[k].ends_at_second, is_never_touched(s, i, s->surface.surface.next[edge]));
            k++;
        }
    assert_int_equal(k, r->n);
}

/* Each slot is in the row of its node, and rows are ascending. */
static void check_rows(const pair_rows *r)
{
    dem_index n = 0;
    for (dem_index i = 0; i < r->n_nodes; i++)
        for (dem_index slot = r->first[i], last = -1; slot >= 0; last = slot, slot = r->next[slot], n++) {
            assert_true(slot > last);
            assert_int_equal(pair_rows_pair(r, slot)->nodes[pair_rows_which(slot)], i);
        }
    assert_int_equal(n, CONTACT_PAIR_NODES * r->n);
}

TEST(the_list_has_every_pair_that_is_near_in_the_order_of_node_and_edge)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    for (int turn = 0; turn < 12; turn++) {
        CLEANUP(close_scene) scene s;
        open_scene(&s, rng, turn % 3 == 0 ? 0.02 : 0.15 * turn, turn % 2 == 0);
        assert_ok(pair_list_follow(&s.list, s.x, 0.0));
        assert_true(s.list.pairs.n > 10);
        check_list(&s, turn % 2 == 0);
        check_rows(&s.list.pairs);
    }
}

/* An edge a hundred cells long goes through the cells piece by piece. */
TEST(a_long_edge_finds_the_nodes_beside_it)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(close_scene) scene s;
    open_scene(&s, rng, 0.3, true);
    vec2_put(s.x, 1, (vec2){6.0, 6.5}); /* across the grid: its two edges are long, too */
    assert_ok(pair_list_follow(&s.list, s.x, 0.0));
    check_list(&s, true);
}

/* That all move alike does not count. */
TEST(the_list_holds_until_two_nodes_have_moved_by_the_margin)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(close_scene) scene s;
    open_scene(&s, rng, 0.1, true);
    assert_ok(pair_list_follow(&s.list, s.x, 0.0));
    s.x[2 * 30] += 0.04;
    s.x[2 * 31] -= 0.04;
    for (dem_index k = 0; k < 2 * s.lattice.n_nodes; k++) s.x[k] += 3.0;
    assert_ok(pair_list_follow(&s.list, s.x, 0.0));
    assert_int_equal(s.list.n_made, 1);
    assert_ok(pair_list_follow(&s.list, s.x, 0.25)); /* only 0.075 m are free then */
    assert_int_equal(s.list.n_made, 2);
    s.x[2 * 25] += 1.0; /* the middle of a body is on no edge */
    assert_ok(pair_list_follow(&s.list, s.x, 0.0));
    assert_int_equal(s.list.n_made, 2);
    s.x[2 * 30 + 1] += 0.101;
    assert_ok(pair_list_follow(&s.list, s.x, 0.0));
    assert_int_equal(s.list.n_made, 3);
    check_list(&s, true);
    check_rows(&s.list.pairs);
}

TEST(positions_that_blow_up_are_refused_and_forgotten)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(close_scene) scene s;
    open_scene(&s, rng, 0.1, true);
    const double kept = s.x[2 * 30];
    s.x[2 * 30] = 1e9;
    assert_int_equal(pair_list_follow(&s.list, s.x, 0.0), DEM_ERROR_INTEGRATOR);
    assert_message_parts("edge * nodes * 30 * its length at rest");
    assert_int_equal(s.list.pairs.n, 0);
    s.x[2 * 30] = (double)NAN;
    assert_int_equal(pair_list_follow(&s.list, s.x, 0.0), DEM_ERROR_INTEGRATOR);
    s.x[2 * 30] = kept;
    assert_ok(pair_list_follow(&s.list, s.x, 0.0));
    check_list(&s, true);
}

/* Stars that are squeezed, so that their surfaces are near each other at rest. */
TEST(pairs_near_at_rest_are_counted_and_left_out)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(dem_lattice_free) dem_lattice lattice = curves_make(rng, 9, 24, 2.5);
    for (dem_index i = 0; i < lattice.n_nodes; i++) lattice.x[2 * i] *= 0.005;
    for (int within = 0; within < 2; within++) {
        contact_surface of;
        pair_list list;
        dem_index n = 0, counted;
        assert_ok(contact_surface_compile(&of, &lattice, 0.0, 1.0));
        assert_ok(pair_list_create(&list, &of, within, 0.01));
        for (dem_index k = 0; k < of.n_nodes; k++)
            for (dem_index e = 0; e < of.surface.n_edges; e++) {
                const dem_index *ends = &of.surface.ends[2 * e], i = of.nodes[k];
                const bool own = lattice.body[i] == lattice.body[ends[0]] && i != ends[0] && i != ends[1];
                n += own && distance(lattice.x, i, ends) < of.laws[lattice.body[i]].thickness;
            }
        assert_ok(pair_list_count_left_out(&list, &counted));
        assert_true(n > 10);
        assert_int_equal(counted, within ? n : 0);
        pair_list_destroy(&list);
        contact_surface_free(&of);
    }
}
