/* SPDX-License-Identifier: BSD-3-Clause */
/* walls.c: walls whose thickness follows from the keys. Differences of coordinates of 1 are right to some 1e-16. */
#include "unit/reading.h"

#include <math.h>

#include "unit/close.h"
#include "walls.h"

static void expect(const char *groups, double thinnest)
{
    resolved r = resolve(groups);
    namelist_errors_free(&r.errors);
    r.errors = (namelist_errors){0};
    const double found = walls_thinnest(&r.deck, 0);
    if (isfinite(thinnest))
        assert_close(found, thinnest, 1e-15);
    else
        assert_true(isinf(found));
    drop_resolved(&r);
}

#define HOLE(x, radius) "&void centre = " x ", radius = " radius " /\n"

TEST(a_ring_is_a_wall)
{
    expect("&body shape = 'ring', radius = 0.5, inner_radius = 0.4, spacing = 0.1 /\n", 0.1);
    expect("&body shape = 'ring', radius = 0.5, inner_radius = 0.2, spacing = 0.1 /\n" HOLE("0, 0.325", "0.05"), 0.075);
}

TEST(walls_are_between_voids_and_the_outline)
{
    expect("&body shape = 'disc', radius = 0.5, spacing = 0.1 /\n" HOLE("0.1, 0", "0.25"), 0.15);
    expect("&body shape = 'rectangle', size = 1, 2, spacing = 0.1 /\n" HOLE("0, 0.4", "0.25"), 0.15);
    expect("&body shape = 'polygon', points = 0, 0, 1, 0, 1, 2, 0, 2, spacing = 0.1 /\n" HOLE("0.3, 1", "0.25"), 0.05);
}

TEST(walls_are_between_voids)
{
    expect("&body shape = 'disc', radius = 2, spacing = 0.1 /\n" HOLE("-0.5, 0", "0.25") HOLE("0.5, 0", "0.125"),
           0.625);
}

TEST(where_there_is_no_wall_none_is_thin)
{
    const double none = (double)INFINITY;
    expect("&body shape = 'rectangle', size = 1, 2, spacing = 0.1 /\n", none);
    expect("&body shape = 'disc', radius = 0.5, spacing = 0.1 /\n" HOLE("0.5, 0", "0.25"), none); /* it opens the rim */
    expect("&body shape = 'disc', radius = 0.5, spacing = 0.1 /\n&void body = 2, centre = 0, 0, radius = 0.45 /\n",
           none);
    expect("&body shape = 'mask', file = 'a.pgm', scale = 1, spacing = 0.1 /\n" HOLE("0, 0", "0.25"), none);
    expect("", none);
}
