/* SPDX-License-Identifier: BSD-3-Clause */
/* probes.c: from &probe groups to nodes and springs, and what is wrong with them. */
#include "unit/reading.h"

#include <math.h>
#include <stdlib.h>

#include "harness/slab_cut.h"
#include "probes.h"
#include "unit/close.h"
#include "unit/solids.h"

#define HEAD "&run t_end = 1 / &body shape = 'disc' / &body shape = 'disc' /\n"

static void assert_refused(const char *groups, const char *expected)
{
    char text[1024], got[2048];
    (void)snprintf(text, sizeof text, HEAD "%s", groups);
    resolved r = resolve_clean(text);
    probes_check(&r.deck, &r.errors);
    list_faults(&r.errors, got, sizeof got);
    drop_resolved(&r);
    assert_string_equal(got, expected);
}

TEST(names_are_different_words)
{
    assert_refused("&probe name = 'a', place = 0, 0 / &probe name = 'B-2_c', number = 3 /", "");
    assert_refused("&probe name = '', place = 0, 0 /",
                   "2:8 'name' in &probe must have 1 to 63 letters, digits, '_' or '-'");
    assert_refused("&probe name = 'a/b', place = 0, 0 /",
                   "2:8 'name' in &probe must have 1 to 63 letters, digits, '_' or '-'");
    assert_refused("&probe name = 'a', place = 0, 0 /\n&probe name = 'a', number = 1 /",
                   "3:8 two probes have the name 'a', the first in line 2");
}

TEST(a_place_or_a_number_says_what_is_probed)
{
    assert_refused("&probe name = 'a' /", "2:1 &probe needs 'place' or 'number'");
    assert_refused("&probe name = 'a', place = 0, 0, number = 1 /", "2:20 &probe needs 'place' or 'number', not both");
    assert_refused("&probe name = 'a', number = 1, body = 2 /", "2:32 'body' in &probe is not used with 'number'");
    assert_refused("&probe name = 'a', place = 0, 0, body = 3 /", "2:34 'body' in &probe is 3, but there are only 2");
}

TEST(a_gauge_has_two_ends_and_others_one)
{
    assert_refused("&probe name = 'a', kind = 'gauge', place = 0, 0 /",
                   "2:36 'place' in &probe expects 4 values for kind 'gauge', got 2");
    assert_refused("&probe name = 'a', kind = 'gauge', number = 4 /",
                   "2:36 'number' in &probe expects 2 values for kind 'gauge', got 1");
    assert_refused("&probe name = 'a', kind = 'spring', number = 4, 5 /",
                   "2:37 'number' in &probe expects 1 value for kind 'spring', got 2");
    assert_refused("&probe name = 'a', place = 0, 0, 1 /",
                   "2:20 'place' in &probe expects 2 values for kind 'node', got 3");
}

/* ---- what is nearest ---- */

/* Two blocks of 3 m x 2 rows: the first at rest in its own coordinates, the second turned by 90 degrees and shifted. */
typedef struct scene {
    dem_lattice lattice;
    placement bodies[2];
    resolved deck;
    dem_probe *probes;
    double (*places)[2];
    size_t n;
} scene;

/* In one slab, or in two of the first `first` nodes and the others. */
static void look(scene *s, dem_index first)
{
    CLEANUP(probes_forget) probe_search search;
    assert_true(probes_begin(&search, s->probes, &s->deck.deck, s->bodies));
    for (dem_index begin = 0, end = first; begin < s->lattice.n_nodes; begin = end, end = s->lattice.n_nodes) {
        CLEANUP(dem_slab_free) dem_slab slab = slab_cut(&s->lattice, begin, end);
        assert_int_equal(slab.n_own, end - begin);
        probes_look(&search, &slab);
    }
    probes_end(&search, s->places, &s->deck.errors);
}

static void find_in(scene *s, dem_index first, const char *groups)
{
    char text[1024];
    const double shift[2] = {10.0, 20.0};
    CLEANUP(dem_lattice_free) dem_lattice second = make_solid(3.0, 1.0, 1.0);
    s->lattice = make_solid(3.0, 1.0, 1.0);
    assert_int_equal(s->lattice.n_nodes, 7);
    dem_lattice_move(&second, acos(-1.0) / 2.0, shift);
    assert_int_equal(dem_lattice_append(&s->lattice, &second), DEM_OK);
    s->bodies[0] = (placement){.first = 0, .n_nodes = 7};
    s->bodies[1] = (placement){.first = 7, .n_nodes = 7, .angle = acos(-1.0) / 2.0, .offset = {10.0, 20.0}};
    (void)snprintf(text, sizeof text, HEAD "%s", groups);
    s->deck = resolve_clean(text);
    s->n = schema_count(&s->deck.deck, "probe");
    s->probes = calloc(s->n + 1, sizeof *s->probes);
    s->places = calloc(s->n + 1, sizeof *s->places);
    assert_true(s->probes != NULL && s->places != NULL);
    look(s, first);
}

static void find(scene *s, const char *groups)
{
    find_in(s, 14, groups);
}

static void drop_scene(scene *s)
{
    probes_free(s->probes, s->n);
    free(s->places);
    drop_resolved(&s->deck);
    dem_lattice_free(&s->lattice);
}

