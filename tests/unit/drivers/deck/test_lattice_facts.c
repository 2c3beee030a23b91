/* SPDX-License-Identifier: BSD-3-Clause */
/* lattice_facts.c: lattices of a few nodes, of which a hand finds the same, and decks. */
#include "lattice_facts.h"

#include "unit/close.h"
#include "unit/deck_text.h"

#define HEAD  "&run t_end = 1 /\n&solver max_step = 1e-3 /\n&material youngs_modulus = 1e7, density = 1000"
#define BLOCK " /\n&body shape = 'rectangle', size = 0.04, 0.04, spacing = 1e-2"

/* Three nodes of body 0 at the corners of a triangle of 3, 4 and 5 m, and one of body 1; two springs of 100 N. */
static double places[8] = {0.0, 0.0, 3.0, 0.0, 3.0, 4.0, -1.0, 1.0}, masses[4] = {1.0, 3.0, 5.0, 2.0};
static double stiffnesses[2] = {100.0, 100.0}, rest_lengths[2] = {3.0, 4.0}, viscosities[2] = {1.0, 3.0};
static dem_index ends[4] = {0, 1, 1, 2};
static int32_t bodies[4] = {0, 0, 0, 1};

static dem_lattice chain(void)
{
    dem_lattice l = dem_lattice_empty();
    l.n_nodes = 4, l.n_springs = 2;
    l.x = places, l.mass = masses, l.body = bodies;
    l.ends = ends, l.stiffness = stiffnesses, l.rest_length = rest_lengths;
    return l;
}

TEST(what_has_a_limit_may_break_and_may_soften_before)
{
    CLEANUP(deck_free) deck none = deck_text_good(HEAD BLOCK " /\n");
    CLEANUP(deck_free)
    deck stretch = deck_text_good(HEAD ", fracture = 'stretch', critical_stretch = 0.1" BLOCK " /\n");
    CLEANUP(deck_free) deck stress = deck_text_good(HEAD ", fracture = 'stress', strength = 1e5" BLOCK " /\n");
    CLEANUP(deck_free)
    deck soft = deck_text_good(HEAD ", fracture = 'stress', strength = 1e5, fracture_energy = 1e3" BLOCK " /\n");
    assert_false(none.facts.may_break || none.facts.may_soften);
    assert_true(stretch.facts.may_break && !stretch.facts.may_soften);
    assert_true(stress.facts.may_break && !stress.facts.may_soften);
    assert_true(soft.facts.may_break && soft.facts.may_soften);
}

/* Of two springs of 100 N one has 3 N s: a hundredth of that for each newton. */
TEST(the_longest_damping_time_is_that_of_the_most_viscous_spring)
{
    dem_lattice l = chain();
    CLEANUP(lattice_facts_free) lattice_facts undamped;
    CLEANUP(lattice_facts_free) lattice_facts damped;
    assert_true(lattice_facts_find(&undamped, &l));
    l.viscosity = viscosities;
    assert_true(lattice_facts_find(&damped, &l));
    assert_close(undamped.damping_time, 0.0, 0.0);
    assert_close(damped.damping_time, 0.03, 0.0);
}

TEST(the_box_holds_all_nodes)
{
    const dem_lattice l = chain();
    CLEANUP(lattice_facts_free) lattice_facts f;
    assert_true(lattice_facts_find(&f, &l));
    assert_close(f.low[0], -1.0, 0.0);
    assert_close(f.low[1], 0.0, 0.0);
    assert_close(f.high[0], 3.0, 0.0);
    assert_close(f.high[1], 4.0, 0.0);
    assert_close(lattice_facts_diagonal(&f), sqrt(32.0), 1e-15);
}

/* sqrt(2/(100 3)) and sqrt(4/(100 4)) s/m; of nodes alone nothing is fast. */
TEST(the_fastest_spring_is_compared_with_the_mean_one)
{
    dem_lattice l = chain();
    const double fast = sqrt(2.0 / 300.0), slow = sqrt(4.0 / 400.0);
    CLEANUP(lattice_facts_free) lattice_facts springs;
    CLEANUP(lattice_facts_free) lattice_facts none;
    assert_true(lattice_facts_find(&springs, &l));
    assert_close(springs.share_of_fastest, 2.0 * fast / (fast + slow), 1e-15);
    l.n_springs = 0;
    assert_true(lattice_facts_find(&none, &l));
    assert_close(none.share_of_fastest, 1.0, 0.0);
}

