/* SPDX-License-Identifier: BSD-3-Clause */
#include "domain/domain_lists.h"

#include <stdlib.h>
#include <string.h>

#include "base/sorted.h"
#include "base/status.h"

/* ---- rows ---- */

typedef int rank_of(const domain_lists *l, dem_index k);

static int owner_of(const domain_lists *l, dem_index node)
{
    return l->shares->owner[node];
}

static int holder_of(const domain_lists *l, dem_index place)
{
    return l->rings.list[place].rank;
}

static int lender_of(const domain_lists *l, dem_index place)
{
    return owner_of(l, l->rings.list[place].node);
}

/* A counting sort: row[r] goes on while the row of rank r is filled, and is then where the next one begins. */
static dem_status sort(rank_lists *out, const domain_lists *l, dem_index n, rank_of *of)
{
    const int n_ranks = l->shares->n_ranks;
    out->row = calloc((size_t)n_ranks + 1, sizeof *out->row);
    out->list = malloc(((size_t)n + 1) * sizeof *out->list);
    CHECK(out->row && out->list, DEM_ERROR_MEMORY, "out of memory for the nodes of %d ranks", n_ranks);
    for (dem_index k = 0; k < n; k++) out->row[of(l, k) + 1]++;
    for (int r = 0; r < n_ranks; r++) out->row[r + 1] += out->row[r];
    for (dem_index k = 0; k < n; k++) out->list[out->row[of(l, k)]++] = k;
    memmove(out->row + 1, out->row, (size_t)n_ranks * sizeof *out->row);
    out->row[0] = 0;
    return DEM_OK;
}

static void free_rows(rank_lists *r)
{
    free(r->row);
    free(r->list);
}

static dem_status list_common(domain_lists *l)
{
    const unsigned char *is_common = l->shares->is_common;
    for (dem_index i = 0; i < l->n_whole && is_common != NULL; i++) l->n_common += is_common[i] != 0;
    l->common = malloc(((size_t)l->n_common + 1) * sizeof *l->common);
    CHECK_MEMORY(l->common);
    dem_index n = 0;
    for (dem_index i = 0; i < l->n_whole && is_common != NULL; i++)
        if (is_common[i]) l->common[n++] = i;
    return DEM_OK;
}

dem_status domain_lists_create(domain_lists *out, const dem_lattice *whole, const domain_shares *shares)
{
    *out = (domain_lists){.shares = shares, .n_whole = whole->n_nodes};
    TRY(ghost_rings_find(&out->rings, whole, shares));
    TRY(sort(&out->own, out, out->n_whole, owner_of));
    TRY(sort(&out->ghosts, out, out->rings.n, holder_of));
    TRY(sort(&out->lent, out, out->rings.n, lender_of));
    TRY(list_common(out));
    out->local = malloc(((size_t)out->n_whole + 1) * sizeof *out->local);
    CHECK(out->local, DEM_ERROR_MEMORY, "out of memory for the numbers of %lld nodes", (long long)out->n_whole);
    for (dem_index i = 0; i < out->n_whole; i++) out->local[i] = -1;
    return DEM_OK;
}

void domain_lists_free(domain_lists *l)
{
    ghost_rings_free(&l->rings);
    free_rows(&l->own);
    free_rows(&l->ghosts);
    free_rows(&l->lent);
    free(l->common);
    free(l->local);
    *l = (domain_lists){0};
}

/* ---- nodes ---- */

dem_status domain_lists_nodes(const domain_lists *l, int rank, dem_index **node, dem_index *n)
{
    const dem_index *own = l->own.list + l->own.row[rank], *ghosts = l->ghosts.list + l->ghosts.row[rank];
    const dem_index n_own = l->own.row[rank + 1] - l->own.row[rank];
    const dem_index n_ghosts = l->ghosts.row[rank + 1] - l->ghosts.row[rank];
    const size_t most = (size_t)(n_own + l->n_common + n_ghosts) + 1;
    dem_index *integrated = malloc(most * sizeof *integrated),
              *numbers = malloc(((size_t)n_ghosts + 1) * sizeof *numbers);
    *node = malloc(most * sizeof **node);
    const bool has_room = integrated != NULL && numbers != NULL && *node != NULL;
    if (has_room) {
        const dem_index n_integrated = sorted_merge(integrated, own, n_own, l->common, l->n_common);
        for (dem_index k = 0; k < n_ghosts; k++) numbers[k] = l->rings.list[ghosts[k]].node;
        *n = sorted_merge(*node, integrated, n_integrated, numbers, n_ghosts);
    }
    free(integrated);
    free(numbers);
    CHECK(has_room, DEM_ERROR_MEMORY, "out of memory for a domain of %lld nodes", (long long)most);
    return DEM_OK;
}

void domain_lists_number(domain_lists *l, const dem_index *node, dem_index n)
{
    for (dem_index k = 0; k < n; k++) l->local[node[k]] = k;
}

void domain_lists_forget(domain_lists *l, const dem_index *node, dem_index n)
{
    for (dem_index k = 0; k < n; k++) l->local[node[k]] = -1;
}
