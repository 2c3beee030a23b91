/* SPDX-License-Identifier: BSD-3-Clause */
/* What the lanes of a block have to do, an item each, and which items one entry can do at the same time. */
#ifndef DEM_ELASTIC_LANE_GROUPS_H
#define DEM_ELASTIC_LANE_GROUPS_H

#include <stdbool.h>
#include <stdint.h>

#include <dem/dem.h>

#include "elastic/layout_lanes.h"

enum { LANE_ITEM_WIDTH = 6 /* coefficients at most */ };

/** What one lane has to do for one spring, term or corner of its node. */
typedef struct lane_item {
    int32_t at, to;     /* operands of this lane */
    int32_t base, last; /* where they would begin for lane 0 if all lay side by side */
    dem_index element;  /* spring, or slot of a coupled triangle */
    bool negative;
    double set[LANE_ITEM_WIDTH];
} lane_item;

typedef struct lane_groups {
    dem_index most;   /**< items of a lane */
    lane_item *items; /**< [LAYOUT_LANES][most] */
    dem_index n[LAYOUT_LANES], next[LAYOUT_LANES];
    bool taken[LAYOUT_LANES]; /**< by the group in hand */
    bool by_slot;             /**< groups are the next items of all lanes, wherever they are */
} lane_groups;

/** Without items. False when memory runs out. Free with lane_groups_free(). */
bool lane_groups_create(lane_groups *g, dem_index most);
void lane_groups_free(lane_groups *g);

/** Begins with the grouping by operands side by side, whose loads are cheaper. If it makes more than twice as many
 *  groups as the fullest lane has items, the k-th items of all lanes are grouped instead. */
void lane_groups_choose(lane_groups *g);

/** Begins with the k-th items of all lanes as groups. */
void lane_groups_by_slot(lane_groups *g);

/** Takes the next items that one entry can do. The leader is the next item with the lowest neighbour relative to its
 *  lane, and all next items that fit it go along; `by_slot` all go. Each lane keeps the order of its own items, on
 *  which the bits of its sum depend.
 *  \return the leader; NULL if no item is left */
const lane_item *lane_groups_take(lane_groups *g);

/** The item of a lane in the group just taken. */
static inline const lane_item *lane_groups_item(const lane_groups *g, int lane)
{
    return &g->items[lane * g->most + g->next[lane] - 1];
}

/** Bits 2q and 2q + 1, one for each component, are set for each lane q that takes part in the group. */
uint16_t lane_groups_mask(const lane_groups *g);

/** The same for each lane whose node is the upper end of its spring. The ring has the force on the lower end; the upper
 *  end subtracts it. */
uint16_t lane_groups_upper(const lane_groups *g);

/** Whether the operands of all lanes that take part can be loaded as one run of memory. */
bool lane_groups_side_by_side(const lane_groups *g, const lane_item *leader);

#endif
