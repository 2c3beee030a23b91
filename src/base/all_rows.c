/* SPDX-License-Identifier: BSD-3-Clause */
/* Each rank sends its rows to every other one, where they come to the place that they have among all. */
#include "base/all_rows.h"

#include <stdlib.h>

#include "base/reduce.h"
#include "base/status.h"

static dem_status allocate(all_rows *a)
{
    const size_t n = (size_t)a->ranks->size;
    a->first = calloc(n + 1, sizeof *a->first);
    a->sent = calloc(n, sizeof *a->sent);
    a->received = calloc(n, sizeof *a->received);
    CHECK(a->first && a->sent && a->received, DEM_ERROR_MEMORY, "out of memory for rows of %d ranks", a->ranks->size);
    return DEM_OK;
}

/* The rows of a rank.  \param first  NULL: each rank has one */
static ranks_message rows_of(int rank, const dem_index *first, size_t size, char *rows)
{
    const size_t begin = first != NULL ? (size_t)first[rank] : (size_t)rank;
    const size_t end = first != NULL ? (size_t)first[rank + 1] : begin + 1;
    return (ranks_message){rank, (end - begin) * size, rows + begin * size};
}

static void exchange(const all_rows *a, const dem_index *first, size_t size, char *rows)
{
    const ranks *r = a->ranks;
    int n = 0;
    for (int k = 0; k < r->size; k++) {
        if (k == r->rank) continue;
        a->received[n] = rows_of(k, first, size, rows);
        a->sent[n] = rows_of(r->rank, first, size, rows);
        a->sent[n++].rank = k;
    }
    r->exchange(r->self, n, a->sent, a->received);
}

dem_status all_rows_create(all_rows *out, const ranks *r, dem_index n)
{
    *out = (all_rows){.ranks = r};
    TRY(reduce_status(r, allocate(out), 0.0));
    dem_index *counts = out->first + 1; /* first */
    counts[r->rank] = n;
    if (r->size > 1) exchange(out, NULL, sizeof *counts, (char *)counts);
    for (int k = 0; k < r->size; k++) out->first[k + 1] += out->first[k];
    out->n = out->first[r->size];
    return DEM_OK;
}

void all_rows_free(all_rows *a)
{
    free(a->first);
    free(a->sent);
    free(a->received);
    *a = (all_rows){0};
}

void all_rows_share(const all_rows *a, size_t size, void *rows)
{
    if (a->ranks->size > 1 && a->n > 0) exchange(a, a->first, size, rows);
}
