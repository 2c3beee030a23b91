/* SPDX-License-Identifier: BSD-3-Clause */
/* Peaks chunk by chunk, from where they are: here, or on the ranks of a run that a simulation leads; and which are the
 * largest. */
#include "base/peak_source.h"

#include <math.h>
#include <stdlib.h>

#include "simulation/leader_peaks.h"

/* ---- chunk by chunk ---- */

dem_status dem_private_peaks_visit_nodes(const dem_peaks *p, rows_taker *take, void *context)
{
    if (p->are_away && p->nodes == NULL) return leader_peaks_visit_nodes(p->away, p, take, context);
    return rows_hand_over(p->nodes, sizeof *p->nodes, p->n_nodes, take, context);
}

dem_status dem_private_peaks_visit_springs(const dem_peaks *p, rows_taker *take, void *context)
{
    if (p->are_away && p->springs == NULL) return leader_peaks_visit_springs(p->away, p, take, context);
    return rows_hand_over(p->springs, sizeof *p->springs, p->n_springs, take, context);
}

dem_status dem_private_peaks_pick_nodes(const dem_peaks *p, const dem_index *list, dem_index n, dem_node_peak *out)
{
    rows_pick pick = {sizeof *out, list, n, out};
    return dem_private_peaks_visit_nodes(p, rows_taker_pick, &pick);
}

dem_status dem_private_peaks_pick_springs(const dem_peaks *p, const dem_index *list, dem_index n, dem_spring_peak *out)
{
    rows_pick pick = {sizeof *out, list, n, out};
    return dem_private_peaks_visit_springs(p, rows_taker_pick, &pick);
}

/* ---- the largest ---- */

/* The n largest so far, those of equal size in the order of their numbers. */
typedef struct ranking {
    double (*size_of)(const void *rows, dem_index k);
    dem_index n, filled;
    dem_index *list; /* [n] numbers, the largest first, */
    double *size;    /* [n] and their sizes */
} ranking;

static double node_size(const void *rows, dem_index k)
{
    return ((const dem_node_peak *)rows)[k].von_mises;
}

static double spring_size(const void *rows, dem_index k)
{
    return fabs(((const dem_spring_peak *)rows)[k].strain);
}

/* Into a list that descends. With n small all is one pass. */
static void insert(ranking *r, dem_index number, double size)
{
    dem_index q = r->filled < r->n ? r->filled++ : r->n - 1;
    for (; q > 0 && r->size[q - 1] < size; q--) {
        r->list[q] = r->list[q - 1];
        r->size[q] = r->size[q - 1];
    }
    r->list[q] = number;
    r->size[q] = size;
}

/* Entries of size 0 have no peak. */
static dem_status rank(void *context, dem_index first, dem_index n, const void *rows)
{
    ranking *r = context;
    for (dem_index k = 0; k < n; k++) {
        const double size = r->size_of(rows, k);
        if (size > 0.0 && !(r->filled == r->n && size <= r->size[r->n - 1])) insert(r, first + k, size);
    }
    return DEM_OK;
}

typedef dem_status visitor(const dem_peaks *p, rows_taker *take, void *context);

static dem_index find_largest(const dem_peaks *p, visitor *visit, ranking r)
{
    if (r.n <= 0) return 0;
    r.size = malloc((size_t)r.n * sizeof *r.size);
    const bool good = r.size != NULL && visit(p, rank, &r) == DEM_OK;
    free(r.size);
    return good ? r.filled : 0;
}

/* As many as there are, at most. */
static dem_index bound(dem_index n, dem_index all)
{
    return n < all ? n : all;
}

dem_index dem_peaks_most_stressed_nodes(const dem_peaks *p, dem_index n, dem_index *list)
{
    return find_largest(p, dem_private_peaks_visit_nodes,
                        (ranking){.size_of = node_size, .n = bound(n, p->n_nodes), .list = list});
}

dem_index dem_peaks_most_strained_springs(const dem_peaks *p, dem_index n, dem_index *list)
{
    return find_largest(p, dem_private_peaks_visit_springs,
                        (ranking){.size_of = spring_size, .n = bound(n, p->n_springs), .list = list});
}
