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
