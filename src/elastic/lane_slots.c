/* SPDX-License-Identifier: BSD-3-Clause */
#include "elastic/lane_slots.h"

/* Insertion sort by the upper node's place: a node has a few springs, and the order of evaluation changes no sum. */
static void sort_by_place(const springs *s, const int32_t *place, dem_index *slot, dem_index n)
{
    for (dem_index k = 1; k < n; k++) {
        const dem_index kept = slot[k];
        const int32_t upper = lane_slots_place(place, s->neighbour[kept]);
        dem_index p = k;
        for (; p > 0 && lane_slots_place(place, s->neighbour[slot[p - 1]]) > upper; p--) slot[p] = slot[p - 1];
        slot[p] = kept;
    }
}

dem_index lane_slots_springs(const springs *s, const int32_t *place, dem_index node, dem_index *slot)
{
    const int32_t own = lane_slots_place(place, node);
    dem_index n = 0;
    for (dem_index p = s->row[node]; p < s->row[node + 1]; p++)
        if (lane_slots_place(place, s->neighbour[p]) > own) slot[n++] = p;
    sort_by_place(s, place, slot, n);
    return n;
}

bool lane_slots_is_lowest(const couplings *c, const int32_t *place, dem_index p, dem_index node)
{
    const dem_index *corner = c->list[c->slot[p] / 3].corner;
    for (int q = 0; q < 3; q++)
        if (lane_slots_place(place, corner[q]) < lane_slots_place(place, node)) return false;
    return true;
}

dem_index lane_slots_couplings(const couplings *c, const int32_t *place, dem_index node, dem_index *slot)
{
    dem_index n = 0;
    for (dem_index p = c->row[node]; p < c->row[node + 1]; p++)
        if (lane_slots_is_lowest(c, place, p, node)) slot[n++] = p;
    return n;
}
