/* SPDX-License-Identifier: BSD-3-Clause */
/* Ring after ring, each by a look at all pairs of nodes that are next to each other. */
#include "domain/ghost_rings.h"

#include <stdlib.h>
#include <string.h>

#include "base/grow.h"
#include "base/reduce.h"
#include "base/status.h"
#include "domain/adjacency.h"

static int compare(const void *a, const void *b)
{
    const ghost *p = a, *q = b;
    if (p->node != q->node) return p->node < q->node ? -1 : 1;
    return (p->rank > q->rank) - (p->rank < q->rank);
}

/* Puts the list in its order, each ghost once, and finds its rows. */
static void sort(ghost_rings *g, dem_index n_nodes)
{
    dem_index kept = 0;
    if (g->n > 0) qsort(g->list, (size_t)g->n, sizeof *g->list, compare);
    for (dem_index k = 0; k < g->n; k++)
        if (kept == 0 || compare(&g->list[k], &g->list[kept - 1]) != 0) g->list[kept++] = g->list[k];
    g->n = kept;
    memset(g->row, 0, (size_t)(n_nodes + 1) * sizeof *g->row);
    for (dem_index k = 0; k < g->n; k++) g->row[g->list[k].node + 1]++;
    for (dem_index i = 0; i < n_nodes; i++) g->row[i + 1] += g->row[i];
}

/* Of the rings so far. */
static bool has(const ghost_rings *g, int rank, dem_index node)
{
    for (dem_index k = g->row[node]; k < g->row[node + 1]; k++)
        if (g->list[k].rank == rank) return true;
    return false;
}

/* A node next to one of the ring before, or to one that the rank integrates. */
static dem_status add(ghost_rings *g, const domain_shares *s, int rank, int ring, dem_index node)
{
    if (domain_shares_have(s, rank, node) || has(g, rank, node)) return DEM_OK;
    CHECK(grow_array((void **)&g->list, &g->capacity, g->n + 1, sizeof *g->list), DEM_ERROR_MEMORY,
          "out of memory for %lld ghosts", (long long)g->n);
    g->list[g->n++] = (ghost){.node = node, .rank = (int32_t)rank, .ring = (int32_t)ring};
    return DEM_OK;
}

/* Node j is next to node i. */
static dem_status add_first(ghost_rings *g, const domain_shares *s, dem_index i, dem_index j)
{
    const bool everywhere = domain_shares_have_all(s, i);
    const int first = everywhere ? 0 : s->owner[i], end = everywhere ? s->n_ranks : first + 1;
    for (int rank = first; rank < end; rank++) TRY(add(g, s, rank, 1, j));
    return DEM_OK;
}

static dem_status add_next(ghost_rings *g, const domain_shares *s, int ring, dem_index i, dem_index j)
{
    for (dem_index k = g->row[i]; k < g->row[i + 1]; k++)
        if (g->list[k].ring == ring - 1) TRY(add(g, s, g->list[k].rank, ring, j));
    return DEM_OK;
}

static dem_status add_ring(ghost_rings *g, const dem_lattice *l, const domain_shares *s, int ring)
{
    dem_index pair[2];
    for (dem_index k = 0; k < adjacency_pairs(l); k++) {
        adjacency_pair(l, k, pair);
        for (int e = 0; e < 2; e++)
            TRY(ring == 1 ? add_first(g, s, pair[e], pair[1 - e]) : add_next(g, s, ring, pair[e], pair[1 - e]));
    }
    sort(g, l->n_nodes);
    return DEM_OK;
}

/* Each rank counts those among its own nodes, where no rank has all. */
static dem_index count_all(const ghost_rings *g, const domain_shares *s)
{
    dem_index own = 0;
    if (s->counting == NULL) return g->n;
    for (dem_index k = 0; k < g->n; k++) own += s->owner[g->list[k].node] == s->counting->rank;
    return reduce_count(s->counting, own);
}

static void keep(ghost_rings *g, int n_rings, dem_index n_nodes)
{
    dem_index kept = 0;
    for (dem_index k = 0; k < g->n; k++)
        if (g->list[k].ring <= n_rings) g->list[kept++] = g->list[k];
    g->n = kept;
    g->n_rings = n_rings;
    sort(g, n_nodes);
}

/* With `fit` rings `most` steps are taken in so many parts; as many have a use for no more rings than the longest. */
static int even_rings(int most, int fit)
{
    const int n_parts = (most + fit - 1) / fit;
    return (most + n_parts - 1) / n_parts;
}

dem_status ghost_rings_find(ghost_rings *out, const dem_lattice *whole, const domain_shares *shares)
{
    *out = (ghost_rings){.n_rings = 1};
    out->row = calloc((size_t)whole->n_nodes + 1, sizeof *out->row);
    CHECK_MEMORY(out->row);
    TRY(add_ring(out, whole, shares, 1));
    dem_index n = count_all(out, shares);
    while (out->n_rings < shares->n_rings && n <= shares->most_ghosts) {
        TRY(add_ring(out, whole, shares, ++out->n_rings));
        n = count_all(out, shares);
    }
    if (out->n_rings == 1 || n <= shares->most_ghosts) return DEM_OK;
    const int fit = even_rings(shares->n_rings, out->n_rings - 1);
    keep(out, fit >= shares->least_rings ? fit : 1, whole->n_nodes);
    return DEM_OK;
}

void ghost_rings_free(ghost_rings *g)
{
    free(g->list);
    free(g->row);
    *g = (ghost_rings){0};
}
