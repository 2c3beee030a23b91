/* SPDX-License-Identifier: BSD-3-Clause */
/* natural_log.h against the logarithm of long doubles. */
#include "base/natural_log.h"

#include "../close.h"

/* Over all binary orders, subnormal numbers included. A rounding of s, one of the series and one of the sum
 * are some 3 units in the last place, and ln 2 is off by 0.2 units. */
TEST(it_agrees_with_the_logarithm_of_long_doubles)
{
    for (double r = 1.0; r > 1e-320; r *= 0.77) {
        const long double expected = logl((long double)r);
        assert_close(natural_log(r), (double)expected, 4.5e-16 * fmax(1e-300, fabs((double)expected)));
    }
    assert_close(natural_log(1.0), 0.0, 0.0);
}
