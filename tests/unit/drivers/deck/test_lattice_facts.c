/* SPDX-License-Identifier: BSD-3-Clause */
/* lattice_facts.c: lattices of a few nodes, of which a hand finds the same, and decks. */
#include "lattice_facts.h"

#include "unit/deck_text.h"

#define HEAD  "&run t_end = 1 /\n&obstacle points = -9, -9, 9, -9 /\n&material youngs_modulus = 1e7, density = 1000"
#define BLOCK " /\n&body shape = 'rectangle', size = 0.04, 0.04, spacing = 1e-2 /\n"

static lattice_facts facts_of(const char *text)
{
    CLEANUP(deck_free) deck d = deck_text_good(text);
    return d.facts;
}

TEST(what_has_a_limit_may_break_and_may_soften_before)
{
    const lattice_facts none = facts_of(HEAD BLOCK);
    const lattice_facts stretch = facts_of(HEAD ", fracture = 'stretch', critical_stretch = 0.1" BLOCK);
    const lattice_facts stress = facts_of(HEAD ", fracture = 'stress', strength = 1e5" BLOCK);
    const lattice_facts soft = facts_of(HEAD ", fracture = 'stress', strength = 1e5, fracture_energy = 1e3" BLOCK);
    assert_false(none.may_break || none.may_soften);
    assert_true(stretch.may_break && !stretch.may_soften);
    assert_true(stress.may_break && !stress.may_soften);
    assert_true(soft.may_break && soft.may_soften);
}

TEST_GROUP(scratch_make, scratch_remove);
