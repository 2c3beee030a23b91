/* SPDX-License-Identifier: BSD-3-Clause */
#include "model/joined_nodes.h"

#include <stdlib.h>

#include "base/status.h"
#include "base/union_find.h"

void joined_nodes_find(const dem_lattice *lattice, const unsigned char *breakable, dem_index *joined)
{
    union_find_start(joined, lattice->n_nodes);
    for (dem_index k = 0; k < lattice->n_springs; k++) {
        const dem_index i = lattice->ends[2 * k], j = lattice->ends[2 * k + 1];
        if (!breakable[i] || !breakable[j]) union_find_unite(joined, i, j);
    }
    for (dem_index i = 0; i < lattice->n_nodes; i++) joined[i] = joined[joined[i]];
}

typedef struct member {
    dem_index joined, node;
} member;

static int compare(const void *a, const void *b)
{
    const member *first = a, *second = b;
    if (first->joined != second->joined) return first->joined < second->joined ? -1 : 1;
    return (first->node > second->node) - (first->node < second->node);
}

dem_status joined_nodes_place(domain *d)
{
    member *list = malloc((size_t)d->n_nodes * sizeof *list + 1);
    d->joined_to = malloc((size_t)d->n_nodes * sizeof *d->joined_to + 1);
    const bool good = list != NULL && d->joined_to != NULL;
    for (dem_index i = 0; i < d->n_nodes && good; i++) list[i] = (member){d->joined[i], i};
    if (good) qsort(list, (size_t)d->n_nodes, sizeof *list, compare);
    for (dem_index k = 0, first = 0; k < d->n_nodes && good; k++) {
        if (list[k].joined != list[first].joined) first = k;
        d->joined_to[list[k].node] = list[first].node;
    }
    free(list);
    CHECK(good, DEM_ERROR_MEMORY, "out of memory for a domain of %lld nodes", (long long)d->n_nodes);
    return DEM_OK;
}
