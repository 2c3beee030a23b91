/* SPDX-License-Identifier: BSD-3-Clause */
#include "model/boundary_nodes.h"

#include <stdlib.h>
#include <string.h>

#include "base/grow.h"
#include "base/reduce.h"
#include "base/sorted.h"
#include "base/status.h"

static bool is_known(const boundary_nodes *b, dem_index node)
{
    return b->domain == NULL || b->domain->is_common[node];
}

/* Likewise after a failure; some arrays may have more room then. */
static dem_status reserve(boundary_nodes *b, dem_index n_here)
{
    const dem_index needed = b->sent.n + n_here;
    dem_index rooms[] = {b->room, b->room, b->room};
    CHECK(grow_array((void **)&b->number, &rooms[0], needed, sizeof *b->number) &&
              grow_array((void **)&b->x, &rooms[1], needed, 2 * sizeof *b->x) &&
              grow_array((void **)&b->here, &rooms[2], needed, sizeof *b->here),
          DEM_ERROR_MEMORY, "out of memory for %lld nodes of the boundary", (long long)needed);
    b->room = rooms[0];
    return DEM_OK;
}

/* The first n of `here` are those that are known. */
static void take(boundary_nodes *b, dem_index n)
{
    b->n = b->sent.n + n;
    for (dem_index k = 0; k < n; k++) b->number[b->sent.n + k] = domain_number(b->domain, b->here[k]);
}

/* ---- where nothing is broken ---- */

static dem_status create_whole(boundary_nodes *b, const dem_lattice *lattice)
{
    mesh_boundary boundary;
    TRY(mesh_boundary_create(&boundary, lattice, NULL));
    const dem_status status = boundary_nodes_reserve(b, &boundary);
    if (status == DEM_OK) boundary_nodes_follow(b, &boundary);
    mesh_boundary_free(&boundary);
    return status;
}

/* \param[out] n  how many there are */
static dem_status list_own(boundary_nodes *b, dem_index *n)
{
    const domain *d = b->domain;
    b->own = malloc(((size_t)d->n_boundary + 1) * sizeof *b->own);
    CHECK(b->own != NULL, DEM_ERROR_MEMORY, "out of memory for %lld nodes of the boundary", (long long)d->n_boundary);
    *n = 0;
    for (dem_index k = 0; k < d->n_boundary; k++)
        if (!is_known(b, d->boundary[k])) b->own[(*n)++] = d->boundary[k];
    return DEM_OK;
}

static dem_index count_own(const boundary_nodes *b)
{
    return b->sent.first[b->ranks->rank + 1] - all_rows_own(&b->sent);
}

static dem_status create_part(boundary_nodes *b)
{
    const domain *d = b->domain;
    dem_index n_own, n_here = 0;
    TRY(reduce_status(b->ranks, list_own(b, &n_own), 0.0));
    TRY(all_rows_create(&b->sent, b->ranks, n_own));
    TRY(reduce_status(b->ranks, reserve(b, d->n_boundary), 0.0));
    for (dem_index k = 0; k < n_own; k++) b->number[all_rows_own(&b->sent) + k] = d->number[b->own[k]];
    all_rows_share(&b->sent, sizeof *b->number, b->number);
    for (dem_index k = 0; k < d->n_boundary; k++)
        if (is_known(b, d->boundary[k])) b->here[n_here++] = d->boundary[k];
    take(b, n_here);
    return DEM_OK;
}

dem_status boundary_nodes_create(boundary_nodes *out, const dem_lattice *lattice, const ranks *r, const domain *d)
{
    *out = (boundary_nodes){.ranks = r, .domain = d};
    return d != NULL ? create_part(out) : create_whole(out, lattice);
}

void boundary_nodes_free(boundary_nodes *b)
{
    all_rows_free(&b->sent);
    free(b->number);
    free(b->x);
    free(b->own);
    free(b->here);
    *b = (boundary_nodes){0};
}

/* ---- later ---- */

dem_status boundary_nodes_reserve(boundary_nodes *b, const mesh_boundary *boundary)
{
    return reserve(b, 2 * boundary->n);
}

/* The ends of the edges. A node that has lost all of its triangles is on no boundary any more. */
void boundary_nodes_follow(boundary_nodes *b, const mesh_boundary *boundary)
{
    dem_index n = 0;
    for (dem_index k = 0; k < boundary->n; k++) {
        const mesh_boundary_edge *edge = &boundary->list[k];
        if (is_known(b, edge->lower)) b->here[n++] = edge->lower;
        if (is_known(b, edge->upper)) b->here[n++] = edge->upper;
    }
    take(b, sorted_make(b->here, n));
}

static void copy(double *to, const double *x, const dem_index *nodes, dem_index n)
{
    for (dem_index k = 0; k < n; k++) memcpy(to + 2 * k, x + 2 * nodes[k], 2 * sizeof *to);
}

void boundary_nodes_locate(boundary_nodes *b, const double *x)
{
    const all_rows *sent = &b->sent;
    copy(b->x + 2 * sent->n, x, b->here, b->n - sent->n);
    if (b->domain == NULL) return;
    copy(b->x + 2 * all_rows_own(sent), x, b->own, count_own(b));
    all_rows_share(sent, 2 * sizeof *b->x, b->x);
}
