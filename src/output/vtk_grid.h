/* SPDX-License-Identifier: BSD-3-Clause */
/* A VTKHDF UnstructuredGrid of lines or triangles, without its points. */
#ifndef DEM_OUTPUT_VTK_GRID_H
#define DEM_OUTPUT_VTK_GRID_H

#include "lattice/lattice_source.h"
#include "output/hdf5_file.h"

#define GRID  "/VTKHDF/"   /* the group that VTK reads; names within it follow */
#define STEPS GRID "Steps" /* the group of times, and of where the data of each begin */

typedef struct grid {
    const char *group; /**< "/VTKHDF", or another that a file leads to under this name */
    dem_index n_points, n_cells;
    int n_corners; /**< of a cell; 2: lines, 3: triangles */
} grid;

/** The corners of a lattice as cells. */
typedef struct grid_corners {
    const lattice_source *lattice;
    size_t member; /**< offset of ends or triangles in a dem_lattice */
} grid_corners;

/** Writes version and type of the grid, counts, connectivity and types of the cells. Points are the caller's. */
dem_status vtk_grid_write(const hdf5_file *file, const grid *g, grid_corners corners, int deflate);

/** The same with corners [n_cells][n_corners] that are all here. */
dem_status vtk_grid_write_here(const hdf5_file *file, const grid *g, const dem_index *corners, int deflate);

#endif
