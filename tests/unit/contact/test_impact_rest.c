/* SPDX-License-Identifier: BSD-3-Clause */
/* impact_rest.c: what comes to rest where. Numbers are worked out by hand; tolerances of
 * 1e-15 to 1e-12 are rounding unless said otherwise. */
#include "unit/contact/impacts.h"

#include "contact/impact_rest.h"

/* ---- notches ---- */

/* The side bends in at node 1 by 1/4 to either side. Pressed down by the weight it comes to rest in the notch if it
 * would not rise by more than eight penetration tolerances; what weighs up, or flies fast, does not. */
TEST(a_vertex_comes_to_rest_in_a_notch_it_would_not_leave)
{
    const double limit = sqrt(2.0 * g * 8.0 * penetration_tolerance), v[4] = {0.0, 0.99 * limit, 1.01 * limit, 0.0};
    const bool rests[4] = {true, true, false, false};
    const dem_obstacle roof = obstacle(3, roof_points, 0.0, 0.0);
    for (int k = 0; k < 4; k++) {
        CLEANUP(scene_close) scene s;
        event_listener listener;
        open_side(&s, &roof, 0.0, 0.0, -0.25);
        if (k == 3) s.acting.gravity[1] = g;
        vec2_put(scene_v(&s), 1, (vec2){0.0, v[k]});
        const contact_instant now = moment(&s, &listener);
        const dem_index left = scene_edge(&s, 0, 1), right = scene_edge(&s, 1, 2);
        assert_int_equal(impact_rest_in_notch(&s.c.set, left, right, &now), rests[k]);
        assert_int_equal(impact_rest_in_notch(&s.c.set, right, left, &now), rests[k]);
        scene_close(&s);
        open_side(&s, &roof, 0.0, 0.0, 0.0); /* a side that does not bend in is no notch */
        const contact_instant flat = moment(&s, &listener);
        vec2_put(scene_v(&s), 1, (vec2){0.0, 0.0});
        s.acting.gravity[0] = 5.0;
        assert_false(impact_rest_in_notch(&s.c.set, scene_edge(&s, 0, 1), scene_edge(&s, 1, 2), &flat));
    }
}
