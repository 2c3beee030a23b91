/* SPDX-License-Identifier: BSD-3-Clause */
/* Recursive coordinate bisection: the nodes of some ranks are cut in two across the longer side of their bounding box,
 * and the ranks with them, until each has its own. Of sides that are nearly equal the upright one is cut, as lattice
 * rows mostly lie and so stay whole. Of nodes at the same coordinate the lower numbers come first, so that the result
 * depends on rest positions, weights and the number of ranks alone. */
#include "domain/partition.h"

#include <stdlib.h>

#include "base/box.h"
#include "base/status.h"

static const double nearly_equal = 0.9; /* the least length of the upright side over that of the other */

/* A node as it is sorted. */
typedef struct place {
    double coordinate, weight;
    dem_index node;
} place;

static int compare(const void *a, const void *b)
{
    const place *p = a, *q = b;
    if (p->coordinate != q->coordinate) return p->coordinate < q->coordinate ? -1 : 1;
    return (p->node > q->node) - (p->node < q->node);
}

/* Consecutive ranks, and the nodes that they are to have. */
typedef struct section {
    place *places; /* [n] */
    dem_index n;
    int first, n_ranks;
} section;

static void sort_along(const section *s, const dem_lattice *l)
{
    box all = box_empty();
    for (dem_index k = 0; k < s->n; k++) all = box_with(all, vec2_at(l->x, s->places[k].node));
    const int along = all.high.y - all.low.y > nearly_equal * (all.high.x - all.low.x);
    for (dem_index k = 0; k < s->n; k++) s->places[k].coordinate = l->x[2 * s->places[k].node + along];
    qsort(s->places, (size_t)s->n, sizeof *s->places, compare);
}

/* How many of the sorted nodes go to the first `half` ranks: as many as do not weigh more than their share, and at
 * least one for each rank on either side. */
static dem_index find_cut(const section *s, int half)
{
    const dem_index most = s->n - (s->n_ranks - half);
    double all = 0.0, sum = 0.0;
    dem_index cut = 0;
    for (dem_index k = 0; k < s->n; k++) all += s->places[k].weight;
    const double share = all * half / s->n_ranks;
    while (cut < most && (cut < half || sum + s->places[cut].weight <= share)) sum += s->places[cut++].weight;
    return cut;
}

/* The depth is that of halving the number of ranks. */
static void bisect(const section *s, const dem_lattice *l, int32_t *owner)
{
    if (s->n_ranks == 1) {
        for (dem_index k = 0; k < s->n; k++) owner[s->places[k].node] = s->first;
        return;
    }
    const int half = s->n_ranks / 2;
    sort_along(s, l);
    const dem_index cut = find_cut(s, half);
    bisect(&(section){s->places, cut, s->first, half}, l, owner);
    bisect(&(section){s->places + cut, s->n - cut, s->first + half, s->n_ranks - half}, l, owner);
}

dem_status partition_bisect(const dem_lattice *lattice, int n, int32_t *owner)
{
    return partition_bisect_weighted(lattice, NULL, n, owner);
}

dem_status partition_bisect_weighted(const dem_lattice *lattice, const double *weights, int n, int32_t *owner)
{
    CHECK(n <= lattice->n_nodes, DEM_ERROR_MODEL, "%d ranks are more than the %lld nodes that they are to share", n,
          (long long)lattice->n_nodes);
    place *places = malloc((size_t)lattice->n_nodes * sizeof *places);
    CHECK_MEMORY(places);
    for (dem_index i = 0; i < lattice->n_nodes; i++)
        places[i] = (place){.weight = weights != NULL ? weights[i] : 1.0, .node = i};
    bisect(&(section){places, lattice->n_nodes, 0, n}, lattice, owner);
    free(places);
    return DEM_OK;
}
