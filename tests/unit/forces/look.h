/* SPDX-License-Identifier: BSD-3-Clause */
/* What tests of other rooms may see of forces' data that no other room of the library touches. */
#ifndef DEM_TEST_FORCES_LOOK_H
#define DEM_TEST_FORCES_LOOK_H

#include "forces/local_nodes.h"

/** The number here of a node of the lattice; -1: it is not here. */
static inline dem_index look_number(const local_nodes *nodes, dem_index node)
{
    return nodes->number[node];
}

#endif
