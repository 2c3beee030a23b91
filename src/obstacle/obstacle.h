/* SPDX-License-Identifier: BSD-3-Clause */
/* Obstacles compiled to segments, and how these follow one another. Bodies live on the left. Segments and vertices are
 * stored in the frame of their obstacle, which is where its points were given at t = 0; functions with an argument t
 * give them where they are at that time. */
#ifndef DEM_OBSTACLE_OBSTACLE_H
#define DEM_OBSTACLE_OBSTACLE_H

#include "obstacle/box_tree.h"
#include "obstacle/motion_law.h"

typedef struct segment {
    vec2 start, end;
    vec2 tangent, normal;      /* unit; the normal points out of the solid, to the left */
    double length;             /* m */
    dem_index obstacle, index; /* which obstacle, which segment of it */
    dem_index before, after;   /* neighbouring segments, -1 at a free end */
    double buried[2];          /* m, continuation inside another obstacle on which a free end stands: start, end */
} segment;

/** A vertex where a polyline bends away from the bodies: the solid's corner sticks out. */
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
    motion_law *laws;          /* [n] how each moves */
    motion_bounds bounds;      /* of all; speed 0: all stand at rest */
    bool is_asked;             /* whether functions of the caller say how some move */
    box_tree *trees;           /* [n] of the segments of each */
    box_tree vertex_tree;      /* of the vertices of those at rest; others are in none of its boxes */
    dem_index *first_vertex;   /* [n + 1] vertices first_vertex[k] .. first_vertex[k+1]-1 are of obstacle k */
    box_tree *vertex_trees;    /* [n] of the vertices of each that moves */
} obstacle_set;

/** Motion of a point of an obstacle; all 0 at rest. */
typedef struct obstacle_motion {
    bool moves;
    vec2 velocity, acceleration; /* m/s, m/s^2 */
    double spin;                 /* rad/s */
} obstacle_motion;

/** The bend from one segment to the next, as a body meets it that slides along. */
typedef enum obstacle_bend {
    OBSTACLE_FREE_END, /* nothing follows */
    OBSTACLE_STRAIGHT, /* the next segment goes on in line */
    OBSTACLE_CONVEX,   /* the next segment falls away */
    OBSTACLE_CONCAVE   /* the next segment stands in the way */
} obstacle_bend;

/** Whether two segments are neighbours, and the place of their common vertex at t. */
bool obstacles_share(const obstacle_set *o, double t, dem_index s, dem_index other, vec2 *vertex);

/** The bend where segment s ends (backwards: where it starts), and the segment beyond it. */
obstacle_bend obstacles_bend(const obstacle_set *o, dem_index s, bool backwards, dem_index *beyond);

/** Whether an obstacle moves. Where none does this is one comparison. */
static inline bool obstacles_moves(const obstacle_set *o, dem_index obstacle)
{
    return o->bounds.speed > 0.0 && o->laws[obstacle].moves;
}

/** The motion of the obstacle's point that is at x at t. */
obstacle_motion obstacles_motion_moving(const obstacle_set *o, dem_index obstacle, double t, vec2 x);

static inline obstacle_motion obstacles_motion(const obstacle_set *o, dem_index obstacle, double t, vec2 x)
{
    return obstacles_moves(o, obstacle) ? obstacles_motion_moving(o, obstacle, t, x) : (obstacle_motion){0};
}

/** Velocity relative to that point, m/s. */
static inline vec2 obstacle_motion_relative(const obstacle_motion *m, vec2 v)
{
    return vec2_sub(v, m->velocity);
}

/** The absolute velocity of a point with this velocity relative to the obstacle. On an obstacle at rest it is
 *  `relative` to the bit, signs of zeros included. */
static inline vec2 obstacle_motion_carry(vec2 velocity, vec2 relative)
{
    return velocity.x != 0.0 || velocity.y != 0.0 ? vec2_add(relative, velocity) : relative;
}

/** b = w' + 2 q' z x (v - w): acceleration of a point with velocity v that stays on the surface there, m/s^2. */
static inline vec2 obstacle_motion_sliding(const obstacle_motion *m, vec2 v)
{
    const vec2 u = vec2_sub(v, m->velocity), coriolis = {-2.0 * m->spin * u.y, 2.0 * m->spin * u.x};
    return m->moves ? vec2_add(m->acceleration, coriolis) : m->acceleration;
}

/** A place at t, in the axes of space, as coordinates in the frame of an obstacle. */
vec2 obstacles_inside(const obstacle_set *o, dem_index obstacle, double t, vec2 x);

/** The place at t, in the axes of space, of a point given in the frame of an obstacle. */
vec2 obstacles_outside(const obstacle_set *o, dem_index obstacle, double t, vec2 x);

/** The segment as it lies at t: the compiled one if its obstacle is at rest; otherwise *moved is filled and
 *  returned. */
const segment *obstacles_segment_moving(const obstacle_set *o, dem_index s, double t, segment *moved);

static inline const segment *obstacles_segment(const obstacle_set *o, dem_index s, double t, segment *moved)
{
    return obstacles_moves(o, o->segments[s].obstacle) ? obstacles_segment_moving(o, s, t, moved) : &o->segments[s];
}

/** Where the vertex is at t. */
vec2 obstacles_vertex(const obstacle_set *o, dem_index vertex, double t);

/** A box around the segment and its buried continuations, without any margin. */
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
