/* SPDX-License-Identifier: BSD-3-Clause */
#include "forces/border_blocks.h"

#include <stdlib.h>

#include "base/status.h"
#include "elastic/layout_lanes.h"

static void mark(uint8_t *is_in, dem_index n_blocks, const dem_index *nodes, dem_index n)
{
    for (dem_index k = 0; k < n; k++)
        if (nodes[k] / LAYOUT_LANES < n_blocks) is_in[nodes[k] / LAYOUT_LANES] = 1;
}

static void list(border_blocks *b, dem_index n_blocks)
{
    for (dem_index block = 0; block < n_blocks; block++)
        if (b->is_in[block]) b->list[b->n++] = block;
}

dem_status border_blocks_create(border_blocks *out, const domain *d, dem_index n_blocks)
{
    *out = (border_blocks){0};
    if (d == NULL || d->n_neighbours == 0) return DEM_OK;
    border_blocks b = {.list = malloc(((size_t)n_blocks + 1) * sizeof *b.list),
                       .is_in = calloc((size_t)n_blocks + 1, sizeof *b.is_in)};
    if (b.list == NULL || b.is_in == NULL) {
        border_blocks_free(&b);
        return status_fail(DEM_ERROR_MEMORY, "out of memory for the border of %lld blocks", (long long)n_blocks);
    }
    for (int k = 0; k < d->n_neighbours; k++) {
        const domain_neighbour *one = &d->neighbours[k];
        mark(b.is_in, n_blocks, one->sent, one->n_sent);
        mark(b.is_in, n_blocks, one->received, one->n_received);
    }
    list(&b, n_blocks);
    *out = b;
    return DEM_OK;
}

void border_blocks_free(border_blocks *b)
{
    free(b->list);
    free(b->is_in);
    *b = (border_blocks){0};
}
