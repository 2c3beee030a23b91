/* SPDX-License-Identifier: BSD-3-Clause */
/* anchor.c: the spring of one anchor, its limit, and its energy. The forces that it makes are in test_anchor_set.c. */
#include "surface_contact/anchor.h"

#include "../close.h"

/* A spring that pulls with 3 N. */
static const anchor pulled = {.stiffness = 10.0, .friction = 0.5, .force = 3.0};

static anchor_load load(double press, double way)
{
    return (anchor_load){.press = press, .way = way};
}

static void expect(const anchor_load at, double force, double ratio, double energy)
{
    assert_close(anchor_force(&pulled, &at), force, 1e-15);
    assert_close(anchor_ratio(&pulled, &at), ratio, 1e-16);
    assert_close(anchor_energy(&pulled, &at), energy, 1e-15);
}

TEST(the_force_is_that_of_the_spring_up_to_friction)
{
    expect(load(100.0, 0.0), 3.0, 0.03, 0.45);
    expect(load(100.0, 0.1), 4.0, 0.04, 0.8);
    expect(load(100.0, -1.0), -7.0, -0.07, 2.45);
    expect(load(2.0, 0.0), 1.0, 0.5, 0.05);
    expect(load(2.0, -4.0), -1.0, -0.5, 0.05);
}

TEST(what_does_not_press_has_none)
{
    expect(load(0.0, 0.1), 0.0, 0.0, 0.0);
}
