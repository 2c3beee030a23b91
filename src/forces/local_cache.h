/* SPDX-License-Identifier: BSD-3-Clause */
/* What has been listed near nodes that impact again and again, for their next impact. Lists depend on the model alone
 * where nothing near has broken or softened, and so they hold for as long as that is so; see local_springs.c. */
#ifndef DEM_FORCES_LOCAL_CACHE_H
#define DEM_FORCES_LOCAL_CACHE_H

#include "base/intern.h"
#include "forces/local_elements.h"

/** The rings round one node, and what acts there; borrowed until something is kept. */
typedef struct local_record {
    dem_index n;
    const int32_t *list;  /* [n] nodes of the lattice */
    const dem_index *end; /* [LOCAL_NODES_RINGS] as in local_nodes */
    local_lists lists;
} local_record;

enum { LOCAL_CACHE_PARTS = 7 };

/** A place for what is kept, of one node at a time. */
typedef struct local_slot {
    dem_index node; /* -1: none */
    int n_rings;
    bool by_node;
    dem_index end[LOCAL_NODES_RINGS];
    intern_span parts[LOCAL_CACHE_PARTS]; /* of numbers that equal lists share */
} local_slot;

typedef struct local_cache {
    local_slot *slots; /* NULL until one is needed */
    intern items;
    dem_index capacity;
    int32_t *numbers; /* [capacity] scratch */
} local_cache;

/** Also empties it. */
void local_cache_destroy(local_cache *c);

/** What is kept of a node with so many rings, if it is.  \return whether it is */
bool local_cache_find(const local_cache *c, dem_index node, int n_rings, local_record *out);

/** Keeps what has been listed near a node, in place of another node; where there is no memory for it, it is not kept.
 *  Stiffness is to be the same under pressure and in tension. */
void local_cache_keep(local_cache *c, dem_index node, const local_nodes *nodes, const local_lists *lists);

#endif
