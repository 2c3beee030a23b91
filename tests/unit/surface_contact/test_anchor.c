/* SPDX-License-Identifier: BSD-3-Clause */
/* anchor.c: the spring of one anchor, its limit, and its energy. The forces that it makes are in test_anchor_set.c. */
#include "surface_contact/anchor.h"

#include "../close.h"

/* A spring that pulls with 3 N, on a node that is pushed down. */
static const anchor pulled = {.stiffness = 10.0, .friction = 0.5, .force = 3.0, .normal = {0.0, -50.0}};

static anchor_load load(double normal_x, double normal_y, double way)
{
    return (anchor_load){.normal = {normal_x, normal_y}, .way = way};
}

static void expect(const anchor_load at, double force, double ratio, double energy)
{
    assert_close(anchor_force(&pulled, &at), force, 1e-15);
    assert_close(anchor_ratio(&pulled, &at), ratio, 1e-16);
    assert_close(anchor_energy(&pulled, &at), energy, 1e-15);
}

TEST(the_force_is_that_of_the_spring_up_to_friction)
{
    expect(load(0.0, -100.0, 0.0), 3.0, 0.03, 0.45);
    expect(load(60.0, -80.0, 0.1), 4.0, 0.04, 0.8);
    expect(load(0.0, -100.0, -1.0), -7.0, -0.07, 2.45);
    expect(load(0.0, -2.0, 0.0), 1.0, 0.5, 0.05);
    expect(load(0.0, -2.0, -4.0), -1.0, -0.5, 0.05);
}

TEST(what_pushes_the_other_way_or_not_at_all_has_none)
{
    expect(load(0.0, 1.0, 0.1), 0.0, 0.0, 0.0);
    expect(load(0.0, 0.0, 0.1), 0.0, 0.0, 0.0);
}
