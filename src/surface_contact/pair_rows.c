/* SPDX-License-Identifier: BSD-3-Clause */
/* Contact pairs and the rows of their nodes, as linked lists of slots: to clear and to fill them costs what there is of
 * pairs, not of nodes. Which pairs come in is decided in pair_list.c and surface_contact.c. */
#include "surface_contact/pair_rows.h"

#include <stdlib.h>

#include "base/grow.h"
#include "base/status.h"

dem_status pair_rows_create(pair_rows *out, dem_index n_nodes)
{
    pair_rows r = {.n_nodes = n_nodes, .first = malloc((size_t)n_nodes * sizeof *r.first)};
    CHECK(r.first != NULL, DEM_ERROR_MEMORY, "out of memory for the contact pairs of %lld nodes", (long long)n_nodes);
    for (dem_index i = 0; i < n_nodes; i++) r.first[i] = -1;
    *out = r;
    return DEM_OK;
}

void pair_rows_destroy(pair_rows *r)
{
    free(r->list);
    free(r->first);
    free(r->next);
    *r = (pair_rows){0};
}

void pair_rows_clear(pair_rows *r)
{
    for (dem_index k = 0; k < r->n; k++)
        for (int which = 0; which < CONTACT_PAIR_NODES; which++) r->first[r->list[k].nodes[which]] = -1;
    r->n = 0;
}

dem_status pair_rows_add(pair_rows *r, const contact_pair *pair)
{
    CHECK(grow_array((void **)&r->list, &r->capacity, r->n + 1, sizeof *r->list), DEM_ERROR_MEMORY,
          "out of memory for %lld contact pairs", (long long)r->n + 1);
    r->list[r->n++] = *pair;
    return DEM_OK;
}

/* From the last slot to the first, each before those of its node that are there: rows come out ascending. */
dem_status pair_rows_link(pair_rows *r)
{
    CHECK(grow_array((void **)&r->next, &r->next_capacity, CONTACT_PAIR_NODES * r->n, sizeof *r->next),
          DEM_ERROR_MEMORY, "out of memory for %lld contact pairs", (long long)r->n);
    for (dem_index slot = CONTACT_PAIR_NODES * r->n - 1; slot >= 0; slot--) {
        const dem_index node = pair_rows_pair(r, slot)->nodes[pair_rows_which(slot)];
        r->next[slot] = r->first[node];
        r->first[node] = slot;
    }
    r->n_linked++;
    return DEM_OK;
}
