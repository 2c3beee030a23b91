/* SPDX-License-Identifier: BSD-3-Clause */
/* What impacts of nodes and of groups have in common: the surface met, and what counts as rest on it. */
#ifndef DEM_CONTACT_IMPACT_REST_H
#define DEM_CONTACT_IMPACT_REST_H

#include "contact/contact_set.h"
#include "contact/impact_law.h"

/** The surface that a candidate meets at a feature, with this unit normal. */
impact_surface impact_rest_surface(const contact_set *c, dem_index k, dem_index feature, vec2 normal);

/** The sign with which a contact begins: it slides the way it moves; at rest it sticks if there is friction. */
int impact_rest_slide(const contact_set *c, dem_index k, dem_index feature, double speed);

/** Speed at or below which a point counts as at rest on a surface to which an acceleration `back` returns it: its hop
 *  would be lower than the position tolerance, than the rounding of coordinates, or than the hop that impacts keep up
 *  for ever because each is taken at the depth of the penetration tolerance; or it would be shorter than twice the
 *  window. A rest speed that is given adds to these limits and replaces none: a smaller one would leave bounces that
 *  never end. -1 if nothing returns it.
 *  \param shared  the impact may open other contacts that share a node */
double impact_rest_speed(const contact_set *c, vec2 x, double back, const impact_surface *on, bool shared);

/** Whether the node between two edges, on a vertex, comes to rest in the notch that they form there. */
bool impact_rest_in_notch(const contact_set *c, dem_index edge, dem_index next, const contact_instant *now);

#endif
