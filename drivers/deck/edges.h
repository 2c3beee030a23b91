/* SPDX-License-Identifier: BSD-3-Clause */
/* Which nodes lie on edges that a lattice follows only in steps: stresses there grow as the spacing shrinks. */
#ifndef DEM_EDGES_H
#define DEM_EDGES_H

#include <stdbool.h>

#include <dem/dem.h>

#include "schema.h"

/** Whether a node is on such an edge, of a body that is neither a mesh nor a file: at an end of an edge of the boundary
 *  that does not run along a side of a rectangle or polygon. A lattice of triangles has rows along the lower and the
 *  upper side of a rectangle, one of squares along all. The edge of a void counts though it may run along a row, too.
 *  A smooth outline has none, unless cracks go through its body: then all count that are not along a side.
 *  Whether the node may touch does not matter. False where bodies of the lattice are not one for one those of the deck.
 */
bool edges_stepped(const schema_deck *groups, const dem_model *model, dem_index node);

#endif
