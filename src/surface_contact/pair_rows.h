/* SPDX-License-Identifier: BSD-3-Clause */
/* Contact pairs in the order of (node, edge), and for each node the pairs in which it is, in the same order. */
#ifndef DEM_SURFACE_CONTACT_PAIR_ROWS_H
#define DEM_SURFACE_CONTACT_PAIR_ROWS_H

#include "surface_contact/contact_pair.h"

typedef struct pair_rows {
    dem_index n_nodes;
    dem_index n, capacity;
    dem_index n_linked; /* how often they have been linked: other pairs have another number */
    contact_pair *list; /* [n] */
    dem_index *first;   /* [n_nodes] first slot of each node, -1: none */
    dem_index *next;    /* [CONTACT_PAIR_NODES n] the next slot of the same node, -1: none; room for all of list */
    dem_index next_capacity;
} pair_rows;

/** None. Free with pair_rows_destroy(). */
dem_status pair_rows_create(pair_rows *out, dem_index n_nodes);
void pair_rows_destroy(pair_rows *r);

/** Removes all pairs. */
void pair_rows_clear(pair_rows *r);

/** Adds a pair behind the others; pair_rows_link() has to follow the last one. */
dem_status pair_rows_add(pair_rows *r, const contact_pair *pair);

/** Lists the pairs by nodes. */
dem_status pair_rows_link(pair_rows *r);

/** Whether a node is in a pair. */
static inline bool pair_rows_has(const pair_rows *r, dem_index node)
{
    return r->first[node] >= 0;
}

/** The pair of a slot, and what the node of the slot is in it. */
static inline const contact_pair *pair_rows_pair(const pair_rows *r, dem_index slot)
{
    return &r->list[slot / CONTACT_PAIR_NODES];
}

static inline int pair_rows_which(dem_index slot)
{
    return (int)(slot % CONTACT_PAIR_NODES);
}

#endif
