/* SPDX-License-Identifier: BSD-3-Clause */
/* Which features of the obstacles the impact of a candidate is with. */
#ifndef DEM_CONTACT_IMPACT_TARGET_H
#define DEM_CONTACT_IMPACT_TARGET_H

#include "contact/contact_set.h"

/** The one or two features that a candidate hits: segments, the one approached faster first, or a vertex. */
typedef struct impact_target {
    int n;
    dem_index feature[2];
} impact_target;

/** How deep a candidate can be at an impact, m: twice the penetration tolerance, plus the way that it moves in ten
 *  times the width to which events are located, plus the largest displacement by which contacts were put back. */
double impact_target_depth(const contact_set *c, dem_index k, const contact_instant *now);

/** Whether a node at a point is in a corner of two segments, rather than on one nearly straight surface or in a
 *  channel: neighbours, which bend up here, form one at their vertex. */
bool impact_target_is_corner(const contact_set *c, dem_index s, dem_index other, surface_query at, double tolerance);

/** What a touching node meets: the segment approached fastest, and a second one that forms a corner with it. */
impact_target impact_target_of_node(const contact_set *c, dem_index k, const contact_instant *now);

/** The edge at a node that a vertex touches where the node is, and that vertex: where a flat side comes down with a
 *  node right on an apex, the normal of the side counts. Returns -1 where there is none. */
dem_index impact_target_edge(const contact_set *c, dem_index k, const contact_instant *now, dem_index *vertex);

#endif
