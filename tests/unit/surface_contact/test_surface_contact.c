/* SPDX-License-Identifier: BSD-3-Clause */
/* surface_contact.c: forces of all nodes against the gradient of the energy and against those of single nodes, pairs
 * near in a step, and what a step must not do. */
#include "surface_contact/surface_contact.h"

#include "curves.h"
#include "evaluated.h"
#include "harness/cleanup_gsl.h"
#include "verification/support.h"

typedef struct scene {
    dem_lattice lattice;
    surface_contact *contact;
    double *x, *inverse_mass;
} scene;

/* Stars side by side with a random shift of all nodes, so that many surfaces are near each other and some cross. */
static void open_scene(scene *s, gsl_rng *rng, double margin)
{
    const surface_contact_rule rule = {.within_bodies = true, .stiffness = 1.0, .margin = margin};
    *s = (scene){.lattice = curves_make(rng, 9, 24, 2.1)};
    const size_t n = (size_t)s->lattice.n_nodes;
    assert_ok(surface_contact_create(&s->contact, &s->lattice, &rule));
    s->x = curves_shift(rng, &s->lattice, 0.1);
    s->inverse_mass = malloc(n * sizeof *s->inverse_mass);
    for (size_t k = 0; k < n; k++) s->inverse_mass[k] = 1.0 + 0.5 * sin((double)k);
}

static void close_scene(scene *s)
{
    surface_contact_destroy(s->contact);
    dem_lattice_free(&s->lattice);
    free(s->x);
    free(s->inverse_mass);
}

/* Every fifth triangle, which then fills the gap between its neighbours.  \return how many pairs of those push */
static dem_index break_some(const scene *s)
{
    CLEANUP(mesh_boundary_free) mesh_boundary boundary;
    CLEANUP(free_memory) unsigned char *broken = calloc((size_t)s->lattice.n_triangles, 1);
    contact_push push;
    dem_index n = 0;
    assert_non_null(broken);
    for (dem_index t = 0; t < s->lattice.n_triangles; t += 5) broken[t] = 1;
    assert_ok(mesh_boundary_create(&boundary, &s->lattice, broken));
    assert_ok(surface_contact_break(s->contact, &boundary, broken, NULL));
    surface_contact_keep(s->contact);
    assert_ok(surface_contact_follow(s->contact, s->x));
    const pair_rows *r = &s->contact->candidates.pairs;
    for (dem_index k = 0; k < r->n; k++) n += r->list[k].fills && contact_pair_push(&r->list[k], s->x, &push);
    return n;
}

/* By differences of fourth order, relative to the force. Places of up to 6 m are rounded by 9e-16 m, which is 1e-9 of
 * the steps h = 1e-6 m; found is 1.4e-10. */
TEST(forces_are_minus_the_gradient_of_the_energy)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(close_scene) scene s;
    open_scene(&s, rng, 0.0);
    assert_true(break_some(&s) > 10);
    assert_true(surface_contact_evaluate(s.contact, s.x));
    assert_true(evaluated_pushed(s.contact) > 20);
    for (dem_index c = 0; c < 2 * s.lattice.n_nodes; c++) {
        const double h = 1e-6, here = s.x[c], steps[4] = {h, -h, 2.0 * h, -2.0 * h};
        double energy[4];
        for (int k = 0; k < 4; k++) {
            s.x[c] = here + steps[k];
            energy[k] = surface_contact_energy(s.contact, s.x);
        }
        s.x[c] = here;
        const double expected = -(8.0 * (energy[0] - energy[1]) - (energy[2] - energy[3])) / (12.0 * h);
        const vec2 force = evaluated_force(s.contact, c / 2);
        const double actual = c % 2 == 0 ? force.x : force.y;
        assert_close(actual, expected, 1e-9 * (1.0 + fabs(actual)));
    }
}

/* With all candidates, and with the pairs that are near in a step: nodes have the same bits, and those on which nothing
 * acts are left alone. */
static void check_single_nodes(const scene *s)
{
    for (dem_index i = 0; i < s->lattice.n_nodes; i++) {
        vec2 force;
        const bool is_pushed = surface_contact_force(s->contact, i, s->x, &force);
        const vec2 expected = evaluated_force(s->contact, i);
        assert_true(is_pushed == surface_contact_acts(expected));
        assert_true(force.x == expected.x && force.y == expected.y);
    }
}

