/* SPDX-License-Identifier: BSD-3-Clause */
/* Which triangles of a lattice a smooth shape keeps, before the nodes of its rim are moved (smoothing.h). Triangles are
 * kept by their centres, so that the rim is about the edge. If they were kept by their nodes, the rim would be half a
 * spacing inside, and a quarter of its nodes too far off: areas were found 5 % (discs) and 12 % (rings) too small at
 * R/10. Nodes are not moved here. */
#ifndef DEM_SHAPE_SHAPE_TRIM_H
#define DEM_SHAPE_SHAPE_TRIM_H

#include "shape/shape.h"

/* Keeps the triangles with their centres in the material, but no pieces of a few triangles.
 * \param lattice  shape_mesh() of the shape, or rows of it
 * \param is_part  these rows: the largest piece is elsewhere, and larger than any that is taken out
 * \return DEM_OK, DEM_ERROR_MEMORY, or DEM_ERROR_MODEL if nothing is left */
dem_status shape_trim(dem_lattice *lattice, const shape *s, bool is_part);

#endif