/* Nodes of a block: 0 to 3 at y = 0, x = -1.5 to 1.5; 4 to 6 at y = 0.87, x = -1 to 1. */
TEST(the_nearest_node_of_the_body_is_taken_in_its_own_coordinates)
{
    CLEANUP(drop_scene) scene s;
    find(&s, "&probe name = 'corner', place = 1.7, -0.2 / &probe name = 'top', place = 0.1, 5 / "
             "&probe name = 'far', body = 2, place = 1.7, -0.2, every = 4 / "
             "&probe name = 'across', kind = 'gauge', body = 2, place = -2, 0, 0, 1 /");
    assert_int_equal(s.deck.errors.n, 0);
    assert_string_equal(s.probes[0].name, "corner");
    assert_int_equal(s.probes[0].kind, DEM_PROBE_NODE);
    assert_int_equal(s.probes[0].number[0], 3);
    assert_int_equal(s.probes[0].every, 1);
    assert_int_equal(s.probes[1].number[0], 5);
    assert_int_equal(s.probes[2].number[0], 7 + 3);
    assert_int_equal(s.probes[2].every, 4);
    assert_int_equal(s.probes[3].kind, DEM_PROBE_GAUGE);
    assert_int_equal(s.probes[3].number[0], 7);
    assert_int_equal(s.probes[3].number[1], 7 + 5);
}

TEST(the_spring_with_the_nearest_middle_is_taken)
{
    CLEANUP(drop_scene) scene s;
    find(&s, "&probe name = 'a', kind = 'spring', place = 0.1, -1 / "
             "&probe name = 'b', kind = 'spring', place = 0.1, -1, body = 2 / &probe name = 'c', kind = 'spring', "
             "number = 9 /");
    assert_int_equal(s.deck.errors.n, 0);
    for (int k = 0; k < 2; k++) { /* from node 1 to 2 */
        const dem_index *ends = s.lattice.ends + 2 * s.probes[k].number[0];
        assert_int_equal(s.probes[k].kind, DEM_PROBE_SPRING);
        assert_int_equal(ends[0], 7 * k + 1);
        assert_int_equal(ends[1], 7 * k + 2);
    }
    assert_int_equal(s.probes[2].number[0], 9);
}

static void expect_place(const scene *s, size_t probe, double x, double y)
{
    const double *at = s->places[probe];
    assert_close(at[0], x, 1e-14 * 20.0);
    assert_close(at[1], y, 1e-14 * 20.0);
}

/* The second block is turned to stand up at (10, 20) m. */
TEST(what_has_two_ends_is_in_the_middle_between_them)
{
    CLEANUP(drop_scene) scene s;
    find(&s, "&probe name = 'a', number = 5 / &probe name = 'b', kind = 'spring', place = 0.1, -1, body = 2 / "
             "&probe name = 'c', kind = 'gauge', number = 7, 12 /");
    assert_int_equal(s.deck.errors.n, 0);
    expect_place(&s, 0, 0.0, sqrt(0.75));
    expect_place(&s, 1, 10.0, 20.0);
    expect_place(&s, 2, 10.0 - 0.5 * sqrt(0.75), 20.0 - 0.75);
}

/* The middle of the first spring from node 5 of the second block is in the other slab. */
TEST(slabs_have_what_the_whole_has)
{
    static const char groups[] =
        "&probe name = 'a', number = 5 / &probe name = 'b', place = 0.1, 5, body = 2 / "
        "&probe name = 'c', kind = 'spring', place = 0.2, 0.4, body = 2 / &probe name = 'd', kind = 'spring', "
        "number = 20 / &probe name = 'e', kind = 'gauge', number = 2, 13 / "
        "&probe name = 'f', kind = 'gauge', place = -2, 0, 2, 0 / &probe name = 'g', place = 0, 0 /";
    CLEANUP(drop_scene) scene whole;
    find(&whole, groups);
    for (dem_index first = 1; first < 14; first++) {
        CLEANUP(drop_scene) scene s;
        find_in(&s, first, groups);
        assert_int_equal(s.deck.errors.n, 0);
        for (size_t k = 0; k < s.n; k++) {
            assert_memory_equal(s.probes[k].number, whole.probes[k].number, sizeof s.probes[k].number);
            assert_memory_equal(s.places[k], whole.places[k], sizeof s.places[k]);
        }
    }
}

TEST(what_is_not_there_is_named)
{
    char got[1024];
    CLEANUP(drop_scene) scene s;
    find(&s, "&probe name = 'a', number = 14 /\n&probe name = 'b', kind = 'spring', number = 22 /\n"
             "&probe name = 'c', kind = 'gauge', place = 0, 0, -0.1, 0 /\n"
             "&probe name = 'd', kind = 'gauge', number = 3, 3 /");
    assert_int_equal(s.lattice.n_springs, 22);
    namelist_errors_sort(&s.deck.errors);
    list_faults(&s.deck.errors, got, sizeof got);
    assert_string_equal(got, "2:20 probe 'a': there is no such node; they are numbered from 0, and there are 14\n"
                             "3:37 probe 'b': there is no such spring; they are numbered from 0, and there are 22\n"
                             "4:36 probe 'c': both ends of the gauge are at node 1\n"
                             "5:36 probe 'd': both ends of the gauge are at node 3");
}
