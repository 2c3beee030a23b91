/* SPDX-License-Identifier: BSD-3-Clause */
/* Each rank sends a row for each own node to rank 0, behind the numbers of these nodes. Rank 0 asks first how many
 * there are. */
#include "domain/gather.h"

#include <stdlib.h>
#include <string.h>

#include "base/reduce.h"
#include "base/status.h"

/* What one rank sends: an item is 8 bytes long, a number of a node or of a row. */
typedef struct rank_rows {
    dem_index n; /* nodes */
    void *items; /* [n] numbers of nodes, then [n][dim] of rows */
} rank_rows;

typedef struct collection {
    const ranks *ranks;
    int dim;
    rank_rows *rows;                /* [ranks] of which rank 0 has all, another one its own */
    ranks_message *sent, *received; /* [ranks] */
} collection;

static size_t size_of(const collection *c, const rank_rows *p)
{
    return (size_t)p->n * (1 + (size_t)c->dim) * sizeof(double);
}

/* Between rank 0 and each of the others. */
static void exchange_with_root(const collection *c, void *(*bytes)(rank_rows *p),
                               size_t (*size)(const collection *c, const rank_rows *p))
{
    const ranks *r = c->ranks;
    const int n = r->rank == 0 ? r->size - 1 : 1;
    for (int k = 0; k < n; k++) {
        const int other = r->rank == 0 ? k + 1 : 0;
        rank_rows *p = &c->rows[r->rank == 0 ? other : r->rank];
        const ranks_message full = {other, size(c, p), bytes(p)}, empty = {other, 0, NULL};
        c->sent[k] = r->rank == 0 ? empty : full;
        c->received[k] = r->rank == 0 ? full : empty;
    }
    r->exchange(r->self, n, c->sent, c->received);
}

static void *count_of(rank_rows *p)
{
    return &p->n;
}

static size_t size_of_count(const collection *c, const rank_rows *p)
{
    (void)c;
    return sizeof p->n;
}

static void *items_of(rank_rows *p)
{
    return p->items;
}

static void pack(const collection *c, const domain *d, const double *from)
{
    rank_rows *p = &c->rows[c->ranks->rank];
    const size_t row = (size_t)c->dim * sizeof *from;
    dem_index *number = p->items;
    char *to = (char *)(number + p->n);
    for (dem_index i = 0; i < d->n_nodes; i++) {
        if (!d->is_own[i]) continue;
        *number++ = d->number[i];
        memcpy(to, from + c->dim * i, row);
        to += row;
    }
}

static void unpack(const collection *c, double *whole)
{
    const size_t row = (size_t)c->dim * sizeof *whole;
    for (int k = 0; k < c->ranks->size; k++) {
        const dem_index *number = c->rows[k].items;
        const char *from = (const char *)(number + c->rows[k].n);
        for (dem_index q = 0; q < c->rows[k].n; q++) memcpy(whole + c->dim * number[q], from + (size_t)q * row, row);
    }
}

static dem_status allocate_lists(collection *c)
{
    const size_t n = (size_t)c->ranks->size;
    c->rows = calloc(n, sizeof *c->rows);
    c->sent = calloc(n, sizeof *c->sent);
    c->received = calloc(n, sizeof *c->received);
    CHECK(c->rows && c->sent && c->received, DEM_ERROR_MEMORY, "out of memory for %zu ranks", n);
    return DEM_OK;
}

static dem_status allocate_items(const collection *c)
{
    for (int k = 0; k < c->ranks->size; k++) {
        const size_t size = size_of(c, &c->rows[k]);
        c->rows[k].items = malloc(size + 1);
        CHECK(c->rows[k].items, DEM_ERROR_MEMORY, "out of memory for %zu bytes of rank %d", size, k);
    }
    return DEM_OK;
}

static dem_status collect(collection *c, const domain *d, const double *from, double *whole)
{
    const ranks *r = c->ranks;
    TRY(reduce_status(r, allocate_lists(c), 0.0));
    for (dem_index i = 0; i < d->n_nodes; i++) c->rows[r->rank].n += d->is_own[i];
    exchange_with_root(c, count_of, size_of_count);
    TRY(reduce_status(r, allocate_items(c), 0.0));
    pack(c, d, from);
    exchange_with_root(c, items_of, size_of);
    if (r->rank == 0) unpack(c, whole);
    return DEM_OK;
}

dem_status gather_rows(const ranks *r, const domain *d, int dim, const double *from, double *whole)
{
    collection c = {.ranks = r, .dim = dim};
    const dem_status status = collect(&c, d, from, whole);
    for (int k = 0; k < r->size && c.rows != NULL; k++) free(c.rows[k].items);
    free(c.rows);
    free(c.sent);
    free(c.received);
    return status;
}
