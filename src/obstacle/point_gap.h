/* SPDX-License-Identifier: BSD-3-Clause */
/* Points against segments: signed gap, nearest feature, what a point touches. Places are those at t, in the axes of
 * space. */
#ifndef DEM_OBSTACLE_POINT_GAP_H
#define DEM_OBSTACLE_POINT_GAP_H

#include "obstacle/obstacle.h"

/** Nearest feature of the obstacles to a point. */
typedef struct obstacle_gap {
    double distance;   /* m, > 0 in front, < 0 inside; infinity where there is no obstacle */
    dem_index segment; /* the nearest segment; -1 where there is none */
    vec2 normal;       /* unit, from the nearest point in front: the gradient of the distance */
} obstacle_gap;

/** Smallest of the signed distances of x to the obstacles at t, leaving out up to two of them (-1: none). Free ends
 *  count as longer by `margin` (m), so that what touches another obstacle there leaves no gap. */
obstacle_gap obstacles_gap(const obstacle_set *o, double t, vec2 x, double margin, dem_index without,
                           dem_index without_too);

/** Signed distance of x to one obstacle: to its nearest point. Where two segments meet, a point nearest to the
 *  vertex is in front if it is on the side of the vertex's mean normal; nearest to a free end, it is in front. */
obstacle_gap obstacles_gap_of(const obstacle_set *o, double t, vec2 x, double margin, dem_index obstacle);

/** A lone segment: within a radius of a place the nearest place of all obstacles is on it, and is no end of it, so that
 *  the gap of a point there is its height over the segment's line. */
typedef struct obstacle_lone_segment {
    vec2 centre;
    double radius;     /* m; 0: no segment is alone there */
    dem_index segment; /* of an obstacle at rest */
} obstacle_lone_segment;

/** The lone segment about x, for a radius that is easily found; none where there are several obstacles, or one that
 *  moves.
 *  \param margin  m, the gaps are those of obstacles_gap() with this margin */
obstacle_lone_segment obstacles_lone_segment(const obstacle_set *o, vec2 x, double margin);

static inline bool obstacle_lone_covers(const obstacle_lone_segment *a, vec2 x)
{
    const vec2 from = vec2_sub(x, a->centre);
    return vec2_dot(from, from) < a->radius * a->radius;
}

/** obstacles_gap() of a point that it covers, to the bit. */
static inline obstacle_gap obstacle_lone_gap(const obstacle_set *o, const obstacle_lone_segment *a, vec2 x)
{
    const segment *s = &o->segments[a->segment];
    return (obstacle_gap){segment_height(s, x), a->segment, s->normal};
}

/** How near a point must be to touch. */
typedef struct obstacle_touch {
    double tolerance;  /* m, to the line and along it */
    double margin;     /* m, as for obstacles_gap() */
    dem_index without; /* obstacle left out, or -1 */
} obstacle_touch;

/** Segments that x touches at t, at most `capacity` of them, into hits; returns their number. */
int obstacles_touching(const obstacle_set *o, double t, vec2 x, const obstacle_touch *point, dem_index *hits,
                       int capacity);

#endif
