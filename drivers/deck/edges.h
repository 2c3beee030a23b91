/* SPDX-License-Identifier: BSD-3-Clause */
/* Which nodes lie on edges that a lattice follows only in steps: stresses there grow as the spacing shrinks. */
#ifndef DEM_EDGES_H
#define DEM_EDGES_H

#include <stdbool.h>

#include <dem/dem.h>

#include "schema.h"

/** Whether a node that may touch is on such an edge, of a body that is neither a mesh nor a file: on any but the
 *  straight sides of a rectangle, those along its rows of nodes: the upper and the lower one of triangles, all of
 *  squares. The edge of a void counts though it may run along a row, too. False where bodies of the lattice are not one
 *  for one those of the deck. */
bool edges_stepped(const schema_deck *groups, const dem_lattice *lattice, dem_index n_bodies, dem_index node);

#endif
