/* SPDX-License-Identifier: BSD-3-Clause */
#include "elastic/lane_groups.h"

#include <stdlib.h>

/* Groups per item of the fullest lane, up to which operands that lie side by side are sought. */
enum { most_rounds = 2 };

bool lane_groups_create(lane_groups *g, dem_index most)
{
    *g = (lane_groups){.most = most, .items = malloc(LAYOUT_LANES * ((size_t)most + 1) * sizeof *g->items)};
    return g->items != NULL;
}

void lane_groups_free(lane_groups *g)
{
    free(g->items);
}

/* The next item of a lane; NULL if it has no more. */
static const lane_item *head(const lane_groups *g, int lane)
{
    return g->next[lane] < g->n[lane] ? &g->items[lane * g->most + g->next[lane]] : NULL;
}

/* Whether an item can be done in one entry with the leader's: with the same sign, and with its operands where the
 * leader's are, shifted by the difference of their lanes. With `by_slot` any item will do, since operands are then
 * listed one by one. */
static bool fits(const lane_groups *g, const lane_item *a, const lane_item *leader)
{
    return g->by_slot || (a->base == leader->base && a->last == leader->last && a->negative == leader->negative);
}

const lane_item *lane_groups_take(lane_groups *g)
{
    const lane_item *leader = NULL;
    for (int lane = 0; lane < LAYOUT_LANES; lane++) {
        const lane_item *a = head(g, lane);
        if (a != NULL && (leader == NULL || (!g->by_slot && a->last < leader->last))) leader = a;
    }
    for (int lane = 0; lane < LAYOUT_LANES; lane++) {
        const lane_item *a = leader != NULL ? head(g, lane) : NULL;
        g->taken[lane] = a != NULL && fits(g, a, leader);
    }
    for (int lane = 0; lane < LAYOUT_LANES; lane++) g->next[lane] += g->taken[lane];
    return leader;
}

/* All items are to be taken again. */
static void rewind_items(lane_groups *g)
{
    for (int lane = 0; lane < LAYOUT_LANES; lane++) g->next[lane] = 0;
}

void lane_groups_choose(lane_groups *g)
{
    dem_index fullest = 0, groups = 0;
    for (int lane = 0; lane < LAYOUT_LANES; lane++) fullest = g->n[lane] > fullest ? g->n[lane] : fullest;
    g->by_slot = false;
    rewind_items(g);
    while (groups <= most_rounds * fullest && lane_groups_take(g) != NULL) groups++;
    g->by_slot = groups > most_rounds * fullest;
    rewind_items(g);
}

void lane_groups_by_slot(lane_groups *g)
{
    g->by_slot = true;
    rewind_items(g);
}

uint16_t lane_groups_mask(const lane_groups *g)
{
    unsigned mask = 0;
    for (int lane = 0; lane < LAYOUT_LANES; lane++)
        if (g->taken[lane]) mask |= 3u << (2 * lane);
    return (uint16_t)mask;
}

uint16_t lane_groups_upper(const lane_groups *g)
{
    unsigned mask = 0;
    for (int lane = 0; lane < LAYOUT_LANES; lane++)
        if (g->taken[lane] && lane_groups_item(g, lane)->negative) mask |= 3u << (2 * lane);
    return (uint16_t)mask;
}

bool lane_groups_side_by_side(const lane_groups *g, const lane_item *leader)
{
    bool all = true;
    for (int lane = 0; lane < LAYOUT_LANES; lane++) {
        const lane_item *a = g->taken[lane] ? lane_groups_item(g, lane) : leader;
        all = all && a->base == leader->base && a->last == leader->last && a->negative == leader->negative;
    }
    return all;
}
