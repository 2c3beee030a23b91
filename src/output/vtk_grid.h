/* SPDX-License-Identifier: BSD-3-Clause */
/* A VTKHDF UnstructuredGrid of lines, without its points. */
#ifndef DEM_OUTPUT_VTK_GRID_H
#define DEM_OUTPUT_VTK_GRID_H

#include "output/hdf5_file.h"

#define GRID  "/VTKHDF/"   /* the group; names within it follow */
#define STEPS GRID "Steps" /* the group of times, and of where the data of each begin */

typedef struct grid {
    dem_index n_points, n_cells;
    const dem_index *ends; /**< [n_cells][2] */
} grid;

/** Writes version and type of the grid, counts, connectivity and types of the cells. Points are the caller's. */
dem_status vtk_grid_write(const hdf5_file *file, const grid *g, int deflate);

#endif
