/* SPDX-License-Identifier: BSD-3-Clause */
/* Breadth-first numbering of nodes (Cuthill and McKee, without their sorting by degree): nodes are numbered by their
 * distance, in springs, from a node at the rim, so that neighbours differ by about the width of the body rather than by
 * its number of nodes. layout.c uses it where the caller's numbers would make the ring buffer long. It changes where
 * numbers lie in memory, never an order of sums. */
#include "elastic/renumber.h"

/* Each pair of neighbours is met from both ends, so that positive differences are enough. */
dem_index renumber_span(const springs *s, const int32_t *place)
{
    dem_index span = 0;
    for (dem_index i = 0; i < s->n_nodes; i++)
        for (dem_index p = s->row[i]; p < s->row[i + 1]; p++) {
            const dem_index j = s->neighbour[p], way = place != NULL ? (dem_index)place[j] - place[i] : j - i;
            if (way > span) span = way;
        }
    return span;
}

/* Of two rows that are next to each other, neighbours of the second one that are next to one of the first. */
static dem_index count_beside(const springs *s, dem_index i)
{
    dem_index n = 0;
    int32_t p = s->row[i - 1];
    for (int32_t q = s->row[i]; q < s->row[i + 1]; q++) {
        while (p < s->row[i] && s->neighbour[p] < s->neighbour[q] - 1) p++;
        n += p < s->row[i] && s->neighbour[p] == s->neighbour[q] - 1;
    }
    return n;
}

bool renumber_is_by_rows(const springs *s)
{
    dem_index n = 0;
    for (dem_index i = 1; i < s->n_nodes; i++) n += count_beside(s, i);
    return 2 * n > s->row[s->n_nodes];
}

/* Appends the part of the lattice that is connected to `first` to the list, which has n nodes so far: each node found
 * adds its neighbours that have no place yet. `order` serves as the queue.
 * \return the new length of the list */
static dem_index spread(const springs *s, dem_index first, dem_index n, int32_t *order, int32_t *place)
{
    dem_index seen = n;
    place[first] = (int32_t)n;
    order[n++] = (int32_t)first;
    for (; seen < n; seen++)
        for (dem_index p = s->row[order[seen]]; p < s->row[order[seen] + 1]; p++) {
            const dem_index j = s->neighbour[p];
            if (place[j] >= 0) continue;
            place[j] = (int32_t)n;
            order[n++] = (int32_t)j;
        }
    return n;
}

/* A first search from an arbitrary node ends at a node that is far from it, hence at the rim. The numbering is that of
 * a second search, which begins there: its rings are narrow. */
void renumber_by_distance(const springs *s, int32_t *order, int32_t *place)
{
    dem_index n = 0;
    for (dem_index i = 0; i < s->n_nodes; i++) place[i] = -1;
    for (dem_index i = 0; i < s->n_nodes; i++) {
        if (place[i] >= 0) continue;
        const dem_index end = spread(s, i, n, order, place), last = order[end - 1];
        for (dem_index q = n; q < end; q++) place[order[q]] = -1;
        n = spread(s, last, n, order, place);
    }
}
