/* SPDX-License-Identifier: BSD-3-Clause */
/* rate_sums.c: rates of three obstacles and the totals, in the plane and in space. */
#include "base/rate_sums.h"

#include <stdlib.h>

#include "harness/test.h"
#include "unit/both_dimensions.h"
#include "unit/close.h"
#include "verification/support.h"

/* 1e16 and -1e16 leave what is between them, in any order, and what was there before is added to that. */
TEST_IN_BOTH(terms_are_added_in_any_order_and_taken_once)
{
    static const double terms[] = {1e16, 3.0, -1e16, 0.125};
    const state_layout l = state_layout_of(dim, 5, 3, true);
    const dem_index row = state_friction_impulse(&l, 2), total = state_total_index(&l, STATE_OBSTACLE);
    double *a = calloc((size_t)state_velocities(&l), sizeof *a);
    rate_sums s;
    assert_non_null(a);
    assert_ok(rate_sums_create(&s, dim, 3));
    for (int first = 0; first < 4; first++) {
        a[state_row(&l, row)] = 1.0;
        a[total] = 0.0;
        for (int k = 0; k < 4; k++) {
            const double term = terms[(first + k) % 4];
            rate_sums_add_row(&s, &l, row, (const double[]){term, 2.0 * term, 0.0});
            rate_sums_add(&s, &l, total, term);
        }
        rate_sums_take(&s, &l, a);
        assert_close(a[state_row(&l, row)], 4.125, 0.0);
        assert_close(a[total], 3.125, 0.0);
        rate_sums_take(&s, &l, a);
        assert_close(a[total], 3.125, 0.0);
    }
    assert_close(a[state_row(&l, row) + 1], 4.0 * 6.25, 0.0);
    for (dem_index k = 0; k < state_row(&l, state_impulse(&l, 0)); k++) assert_close(a[k], 0.0, 0.0);
    rate_sums_free(&s);
    free(a);
}

/* Blocks of terms are added to the same sums: to one rate, or in turns to two that follow each other. */
TEST(blocks_of_terms_count_with_those_one_by_one)
{
    const state_layout l = state_layout_of(2, 5, 3, true);
    const dem_index row = state_row(&l, state_impulse(&l, 1)), total = state_total_index(&l, STATE_FRICTION);
    double *a = calloc((size_t)state_velocities(&l), sizeof *a), pairs[EXACT_SUM_BLOCK], terms[EXACT_SUM_BLOCK];
    rate_sums s;
    assert_non_null(a);
    assert_ok(rate_sums_create(&s, 2, 3));
    rate_sums_add_row(&s, &l, state_impulse(&l, 1), (const double[]){1e16, -1e16});
    rate_sums_add(&s, &l, total, 1e16);
    for (int k = 0; k < 50; k++) {
        pairs[2 * k] = k == 7 ? -1e16 : 0.125;
        pairs[2 * k + 1] = k == 9 ? 1e16 : 3.0;
        terms[k] = k == 0 ? -1e16 : 0.5;
    }
    rate_sums_add_pairs(&s, &l, row, pairs, 100);
    rate_sums_add_terms(&s, &l, total, terms, 50);
    rate_sums_take(&s, &l, a);
    assert_close(a[row], 49.0 * 0.125, 0.0);
    assert_close(a[row + 1], 49.0 * 3.0, 0.0);
    assert_close(a[total], 49.0 * 0.5, 0.0);
    assert_close(a[row + 2], 0.0, 0.0);
    rate_sums_free(&s);
    free(a);
}
