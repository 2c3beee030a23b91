/* SPDX-License-Identifier: BSD-3-Clause */
/* Which rank owns which node: rest positions are bisected again and again, so that domains are compact and of equal
 * size, or weight (docs/algorithms.md, Ranks). */
#ifndef DEM_DOMAIN_PARTITION_H
#define DEM_DOMAIN_PARTITION_H

#include <dem/dem.h>

/** Shares the nodes of a lattice out among n ranks: each gets one at least, and as many as any other but for one.
 *  \param[out] owner  [n_nodes] 0 <= owner < n
 *  \return DEM_ERROR_MODEL for more ranks than nodes, DEM_ERROR_MEMORY */
dem_status partition_bisect(const dem_lattice *lattice, int n, int32_t *owner);

/** The same by weights: each rank gets one node at least, and about as much weight as any other.
 *  \param weights  [n_nodes] >= 0; NULL: all the same */
dem_status partition_bisect_weighted(const dem_lattice *lattice, const double *weights, int n, int32_t *owner);

#endif
