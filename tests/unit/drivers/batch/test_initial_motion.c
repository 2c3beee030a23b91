/* SPDX-License-Identifier: BSD-3-Clause */
/* initial_motion.c: two bodies, of momenta that a hand adds up. */
#include "initial_motion.h"

#include "verification/support.h"

/* Nodes of 1 and 3 kg in body 0, one of 4 kg in body 1. */
TEST(a_body_and_all_bodies_have_the_velocity_of_their_centre_of_mass)
{
    const double x[6] = {0.0, 0.0, 1.0, 0.0, 2.0, 0.0}, mass[3] = {1.0, 3.0, 4.0};
    const double velocity[6] = {4.0, 0.0, 0.0, -8.0, 1.0, 2.0};
    const double expected[3][2] = {{1.0, -2.0}, {1.0, -6.0}, {1.0, 2.0}}; /* of all, body 0, body 1: exact */
    int32_t body[3] = {0, 0, 1};
    CLEANUP(dem_lattice_free) dem_lattice l = support_lattice(3, x, mass, 0, NULL, 0.0, 0.0, NULL);
    support_start(&l, NULL, velocity);
    l.body = calloc(3, sizeof *l.body);
    assert_non_null(l.body);
    memcpy(l.body, body, sizeof body);
    for (int b = -1; b < 2; b++) {
        double v[2];
        initial_motion_velocity(&l, b, v);
        for (int c = 0; c < 2; c++) assert_close(v[c], expected[b + 1][c], 0.0);
    }
}

TEST(without_velocities_bodies_are_at_rest)
{
    const double x[2] = {0.0, 0.0}, mass = 2.0;
    double v[2] = {1.0, 1.0};
    CLEANUP(dem_lattice_free) dem_lattice l = support_lattice(1, x, &mass, 0, NULL, 0.0, 0.0, NULL);
    initial_motion_velocity(&l, -1, v);
    assert_close(v[0], 0.0, 0.0);
    assert_close(v[1], 0.0, 0.0);
}
