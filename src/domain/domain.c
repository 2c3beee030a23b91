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

typedef struct borders {
    dem_index n;
    border *list; /* [n] */
} borders;

/* Own nodes that are ghosts of another rank, with that rank, and ghosts with theirs. */
typedef struct draft {
    domain_lists *lists;
    int rank;
    borders sent, received;
} draft;

static dem_status open_list(borders *b, dem_index n)
{
    b->list = malloc(((size_t)n + 1) * sizeof *b->list);
    CHECK_MEMORY(b->list);
    return DEM_OK;
}

/* The ghosts of this rank, and the own nodes that others have as ghosts. */
static dem_status list_borders(draft *d)
{
    const domain_lists *l = d->lists;
    const dem_index *ghosts = l->ghosts.row + d->rank, *lent = l->lent.row + d->rank;
    TRY(open_list(&d->received, ghosts[1] - ghosts[0]));
    TRY(open_list(&d->sent, lent[1] - lent[0]));
    for (dem_index k = ghosts[0]; k < ghosts[1]; k++) {
        const dem_index node = l->rings.list[l->ghosts.list[k]].node;
        d->received.list[d->received.n++] = (border){l->shares->owner[node], node};
    }
    for (dem_index k = lent[0]; k < lent[1]; k++) {
        const ghost *g = &l->rings.list[l->lent.list[k]];
        d->sent.list[d->sent.n++] = (border){g->rank, g->node};
    }
    return DEM_OK;
}

/* `local` has the number in the domain of each node of the whole lattice afterwards. */
static dem_status number_nodes(domain *d, const draft *from)
{
    domain_lists *l = from->lists;
    const domain_shares *s = l->shares;
    CHECK(l->own.row[from->rank] < l->own.row[from->rank + 1], DEM_ERROR_MODEL, "rank %d has no node of its own",
          from->rank);
    TRY(domain_lists_nodes(l, from->rank, &d->number, &d->n_nodes));
    d->is_own = malloc((size_t)d->n_nodes);
    d->is_ghost = malloc((size_t)d->n_nodes);
    d->is_common = malloc((size_t)d->n_nodes);
    d->is_outer = calloc((size_t)d->n_nodes, 1);
    CHECK(d->is_own && d->is_ghost && d->is_common && d->is_outer, DEM_ERROR_MEMORY,
          "out of memory for a domain of %lld nodes", (long long)d->n_nodes);
    domain_lists_number(l, d->number, d->n_nodes);
    for (dem_index i = 0; i < d->n_nodes; i++) {
        d->is_own[i] = s->owner[d->number[i]] == from->rank;
        d->is_ghost[i] = !domain_shares_have(s, from->rank, d->number[i]);
        d->is_common[i] = domain_shares_have_all(s, d->number[i]);
    }
    for (dem_index k = l->ghosts.row[from->rank]; k < l->ghosts.row[from->rank + 1]; k++) {
        const ghost *g = &l->rings.list[l->ghosts.list[k]];
        d->is_outer[l->local[g->node]] = g->ring == l->rings.n_rings;
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

static dem_status list_neighbours(domain *d, const draft *from)
{
    const int n_ranks = from->lists->shares->n_ranks;
    d->neighbours = calloc((size_t)n_ranks, sizeof *d->neighbours);
    CHECK_MEMORY(d->neighbours);
    dem_index p = 0, q = 0;
    for (int rank = 0; rank < n_ranks; rank++) {
        const dem_index n_sent = count_of(&from->sent, p, rank), n_received = count_of(&from->received, q, rank);
        if (n_sent == 0 && n_received == 0) continue;
        domain_neighbour *one = &d->neighbours[d->n_neighbours++];
        *one = (domain_neighbour){.rank = rank, .n_sent = n_sent, .n_received = n_received};
        TRY(list_nodes(&one->sent, from->sent.list + p, n_sent, from->lists->local));
        TRY(list_nodes(&one->received, from->received.list + q, n_received, from->lists->local));
        p += n_sent;
        q += n_received;
    }
    return DEM_OK;
}

static dem_status fill(domain *d, draft *from)
{
    borders *const both[] = {&from->sent, &from->received};
    TRY(list_borders(from));
    d->n_rings = from->lists->rings.n_rings;
    for (int k = 0; k < 2; k++) qsort(both[k]->list, (size_t)both[k]->n, sizeof *both[k]->list, compare);
    TRY(number_nodes(d, from));
    return list_neighbours(d, from);
}

dem_status domain_create_within(domain *out, domain_lists *lists, int rank)
{
    domain d = {.n_whole = lists->n_whole};
    draft from = {.lists = lists, .rank = rank};
    const dem_status status = fill(&d, &from);
    free(from.sent.list);
    free(from.received.list);
    domain_lists_forget(lists, d.number, d.n_nodes);
    if (status == DEM_OK)
        *out = d;
    else
        domain_free(&d);
    return status;
}

dem_status domain_create(domain *out, const dem_lattice *whole, const domain_shares *shares, int rank)
{
    domain_lists lists;
    dem_status status = domain_lists_create(&lists, whole, shares);
    if (status == DEM_OK) status = domain_create_within(out, &lists, rank);
    domain_lists_free(&lists);
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
    free(d->joined);
    free(d->joined_to);
    free(d->boundary);
    *d = (domain){0};
}

dem_index domain_node(const domain *d, dem_index number)
{
    if (d == NULL) return number;
    const dem_index i = sorted_find(d->number, d->n_nodes, number);
    return i >= 0 && !d->is_ghost[i] ? i : -1;
}
