/* SPDX-License-Identifier: BSD-3-Clause */
/* impact_solve.c: which impact it is. Numbers are worked out by hand; tolerances of
 * 1e-15 to 1e-12 are rounding unless said otherwise. */
#include "unit/contact/impacts.h"

/* ---- groups ---- */

/* Node 0 slides on a ledge left of the ridge and the edge comes down on it: J = -(1 + eta) v_n/W lifts the node off
 * the ledge; both are put back on their surfaces, and what has opened is reported after the impact. */
TEST(a_node_on_a_floor_is_lifted_off_by_the_edge_beside_it)
{
    const double q = 0.75, W = mobility(q), J = 1.5 * q / W, ledge_points[4] = {-8.0, 0.0, -0.5, 0.0};
    const dem_obstacle both[2] = {obstacle(3, roof_points, 0.5, 0.0), obstacle(2, ledge_points, 0.5, 0.0)};
    CLEANUP(scene_close) scene s;
    scene_open_triangle(&s, masses, -1.5, 0.0, both, 2);
    scene_put(&s, 0, -1.5, 0.3 * penetration_tolerance, 0.5, 0.0);
    scene_put(&s, 1, 0.5, -1.5 * penetration_tolerance, 0.5, -1.0);
    assert_ok(contact_set_close(&s.c.set, 0, (contact_point){.feature = 2, .slide = 1}));
    hit(&s, scene_edge(&s, 0, 1), 1, 0, 0);
    check_vec(velocity(&s, 0), 0.5, 0.25 * J, 1e-11); /* the square of the slope that putting them back leaves, 1e-6 */
    check_vec(velocity(&s, 1), 0.5, -1.0 + 0.75 * J / 3.0, 1e-11);
    assert_close(s.y[1], 0.0, 1e-15);
    assert_close(0.25 * s.y[1] + 0.75 * s.y[3], 0.0, 1e-15);
    assert_int_equal(s.c.set.list[0].n_closed, 0);
    assert_int_equal(s.n_events, 2);
    assert_int_equal(s.events[0].kind, DEM_EVENT_RELEASE); /* in the order of candidates */
    assert_int_equal(s.events[0].node, 0);
    assert_int_equal(s.events[0].other, -1);
    assert_int_equal(s.events[1].kind, DEM_EVENT_IMPACT);
    assert_int_equal(s.events[1].other, 1);
    assert_int_equal(s.c.set.ledger.counts.releases, 1);
}
