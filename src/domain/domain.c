/* SPDX-License-Identifier: BSD-3-Clause */
/* Two nodes are next to each other if a spring joins them or a triangle has both: then the force on one may depend on
 * the other. Every rank finds its domain in the whole lattice by itself: what it sends to another rank is what that one
 * expects, in the same order, as both go by the same rule. */
#include "domain/domain.h"

#include <stdlib.h>

#include "base/sorted.h"
#include "base/status.h"

/* A node at the end of the domain, and a rank on the other side. */
typedef struct border {
    int rank;
    dem_index node; /* its number in the whole lattice */
} border;

static int compare(const void *a, const void *b)
{
    const border *p = a, *q = b;
    if (p->rank != q->rank) return p->rank < q->rank ? -1 : 1;
    return (p->node > q->node) - (p->node < q->node);
}

/* Sorts, and keeps one of equal ones.  \return how many are left */
static dem_index sort_borders(border *list, dem_index n)
{
    dem_index kept = 0;
    if (n > 0) qsort(list, (size_t)n, sizeof *list, compare);
    for (dem_index k = 0; k < n; k++)
        if (kept == 0 || compare(&list[k], &list[kept - 1]) != 0) list[kept++] = list[k];
    return kept;
}

/* Own nodes next to another rank's, with that rank, and ghosts with theirs. Without lists they are only counted. */
typedef struct draft {
    const int32_t *owner;
    int rank;
    dem_index n; /* of each list */
    border *sent, *received;
} draft;

static void join(draft *d, dem_index i, dem_index j)
{
    if (d->owner[i] != d->rank || d->owner[j] == d->rank) return;
    if (d->sent != NULL) {
        d->sent[d->n] = (border){d->owner[j], i};
        d->received[d->n] = (border){d->owner[j], j};
    }
    d->n++;
}

static void join_all(draft *d, const dem_lattice *l)
{
    d->n = 0;
    for (dem_index k = 0; k < l->n_springs; k++) {
        join(d, l->ends[2 * k], l->ends[2 * k + 1]);
        join(d, l->ends[2 * k + 1], l->ends[2 * k]);
    }
    for (dem_index k = 0; k < 3 * l->n_triangles; k++) {
        const dem_index next = k / 3 * 3 + (k + 1) % 3;
        join(d, l->triangles[k], l->triangles[next]);
        join(d, l->triangles[next], l->triangles[k]);
    }
}

/* `local` has the number in the domain of each node of the whole lattice; -1: it is not there. */
static dem_status number_nodes(domain *d, const draft *from, dem_index n_received, dem_index *local)
{
    for (dem_index i = 0; i < d->n_whole; i++) local[i] = from->owner[i] == from->rank ? 0 : -1;
    for (dem_index k = 0; k < n_received; k++) local[from->received[k].node] = 0;
    for (dem_index i = 0; i < d->n_whole; i++)
        if (local[i] == 0) local[i] = d->n_nodes++;
    CHECK(d->n_nodes > n_received, DEM_ERROR_MODEL, "rank %d has no node of its own", from->rank);
    d->number = malloc((size_t)d->n_nodes * sizeof *d->number);
    d->is_own = malloc((size_t)d->n_nodes);
    CHECK(d->number && d->is_own, DEM_ERROR_MEMORY, "out of memory for a domain of %lld nodes", (long long)d->n_nodes);
    for (dem_index i = 0; i < d->n_whole; i++) {
        if (local[i] < 0) continue;
        d->number[local[i]] = i;
        d->is_own[local[i]] = from->owner[i] == from->rank;
    }
    return DEM_OK;
}

/* How many of a sorted list, from one on, are of the same rank. */
static dem_index count_same(const border *list, dem_index n, dem_index from)
{
    dem_index end = from;
    while (end < n && list[end].rank == list[from].rank) end++;
    return end - from;
}

static dem_status list_nodes(dem_index **out, const border *list, dem_index n, const dem_index *local)
{
    *out = malloc((size_t)n * sizeof **out);
    CHECK_MEMORY(*out);
    for (dem_index k = 0; k < n; k++) (*out)[k] = local[list[k].node];
    return DEM_OK;
}

/* Both lists have the same ranks, as nodes next to each other are in both. */
static dem_status list_neighbours(domain *d, const draft *from, const dem_index n[2], const dem_index *local)
{
    int count = 0;
    for (dem_index p = 0; p < n[0]; p += count_same(from->sent, n[0], p)) count++;
    d->neighbours = calloc((size_t)count + 1, sizeof *d->neighbours);
    CHECK_MEMORY(d->neighbours);
    for (dem_index p = 0, q = 0; p < n[0];) {
        domain_neighbour *one = &d->neighbours[d->n_neighbours++];
        one->rank = from->sent[p].rank;
        one->n_sent = count_same(from->sent, n[0], p);
        one->n_received = count_same(from->received, n[1], q);
        TRY(list_nodes(&one->sent, from->sent + p, one->n_sent, local));
        TRY(list_nodes(&one->received, from->received + q, one->n_received, local));
        p += one->n_sent;
        q += one->n_received;
    }
    return DEM_OK;
}

static dem_status fill(domain *d, draft *from, const dem_lattice *whole, dem_index *local)
{
    join_all(from, whole);
    from->sent = malloc(((size_t)from->n + 1) * sizeof *from->sent);
    from->received = malloc(((size_t)from->n + 1) * sizeof *from->received);
    CHECK(local && from->sent && from->received, DEM_ERROR_MEMORY, "out of memory for the domain of rank %d",
          from->rank);
    join_all(from, whole);
    const dem_index n[2] = {sort_borders(from->sent, from->n), sort_borders(from->received, from->n)};
    TRY(number_nodes(d, from, n[1], local));
    return list_neighbours(d, from, n, local);
}

dem_status domain_create(domain *out, const dem_lattice *whole, const int32_t *owner, int rank)
{
    domain d = {.n_whole = whole->n_nodes};
    draft from = {.owner = owner, .rank = rank};
    dem_index *local = malloc((size_t)whole->n_nodes * sizeof *local);
    const dem_status status = fill(&d, &from, whole, local);
    free(local);
    free(from.sent);
    free(from.received);
    if (status == DEM_OK)
        *out = d;
    else
        domain_free(&d);
    return status;
}

void domain_free(domain *d)
{
    for (int k = 0; k < d->n_neighbours; k++) {
        free(d->neighbours[k].sent);
        free(d->neighbours[k].received);
    }
    free(d->neighbours);
    free(d->number);
    free(d->spring);
    free(d->is_own);
    *d = (domain){0};
}

dem_index domain_own_node(const domain *d, dem_index number)
{
    if (d == NULL) return number;
    const dem_index i = sorted_find(d->number, d->n_nodes, number);
    return i >= 0 && d->is_own[i] ? i : -1;
}
