/* SPDX-License-Identifier: BSD-3-Clause */
/* Rest, and constant velocity. */
#include "obstacle/motion_law.h"

motion_law motion_law_of(const dem_obstacle *obstacle)
{
    const vec2 velocity = vec2_at(obstacle->velocity, 0);
    return (motion_law){velocity.x != 0.0 || velocity.y != 0.0, velocity};
}

pose motion_law_pose(const motion_law *law, double t)
{
    return (pose){.centre = vec2_scale(t, law->velocity), .velocity = law->velocity, .axis = {1.0, 0.0}};
}

double motion_law_speed(const motion_law *law)
{
    return vec2_norm(law->velocity);
}

bool motion_law_is_same(const motion_law *a, const motion_law *b)
{
    return a->velocity.x == b->velocity.x && a->velocity.y == b->velocity.y;
}
