/* SPDX-License-Identifier: BSD-3-Clause */
/* Nodes that all ranks have in common, as an event of contact may concern them: every rank integrates all of these, and
 * resolves all events, so that no rank has to ask another one about any. */
#ifndef DEM_DOMAIN_COMMON_NODES_H
#define DEM_DOMAIN_COMMON_NODES_H

#include <dem/dem.h>

/** Finds what may touch, and its neighbours up to ring n_rings.
 *  \param lattice          with flags
 *  \param[out] is_common   [n_nodes] not 0: a common node */
void common_nodes_find(const dem_lattice *lattice, int n_rings, unsigned char *is_common);

#endif
