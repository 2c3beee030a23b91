/* SPDX-License-Identifier: BSD-3-Clause */
/* A VTKHDF UnstructuredGrid of lines or triangles: version, type, counts, and the cells by their connectivity. Frames
 * (frames.c) and obstacles (obstacle_file.c) add points and data of their own. Names and codes are those of VTK's file
 * format. */
#include "output/vtk_grid.h"

#include "base/status.h"
#include "output/hdf5_attribute.h"
#include "output/chunkwise.h"

#include <stdio.h>
#include <string.h>

/* VTK's codes of cells. */
enum { VTK_LINE = 3, VTK_TRIANGLE = 5 };

enum { NAME = 64 };

/* The path of a dataset of the grid, and its rows. */
static hdf5_rows rows_of(char path[NAME], const grid *g, const char *name, hdf5_kind kind, int deflate)
{
    (void)snprintf(path, NAME, "%s/%s", g->group, name);
    return (hdf5_rows){path, kind, 1, {0}, 0, deflate};
}

static dem_status write_count(const hdf5_file *file, const grid *g, const char *name, dem_index count)
{
    char path[NAME];
    return hdf5_write(file, rows_of(path, g, name, HDF5_I64, 0), 1, &count);
}

/* Cell k has the entries offsets[k] to offsets[k + 1] - 1 of the connectivity. */
static void fill_offsets(const void *context, hsize_t first, hsize_t n, void *rows)
{
    const grid *g = context;
    dem_index *offset = rows;
    for (hsize_t k = 0; k < n; k++) offset[k] = g->n_corners * (dem_index)(first + k);
}

/* One code for each cell. */
static void fill_types(const void *context, hsize_t first, hsize_t n, void *rows)
{
    const grid *g = context;
    (void)first;
    memset(rows, g->n_corners == 2 ? VTK_LINE : VTK_TRIANGLE, (size_t)n);
}

/* The grid is one part, so each of the three counts is an array of one number. */
static dem_status write_head(const hdf5_file *file, const grid *g)
{
    static const dem_index version[2] = {2, 0};
    TRY(hdf5_write_attribute(file, g->group, "Version", HDF5_I64, 2, version));
    TRY(hdf5_write_attribute_text(file, g->group, "Type", "UnstructuredGrid"));
    TRY(write_count(file, g, "NumberOfPoints", g->n_points));
    TRY(write_count(file, g, "NumberOfCells", g->n_cells));
    return write_count(file, g, "NumberOfConnectivityIds", g->n_corners * g->n_cells);
}

static dem_status write_cells(const hdf5_file *file, const grid *g, int deflate)
{
    char path[NAME];
    const hsize_t n = (hsize_t)g->n_cells;
    TRY(chunkwise_fill(file, rows_of(path, g, "Offsets", HDF5_I64, deflate), n + 1, fill_offsets, g));
    return chunkwise_fill(file, rows_of(path, g, "Types", HDF5_U8, deflate), n, fill_types, g);
}

dem_status vtk_grid_write(const hdf5_file *file, const grid *g, grid_corners corners, int deflate)
{
    char path[NAME];
    const hdf5_rows rows = rows_of(path, g, "Connectivity", HDF5_I64, deflate);
    TRY(write_head(file, g));
    TRY(chunkwise_copy(file, rows, corners.lattice, corners.member, g->n_cells, g->n_corners));
    return write_cells(file, g, deflate);
}

dem_status vtk_grid_write_here(const hdf5_file *file, const grid *g, const dem_index *corners, int deflate)
{
    char path[NAME];
    const hdf5_rows rows = rows_of(path, g, "Connectivity", HDF5_I64, deflate);
    TRY(write_head(file, g));
    TRY(hdf5_write(file, rows, (hsize_t)(g->n_corners * g->n_cells), corners));
    return write_cells(file, g, deflate);
}
