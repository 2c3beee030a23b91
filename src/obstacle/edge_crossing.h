/* SPDX-License-Identifier: BSD-3-Clause */
/* Edges of bodies that segments of obstacles go through. Vertices and nodes that are not inside of anything do not tell
 * of it: a spike may end in a void of the body. */
#ifndef DEM_OBSTACLE_EDGE_CROSSING_H
#define DEM_OBSTACLE_EDGE_CROSSING_H

#include "obstacle/obstacle.h"

/** The segment that goes deepest through an edge. */
typedef struct obstacle_crossing {
    dem_index segment; /* -1: none does */
    double depth;      /* m, least distance by which either must move to come apart; 0: none */
} obstacle_crossing;

/** Of all segments where they are at t, against the edge between a and b, leaving out up to two obstacles (-1: none).
 *  Of equal depths the lowest index counts. */
obstacle_crossing obstacles_crossing(const obstacle_set *o, double t, const vec2 edge[2], const dem_index without[2]);

#endif
