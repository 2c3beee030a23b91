/* SPDX-License-Identifier: BSD-3-Clause */
/* How segments of a set follow one another. */
#include "obstacle/obstacle.h"

static const double straight_below = 1e-9; /* sine of the bend */

box segment_cover(const segment *s)
{
    return box_around(vec2_along(s->start, -s->buried[0], s->tangent), vec2_along(s->end, s->buried[1], s->tangent),
                      0.0);
}

bool obstacles_share(const obstacle_set *o, dem_index s, dem_index other, vec2 *vertex)
{
    const bool ends = o->segments[s].after == other, starts = o->segments[s].before == other;
    *vertex = ends ? o->segments[s].end : o->segments[s].start;
    return ends || starts;
}

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
