/* SPDX-License-Identifier: BSD-3-Clause */
/* Each domain is found in the whole lattice without the others: what its rank sends to another one is what that one
 * expects, in the same order, as both go by the same rule. Own nodes near common ones go to all ranks. */
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

/* A list, or without room only how long it would be. */
typedef struct borders {
    dem_index n;
    border *list;
} borders;

/* Own nodes that are ghosts of another rank, with that rank, and ghosts with theirs. */
typedef struct draft {
    const domain_shares *shares;
    const ghost_rings *rings;
    int rank;
    borders sent, received;
} draft;

static void note(borders *b, int rank, dem_index node)
{
    if (b->list != NULL) b->list[b->n] = (border){rank, node};
    b->n++;
}

/* Of the ghosts of all ranks this one's, and those that are own nodes here. */
static void list_borders(draft *d)
{
    d->sent.n = d->received.n = 0;
    for (dem_index k = 0; k < d->rings->n; k++) {
        const ghost *g = &d->rings->list[k];
        const int owner = d->shares->owner[g->node];
        if (g->rank == d->rank) note(&d->received, owner, g->node);
        if (owner == d->rank) note(&d->sent, g->rank, g->node);
    }
}

static bool is_integrated(const draft *d, dem_index i)
{
    return domain_shares_have(d->shares, d->rank, i);
}

/* `local` has the number in the domain of each node of the whole lattice; -1: it is not there. */
static dem_status number_nodes(domain *d, const draft *from, dem_index *local)
{
    dem_index n_own = 0;
    for (dem_index i = 0; i < d->n_whole; i++) {
        local[i] = is_integrated(from, i) ? 0 : -1;
        n_own += from->shares->owner[i] == from->rank;
    }
    CHECK(n_own > 0, DEM_ERROR_MODEL, "rank %d has no node of its own", from->rank);
    for (dem_index k = 0; k < from->received.n; k++) local[from->received.list[k].node] = 0;
    for (dem_index i = 0; i < d->n_whole; i++)
        if (local[i] == 0) local[i] = d->n_nodes++;
    d->number = malloc((size_t)d->n_nodes * sizeof *d->number);
    d->is_own = malloc((size_t)d->n_nodes);
    d->is_ghost = malloc((size_t)d->n_nodes);
    d->is_common = malloc((size_t)d->n_nodes);
    d->is_outer = calloc((size_t)d->n_nodes, 1);
    CHECK(d->number && d->is_own && d->is_ghost && d->is_common && d->is_outer, DEM_ERROR_MEMORY,
          "out of memory for a domain of %lld nodes", (long long)d->n_nodes);
    for (dem_index i = 0; i < d->n_whole; i++) {
        if (local[i] < 0) continue;
        d->number[local[i]] = i;
        d->is_own[local[i]] = from->shares->owner[i] == from->rank;
        d->is_ghost[local[i]] = !is_integrated(from, i);
        d->is_common[local[i]] = domain_shares_have_all(from->shares, i);
    }
    for (dem_index k = 0; k < from->rings->n; k++) {
        const ghost *g = &from->rings->list[k];
        if (g->rank == from->rank) d->is_outer[local[g->node]] = g->ring == from->rings->n_rings;
    }
    return DEM_OK;
}

/* How many nodes of a sorted list, from one on, are of a rank. */
static dem_index count_of(const borders *b, dem_index from, int rank)
{
    dem_index end = from;
    while (end < b->n && b->list[end].rank == rank) end++;
    return end - from;
}

static dem_status list_nodes(dem_index **out, const border *list, dem_index n, const dem_index *local)
{
    *out = malloc(((size_t)n + 1) * sizeof **out);
    CHECK_MEMORY(*out);
    for (dem_index k = 0; k < n; k++) (*out)[k] = local[list[k].node];
    return DEM_OK;
}

static dem_status list_neighbours(domain *d, const draft *from, const dem_index *local)
{
    d->neighbours = calloc((size_t)from->shares->n_ranks, sizeof *d->neighbours);
    CHECK_MEMORY(d->neighbours);
    dem_index p = 0, q = 0;
    for (int rank = 0; rank < from->shares->n_ranks; rank++) {
        const dem_index n_sent = count_of(&from->sent, p, rank), n_received = count_of(&from->received, q, rank);
        if (n_sent == 0 && n_received == 0) continue;
        domain_neighbour *one = &d->neighbours[d->n_neighbours++];
        *one = (domain_neighbour){.rank = rank, .n_sent = n_sent, .n_received = n_received};
        TRY(list_nodes(&one->sent, from->sent.list + p, n_sent, local));
        TRY(list_nodes(&one->received, from->received.list + q, n_received, local));
        p += n_sent;
        q += n_received;
    }
    return DEM_OK;
}

static dem_status fill(domain *d, draft *from, dem_index *local)
{
    borders *const both[] = {&from->sent, &from->received};
    list_borders(from);
    for (int k = 0; k < 2; k++) both[k]->list = malloc(((size_t)both[k]->n + 1) * sizeof *both[k]->list);
    CHECK(local && from->sent.list && from->received.list, DEM_ERROR_MEMORY, "out of memory for the domain of rank %d",
          from->rank);
    list_borders(from);
    d->n_rings = from->rings->n_rings;
    for (int k = 0; k < 2; k++) qsort(both[k]->list, (size_t)both[k]->n, sizeof *both[k]->list, compare);
    TRY(number_nodes(d, from, local));
    return list_neighbours(d, from, local);
}

dem_status domain_create_within(domain *out, const dem_lattice *whole, const domain_shares *shares,
                                const ghost_rings *rings, int rank)
{
    domain d = {.n_whole = whole->n_nodes};
    draft from = {.shares = shares, .rings = rings, .rank = rank};
    dem_index *local = malloc((size_t)whole->n_nodes * sizeof *local);
    const dem_status status = fill(&d, &from, local);
    free(local);
    free(from.sent.list);
    free(from.received.list);
    if (status == DEM_OK)
        *out = d;
    else
        domain_free(&d);
    return status;
}

dem_status domain_create(domain *out, const dem_lattice *whole, const domain_shares *shares, int rank)
{
    ghost_rings rings = {0};
    dem_status status = ghost_rings_find(&rings, whole, shares);
    if (status == DEM_OK) status = domain_create_within(out, whole, shares, &rings, rank);
    ghost_rings_free(&rings);
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
    free(d->triangle);
    free(d->is_own);
    free(d->is_ghost);
    free(d->is_common);
    free(d->is_outer);
    *d = (domain){0};
}

dem_index domain_node(const domain *d, dem_index number)
{
    if (d == NULL) return number;
    const dem_index i = sorted_find(d->number, d->n_nodes, number);
    return i >= 0 && !d->is_ghost[i] ? i : -1;
}
