/* SPDX-License-Identifier: BSD-3-Clause */
/* cell_search.c against a look at every point. */
#include "surface_contact/cell_search.h"

#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_rng.h>

#include "harness/cleanup_gsl.h"
#include "verification/support.h"

enum { POINTS = 500 };

static bool has(const cell_search *c, dem_index number)
{
    for (dem_index k = 0; k < c->n_found; k++)
        if (c->found[k] == number) return true;
    return false;
}

/* Points in clusters far apart, many on the borders of cells, and boxes of all sizes. */
TEST(a_box_has_the_points_that_are_in_it)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(cell_search_free) cell_search c = {0};
    double x[2 * POINTS];
    for (int k = 0; k < 2 * POINTS; k++)
        x[k] = 1e6 * (double)gsl_rng_uniform_int(rng, 2) + 0.25 * (double)gsl_rng_uniform_int(rng, 40) - 3.0;
    for (int turn = 0; turn < 300; turn++) {
        assert_ok(cell_search_fill(&c, x, POINTS - turn, 0.5 + 0.01 * turn));
        const double *centre = &x[2 * gsl_rng_uniform_int(rng, POINTS)], size = 4.0 * gsl_rng_uniform(rng);
        const vec2 low = {centre[0] - size, centre[1] - size}, high = {centre[0] + size, centre[1] + 0.5 * size};
        assert_ok(cell_search_find(&c, low, high));
        for (dem_index k = 0; k < POINTS; k++) {
            const bool inside = k < POINTS - turn && x[2 * k] >= low.x && x[2 * k] <= high.x && x[2 * k + 1] >= low.y &&
                                x[2 * k + 1] <= high.y;
            assert_int_equal(has(&c, k), inside);
        }
    }
}

/* Positions of a step that has blown up: they are found nowhere, and do no harm. */
TEST(points_that_are_not_finite_are_passed_over)
{
    CLEANUP(cell_search_free) cell_search c = {0};
    const double x[8] = {NAN, 0.0, INFINITY, 1.0, 0.0, -INFINITY, 0.5, 0.5};
    assert_ok(cell_search_fill(&c, x, 4, 1.0));
    assert_ok(cell_search_find(&c, (vec2){0.0, 0.0}, (vec2){1.0, 1.0}));
    assert_int_equal(c.n_found, 1);
    assert_int_equal(c.found[0], 3);
}

TEST(without_points_nothing_is_found)
{
    CLEANUP(cell_search_free) cell_search c = {0};
    assert_ok(cell_search_fill(&c, NULL, 0, 1.0));
    assert_ok(cell_search_find(&c, (vec2){-2.0, -2.0}, (vec2){2.0, 2.0}));
    assert_int_equal(c.n_found, 0);
}
