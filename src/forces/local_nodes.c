/* SPDX-License-Identifier: BSD-3-Clause */
/* The nodes near an event, with numbers of their own: a list, and for each node of the lattice its number in it.
 * Numbers are given out ring by ring, so that a ring is an interval of them. Which nodes are near is found elsewhere
 * (events/neighbourhood.c), since that depends on forces and constraints. */
#include "forces/local_nodes.h"

#include <stdlib.h>
#include <string.h>

#include "base/grow.h"
#include "base/status.h"

dem_status local_nodes_create(local_nodes *out, dem_index n_nodes, int n_rings)
{
    local_nodes b = {.n_rings = n_rings, .number = malloc((size_t)n_nodes * sizeof *b.number)};
    CHECK(b.number != NULL, DEM_ERROR_MEMORY, "out of memory for the neighbours of %lld nodes", (long long)n_nodes);
    for (dem_index i = 0; i < n_nodes; i++) b.number[i] = -1;
    *out = b;
    return DEM_OK;
}

void local_nodes_destroy(local_nodes *b)
{
    free(b->number);
    free(b->list);
    *b = (local_nodes){0};
}

/* Resets only the nodes of the list: an event costs what is near it, not what the lattice has. */
void local_nodes_clear(local_nodes *b)
{
    for (dem_index j = 0; j < b->n; j++) b->number[b->list[j]] = -1;
    b->n = 0;
}

/* The next number; the caller closes a ring by noting how many nodes there are. */
dem_status local_nodes_append(local_nodes *b, dem_index node)
{
    CHECK(grow_array((void **)&b->list, &b->capacity, b->n + 1, sizeof *b->list), DEM_ERROR_MEMORY,
          "out of memory for what is near an event");
    b->number[node] = (int32_t)b->n;
    b->list[b->n++] = node;
    return DEM_OK;
}

dem_status local_nodes_fill(local_nodes *b, dem_index n, const int32_t *list, const dem_index *end)
{
    CHECK(grow_array((void **)&b->list, &b->capacity, n, sizeof *b->list), DEM_ERROR_MEMORY,
          "out of memory for what is near an event");
    for (dem_index j = 0; j < n; j++) {
        b->list[j] = list[j];
        b->number[list[j]] = (int32_t)j;
    }
    memcpy(b->end, end, sizeof b->end);
    b->n = n;
    return DEM_OK;
}
