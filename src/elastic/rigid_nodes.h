/* SPDX-License-Identifier: BSD-3-Clause */
/* Nodes of rigid bodies, whose springs and triangles carry nothing and are left out when a lattice is compiled. */
#ifndef DEM_ELASTIC_RIGID_NODES_H
#define DEM_ELASTIC_RIGID_NODES_H

#include <stdbool.h>

#include <dem/dem.h>

/** Whether a node is of a rigid body. With it all nodes are to which springs or triangles join it. */
static inline bool rigid_nodes_have(const dem_lattice *lattice, dem_index node)
{
    return lattice->flags != NULL && (lattice->flags[node] & DEM_NODE_RIGID) != 0;
}

#endif
