/* SPDX-License-Identifier: BSD-3-Clause */
/* event_heap.c: which key is due first, against a search through all. */
#include "verification/support.h"

#include <gsl/gsl_rng.h>

#include "events/event_heap.h"
#include "harness/cleanup_gsl.h"

static bool is_lower(const void *self, dem_index a, dem_index b)
{
    (void)self;
    return a < b;
}

static const event_key_order by_number = {is_lower, NULL};

TEST(what_is_due_first_comes_first_and_of_equals_the_lowest)
{
    CLEANUP(event_heap_destroy) event_heap h;
    assert_ok(event_heap_create(&h, 4, by_number));
    assert_int_equal(event_heap_first(&h), -1);
    event_heap_set(&h, 3, 1.0, 0);
    event_heap_set(&h, 2, 2.0, 0);
    assert_int_equal(event_heap_first(&h), 3);
    event_heap_set(&h, 1, 1.0, 0);
    assert_int_equal(event_heap_first(&h), 1);
    event_heap_set(&h, 1, 3.0, 0);
    assert_int_equal(event_heap_first(&h), 3);
    event_heap_set(&h, 2, 0.5, 0);
    assert_int_equal(event_heap_first(&h), 2);
}

static bool is_higher(const void *self, dem_index a, dem_index b)
{
    return *(const bool *)self && a > b;
}

TEST(of_equal_times_the_lowest_generation_and_then_the_order_of_the_caller_decide)
{
    const bool yes = true;
    CLEANUP(event_heap_destroy) event_heap h;
    assert_ok(event_heap_create(&h, 4, (event_key_order){is_higher, &yes}));
    for (dem_index k = 0; k < 4; k++) event_heap_set(&h, k, 1.0, k < 2 ? 0 : 1);
    assert_int_equal(event_heap_first(&h), 1);
    assert_int_equal(event_heap_generation(&h, 3, 1.0), 1);
    assert_int_equal(event_heap_generation(&h, 3, 1.5), -1);
    event_heap_set(&h, 1, (double)INFINITY, 0);
    assert_int_equal(event_heap_generation(&h, 1, 1.0), -1);
    assert_int_equal(event_heap_first(&h), 0);
    event_heap_set(&h, 0, 1.0, 2); /* moved behind */
    assert_int_equal(event_heap_first(&h), 3);
    event_heap_set(&h, 3, 1.0, 7);
    assert_int_equal(event_heap_first(&h), 2);
    event_heap_set(&h, 0, 0.5, 9);
    assert_int_equal(event_heap_first(&h), 0);
}

TEST(what_is_never_due_is_not_there)
{
    CLEANUP(event_heap_destroy) event_heap h;
    assert_ok(event_heap_create(&h, 2, by_number));
    event_heap_set(&h, 0, (double)INFINITY, 0);
    assert_int_equal(event_heap_first(&h), -1);
    event_heap_set(&h, 0, 1.0, 0);
    event_heap_set(&h, 1, 2.0, 0);
    event_heap_set(&h, 0, (double)INFINITY, 0);
    assert_int_equal(event_heap_first(&h), 1);
    event_heap_set(&h, 1, (double)NAN, 0);
    assert_int_equal(event_heap_first(&h), -1);
}

TEST(a_cleared_heap_is_empty_and_can_be_filled_again)
{
    CLEANUP(event_heap_destroy) event_heap h;
    assert_ok(event_heap_create(&h, 3, by_number));
    for (dem_index k = 0; k < 3; k++) event_heap_set(&h, k, 1.0, 0);
    event_heap_clear(&h);
    assert_int_equal(event_heap_first(&h), -1);
    event_heap_set(&h, 2, 5.0, 0);
    assert_int_equal(event_heap_first(&h), 2);
    assert_int_equal(h.n, 1);
}

enum { n_keys = 40 };

static dem_index first_of(const double *due)
{
    dem_index first = -1;
    for (dem_index k = 0; k < n_keys; k++)
        if (isfinite(due[k]) && (first < 0 || due[k] < due[first])) first = k;
    return first;
}

/* Times are whole numbers up to 20, so that many are equal. */
TEST(any_changes_leave_the_first_that_a_search_finds)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    double due[n_keys];
    CLEANUP(event_heap_destroy) event_heap h;
    assert_ok(event_heap_create(&h, n_keys, by_number));
    for (dem_index k = 0; k < n_keys; k++) due[k] = (double)INFINITY;
    for (int turn = 0; turn < 100000; turn++) {
        const dem_index k = (dem_index)gsl_rng_uniform_int(rng, n_keys);
        due[k] = gsl_rng_uniform(rng) < 0.3 ? (double)INFINITY : (double)gsl_rng_uniform_int(rng, 20);
        event_heap_set(&h, k, due[k], 0);
        assert_int_equal(event_heap_first(&h), first_of(due));
    }
}
