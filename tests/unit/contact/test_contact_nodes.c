/* SPDX-License-Identifier: BSD-3-Clause */
/* contact_nodes.h: sums over the nodes of a contact, up to four. Weights and masses are such that nothing is rounded,
 * so that tolerances are 0. */
#include "verification/support.h"

#include "contact/contact_nodes.h"

enum { n_nodes = 5 };

/* Node 3 does not move by impulses. */
static const double inverse_mass[n_nodes] = {0.5, 1.0, 2.0, 0.0, 4.0};

/* A quarter along edge 0-1 of a body on the middle of edge 2-3 of another. */
static const contact_nodes both = {4, {0, 1, 2, 3}, {0.75, 0.25, -0.5, -0.5}};

TEST(the_motion_of_a_contact_is_that_of_the_body_less_the_partners)
{
    const double v[2 * n_nodes] = {4.0, 0.0, 8.0, 4.0, 1.0, 1.0, 3.0, -5.0, 100.0, 100.0};
    const vec2 relative = contact_nodes_sum(&both, v);
    assert_close(relative.x, 3.0 + 2.0 - 0.5 - 1.5, 0.0);
    assert_close(relative.y, 1.0 - 0.5 + 2.5, 0.0);
}

/* 9/16 of 1/2, 1/16 of 1, 1/4 of 2, and nothing of node 3. */
TEST(an_impulse_moves_a_contact_by_its_mobility)
{
    double v[2 * n_nodes] = {0.0};
    const double mobility = contact_nodes_mobility(&both, inverse_mass);
    assert_close(mobility, 0.28125 + 0.0625 + 0.5, 0.0);
    contact_nodes_push(&both, inverse_mass, 2.0, (vec2){1.0, -3.0}, v);
    const vec2 relative = contact_nodes_sum(&both, v);
    assert_close(relative.x, 2.0 * mobility, 0.0);
    assert_close(relative.y, -6.0 * mobility, 0.0);
    const double expected[2 * n_nodes] = {0.75, -2.25, 0.5, -1.5, -2.0, 6.0};
    for (int k = 0; k < 2 * n_nodes; k++) assert_close(v[k], expected[k], 0.0);
}

/* What has no inverse mass might as well not be there, as ground is not. */
TEST(a_partner_of_inverse_mass_zero_has_no_share)
{
    const contact_nodes alone = {1, {4}, {1.0}}, on_ground = {2, {4, 3}, {1.0, -1.0}};
    double v[2 * n_nodes] = {0.0}, w[2 * n_nodes] = {0.0};
    assert_close(contact_nodes_mobility(&on_ground, inverse_mass), contact_nodes_mobility(&alone, inverse_mass), 0.0);
    contact_nodes_push(&alone, inverse_mass, 1.0, (vec2){0.5, 2.0}, v);
    contact_nodes_push(&on_ground, inverse_mass, 1.0, (vec2){0.5, 2.0}, w);
    assert_memory_equal(v, w, sizeof v);
}

/* Node 4 on the edge 0-1: an impulse at one moves the other by the nodes that they share, and by as much the other way
 * round. */
TEST(contacts_that_share_nodes_move_each_other)
{
    const contact_nodes beside = {3, {4, 1, 0}, {1.0, -0.5, -0.5}};
    double v[2 * n_nodes] = {0.0};
    const double coupling = contact_nodes_coupling(&both, &beside, inverse_mass);
    assert_close(coupling, -0.5 * (0.75 * 0.5 + 0.25), 0.0);
    assert_close(contact_nodes_coupling(&beside, &both, inverse_mass), coupling, 0.0);
    assert_close(contact_nodes_coupling(&both, &both, inverse_mass), contact_nodes_mobility(&both, inverse_mass), 0.0);
    contact_nodes_push(&beside, inverse_mass, 1.0, (vec2){0.0, 1.0}, v);
    assert_close(contact_nodes_sum(&both, v).y, coupling, 0.0);
}
