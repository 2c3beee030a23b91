/* SPDX-License-Identifier: BSD-3-Clause */
/* Impacts: what a site strikes, what its velocity becomes, and whether the contact lasts. */
#ifndef DEM_CONTACT_IMPACT_SOLVE_H
#define DEM_CONTACT_IMPACT_SOLVE_H

#include "contact/contact_set.h"

/** The one or two features that a site strikes: segments, the one approached faster first, or a vertex. */
typedef struct contact_hit {
    int n;
    dem_index feature[2];
} contact_hit;

/** How deep a site can be at an impact, m: twice the skin, how far it moves in ten times the time to which events are
 *  located, and how far it may have been moved to straighten a contact beside it. */
double strike_depth(const contact_sites *c, dem_index k, const contact_moment *now);

/** Whether a node at x is in a corner of two segments, rather than on one nearly straight surface or in a channel:
 *  neighbours, which bend up here, form one at their vertex. */
bool strike_corner(const contact_sites *c, dem_index s, dem_index other, vec2 x, double tolerance);

/** What a touching node meets: the segment approached fastest, and a second one that forms a corner with it. */
contact_hit strike_met(const contact_sites *c, dem_index k, const contact_moment *now);

/** The edge at a node whose side a vertex meets where the node is, and the vertex: when a flat side comes down with a
 *  node right on an apex, the side's normal counts. Returns -1 where there is none. */
dem_index strike_side(const contact_sites *c, dem_index k, const contact_moment *now, dem_index *vertex);

/** Puts a group of contacts on their surfaces, and books what that puts in.  \return how far nodes have moved, m */
double strike_straighten(contact_sites *c, dem_index group, contact_moment *now);

/** Stops a group of contacts, and books what that takes. */
void strike_stop(contact_sites *c, dem_index group, contact_moment *now);

/** A site strikes: it is put back on the surface, rebounds, and the contacts that last are closed. A node on a segment
 *  that it does not strike again leaves it. */
dem_status strike(contact_sites *c, dem_index k, contact_hit hit, contact_moment *now);

/** Whether the node between two edges, on a vertex, comes to rest in the notch that they form there. */
bool strike_notch(const contact_sites *c, dem_index edge, dem_index next, const contact_moment *now);

/** A free site that nears a surface with this unit normal is reflected where it is: no contact closes. */
void strike_early(contact_sites *c, dem_index k, const contact_gap *gap, contact_moment *now);

#endif
