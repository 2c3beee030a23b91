/* SPDX-License-Identifier: BSD-3-Clause */
/* Nodes that all ranks have in common, as contact may concern them: every rank integrates all of these, finds the
 * forces of bodies on each other, and resolves all events, so that no rank has to ask another one about any. */
#ifndef DEM_DOMAIN_COMMON_NODES_H
#define DEM_DOMAIN_COMMON_NODES_H

#include <dem/dem.h>

/** Adds the neighbours up to ring n_rings to common nodes.
 *  \param[in,out] is_common  [n_nodes] not 0: a common node; at first 0 or 1 */
void common_nodes_add_rings(const dem_lattice *lattice, int n_rings, unsigned char *is_common);

#endif
