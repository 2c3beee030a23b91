/* SPDX-License-Identifier: BSD-3-Clause */
/* friction_pattern.c: both momenta, what the node gets, what is summed over the nodes, and that a node which goes round
 * the vertices of a surface meets no jump. */
#include "surface_contact/friction_pattern.h"

#include <gsl/gsl_math.h>
#include <gsl/gsl_rng.h>

#include "../close.h"
#include "harness/cleanup_gsl.h"

enum { N = 2 * CONTACT_PAIR_NODES };

/* The node, A, B, the node before A, the node after B. */
static const contact_pair pair = {.nodes = {0, 1, 2, 3, 4}, .thickness = 1.0, .weight = 1.0};

static double draw(gsl_rng *rng, double from, double to)
{
    return from + (to - from) * gsl_rng_uniform(rng);
}

/* Edges of an outline that is convex, and a node that an edge of it pushes or a vertex. */
static void draw_push(gsl_rng *rng, double *x, contact_push *push)
{
    static const double middle[N] = {1.0, -0.6, 0.0, 0.0, 2.0, 0.0, -2.0, 2.0, 4.0, 2.0};
    do {
        for (int c = 0; c < N; c++) x[c] = middle[c] + draw(rng, -0.3, 0.3);
        x[0] += draw(rng, -1.5, 0.5);
    } while (!contact_pair_push(&pair, x, push) || vec2_norm(contact_push_on(push, CONTACT_PAIR_NODE)) < 0.01);
}

/* To the rounding of vectors and places of some units. */
TEST(vectors_and_moments_sum_up_to_nothing)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    int n_by_vertex = 0;
    for (int k = 0; k < 1000; k++) {
        double x[N], moment = 0.0;
        contact_push push;
        vec2 sum = {0.0, 0.0};
        draw_push(rng, x, &push);
        n_by_vertex += vec2_norm(push.by_vertex) > 0.0;
        const friction_pattern p = friction_pattern_make(&push, x);
        for (int which = 0; which < CONTACT_PAIR_NODES; which++) {
            assert_int_equal(p.nodes[which], which);
            sum = vec2_add(sum, p.at[which]);
            moment += vec2_cross(vec2_at(x, which), p.at[which]);
        }
        const double size = 1.0 + vec2_norm(p.at[CONTACT_PAIR_NODE]);
        assert_close(vec2_norm(sum), 0.0, 1e-15 * size);
        assert_close(moment, 0.0, 1e-14 * size);
    }
    assert_true(n_by_vertex > 100 && n_by_vertex < 900);
}

/* In front of the middle of an edge along x, which pushes it with 1/6 N at 2/3 of the thickness. */
TEST(the_node_has_the_push_turned_to_the_left)
{
    const double x[N] = {1.0, -2.0 / 3.0, 0.0, 0.0, 2.0, 0.0, -2.0, 0.0, 4.0, 0.0};
    contact_push push;
    assert_true(contact_pair_push(&pair, x, &push));
    const friction_pattern p = friction_pattern_make(&push, x), twice = friction_pattern_scale(2.0, &p);
    assert_close(p.at[CONTACT_PAIR_NODE].x, 1.0 / 6.0, 1e-15);
    assert_close(p.at[CONTACT_PAIR_NODE].y, 0.0, 0.0);
    /* A moment of 1/6 N times 2/3 m: a quarter of it on the edge before, half on this one, a quarter on the next. */
    const double couple = 1.0 / 18.0;
    const double across[CONTACT_PAIR_NODES] = {0.0, 0.25 * couple, -0.25 * couple, 0.25 * couple, -0.25 * couple};
    for (int which = 1; which < CONTACT_PAIR_NODES; which++) {
        assert_close(p.at[which].x, which <= CONTACT_PAIR_SECOND ? -1.0 / 12.0 : 0.0, 1e-15);
        assert_close(p.at[which].y, across[which], 1e-15);
        assert_close(twice.at[which].y, 2.0 * p.at[which].y, 0.0);
    }
    const double v[N] = {3.0, 1.0}, x0[N] = {-2.0, -5.0 / 3.0, 0.0, 0.0, 2.0, 0.0, -2.0, 0.0, 4.0, 0.0};
    assert_close(friction_pattern_dot(&p, v), 0.5, 1e-15);
    assert_close(friction_pattern_way(&p, x0, x), 0.5, 1e-15);
}

/* ---- no jumps ---- */

/* Nodes 1 to 7 are along a surface, the middle one at the origin, and node 0 goes round it. */
enum { ALONG = 7, PLACES = 1 + ALONG };

/* The sum of the patterns of all edges. */
static void pattern_at(const double *x, vec2 sum[PLACES])
{
    for (int i = 0; i < PLACES; i++) sum[i] = (vec2){0.0, 0.0};
    for (dem_index first = 2; first + 2 <= ALONG; first++) {
        const contact_pair p = {.nodes = {0, first, first + 1, first - 1, first + 2}, .thickness = 1.0, .weight = 1.0};
        contact_push push;
        if (!contact_pair_push(&p, x, &push)) continue;
        const friction_pattern pattern = friction_pattern_make(&push, x);
        for (int which = 0; which < CONTACT_PAIR_NODES; which++)
            sum[p.nodes[which]] = vec2_add(sum[p.nodes[which]], pattern.at[which]);
    }
}

/* The greatest change of any vector in one of n steps round the vertex at which the surface turns, as far as the node
 * is well in front of both edges. */
static double greatest_jump(double turn, int n)
{
    double most = 0.0, x[2 * PLACES];
    vec2 last[PLACES], now[PLACES];
    const vec2 before = {-cos(0.5 * turn), sin(0.5 * turn)}, after = {cos(0.5 * turn), sin(0.5 * turn)};
    for (int i = 1; i <= ALONG; i++)
        vec2_put(x, i, vec2_scale(2.0 * abs(i - ALONG / 2 - 1), i <= ALONG / 2 ? before : after));
    for (int k = 0; k <= n; k++) {
        const double angle = -0.5 * M_PI + (0.5 * M_PI - 0.6 + 0.5 * turn) * (2.0 * k / n - 1.0);
        vec2_put(x, 0, vec2_scale(0.6, (vec2){cos(angle), sin(angle)}));
        pattern_at(x, now);
        for (int i = 0; i < PLACES && k > 0; i++) most = fmax(most, vec2_norm(vec2_sub(now[i], last[i])));
        for (int i = 0; i < PLACES; i++) last[i] = now[i];
    }
    return most;
}

/* A jump would be as large with half of the steps. The surface is straight, or turns at a convex or concave vertex. */
TEST(a_node_that_passes_a_vertex_meets_no_jump)
{
    static const double turns[3] = {0.0, 0.8, -0.8};
    for (int k = 0; k < 3; k++) {
        const double coarse = greatest_jump(turns[k], 10000), fine = greatest_jump(turns[k], 20000);
        assert_true(coarse < 2e-3 && fine < 0.51 * coarse);
    }
}
