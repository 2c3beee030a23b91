/* SPDX-License-Identifier: BSD-3-Clause */
/* Segments and vertices of compiled obstacles at a given time, and how segments follow one another. Geometry stays as
 * compiled, in the frame of each obstacle; an obstacle that moves has its pose applied when it is asked for. Distances
 * are not here but in point_gap.c and vertex_gap.c, compiling in obstacle_set.c. */
#include "obstacle/obstacle.h"

static const double straight_below = 1e-9; /* sine of the bend */

/* The segment and what of it is buried behind another obstacle at its free ends. */
box segment_cover(const segment *s)
{
    return box_around(vec2_along(s->start, -s->buried[0], s->tangent), vec2_along(s->end, s->buried[1], s->tangent),
                      0.0);
}

/* Velocity and acceleration, seen from outside, of the obstacle's point that is at x at t. */
obstacle_motion obstacles_motion_moving(const obstacle_set *o, dem_index obstacle, double t, vec2 x)
{
    const pose at = motion_law_pose(&o->laws[obstacle], t);
    return (obstacle_motion){true, pose_velocity(&at, x), pose_acceleration(&at, x), at.spin};
}

vec2 obstacles_inside(const obstacle_set *o, dem_index obstacle, double t, vec2 x)
{
    if (!o->laws[obstacle].moves) return x;
    const pose at = motion_law_pose(&o->laws[obstacle], t);
    return pose_inside(&at, x);
}

vec2 obstacles_outside(const obstacle_set *o, dem_index obstacle, double t, vec2 x)
{
    if (!o->laws[obstacle].moves) return x;
    const pose at = motion_law_pose(&o->laws[obstacle], t);
    return pose_outside(&at, x);
}

/* Ends are carried along, directions are only turned. */
const segment *obstacles_segment_moving(const obstacle_set *o, dem_index s, double t, segment *moved)
{
    const segment *given = &o->segments[s];
    const pose at = motion_law_pose(&o->laws[given->obstacle], t);
    *moved = *given;
    moved->start = pose_outside(&at, given->start);
    moved->end = pose_outside(&at, given->end);
    moved->tangent = pose_turn(&at, given->tangent);
    moved->normal = pose_turn(&at, given->normal);
    return moved;
}

vec2 obstacles_vertex(const obstacle_set *o, dem_index vertex, double t)
{
    const obstacle_vertex *v = &o->vertices[vertex];
    return obstacles_outside(o, o->segments[v->before].obstacle, t, v->at);
}

/* *vertex is the end of s if `other` follows it, else its start, which is their vertex if `other` precedes it. */
bool obstacles_share(const obstacle_set *o, double t, dem_index s, dem_index other, vec2 *vertex)
{
    const bool ends = o->segments[s].after == other, starts = o->segments[s].before == other;
    segment moved;
    const segment *here = obstacles_segment(o, s, t, &moved);
    *vertex = ends ? here->end : here->start;
    return ends || starts;
}

/* The sine of the bend is the cross product of the tangents. Bodies are on the left: a turn to the right (< 0) makes a
 * convex vertex. Tangents that are opposite have a small sine, too, and are no straight line. */
obstacle_bend obstacles_bend(const obstacle_set *o, dem_index s, bool backwards, dem_index *beyond)
{
    const segment *here = &o->segments[s];
    *beyond = backwards ? here->before : here->after;
    if (*beyond < 0) return OBSTACLE_FREE_END;
    const segment *there = &o->segments[*beyond];
    const double turn =
        backwards ? vec2_cross(there->tangent, here->tangent) : vec2_cross(here->tangent, there->tangent);
    const double along = vec2_dot(here->tangent, there->tangent);
    if (fabs(turn) < straight_below && along > 0.0) return OBSTACLE_STRAIGHT;
    return turn < 0.0 ? OBSTACLE_CONVEX : OBSTACLE_CONCAVE;
}
