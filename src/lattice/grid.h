/* SPDX-License-Identifier: BSD-3-Clause */
/* Rows of regular triangulations: of equilateral triangles, or of square cells of two triangles each. A grid is any
 * range of the rows of one that goes on above and below, and has the same bits as these rows have in the whole. */
#ifndef DEM_LATTICE_GRID_H
#define DEM_LATTICE_GRID_H

#include <stdbool.h>

#include <dem/dem.h>

/** Rows first .. last. Nodes are at x = s spacing/2 with whole s, |s| <= reach, that differ by 2: s has the parity of
 *  reach in wide rows, which are those of squares and, of triangles, the even ones; the other one in the rest. So x is
 *  mirror symmetric to the bit. Row 0 has y = 0. */
typedef struct grid {
    bool is_square;
    dem_index reach, first, last;
    double spacing; /* m */
} grid;

/** All rows of a rectangle standing on the origin. Width and height are rounded to whole columns and rows.
 *  \return DEM_ERROR_ARGUMENT, DEM_ERROR_MODEL for too many nodes */
dem_status grid_of_rectangle(grid *out, double width, double height, double spacing);
dem_status grid_of_squares(grid *out, double width, double height, double spacing);

/** Of a disc about the origin, a column wider on each side.
 *  \param reach  m, as far as nodes are wanted */
dem_status grid_around_disc(grid *out, double reach, double spacing);

/** Whether a node of such a grid is in its disc, edge included.  \param reach  double, m */
bool grid_disc_has(void *reach, const double *x);

/** Of the rows of a grid those from `first` to `last`. */
grid grid_between(const grid *whole, dem_index first, dem_index last);

/** Between two rows, m. */
double grid_height(const grid *g);

/** The number of nodes in rows first .. last, and of triangles between them; 0 for last < first. */
dem_index grid_count_nodes(const grid *g);
dem_index grid_count_triangles(const grid *g);

/** The number of nodes in rows below `row`, and of triangles below it. */
dem_index grid_nodes_below(const grid *g, dem_index row);
dem_index grid_triangles_below(const grid *g, dem_index row);

/** Its nodes, row by row, and triangles, strip by strip between two rows: counter-clockwise, of squares those of a cell
 *  next to each other.
 *  \param[out] out  an empty lattice; dem_lattice_free() frees it  \return DEM_ERROR_MEMORY */
dem_status grid_lattice(dem_lattice *out, const grid *g);

#endif
