/* SPDX-License-Identifier: BSD-3-Clause */
/* early_reflection.c: impacts before anything touches. Numbers are worked out by hand; tolerances of
 * 1e-15 to 1e-12 are rounding unless said otherwise. */
#include "unit/contact/impacts.h"

#include "contact/early_reflection.h"

/* ---- early reflection ---- */

TEST(an_early_reflection_leaves_a_node_where_it_is)
{
    const dem_obstacle rough = obstacle(2, floor_points, 0.5, 0.25);
    const contact_gap gap = {0.1, 0, 0.0, {0.0, 1.0}};
    event_listener listener;
    CLEANUP(scene_close) scene s;
    open_node(&s, &rough, 1, 3.0, -4.0);
    scene_put(&s, 0, 0.25, 0.1, 3.0, -4.0);
    contact_instant now = moment(&s, &listener);
    early_reflection_of(&s.c.set, 0, &gap, &now);
    scene_check(&s, 0, 0.25, 0.1, 1.5, 2.0);
    assert_int_equal(s.c.set.list[0].n_closed, 0);
    assert_int_equal(s.c.set.ledger.counts.early, 1);
    assert_int_equal(s.c.set.ledger.counts.impacts, 1);
    check_vec(ledger_vector(s.c.set.ledger.impulse, 0), -3.0, 12.0, 1e-14);
    check_vec(vec2_at(s.impacts[0].impulse, 0), -3.0, 12.0, 1e-14);
    check_vec(vec2_at(s.impacts[0].after, 0), 1.5, 2.0, 1e-15);
    assert_close(s.impacts[0].energy, 25.0 - 6.25, 1e-14);
    assert_close(exact_sum_value(&s.c.set.ledger.projection), 0.0, 0.0);
}

/* Near a vertex the gap's normal is no segment's: 5 m/s down are 4 m/s along (0.6, 0.8), and 6 n more turn that. */
TEST(an_early_reflection_goes_along_the_normal_of_the_gap)
{
    const dem_obstacle smooth = obstacle(2, floor_points, 0.5, 0.0);
    const contact_gap gap = {0.1, 0, 0.0, {0.6, 0.8}};
    event_listener listener;
    CLEANUP(scene_close) scene s;
    open_node(&s, &smooth, 1, 0.0, -5.0);
    contact_instant now = moment(&s, &listener);
    early_reflection_of(&s.c.set, 0, &gap, &now);
    check_vec(velocity(&s, 0), 3.6, -0.2, 1e-14);
    check_vec(vec2_at(s.impacts[0].normal, 0), 0.6, 0.8, 0.0);
    check_vec(ledger_vector(s.c.set.ledger.friction_impulse, 0), 0.0, 0.0, 1e-14);
}

TEST(an_early_reflection_of_an_edge_shares_its_impulse_too)
{
    const double q = 0.25, J = 1.5 / mobility(q);
    const dem_obstacle roof = obstacle(3, roof_points, 0.5, 0.0);
    const contact_gap gap = {0.1, 0, q, {0.0, 1.0}};
    event_listener listener;
    CLEANUP(scene_close) scene s;
    const dem_index edge = open_edge(&s, &roof, q, 0.0);
    for (dem_index i = 0; i < 3; i++) scene_put(&s, i, s.y[2 * i], s.y[2 * i + 1] + 0.1, 0.5, -1.0);
    const double before = kinetic(&s);
    contact_instant now = moment(&s, &listener);
    early_reflection_of(&s.c.set, edge, &gap, &now);
    check_vec(velocity(&s, 0), 0.5, -1.0 + 0.75 * J, 1e-14);
    check_vec(velocity(&s, 1), 0.5, -1.0 + 0.25 * J / 3.0, 1e-14);
    assert_close(s.impacts[0].energy, before - kinetic(&s), 1e-13);
    assert_close(s.impacts[0].weight, q, 1e-14);
    assert_int_equal(s.c.set.ledger.counts.vertex_impacts, 1);
}
