/* SPDX-License-Identifier: BSD-3-Clause */
/* contact_source.c: the order of candidates that change at the same time. */
#include "unit/contact/impacts.h"

#include "contact/contact_source.h"

/* A square of two triangles, whose boundary goes 2, 1, 0, 3: nodes come first, then edges by the lower and the higher
 * of their nodes, whichever the surface has first. */
TEST(candidates_are_ordered_by_the_numbers_of_their_nodes)
{
    enum { N = 8 };
    const double at[8] = {1.0, 2.0, 1.0, 1.0, 0.0, 1.0, 0.0, 2.0};
    const dem_index corners[6] = {2, 1, 0, 2, 0, 3};
    static const contact_key order[N] = {{0, -1}, {1, -1}, {2, -1}, {3, -1}, {1, 0}, {0, 3}, {2, 1}, {3, 2}};
    const dem_obstacle roof = obstacle(3, roof_points, 0.5, 0.0);
    CLEANUP(scene_close) scene s;
    CLEANUP(contact_source_destroy) contact_source source;
    dem_index place[N], n_descents = 0;
    scene_open(&s, 4, at, masses, 2, corners, &roof, 1);
    assert_ok(contact_source_create(&source, &s.c));
    const event_key_order *o = &source.heap.order;
    assert_int_equal(s.c.set.n, N);
    for (int k = 0; k < N; k++) place[k] = contact_set_find(&s.c.set, order[k]);
    for (int a = 0; a < N; a++) {
        assert_true(place[a] >= 0);
        n_descents += a > 0 && place[a] < place[a - 1];
        for (int b = 0; b < N; b++) assert_true(o->before(o->self, place[a], place[b]) == (a < b));
    }
    assert_true(n_descents > 0); /* the surface has another order */
}
