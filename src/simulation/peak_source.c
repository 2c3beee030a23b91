/* SPDX-License-Identifier: BSD-3-Clause */
/* Peaks chunk by chunk, from where they are: here, or on the ranks of a run that a simulation leads; and which are the
 * largest. */
#include "base/peak_source.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/status.h"
#include "simulation/leader_peaks.h"

/* ---- chunk by chunk ---- */

dem_status dem_private_peaks_visit_nodes(const dem_peaks *p, rows_taker *take, void *context)
{
    if (p->are_away && p->nodes == NULL) return leader_peaks_visit_nodes(p->away, p, take, context);
    if (p->from == NULL) return rows_hand_over(p->nodes, sizeof *p->nodes, p->n_nodes, take, context);
    const rows_source all = {peaks_read_nodes, (void *)(uintptr_t)p, sizeof *p->nodes, p->n_nodes};
    return rows_pass_on(&all, take, context);
}

dem_status dem_private_peaks_visit_springs(const dem_peaks *p, rows_taker *take, void *context)
{
    if (p->are_away && p->springs == NULL) return leader_peaks_visit_springs(p->away, p, take, context);
    if (p->from == NULL) return rows_hand_over(p->springs, sizeof *p->springs, p->n_springs, take, context);
    const rows_source all = {peaks_read_springs, (void *)(uintptr_t)p, sizeof *p->springs, p->n_springs};
    return rows_pass_on(&all, take, context);
}

/* ---- the largest ---- */

/* The n largest so far, those of equal size in the order of their numbers. */
typedef struct ranking {
    double (*size_of)(const void *peak);
    size_t row; /* bytes */
    dem_index n, filled;
    dem_index *list; /* [n] numbers, the largest first, */
    char *peaks;     /* [n][row] and what they have */
} ranking;

static double node_size(const void *peak)
{
    return ((const dem_node_peak *)peak)->von_mises;
}

static double spring_size(const void *peak)
{
    return fabs(((const dem_spring_peak *)peak)->strain);
}

static char *peak_at(const ranking *r, dem_index q)
{
    return r->peaks + (size_t)q * r->row;
}

/* Into a list that descends. With n small all is one pass. */
static void insert(ranking *r, dem_index number, const void *peak)
{
    dem_index q = r->filled < r->n ? r->filled++ : r->n - 1;
    for (; q > 0 && r->size_of(peak_at(r, q - 1)) < r->size_of(peak); q--) {
        r->list[q] = r->list[q - 1];
        memcpy(peak_at(r, q), peak_at(r, q - 1), r->row);
    }
    r->list[q] = number;
    memcpy(peak_at(r, q), peak, r->row);
}

/* Entries of size 0 have no peak. */
static dem_status rank(void *context, dem_index first, dem_index n, const void *rows)
{
    ranking *r = context;
    for (dem_index k = 0; k < n; k++) {
        const void *peak = (const char *)rows + (size_t)k * r->row;
        const double size = r->size_of(peak);
        const bool is_small = r->filled == r->n && size <= r->size_of(peak_at(r, r->n - 1));
        if (size > 0.0 && !is_small) insert(r, first + k, peak);
    }
    return DEM_OK;
}

/* As many as there are, at most. */
static dem_index bound(dem_index n, dem_index all)
{
    return n < all ? n : all;
}

dem_status dem_private_peaks_largest_nodes(const dem_peaks *p, dem_index *n, dem_index *list, dem_node_peak *peaks)
{
    ranking r = {node_size, sizeof *peaks, bound(*n, p->n_nodes), 0, list, (char *)peaks};
    *n = 0;
    if (r.n > 0) TRY(dem_private_peaks_visit_nodes(p, rank, &r));
    *n = r.filled;
    return DEM_OK;
}

dem_status dem_private_peaks_largest_springs(const dem_peaks *p, dem_index *n, dem_index *list, dem_spring_peak *peaks)
{
    ranking r = {spring_size, sizeof *peaks, bound(*n, p->n_springs), 0, list, (char *)peaks};
    *n = 0;
    if (r.n > 0) TRY(dem_private_peaks_visit_springs(p, rank, &r));
    *n = r.filled;
    return DEM_OK;
}

dem_index dem_peaks_most_stressed_nodes(const dem_peaks *p, dem_index n, dem_index *list)
{
    n = bound(n, p->n_nodes);
    dem_node_peak *peaks = n > 0 ? malloc((size_t)n * sizeof *peaks) : NULL;
    const bool good = peaks != NULL && dem_private_peaks_largest_nodes(p, &n, list, peaks) == DEM_OK;
    free(peaks);
    return good ? n : 0;
}

dem_index dem_peaks_most_strained_springs(const dem_peaks *p, dem_index n, dem_index *list)
{
    n = bound(n, p->n_springs);
    dem_spring_peak *peaks = n > 0 ? malloc((size_t)n * sizeof *peaks) : NULL;
    const bool good = peaks != NULL && dem_private_peaks_largest_springs(p, &n, list, peaks) == DEM_OK;
    free(peaks);
    return good ? n : 0;
}
