/* SPDX-License-Identifier: BSD-3-Clause */
/* Obstacles compiled to segments, and how these follow one another. Bodies live on the left. */
#ifndef DEM_OBSTACLE_OBSTACLE_H
#define DEM_OBSTACLE_OBSTACLE_H

#include "obstacle/box_tree.h"

typedef struct segment {
    vec2 start, end;
    vec2 tangent, normal;      /* unit; the normal points out of the solid, to the left */
    double length;             /* m */
    dem_index obstacle, index; /* which obstacle, which segment of it */
    dem_index before, after;   /* neighbouring segments, -1 at a free end */
    double buried[2];          /* m, how far it goes on inside another obstacle on which it stands: before, after */
} segment;

/** Where a polyline bends so that the solid's corner sticks out. */
typedef struct obstacle_vertex {
    vec2 at;
    dem_index before, after; /* segments that end and begin there */
} obstacle_vertex;

typedef struct obstacle_set {
    dem_index n, n_segments, n_vertices;
    dem_obstacle *list;        /* [n] with its own copies of the points */
    dem_index *first;          /* [n + 1] segments first[k] .. first[k+1]-1 are of obstacle k */
    segment *segments;         /* [n_segments] obstacle by obstacle, in order */
    obstacle_vertex *vertices; /* [n_vertices] obstacle by obstacle, in the order of the segments that end there */
    box_tree *trees;           /* [n] of the segments of each */
    box_tree vertex_tree;
} obstacle_set;

/** How a polyline turns from one segment into the next, seen by a body that slides along it. */
typedef enum obstacle_bend {
    OBSTACLE_FREE_END, /* nothing follows */
    OBSTACLE_STRAIGHT, /* the next segment goes on in line */
    OBSTACLE_CONVEX,   /* the next segment falls away */
    OBSTACLE_CONCAVE   /* the next segment stands in the way */
} obstacle_bend;

/** Whether two segments are neighbours, and the vertex that they share. */
bool obstacles_share(const obstacle_set *o, dem_index s, dem_index other, vec2 *vertex);

/** Bend where segment s ends (or, backwards, starts), and the segment beyond it. */
obstacle_bend obstacles_bend(const obstacle_set *o, dem_index s, bool backwards, dem_index *beyond);

/** All that counts as the segment, but for a margin. */
box segment_cover(const segment *s);

/** Signed distance to the segment's line, and place along it from its start, m. */
static inline double segment_height(const segment *s, vec2 x)
{
    return vec2_dot(vec2_sub(x, s->start), s->normal);
}

static inline double segment_place(const segment *s, vec2 x)
{
    return vec2_dot(vec2_sub(x, s->start), s->tangent);
}

#endif
