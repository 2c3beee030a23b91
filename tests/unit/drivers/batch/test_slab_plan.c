/* SPDX-License-Identifier: BSD-3-Clause */
/* slab_plan.c: by how many nodes and ranks a body is made in slabs, and what memory the largest rank is expected to
 * take then. */
#include "slab_plan.h"

#include "rank_group.h"
#include "unit/close.h"
#include "unit/deck_text.h"

#define RUN "&run t_end = 1 /\n&solver max_step = 1e-3 /\n&material youngs_modulus = 1e7, density = 1000 /\n"

static dem_index slabs_for(deck *d, int n_ranks, double nodes)
{
    const rank_group group = {.size = n_ranks};
    const command c = {.ranks = n_ranks > 0 ? &group : NULL, .slab_nodes = 1000.0};
    d->slabs.n = 0;
    slab_plan_decide(d, &c, nodes);
    return d->slabs.n;
}

TEST(large_bodies_that_suit_are_made_by_several_ranks)
{
    CLEANUP(deck_free)
    deck d = deck_text_good(RUN "&body shape = 'disc', radius = 0.05, spacing = 1e-2, outline = 'lattice' /\n");
    CLEANUP(deck_free)
    deck parts = deck_text_good(RUN "&body shape = 'disc', radius = 0.05, spacing = 1e-2 /\n"
                                    "&output fields = 'fragment' /\n");
    CLEANUP(deck_free)
    deck many = deck_text_good(RUN "&body shape = 'disc', radius = 0.05, spacing = 1e-2, outline = 'lattice', "
                                   "copies = 40, 5, pitch = 0.2, 0.2 /\n");
    assert_int_equal(slabs_for(&many, 4, 1999.0), 0); /* fewer than 10 of each */
    assert_int_equal(slabs_for(&many, 4, 2000.0), 4);
    assert_int_equal(slabs_for(&d, 4, 1000.0), 4);
    assert_int_equal(slabs_for(&d, 4, 999.0), 0);
    assert_int_equal(slabs_for(&d, 1, 1e6), 0);
    assert_int_equal(slabs_for(&d, 0, 1e6), 0);
    assert_int_equal(slabs_for(&parts, 4, 1e6), 0);
}

/* 1.25 shares, and 80 MB of each process, but no more than a process alone. */
TEST(the_largest_rank_has_a_share_and_what_each_process_takes)
{
    CLEANUP(deck_free)
    deck d = deck_text_good(RUN "&body shape = 'disc', radius = 0.05, spacing = 1e-2, outline = 'lattice' /\n");
    estimate whole = {.nodes = 1e6, .memory = 1e9}, of_4 = whole, small = {.nodes = 1e6, .memory = 1e8};
    slab_plan_share_memory(&whole, &d);
    assert_close(whole.memory, 1e9, 0.0);
    d.slabs.n = 4;
    slab_plan_share_memory(&of_4, &d);
    assert_close(of_4.memory, 3.925e8, 0.0);
    slab_plan_share_memory(&small, &d);
    assert_close(small.memory, 1e8, 0.0);
}

TEST_GROUP(scratch_make, scratch_remove);