/* Springs wait for the masses of their upper ends, which are not in the next slab, and for those before them. */
TEST(facts_are_those_of_the_whole_where_springs_are_longer_than_slabs)
{
    dem_index far[10] = {0, 3, 0, 1, 1, 2, 1, 3, 2, 3};
    double scales[5] = {100.0, 300.0, 70.0, 20.0, 90.0}, lengths[5] = {1.0, 2.0, 3.0, 4.0, 5.0};
    dem_lattice l = chain();
    CLEANUP(lattice_facts_free) lattice_facts whole;
    CLEANUP(lattice_facts_free) lattice_facts slabs = {0};
    l.n_springs = 5, l.stiffness = scales, l.rest_length = lengths;
    l.body = NULL, l.ends = far;
    assert_true(lattice_facts_find(&whole, &l));
    for (dem_index i = 0; i < 4; i++) {
        dem_index rim[3] = {0, 1, 2};
        dem_slab s = dem_slab_empty();
        for (dem_index k = i; k < 3; k++) rim[k] = k + 1;
        s.lattice = l;
        s.n_nodes = 4, s.first_node = i, s.first_own = i, s.n_own = 1, s.rim = rim;
        assert_true(lattice_facts_add(&slabs, &s));
    }
    assert_int_equal(slabs.n_springs, 5);
    assert_int_equal(slabs.n_waiting, 0);
    assert_close(slabs.share_of_fastest, whole.share_of_fastest, 0.0);
    assert_close(slabs.motion.mass, whole.motion.mass, 0.0);
}

/* 10 kg m/s of body 0, of 9 kg, and 2 (3, 0) kg m/s of body 1, of 2 kg. */
TEST(bodies_have_momenta_and_all_have_their_sum)
{
    double velocities[8] = {1.0, 0.0, 3.0, 0.0, 0.0, -2.0, 3.0, 0.0};
    dem_lattice l = chain();
    l.velocity = velocities;
    CLEANUP(lattice_facts_free) lattice_facts f;
    assert_true(lattice_facts_find(&f, &l));
    const initial_motion all[3] = {f.motion, f.bodies[0].motion, f.bodies[1].motion};
    const initial_motion expected[3] = {{11.0, {16.0, -10.0}}, {9.0, {10.0, -10.0}}, {2.0, {6.0, 0.0}}};
    for (int k = 0; k < 3; k++) {
        assert_close(all[k].mass, expected[k].mass, 0.0);
        for (int c = 0; c < 2; c++) assert_close(all[k].momentum[c], expected[k].momentum[c], 0.0);
    }
}

/* The second group has two copies: bodies 1 and 2. */
TEST(of_each_body_it_is_known_whether_it_is_rigid)
{
    CLEANUP(deck_free) deck elastic = deck_text_good(HEAD BLOCK " /\n");
    CLEANUP(deck_free)
    deck d = deck_text_good(HEAD BLOCK " /\n&body shape = 'disc', radius = 0.02, spacing = 1e-2, position = 0.1, 0, "
                                       "rigid = .true., guide = 'y', copies = 2, 1, pitch = 0.1, 0.1 /\n"
                                       "&body shape = 'disc', radius = 0.02, spacing = 1e-2, position = 0, 0.2, "
                                       "rigid = .true. /\n");
    const unsigned expected[4] = {0, DEM_NODE_RIGID | DEM_NODE_GUIDE_Y, DEM_NODE_RIGID | DEM_NODE_GUIDE_Y,
                                  DEM_NODE_RIGID};
    assert_int_equal(d.facts.n_bodies, 4);
    for (int b = 0; b < 4; b++) assert_int_equal(d.facts.bodies[b].rigid, expected[b]);
    assert_true(lattice_facts_any_rigid(&d.facts));
    assert_int_equal(elastic.facts.n_bodies, 1);
    assert_false(lattice_facts_any_rigid(&elastic.facts));
}

TEST_GROUP(scratch_make, scratch_remove);
