/* SPDX-License-Identifier: BSD-3-Clause */
/* What of a lattice may break by itself, and what depends on that. */
#ifndef DEM_MODEL_BREAKABLE_NODES_H
#define DEM_MODEL_BREAKABLE_NODES_H

#include <stdbool.h>

#include <dem/dem.h>

/** Whether elements of a lattice have limits. */
static inline bool breakable_lattice(const dem_lattice *lattice)
{
    return lattice->strength != NULL || lattice->critical_stretch != NULL;
}

/** Whether an element may break at all: it has a limit, and its body is not rigid. Elements are numbered: first the
 *  triangles of a lattice, then its springs. */
bool breakable_element(const dem_lattice *lattice, dem_index element);

/** Marks the nodes whose forces change when an element breaks, and so what may be a surface then: the nodes of elements
 *  that may break, and all that are next to these, as triangles break with a spring that they hold, and the second
 *  diagonal of a cell ends there. A spring of which an end is not marked cannot break.
 *  \param lattice      that of a model
 *  \param[out] marked  [n_nodes] 1: such a node; else 0 */
void breakable_nodes_mark(const dem_lattice *lattice, unsigned char *marked);

#endif
