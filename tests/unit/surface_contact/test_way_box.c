/* SPDX-License-Identifier: BSD-3-Clause */
/* way_box.c: against the ways one by one, for every number of points that a machine may take together. */
#include "surface_contact/way_box.h"

#include "harness/test.h"

enum { MOST = 23 };

/* Points 3 k and 3 k + 1 of an array, in no order of size, that have come from places a little off. */
static void make(double *x, dem_index *at, double *from)
{
    for (int k = 0; k < 6 * MOST; k++) x[k] = sin(7.0 * k);
    for (int k = 0; k < MOST; k++) at[k] = 6 * ((5 * k) % MOST);
    for (int k = 0; k < 4 * MOST; k++) from[k] = cos(11.0 * k);
}

TEST(the_box_is_just_as_large_as_its_ways)
{
    double x[6 * MOST], from[4 * MOST];
    dem_index at[MOST];
    make(x, at, from);
    for (dem_index n = 1; n <= MOST; n++) {
        double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
        for (dem_index k = 0; k < n; k++)
            for (int c = 0; c < 4; c++) {
                low[c % 2] = fmin(low[c % 2], x[at[k] + c] - from[4 * k + c]);
                high[c % 2] = fmax(high[c % 2], x[at[k] + c] - from[4 * k + c]);
            }
        const box ways = way_box_of(x, at, from, n);
        assert_true(ways.low.x == low[0] && ways.low.y == low[1] && ways.high.x == high[0] && ways.high.y == high[1]);
    }
}

TEST(no_points_have_no_box_and_what_is_no_number_is_passed_over)
{
    double x[6 * MOST], from[4 * MOST];
    dem_index at[MOST];
    make(x, at, from);
    const box none = way_box_of(x, at, from, 0);
    assert_true(none.low.x == INFINITY && none.low.y == INFINITY && none.high.x == -INFINITY);
    for (dem_index k = 0; k < MOST; k++) {
        const box whole = way_box_of(x, at, from, MOST);
        const double kept = x[at[k]];
        x[at[k]] = (double)NAN;
        const box ways = way_box_of(x, at, from, MOST);
        assert_true(ways.low.x >= whole.low.x && ways.high.x <= whole.high.x && ways.low.y == whole.low.y);
        x[at[k]] = -(double)INFINITY;
        assert_true(way_box_of(x, at, from, MOST).low.x == -INFINITY);
        x[at[k]] = kept;
    }
}
