/* SPDX-License-Identifier: BSD-3-Clause */
/* Which nodes are of one fragment whatever breaks, as springs that cannot break join them: so a domain that has all
 * that may break knows what it splits off, though it has not all of the body. */
#ifndef DEM_MODEL_JOINED_NODES_H
#define DEM_MODEL_JOINED_NODES_H

#include "domain/domain.h"

/** Finds the lowest node of those that such springs join to each node.
 *  \param lattice      the whole
 *  \param breakable    [n_nodes] breakable_nodes_mark(): a spring between two of these may break
 *  \param[out] joined  [n_nodes] */
void joined_nodes_find(const dem_lattice *lattice, const unsigned char *breakable, dem_index *joined);

/** Finds in a domain whose `joined` is known the lowest one of the nodes that have the same there: `joined_to`.
 *  \return DEM_ERROR_MEMORY */
dem_status joined_nodes_place(domain *d);

#endif
