/* SPDX-License-Identifier: BSD-3-Clause */
/* A counting sort: row[i] goes on while the row of node i is filled, and is then where the next one begins. */
#include "lattice/node_rows.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"

static void fill(node_rows *r, const dem_index *node, int arity, dem_index n, dem_index n_nodes)
{
    for (dem_index k = 0; k < arity * n; k++) r->row[node[k] + 1]++;
    for (dem_index i = 0; i < n_nodes; i++) r->row[i + 1] += r->row[i];
    for (dem_index k = 0; k < arity * n; k++) r->list[r->row[node[k]]++] = (int32_t)(k / arity);
    memmove(r->row + 1, r->row, (size_t)n_nodes * sizeof *r->row);
    r->row[0] = 0;
}

dem_status node_rows_create(node_rows *out, const dem_index *node, int arity, dem_index n, dem_index n_nodes)
{
    *out = (node_rows){.row = calloc((size_t)n_nodes + 1, sizeof *out->row),
                       .list = malloc(((size_t)arity * (size_t)n + 1) * sizeof *out->list)};
    CHECK(out->row && out->list, DEM_ERROR_MEMORY, "out of memory for lists of %lld nodes", (long long)n_nodes);
    fill(out, node, arity, n, n_nodes);
    return DEM_OK;
}

void node_rows_free(node_rows *r)
{
    free(r->row);
    free(r->list);
    *r = (node_rows){0};
}
