/* SPDX-License-Identifier: BSD-3-Clause */
/* obstacle_load.c: place, angle and power of an obstacle. */
#include "unit/contact/bench.h"

#include "contact/obstacle_load.h"

/* After a quarter turn and 0.5 s, with forces on two obstacles; the friction of the first contact acts along
 * (n_y, -n_x). */
TEST(the_power_is_that_of_the_forces_on_the_points_that_they_act_on)
{
    static const double points[4] = {1.0, 0.0, 3.0, 0.0};
    const dem_contact list[3] = {
        {.obstacle = 1, .x = {1.0, 4.0}, .normal = {0.0, 1.0}, .force = 6.0, .friction = {2.0, 0.0}},
        {.obstacle = 0, .x = {9.0, 9.0}, .normal = {1.0, 0.0}, .force = 8.0},
        {.obstacle = 1, .x = {2.0, 2.0}, .normal = {1.0, 0.0}, .force = 5.0}};
    bench b;
    bench_open(&b, 1);
    b.list[1].points = points;
    b.list[1].n_points = 2;
    b.list[1].velocity[1] = 2.0;
    b.list[1].pivot[0] = 1.0;
    b.list[1].spin = M_PI;
    b.laws[1] = motion_law_of(&b.list[1]);
    const pose at = motion_law_pose(&b.laws[1], 0.5);
    dem_obstacle_load load = {0};
    obstacle_load_add_motion(&load, &at, 1, list, 3);
    assert_close(load.displacement[0], 0.0, 0.0);
    assert_close(load.displacement[1], 1.0, 0.0);
    assert_close(load.angle, 0.5 * M_PI, 1e-15);
    /* The pivot is at (1, 1): w is (-3 pi, 2) at the first contact and (-pi, 2 + pi) at the second. */
    assert_close(load.power, 6.0 * 2.0 + 2.0 * -3.0 * M_PI + 5.0 * -M_PI, 1e-13);
}
