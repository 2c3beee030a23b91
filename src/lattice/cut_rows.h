/* SPDX-License-Identifier: BSD-3-Clause */
/* Rows of a grid of which not all stays, and slabs of them: whole rows of what is left. */
#ifndef DEM_LATTICE_CUT_ROWS_H
#define DEM_LATTICE_CUT_ROWS_H

#include "lattice/grid.h"

/** Which rows of the whole are made. */
typedef struct cut_range {
    grid rows; /* all of them */
    grid own;  /* those that are counted, or own ones of a slab; the rows beside tell what is left of these */
} cut_range;

/** Says which triangles stay of some rows, and moves nodes to where they are to be. With a height of 1 what is said of
 *  a triangle depends on its nodes alone, of a cell of squares on those of both triangles. With a larger one it may go
 *  by other rows, too, and triangles may get other nodes, so that one between the rows k and k + 1 has nodes in rows
 *  k + 1 - height to k + height; those that would get one which is not there are not asked for.
 *  \param rows       range->rows from grid_lattice()
 *  \param[out] keep  [n_triangles]
 *  \return DEM_ERROR_MEMORY */
typedef dem_status cut_rows_mark(void *context, const cut_range *range, dem_lattice *rows, bool *keep);

typedef struct cut_rows {
    grid whole;
    cut_rows_mark *mark; /* NULL: all stays where it is */
    void *context;
    dem_index height; /* rows that nodes of a triangle are apart at most: 1 or more */
    dem_index least;  /* rows that are counted at a time */
} cut_rows;

/** Makes one of n_parts slabs. Where all stays each has the same number of rows, or one more, else about as many nodes;
 *  these are counted by making all rows, some at a time.
 *  \param[out] out  of this library's version; overwritten, not freed; dem_slab_free() frees it
 *  \return DEM_ERROR_MODEL for more parts than rows with nodes, and where nothing is left; DEM_ERROR_MEMORY */
dem_status cut_rows_slab(dem_slab *out, const cut_rows *c, dem_index part, dem_index n_parts);

/** Makes the slab of the rows whose first nodes have, of what is left, the numbers from `begin` on, before `end`, and
 *  of those behind them that cannot begin a slab, as triangles above them have nodes below. Where there are none it has
 *  but the numbers of nodes and triangles of the whole.
 *  \param counts  NULL in it, or what a call for the same rows has left there, which does not count them again: a list,
 *                 of which the first number says how many follow; to be freed; NULL after a failure
 *  \return DEM_ERROR_MODEL where nothing is left; DEM_ERROR_MEMORY */
dem_status cut_rows_between(dem_slab *out, const cut_rows *c, dem_index **counts, dem_index begin, dem_index end);

#endif
