/* SPDX-License-Identifier: BSD-3-Clause */
/* Which nodes are ghosts of which ranks: those up to so many neighbours away from what a rank integrates. */
#ifndef DEM_DOMAIN_GHOST_RINGS_H
#define DEM_DOMAIN_GHOST_RINGS_H

#include "domain/domain_shares.h"

/** A node that a rank has as a ghost. */
typedef struct ghost {
    dem_index node; /* its number in the whole lattice */
    int32_t rank;
    int32_t ring; /* 1: next to a node that the rank integrates, 2: next to one of these, ... */
} ghost;

/** Those of all ranks, by node, then by rank. */
typedef struct ghost_rings {
    int n_rings;
    dem_index n, capacity;
    ghost *list;    /* [n] */
    dem_index *row; /* [n_nodes + 1] where those of a node begin */
} ghost_rings;

/** Finds the same on every rank; of a part of the whole what a rank has, and what others have of it. Collective, where
 *  ranks count together. Free with ghost_rings_free(), after a failure, too.  \return DEM_ERROR_MEMORY */
dem_status ghost_rings_find(ghost_rings *out, const dem_lattice *whole, const domain_shares *shares);
void ghost_rings_free(ghost_rings *g);

#endif