TEST(single_nodes_have_the_bits_of_all)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    for (int turn = 0; turn < 10; turn++) {
        CLEANUP(close_scene) scene s;
        open_scene(&s, rng, 0.0);
        if (turn % 2 == 1) assert_true(break_some(&s) > 10);
        assert_true(surface_contact_evaluate(s.contact, s.x));
        assert_true(surface_contact_evaluate(s.contact, s.x)); /* what the first one left does not matter */
        check_single_nodes(&s);
        assert_ok(surface_contact_begin_step(s.contact, s.x, s.x));
        assert_true(s.contact->rows == &s.contact->near && s.contact->near.n < s.contact->candidates.pairs.n);
        check_single_nodes(&s);
    }
}

/* Which pairs are near depends on the motion alone, so that local corrections have the same nodes with any list that
 * has room for the way in the step, 0.03 of the mean edge here. */
TEST(pairs_near_in_a_step_do_not_depend_on_the_margin)
{
    const double margins[3] = {0.08, 0.25, 1.5};
    enum { ROOM = 4096 };
    static contact_pair near[ROOM];
    dem_index n_near = 0;
    for (int k = 0; k < 3; k++) {
        CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
        CLEANUP(close_scene) scene s;
        open_scene(&s, rng, margins[k]);
        assert_true(break_some(&s) > 10);
        CLEANUP(free_memory) double *x1 = malloc(2 * (size_t)s.lattice.n_nodes * sizeof *x1);
        for (dem_index c = 0; c < 2 * s.lattice.n_nodes; c++) x1[c] = s.x[c] + 0.004 * sin((double)c);
        assert_ok(surface_contact_begin_step(s.contact, s.x, x1));
        const pair_rows *found = &s.contact->near;
        if (k == 0) {
            n_near = found->n;
            assert_true(n_near > 20 && n_near <= ROOM);
            memcpy(near, found->list, (size_t)n_near * sizeof *near);
        }
        assert_int_equal(found->n, n_near);
        for (dem_index j = 0; j < n_near; j++)
            assert_memory_equal(found->list[j].nodes, near[j].nodes, sizeof near->nodes);
    }
}

/* The diagonal of the stiffness by differences of the forces is never above the bound, which is about twice the largest
 * one. */
TEST(the_bound_of_the_stiffness_holds)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(close_scene) scene s;
    double largest = 0.0;
    open_scene(&s, rng, 0.0);
    const double bound = surface_contact_stiffening(s.contact, s.inverse_mass, 0.0, s.x, false);
    for (dem_index c = 0; c < 2 * s.lattice.n_nodes; c++) {
        const double h = 1e-8, here = s.x[c];
        double force[2];
        for (int k = 0; k < 2; k++) {
            s.x[c] = here + (k == 0 ? -h : h);
            assert_true(surface_contact_evaluate(s.contact, s.x));
            const vec2 here_force = evaluated_force(s.contact, c / 2);
            force[k] = c % 2 == 0 ? here_force.x : here_force.y;
        }
        s.x[c] = here;
        largest = fmax(largest, (force[0] - force[1]) / (2.0 * h) * s.inverse_mass[c / 2]);
    }
    assert_true(largest < bound);
    assert_true(largest > 0.2 * bound);
}

/* Only what is harmless is left out, and at last all of it is: the nearest pair is at a thousandth of the thickness or
 * more. */
TEST(a_stiffness_is_left_out_only_where_it_is_harmless)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    int n_found = 0;
    for (int turn = 0; turn < 10; turn++) {
        CLEANUP(close_scene) scene s;
        open_scene(&s, rng, 0.0);
        assert_true(surface_contact_evaluate(s.contact, s.x));
        const double all = surface_contact_stiffening(s.contact, s.inverse_mass, 0.0, s.x, false);
        for (double harmless = 1e-3 * all; harmless < 1e9 * all; harmless *= 1.5) {
            const double found = surface_contact_stiffening(s.contact, s.inverse_mass, harmless, s.x, true);
            s.contact->is_evaluated = false; /* looks at all pairs again */
            const double again = surface_contact_stiffening(s.contact, s.inverse_mass, harmless, s.x, true);
            assert_true(surface_contact_evaluate(s.contact, s.x) && found == again);
            assert_true(found == all || (found == 0.0 && all <= harmless));
            n_found += found == all;
        }
        assert_true(surface_contact_stiffening(s.contact, s.inverse_mass, 1e9 * all, s.x, true) == 0.0);
    }
    assert_true(n_found > 10 * 17); /* those below `all` at least: log(1e3)/log(1.5) = 17.04 each */
}

