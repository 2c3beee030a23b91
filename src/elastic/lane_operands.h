/* SPDX-License-Identifier: BSD-3-Clause */
/* What an entry of a layout reads, and which lanes take part in it, for all passes over blocks. A file of vectors,
 * lanes_*.h, comes first. */
#ifndef DEM_ELASTIC_LANE_OPERANDS_H
#define DEM_ELASTIC_LANE_OPERANDS_H

#include "base/inline.h"
#include "elastic/layout.h"

/** The operands of an entry for all lanes. `here` is where those that lie side by side are counted from. */
INLINE pairs lane_operands_fetch(const layout *l, const double *array, const double *here, int32_t at, bool gathered)
{
    return gathered ? pairs_gather(array, l->lists + at) : pairs_load(here + at);
}

/** A bit for each lane that takes part in an entry. Its mask has two bits for each node: those of nodes 0 to 3 are
 *  those of lanes 0, 2, 4, 6, and nodes 4 to 7 have the others. */
INLINE unsigned lane_operands_taken(const layout_entry *e)
{
    return (e->mask & 0x55u) | (e->mask >> 8 & 0x55u) << 1;
}

/** A bit for each node whose lane is chosen. */
INLINE unsigned lane_operands_nodes(unsigned chosen)
{
    unsigned nodes = 0;
    for (int q = 0; q < LAYOUT_LANES; q++) nodes |= (chosen >> layout_lane(q) & 1u) << q;
    return nodes;
}

#endif
