/* SPDX-License-Identifier: BSD-3-Clause */
/* What a node evaluates for both or all of its ends in a sweep, as slots of its rows: each spring is its lower node's,
 * and each coupled triangle its lowest corner's. A node's place says how low it is; a list of places is NULL where
 * places are node numbers. */
#ifndef DEM_ELASTIC_LANE_SLOTS_H
#define DEM_ELASTIC_LANE_SLOTS_H

#include <stdint.h>

#include "elastic/couplings.h"
#include "elastic/springs.h"

/** The place of a node. */
static inline int32_t lane_slots_place(const int32_t *place, dem_index node)
{
    return place != NULL ? place[node] : (int32_t)node;
}

/** Slots of springs to nodes at higher places, ascending by these.
 *  \param[out] slot  has room for the row of the node
 *  \return how many there are */
dem_index lane_slots_springs(const springs *s, const int32_t *place, dem_index node, dem_index *slot);

/** Whether the node whose row has slot p is the lowest corner of the coupled triangle there. */
bool lane_slots_is_lowest(const couplings *c, const int32_t *place, dem_index p, dem_index node);

/** Slots of coupled triangles of which the node is the lowest corner, in the order of its row. */
dem_index lane_slots_couplings(const couplings *c, const int32_t *place, dem_index node, dem_index *slot);

#endif
