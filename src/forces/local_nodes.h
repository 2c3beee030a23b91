/* SPDX-License-Identifier: BSD-3-Clause */
/* The nodes near an event, with numbers of their own, ring by ring. Ring 0 has the nodes that the event concerns, and
 * each further ring those on which the forces on the ring before it depend. */
#ifndef DEM_FORCES_LOCAL_NODES_H
#define DEM_FORCES_LOCAL_NODES_H

#include <stdbool.h>

#include <dem/dem.h>

enum { LOCAL_NODES_RINGS = 8 };

typedef struct local_nodes {
    int n_rings;     /* the last is a frame: its nodes accelerate others, but are not accelerated */
    int32_t *number; /* [n_nodes] the number here of a node of the lattice; -1: none */
    dem_index n, capacity;
    dem_index *list;                  /* [n] in the lattice */
    dem_index end[LOCAL_NODES_RINGS]; /* nodes of ring r or nearer */
} local_nodes;

/** None. `n_rings` < LOCAL_NODES_RINGS. Free with local_nodes_destroy(). */
dem_status local_nodes_create(local_nodes *out, dem_index n_nodes, int n_rings);
void local_nodes_destroy(local_nodes *b);

void local_nodes_clear(local_nodes *b);

/** Makes them these n nodes, with their rings; there are none yet.  \return DEM_ERROR_MEMORY: as it was */
dem_status local_nodes_fill(local_nodes *b, dem_index n, const int32_t *list, const dem_index *end);

/** Adds a node that is not there. */
dem_status local_nodes_append(local_nodes *b, dem_index node);

/** Adds a node if it is not there. */
static inline dem_status local_nodes_add(local_nodes *b, dem_index node)
{
    return b->number[node] >= 0 ? DEM_OK : local_nodes_append(b, node);
}

/** The same as a callback, with the nodes as its context. */
static inline dem_status local_nodes_add_to(void *context, dem_index node)
{
    return local_nodes_add(context, node);
}

/** Whether a node is in the ring or nearer. */
static inline bool local_nodes_have(const local_nodes *b, dem_index node, int ring)
{
    return b->number[node] >= 0 && b->number[node] < b->end[ring];
}

/** Where ring r begins. */
static inline dem_index local_nodes_begin(const local_nodes *b, int ring)
{
    return ring > 0 ? b->end[ring - 1] : 0;
}

/** How many nodes are accelerated. */
static inline dem_index local_nodes_n_moving(const local_nodes *b)
{
    return b->end[b->n_rings - 1];
}

#endif
