/* SPDX-License-Identifier: BSD-3-Clause */
/* twofold.h against exact sums. */
#include "verification/support.h"

#include <gsl/gsl_rng.h>

#include "base/exact_sum.h"
#include "base/twofold.h"
#include "harness/cleanup_gsl.h"

/* 1e5 terms of both signs between 1e-8 and 1e8: in doubles alone the sum is wrong by some 1e-11 of its terms. */
TEST(a_sum_has_the_bits_of_the_exact_one)
{
    CLEANUP(free_rng) gsl_rng *r = gsl_rng_alloc(gsl_rng_mt19937);
    twofold sum = {0}, parts[3] = {{0}};
    exact_sum exact = {0};
    double plain = 0.0;
    for (int k = 0; k < 100000; k++) {
        const double term = (gsl_rng_uniform(r) - 0.5) * pow(10.0, 16.0 * gsl_rng_uniform(r) - 8.0);
        twofold_add(&sum, term);
        twofold_add(&parts[k % 3], term);
        exact_sum_add(&exact, term);
        plain += term;
    }
    const double value = exact_sum_value(&exact);
    assert_close(twofold_value(sum), value, 0.0);
    assert_true(plain != value);
    for (int k = 1; k < 3; k++) twofold_join(&parts[0], parts[k]);
    assert_close(twofold_value(parts[0]), value, 0.0);
}

TEST(small_terms_are_not_lost_behind_large_ones)
{
    twofold sum = {0};
    const double terms[] = {1e100, 1.0, 3.0, -1e100, 0.5};
    for (int k = 0; k < 5; k++) twofold_add(&sum, terms[k]);
    assert_close(twofold_value(sum), 4.5, 0.0);
    assert_close(twofold_value((twofold){0}), 0.0, 0.0);
}

TEST(what_is_not_finite_stays_so)
{
    twofold up = {0}, both = {0}, none = {0};
    twofold_add(&up, 1.0);
    twofold_add(&up, (double)INFINITY);
    twofold_add(&up, 1.0);
    assert_true(isinf(twofold_value(up)) && twofold_value(up) > 0.0);
    twofold_add(&both, (double)INFINITY);
    twofold_add(&both, -(double)INFINITY);
    assert_true(isnan(twofold_value(both)));
    twofold_add(&none, (double)NAN);
    assert_true(isnan(twofold_value(none)));
}