/* ---- steps ---- */

/* Two triangles, one over the other: nodes 0 1 2 and 3 4 5, the tip 3 is above the edge from 1 to 2. */
static void open_triangles(scene *s, double gap)
{
    *s = (scene){.lattice = dem_lattice_empty()};
    const double x[12] = {0.0, -1.0, 1.0, 0.0, -1.0, 0.0, 0.0, 0.15, 1.0, 1.15, -1.0, 1.15};
    const dem_index corners[6] = {0, 1, 2, 3, 4, 5};
    const surface_contact_rule rule = {.within_bodies = true, .thickness = 0.2, .stiffness = 1.0};
    s->lattice.n_nodes = s->lattice.n_springs = 6;
    s->lattice.n_triangles = 2;
    s->lattice.x = calloc(12, sizeof *s->lattice.x);
    s->lattice.flags = calloc(6, sizeof *s->lattice.flags);
    s->lattice.body = calloc(6, sizeof *s->lattice.body);
    s->lattice.triangles = calloc(6, sizeof *s->lattice.triangles);
    s->lattice.ends = calloc(12, sizeof *s->lattice.ends);
    s->lattice.stiffness = calloc(6, sizeof *s->lattice.stiffness);
    s->lattice.rest_length = calloc(6, sizeof *s->lattice.rest_length);
    s->x = calloc(12, sizeof *s->x);
    memcpy(s->lattice.x, x, sizeof x);
    memcpy(s->lattice.triangles, corners, sizeof corners);
    for (dem_index i = 0; i < 6; i++) {
        s->lattice.body[i] = i < 3 ? 0 : 1;
        s->lattice.ends[2 * i] = i;
        s->lattice.ends[2 * i + 1] = i % 3 < 2 ? i + 1 : i - 2;
        s->lattice.stiffness[i] = s->lattice.rest_length[i] = 1.0;
    }
    memcpy(s->x, x, sizeof x);
    s->x[7] = gap;
    assert_ok(surface_contact_create(&s->contact, &s->lattice, &rule));
    assert_ok(surface_contact_follow(s->contact, s->x));
}

TEST(a_crossing_is_found_with_its_node_its_edge_and_its_time)
{
    CLEANUP(close_scene) scene s;
    open_triangles(&s, 0.15);
    surface_crossing crossing;
    double x1[12];
    memcpy(x1, s.x, sizeof x1);
    x1[7] = -0.05;
    assert_ok(surface_contact_begin_step(s.contact, s.x, x1));
    assert_int_equal(surface_contact_check_step(s.contact, s.x, x1, &crossing), SURFACE_CONTACT_CROSSED);
    assert_int_equal(crossing.pair.nodes[CONTACT_PAIR_NODE], 3);
    assert_int_equal(crossing.pair.nodes[CONTACT_PAIR_FIRST], 1);
    assert_int_equal(crossing.pair.nodes[CONTACT_PAIR_SECOND], 2);
    assert_close(crossing.part, 0.75, 1e-15);
    x1[7] = 0.05;
    assert_ok(surface_contact_begin_step(s.contact, s.x, x1));
    assert_int_equal(surface_contact_check_step(s.contact, s.x, x1, &crossing), SURFACE_CONTACT_SOUND);
}

/* The step itself keeps the tip beyond the thickness and the margin of near pairs; events move it to where
 * the edge pushes it. */
TEST(what_events_bring_near_beyond_the_step_is_found)
{
    CLEANUP(close_scene) scene s;
    open_triangles(&s, 0.4);
    surface_crossing crossing;
    double x1[12];
    memcpy(x1, s.x, sizeof x1);
    assert_ok(surface_contact_begin_step(s.contact, s.x, x1));
    assert_int_equal(s.contact->near.n, 0);
    assert_int_equal(surface_contact_check_step(s.contact, s.x, x1, &crossing), SURFACE_CONTACT_SOUND);
    x1[7] = 0.19;
    assert_int_equal(surface_contact_check_step(s.contact, s.x, x1, &crossing), SURFACE_CONTACT_OUTGROWN);
}
