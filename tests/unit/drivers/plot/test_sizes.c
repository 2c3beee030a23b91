/* SPDX-License-Identifier: BSD-3-Clause */
/* sizes.c: shares of the mass, and what has no table of fragments. */
#include "trajectory_fixture.h"

#include "sizes.h"

TEST(a_share_has_all_masses_up_to_one)
{
    const double mass[] = {1.0, 2.0, 2.0, 5.0};
    assert_close(sizes_share(4, mass, 0.5), 0.0, 0.0);
    assert_close(sizes_share(4, mass, 1.0), 0.1, 1e-16);
    assert_close(sizes_share(4, mass, 2.0), 0.5, 1e-16);
    assert_close(sizes_share(4, mass, 4.9), 0.5, 1e-16);
    assert_close(sizes_share(4, mass, 5.0), 1.0, 0.0);
    assert_close(sizes_share(0, mass, 5.0), 0.0, 0.0);
}

/* Where all fragments are of about one size the axis is widened; there is a power of ten at both of its ends then. */
TEST(an_axis_of_masses_has_two_powers_of_ten)
{
    static const double masses[][2] = {{0.02, 0.02}, {2.0, 7.0}, {1.0, 1.0}, {8.0, 12.0}, {1e-3, 40.0}};
    double begin, end;
    for (size_t k = 0; k < sizeof masses / sizeof *masses; k++) {
        const double lo = log10(masses[k][0]), hi = log10(masses[k][1]);
        sizes_axis(masses[k][0], masses[k][1], &begin, &end);
        assert_true(begin < lo && end > hi);
        assert_true(floor(end) - ceil(begin) >= 1.0);
    }
    assert_close(begin, -3.0 - 0.1 * log10(4e4), 1e-14);
    assert_close(end, log10(40.0) + 0.1 * log10(4e4), 1e-14);
}
