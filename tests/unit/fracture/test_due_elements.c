/* SPDX-License-Identifier: BSD-3-Clause */
/* due_elements.c: which elements are due, and which first, against a search through all. */
#include "verification/support.h"

#include <gsl/gsl_rng.h>

#include "fracture/due_elements.h"
#include "harness/cleanup_gsl.h"

TEST(what_is_never_due_is_not_there)
{
    CLEANUP(due_elements_destroy) due_elements d = {0};
    due_elements_set(&d, 7, (double)INFINITY);
    assert_true(isinf(due_elements_first(&d)));
    due_elements_set(&d, 7, 2.0);
    due_elements_set(&d, 9, 1.0);
    assert_close(due_elements_first(&d), 1.0, 0.0);
    due_elements_set(&d, 9, (double)NAN);
    assert_close(due_elements_first(&d), 2.0, 0.0);
    due_elements_set(&d, 7, (double)INFINITY);
    assert_int_equal(d.n, 0);
}

enum { n_elements = 300 };

/* Irregular, so that some have the same home. */
static dem_index element_of(dem_index k)
{
    return 1000 * k + k * k * 13 % 1000;
}

/* Each place has an element, whose parent is not due later, and all that are due have a place. */
static void check(const due_elements *d, const double *due)
{
    double first = (double)INFINITY;
    dem_index n = 0;
    for (dem_index k = 0; k < n_elements; k++) {
        first = fmin(first, due[k]);
        n += isfinite(due[k]);
    }
    assert_int_equal(d->n, n);
    assert_true(due_elements_first(d) == first);
    for (dem_index p = 0; p < n; p++) {
        assert_close(d->list[p].t, due[d->list[p].element / 1000], 0.0);
        assert_true(p == 0 || !(d->list[p].t < d->list[(p - 1) / 2].t));
    }
}

/* Times are whole, so that many are equal; it is cleared now and then. */
TEST(any_changes_leave_what_a_search_finds)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(due_elements_destroy) due_elements d = {0};
    double due[n_elements];
    for (int turn = 0; turn < 20000; turn++) {
        if (turn % 2500 == 0) {
            due_elements_clear(&d);
            for (dem_index k = 0; k < d.n_cells; k++) assert_int_equal(d.cells[k], -1);
            for (dem_index k = 0; k < n_elements; k++) due[k] = (double)INFINITY;
        }
        const dem_index k = (dem_index)gsl_rng_uniform_int(rng, n_elements);
        const double never = turn % 2500 < 1250 ? 0.2 : 0.8;
        due[k] = gsl_rng_uniform(rng) < never ? (double)INFINITY : (double)gsl_rng_uniform_int(rng, 50);
        due_elements_set(&d, element_of(k), due[k]);
        check(&d, due);
    }
    assert_int_equal(d.status, DEM_OK);
}
