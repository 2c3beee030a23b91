/* SPDX-License-Identifier: BSD-3-Clause */
/* surface_ways.c: against the distances of all nodes from each other, for few bodies and for many. */
#include "surface_contact/surface_ways.h"

#include "curves.h"
#include "harness/cleanup_gsl.h"
#include "verification/support.h"

static const double reach = 0.5; /* m */

/* Stars on a grid, a state noted, and another one. */
typedef struct scene {
    dem_lattice lattice;
    contact_surface surface;
    surface_ways ways;
    double *x;
} scene;

static void open_scene(scene *s, gsl_rng *rng, dem_index n_bodies, double step)
{
    *s = (scene){.lattice = curves_make(rng, n_bodies, 9, step)};
    const size_t size = 2 * (size_t)s->lattice.n_nodes * sizeof *s->x;
    assert_ok(contact_surface_compile(&s->surface, &s->lattice, 0.0, 1.0));
    s->ways.surface = &s->surface;
    assert_ok(surface_ways_note(&s->ways, reach, s->lattice.x));
    s->x = malloc(size);
    memcpy(s->x, s->lattice.x, size);
}

static void close_scene(scene *s)
{
    surface_ways_destroy(&s->ways);
    contact_surface_free(&s->surface);
    dem_lattice_free(&s->lattice);
    free(s->x);
}

static double distance(const double *x, dem_index i, dem_index j)
{
    return vec2_norm(vec2_sub(vec2_at(x, i), vec2_at(x, j)));
}

/* Whether no two nodes of the surface have come nearer than they may. */
static bool are_within(const scene *s, double most)
{
    const contact_surface *c = &s->surface;
    const double rounding = 1e-12;
    for (dem_index k = 0; k < c->n_nodes; k++)
        for (dem_index m = 0; m < k; m++) {
            const double now = distance(s->x, c->nodes[k], c->nodes[m]);
            const double before = distance(s->lattice.x, c->nodes[k], c->nodes[m]);
            if (now < before - most - rounding && now < reach - most - rounding) return false;
        }
    return true;
}

static void move_body(scene *s, dem_index body, vec2 way)
{
    for (dem_index i = 0; i < s->lattice.n_nodes; i++)
        if (s->lattice.body[i] == body) vec2_put(s->x, i, vec2_add(vec2_at(s->x, i), way));
}

static vec2 random_way(gsl_rng *rng, double size)
{
    const double x = size * (gsl_rng_uniform(rng) - 0.5);
    return (vec2){x, size * (gsl_rng_uniform(rng) - 0.5)};
}

/* Bodies fly in all directions and lose their shapes, by ways of all sizes. One body is one group, so are 40. */
TEST(nothing_has_come_nearer_than_is_said)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    static const dem_index bodies[3] = {1, 5, 40};
    int n_within = 0, n_not = 0, n_nearer = 0;
    for (int turn = 0; turn < 300; turn++) {
        CLEANUP(close_scene) scene s;
        open_scene(&s, rng, bodies[turn % 3], turn % 2 == 0 ? 2.1 : 12.0);
        const double flight = 20.0 * pow(10.0, -3.0 * gsl_rng_uniform(rng)), shape = 0.1 * gsl_rng_uniform(rng);
        for (dem_index b = 0; b < bodies[turn % 3]; b++) move_body(&s, b, random_way(rng, flight));
        for (dem_index i = 0; i < s.lattice.n_nodes; i++)
            vec2_put(s.x, i, vec2_add(vec2_at(s.x, i), random_way(rng, shape)));
        const bool within = surface_ways_within(&s.ways, 0.2, s.x), right = are_within(&s, 0.2);
        const double longest = surface_ways_longest(&s.ways, s.x);
        assert_true(right || !within);
        assert_true(surface_ways_within(&s.ways, longest, s.x) && !surface_ways_within(&s.ways, 0.999 * longest, s.x));
        n_within += within;
        n_not += !within;
        n_nearer += !right;
    }
    assert_true(n_within > 50 && n_not > 50 && n_nearer > 20);
}

/* Bodies of 2 m, 10 m apart, of which only neighbours that come into reach count. */
TEST(bodies_far_apart_may_move_until_they_are_in_reach)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(close_scene) scene s;
    open_scene(&s, rng, 2, 12.0);
    move_body(&s, 1, (vec2){-9.0, 0.0});
    assert_true(surface_ways_within(&s.ways, 0.1, s.x));
    vec2_put(s.x, 5, vec2_add(vec2_at(s.x, 5), (vec2){0.0, 0.11}));
    assert_false(surface_ways_within(&s.ways, 0.1, s.x));
    vec2_put(s.x, 5, vec2_at(s.lattice.x, 5));
    move_body(&s, 1, (vec2){-1.0, 0.0});
    assert_false(surface_ways_within(&s.ways, 0.1, s.x));
    assert_ok(surface_ways_note(&s.ways, reach, s.x));
    assert_true(surface_ways_within(&s.ways, 0.1, s.x));
    move_body(&s, 1, (vec2){0.2, 0.0});
    assert_false(surface_ways_within(&s.ways, 0.1, s.x));
    move_body(&s, 0, (vec2){0.15, 0.0});
    assert_true(surface_ways_within(&s.ways, 0.1, s.x));
}

/* The box of vectors in all directions is larger than the largest difference by a square's diagonal at most. */
TEST(no_two_nodes_differ_by_more_than_the_spread)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(close_scene) scene s;
    open_scene(&s, rng, 5, 12.0);
    const contact_surface *c = &s.surface;
    for (dem_index i = 0; i < s.lattice.n_nodes; i++) vec2_put(s.x, i, random_way(rng, 4.0));
    double largest = 0.0;
    for (dem_index k = 0; k < c->n_nodes; k++)
        for (dem_index m = 0; m < k; m++) largest = fmax(largest, distance(s.x, c->nodes[k], c->nodes[m]));
    const double spread = surface_ways_spread(&s.ways, s.x);
    assert_true(spread >= largest && spread <= sqrt(2.0) * largest);
}
