/* SPDX-License-Identifier: BSD-3-Clause */
/* shared_use.c: which options have a use for rings of ghosts, and for surfaces of bodies that ranks have in common. */
#include "verification/support.h"
#include "simulation/shared_use.h"

static dem_private_whole use_of(const dem_options *o)
{
    dem_private_whole whole = {0};
    assert_ok(dem_private_use_shared(&whole, o));
    return whole;
}

static void assert_rings(const dem_options *o, int least, int most)
{
    const dem_private_whole whole = use_of(o);
    assert_int_equal(whole.use.least, least);
    assert_int_equal(whole.use.most, most);
}

TEST(pairs_use_a_ring_for_two_stages_and_verlet_one_for_a_step)
{
    dem_options o = dem_options_default();
    assert_rings(&o, 3, 3);
    o.method = DEM_METHOD_VERLET;
    assert_rings(&o, 4, 16);
    o.contact = DEM_CONTACT_EXACT;
    assert_rings(&o, 1, 1);
    o = dem_options_default();
    o.method = DEM_METHOD_DOPRI45;
    assert_rings(&o, 1, 1);
}

static dem_status push(void *context, const dem_force_query *q, double *force)
{
    (void)context;
    for (dem_index k = 0; k < 2 * q->n; k++) force[k] = 0.0;
    return DEM_OK;
}

TEST(what_acts_on_ghosts_alone_leaves_one_ring)
{
    static const dem_boundary pull = {.struct_size = sizeof pull};
    static const dem_method methods[] = {DEM_METHOD_FEHLBERG45, DEM_METHOD_VERLET};
    for (int k = 0; k < 2; k++) {
        dem_options o = dem_options_default();
        o.method = methods[k];
        o.n_boundaries = 1;
        o.boundaries = &pull;
        assert_rings(&o, 1, 1);
        o.n_boundaries = 0;
        o.force = push;
        assert_rings(&o, 1, 1);
    }
}

TEST(surfaces_are_common_if_bodies_touch)
{
    dem_options o = dem_options_default();
    o.bodies = DEM_BODIES_NONE;
    assert_int_equal(use_of(&o).touching, DEM_PRIVATE_TOUCHING_NONE);
    o.bodies = DEM_BODIES_ALL;
    assert_int_equal(use_of(&o).touching, DEM_PRIVATE_TOUCHING_SOME);
}
