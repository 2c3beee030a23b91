/* SPDX-License-Identifier: BSD-3-Clause */
/* Obstacles compiled to segments: signed gap, nearest feature, what a point touches. Bodies live on the left. */
#ifndef DEM_OBSTACLE_OBSTACLE_H
#define DEM_OBSTACLE_OBSTACLE_H

#include "obstacle/box_tree.h"

typedef struct segment {
    vec2 start, end;
    vec2 tangent, normal;      /* unit; the normal points out of the solid, to the left */
    double length;             /* m */
    double restitution;        /* eta of its obstacle */
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

/** Nearest feature of the obstacles to a point. */
typedef struct obstacle_gap {
    double distance;   /* m, > 0 in front, < 0 inside; infinity where there is no obstacle */
    dem_index segment; /* the nearest segment; -1 where there is none */
    vec2 normal;       /* unit, from the nearest point in front: the gradient of the distance */
} obstacle_gap;

/** How a polyline turns from one segment into the next, seen by a body that slides along it. */
typedef enum obstacle_bend {
    OBSTACLE_FREE_END, /* nothing follows */
    OBSTACLE_STRAIGHT, /* the next segment goes on in line */
    OBSTACLE_CONVEX,   /* the next segment falls away */
    OBSTACLE_CONCAVE   /* the next segment stands in the way */
} obstacle_bend;

/** Validates, copies and compiles; DEM_ERROR_MODEL names the obstacle and the segment. Free with obstacles_free. */
dem_status obstacles_compile(obstacle_set *out, const dem_obstacle *list, dem_index n);
void obstacles_free(obstacle_set *o);

/** Smallest of the signed distances of x to the obstacles, leaving out up to two of them (-1: none). Free ends count as
 *  longer by `margin` (m), so that what touches another obstacle there leaves no gap. */
obstacle_gap obstacles_gap(const obstacle_set *o, vec2 x, double margin, dem_index without, dem_index without_too);

/** Signed distance of x to one obstacle: to its nearest point. Where two segments meet, a point nearest to the
 *  vertex is in front if it is on the side of the vertex's mean normal; nearest to a free end, it is in front. */
obstacle_gap obstacles_gap_of(const obstacle_set *o, vec2 x, double margin, dem_index obstacle);

/** How near a point must be to touch. */
typedef struct obstacle_touch {
    double tolerance;  /* m, to the line and along it */
    double margin;     /* m, as for obstacles_gap() */
    dem_index without; /* obstacle left out, or -1 */
} obstacle_touch;

/** Segments that x touches, at most `capacity` of them, into hits; returns their number. */
int obstacles_touching(const obstacle_set *o, vec2 x, const obstacle_touch *point, dem_index *hits, int capacity);

/** A straight edge of a body, from a to b with the body on its left. */
typedef struct obstacle_edge {
    vec2 a, b;
    vec2 previous, next;  /* where the boundary comes from and goes on; a and b if nothing is known of that */
    double tolerance;     /* m, by which the edge counts as longer at both ends */
    double depth;         /* m, how far behind the edge a vertex is still looked at */
    double reach;         /* m, how far in front of it */
    dem_index without[2]; /* obstacles left out, or -1 */
    dem_index except[2];  /* vertices left out, or -1 */
} obstacle_edge;

/** The vertex nearest to entering through the edge. */
typedef struct obstacle_poke {
    double distance;  /* m, of the vertex in front of the edge: > 0 outside the body, < 0 inside; infinity: none */
    dem_index vertex; /* -1: none */
    double place;     /* of its foot on the edge, 0 at a, 1 at b, or the nearer end of it */
    vec2 normal;      /* unit, left of the edge: into the body, out of the obstacle */
} obstacle_poke;

/** Of the convex vertices whose foot is on the edge, nearer in front than `reach` and behind than `depth`, and whose
 *  mean normal points into the body: the one with the smallest distance, the first of equals. One behind the edge that
 *  is nearer to a neighbouring edge, round a convex corner of the body, is not meant; one in a notch of the body,
 *  behind the edge and its neighbour between their feet, is. */
obstacle_poke obstacles_poke(const obstacle_set *o, const obstacle_edge *edge);

/** Distance of the edge to the nearest convex vertex, at most its `reach`, m. */
double obstacles_clearance(const obstacle_set *o, const obstacle_edge *edge);

/** Whether two segments are neighbours, and the vertex that they share. */
bool obstacles_share(const obstacle_set *o, dem_index s, dem_index other, vec2 *vertex);

/** Bend where segment s ends (or, backwards, starts), and the segment beyond it. */
obstacle_bend obstacles_bend(const obstacle_set *o, dem_index s, bool backwards, dem_index *beyond);

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
