/* SPDX-License-Identifier: BSD-3-Clause */
/* Where a rigid body is at one time and how it moves: the frame in which its geometry is given, in the axes of space.
 * With c the centre, o the origin and q the angle, the point that is given at X is at x = c + R(q) (X - o). With
 * r = x - c it moves with
 *   w = c' + q' z x r,    w' = c'' + q'' z x r - q'^2 r. */
#ifndef DEM_OBSTACLE_POSE_H
#define DEM_OBSTACLE_POSE_H

#include "base/vec2.h"

typedef struct pose {
    vec2 origin;                         /* o m, the point of the body that is at the centre, as it is given */
    vec2 centre, velocity, acceleration; /* c m, c' m/s, c'' m/s^2 */
    vec2 axis;                           /* (cos q, sin q) */
    double angle, spin, spin_rate;       /* q rad, q' rad/s, q'' rad/s^2 */
} pose;

/** A direction of the body, in the axes of space. */
static inline vec2 pose_turn(const pose *p, vec2 d)
{
    return (vec2){p->axis.x * d.x - p->axis.y * d.y, p->axis.y * d.x + p->axis.x * d.y};
}

/** A place given in the body's frame, in the axes of space. */
static inline vec2 pose_outside(const pose *p, vec2 x)
{
    return vec2_add(p->centre, pose_turn(p, vec2_sub(x, p->origin)));
}

/** A place in the axes of space, in the body's frame. */
static inline vec2 pose_inside(const pose *p, vec2 x)
{
    const vec2 r = vec2_sub(x, p->centre);
    const vec2 turned_back = {p->axis.x * r.x + p->axis.y * r.y, p->axis.x * r.y - p->axis.y * r.x};
    return vec2_add(turned_back, p->origin);
}

/** w, m/s: the velocity of the body's point at x. */
static inline vec2 pose_velocity(const pose *p, vec2 x)
{
    const vec2 r = vec2_sub(x, p->centre);
    return vec2_add(p->velocity, (vec2){-p->spin * r.y, p->spin * r.x});
}

/** w', m/s^2: the acceleration of the body's point at x. */
static inline vec2 pose_acceleration(const pose *p, vec2 x)
{
    const vec2 r = vec2_sub(x, p->centre), turned = {-p->spin_rate * r.y, p->spin_rate * r.x};
    return vec2_along(vec2_add(p->acceleration, turned), -p->spin * p->spin, r);
}

#endif
