/* SPDX-License-Identifier: BSD-3-Clause */
/* What of a lattice lies in an outline: triangles by their centres, springs by their middles. */
#ifndef DEM_ENCLOSED_H
#define DEM_ENCLOSED_H

#include <stdbool.h>

#include <dem/dem.h>

#include "outline.h"

/* Gives the triangles in an outline a value, `step` of them at a time by their common centre: 2 for cells, else 1.
 * \param of  [n_triangles]
 * \return how many */
dem_index enclosed_triangles(dem_index *of, const dem_lattice *lattice, const outline *o, dem_index value,
                             dem_index step);

/* \param springs  [n_springs] set to true for those in an outline */
void enclosed_springs(bool *springs, const dem_lattice *lattice, const outline *o);

#endif
