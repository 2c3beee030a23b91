/* SPDX-License-Identifier: BSD-3-Clause */
/* natural_power.h against the powers of long doubles. */
#include "base/natural_power.h"

#include "../close.h"

/* The logarithm is off by 4.5e-16 of itself (test_natural_log.c), its product with p by another rounding, and the
 * series of e^r by some 2e-16. */
TEST(it_agrees_with_the_powers_of_long_doubles)
{
    for (double p = 0.01; p < 8.0; p *= 1.37)
        for (double x = 1e-30; x < 1e30; x *= 2.9) {
            const long double expected = powl((long double)x, (long double)p);
            const double log_of_it = p * fabs(log(x));
            assert_close(natural_power(x, p), (double)expected, (6e-16 * log_of_it + 4e-16) * (double)expected);
        }
    assert_close(natural_power(1.0, 0.3), 1.0, 0.0);
}

TEST(beyond_the_range_of_doubles_it_is_infinite_or_0)
{
    assert_true(isinf(natural_power(1e300, 2.0)));
    assert_close(natural_power(1e-300, 2.0), 0.0, 0.0);
    assert_true(isfinite(natural_power_of_e(709.7)));
    assert_true(natural_power_of_e(-744.0) > 0.0);
}
