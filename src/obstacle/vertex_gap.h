/* SPDX-License-Identifier: BSD-3-Clause */
/* Edges of bodies against convex vertices of obstacles. Places are those at t, in the axes of space. */
#ifndef DEM_OBSTACLE_VERTEX_GAP_H
#define DEM_OBSTACLE_VERTEX_GAP_H

#include "obstacle/obstacle.h"

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

/** The vertex that is deepest in the body, or nearest to entering it, through the edge. */
typedef struct obstacle_vertex_gap {
    double distance;  /* m, of the vertex in front of the edge: > 0 outside the body, < 0 inside; infinity: none */
    dem_index vertex; /* -1: none */
    double place;     /* of its foot on the edge, 0 at a, 1 at b, or the nearer end of it */
    vec2 normal;      /* unit, left of the edge: into the body, out of the obstacle */
} obstacle_vertex_gap;

/** The convex vertex with the smallest distance at t, and of equal ones the first. Only vertices count whose foot is on
 *  the edge, which are nearer in front than `reach` and behind than `depth`, and whose mean normal points into the
 *  body. Behind the edge, a vertex that is nearer to a neighbouring edge round a convex corner of the body belongs to
 *  that edge; one in a notch of the body, with its foot beyond the ends of both edges, belongs to both. */
obstacle_vertex_gap obstacles_vertex_gap(const obstacle_set *o, double t, const obstacle_edge *edge);

/** Distance of the edge to the nearest convex vertex at t, at most its `reach`, m. */
double obstacles_clearance(const obstacle_set *o, double t, const obstacle_edge *edge);

#endif
