/* SPDX-License-Identifier: BSD-3-Clause */
/* softening.h: the saw-tooth against the law that it stands for. */
#include "verification/support.h"

#include "elastic/softening.h"

static const double ratios[] = {1.1, 1.7, 2.0, 3.0, 6.0, 15.0, 40.0};
enum { N_RATIOS = sizeof ratios / sizeof *ratios };

/* Stress over strength by the law. */
static double law(double q, double u)
{
    return (q - u) / (q - 1.0);
}

/* The energy is what is taken at each limit, U^2/2 times what is lost there; that of the law is the area under it, 1/2
 * up to the strength and (q - 1)/2 behind it. 1e-14 of it is rounding. */
TEST(a_triangle_that_breaks_has_taken_the_energy_of_the_law)
{
    for (int k = 0; k < N_RATIOS; k++) {
        const double q = ratios[k];
        const int n = softening_levels(q);
        double taken = 0.0;
        for (int level = 0; level <= n; level++) {
            const double u = softening_limit(q, level), after = level < n ? softening_left(q, level + 1) : 0.0;
            taken += 0.5 * u * u * (softening_left(q, level) - after);
        }
        assert_close(taken, 0.5 * q, 1e-14 * q);
    }
}

/* The limits go from 1 to q, where nothing would be left. */
TEST(limits_grow_and_what_is_left_falls)
{
    for (int k = 0; k < N_RATIOS; k++) {
        const double q = ratios[k];
        const int n = softening_levels(q);
        assert_close(softening_limit(q, 0), 1.0, 0.0);
        assert_close(softening_left(q, 0), 1.0, 0.0);
        assert_close(softening_limit(q, n), q, 1e-14 * q);
        for (int level = 0; level < n; level++) {
            assert_true(softening_limit(q, level + 1) > softening_limit(q, level));
            assert_true(softening_left(q, level + 1) < softening_left(q, level));
        }
        assert_true(softening_left(q, n) > 0.0);
    }
}

/* Before and after each limit the stress is off the law by the same, q ln q/(64 (q - 1)), to the next order in the way
 * between two limits. */
TEST(the_stress_stays_near_the_law)
{
    for (int k = 0; k < N_RATIOS; k++) {
        const double q = ratios[k], bound = q * log(q) / (64.0 * (q - 1.0)), way = log(q) / 32.0;
        for (int level = 1; level <= softening_levels(q); level++) {
            const double left = softening_left(q, level), from = softening_limit(q, level - 1);
            const double to = softening_limit(q, level);
            assert_close(law(q, from) - left * from, bound, way * bound);
            assert_close(left * to - law(q, to), bound, way * bound);
        }
    }
}

TEST(a_brittle_triangle_breaks_at_its_strength)
{
    assert_int_equal(softening_levels(1.0), 0);
    assert_close(softening_limit(1.0, 0), 1.0, 0.0);
}
