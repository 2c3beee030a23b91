/* SPDX-License-Identifier: BSD-3-Clause */
/* A lattice without its broken triangles, as what is computed from a triangulation wants to see it. */
#ifndef DEM_MODEL_WHOLE_TRIANGLES_H
#define DEM_MODEL_WHOLE_TRIANGLES_H

#include <dem/dem.h>

/** The lattice with the triangles that are whole, in their order, as all that it has. They are numbered anew, and only
 *  they are owned: everything that a lattice has of each triangle is still that of the old numbers.
 *  \param broken  [n_triangles] 1: broken; NULL: all are whole
 *  \return DEM_ERROR_MEMORY. Free with whole_triangles_free() */
dem_status whole_triangles_of(dem_lattice *out, const dem_lattice *lattice, const unsigned char *broken);
void whole_triangles_free(dem_lattice *lattice);

#endif
