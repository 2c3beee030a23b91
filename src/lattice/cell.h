/* SPDX-License-Identifier: BSD-3-Clause */
/* Square cells, or other convex quadrilaterals: two triangles each, with both diagonals as springs. */
#ifndef DEM_LATTICE_CELL_H
#define DEM_LATTICE_CELL_H

#include <stdbool.h>

#include <dem/dem.h>

/** The corners of the quadrilateral that two triangles make, counter-clockwise, the first and third where these do not
 *  meet.  \return false where they do not share a side */
bool cell_corners(const dem_lattice *l, dem_index first, dem_index second, dem_index corner[4]);

/** Whether all its angles are less than two right ones. */
bool cell_is_convex(const dem_lattice *l, const dem_index corner[4]);

/** Which triangles of a solid are halves of cells: they share a side with the one before or after, and a spring is the
 *  other diagonal.  \param[out] half  [n_triangles] 0 or 1 */
dem_status cell_mark(unsigned char *half, const dem_lattice *l);

#endif
