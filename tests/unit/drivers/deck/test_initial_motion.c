/* SPDX-License-Identifier: BSD-3-Clause */
/* initial_motion.c: nodes whose momenta a hand adds up. */
#include "unit/close.h"

#include "initial_motion.h"

/* Nodes of 1, 3 and 4 kg, and one of 8 kg that is fixed. */
static double masses[4] = {1.0, 3.0, 4.0, 8.0}, velocities[8] = {4.0, 0.0, 0.0, -8.0, 1.0, 2.0, 9.0, 9.0};
static unsigned char flags[4] = {DEM_NODE_CONTACT, DEM_NODE_CONTACT, DEM_NODE_CONTACT, DEM_NODE_FIXED};

static dem_lattice nodes(void)
{
    dem_lattice l = dem_lattice_empty();
    l.n_nodes = 4, l.mass = masses, l.velocity = velocities, l.flags = flags;
    return l;
}

static void expect(const dem_lattice *l, dem_index n, double x, double y)
{
    initial_motion m = {0};
    double v[2];
    for (dem_index i = 0; i < n; i++) initial_motion_add(&m, l, i);
    initial_motion_velocity(v, &m);
    assert_close(v[0], x, 0.0);
    assert_close(v[1], y, 0.0);
}

TEST(nodes_together_have_the_velocity_of_their_centre_of_mass)
{
    const dem_lattice l = nodes();
    expect(&l, 2, 1.0, -6.0);
    expect(&l, 3, 1.0, -2.0);
}

TEST(a_fixed_node_has_mass_and_no_velocity)
{
    dem_lattice l = nodes();
    expect(&l, 4, 0.5, -1.0);
    l.flags = NULL;
    expect(&l, 4, 5.0, 3.5);
}

TEST(without_velocities_nodes_are_at_rest)
{
    dem_lattice l = nodes();
    l.velocity = NULL;
    expect(&l, 3, 0.0, 0.0);
}
