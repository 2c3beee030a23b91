/* SPDX-License-Identifier: BSD-3-Clause */
/* A VTKHDF UnstructuredGrid of lines or triangles: version, type, counts, and the cells by their connectivity. Frames
 * (frames.c) and obstacles (obstacle_file.c) add points and data of their own. Names and codes are those of VTK's file
 * format. */
#include "output/vtk_grid.h"

#include "base/status.h"
#include "output/hdf5_attribute.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* VTK's codes of cells. */
enum { VTK_LINE = 3, VTK_TRIANGLE = 5 };

enum { NAME = 64 };

/* A dataset of the grid. */
static dem_status write_data(const hdf5_file *file, const grid *g, const char *name, hdf5_rows rows, dem_index count,
                             const void *data)
{
    char path[NAME];
    (void)snprintf(path, sizeof path, "%s/%s", g->group, name);
    rows.name = path;
    return hdf5_write(file, rows, (hsize_t)count, data);
}

static dem_status write_numbers(const hdf5_file *file, const grid *g, const char *name, int deflate, dem_index count,
                                const dem_index *data)
{
    return write_data(file, g, name, (hdf5_rows){NULL, HDF5_I64, 1, {0}, 0, deflate}, count, data);
}

/* Cell k has the entries offsets[k] to offsets[k + 1] - 1 of the connectivity. */
static dem_status write_offsets(const hdf5_file *file, const grid *g, int deflate)
{
    dem_index *offsets = malloc((size_t)(g->n_cells + 1) * sizeof *offsets);
    CHECK_MEMORY(offsets);
    for (dem_index k = 0; k <= g->n_cells; k++) offsets[k] = g->n_corners * k;
    const dem_status status = write_numbers(file, g, "Offsets", deflate, g->n_cells + 1, offsets);
    free(offsets);
    return status;
}

/* One code for each cell. */
static dem_status write_types(const hdf5_file *file, const grid *g, int deflate)
{
    unsigned char *types = malloc((size_t)g->n_cells + 1);
    CHECK_MEMORY(types);
    memset(types, g->n_corners == 2 ? VTK_LINE : VTK_TRIANGLE, (size_t)g->n_cells);
    const dem_status status =
        write_data(file, g, "Types", (hdf5_rows){NULL, HDF5_U8, 1, {0}, 0, deflate}, g->n_cells, types);
    free(types);
    return status;
}

/* The grid is one part, so each of the three counts is an array of one number. */
dem_status vtk_grid_write(const hdf5_file *file, const grid *g, int deflate)
{
    static const dem_index version[2] = {2, 0};
    const dem_index n_corners = g->n_corners * g->n_cells;
    TRY(hdf5_write_attribute(file, g->group, "Version", HDF5_I64, 2, version));
    TRY(hdf5_write_attribute_text(file, g->group, "Type", "UnstructuredGrid"));
    TRY(write_numbers(file, g, "NumberOfPoints", 0, 1, &g->n_points));
    TRY(write_numbers(file, g, "NumberOfCells", 0, 1, &g->n_cells));
    TRY(write_numbers(file, g, "NumberOfConnectivityIds", 0, 1, &n_corners));
    TRY(write_numbers(file, g, "Connectivity", deflate, n_corners, g->corners));
    TRY(write_offsets(file, g, deflate));
    return write_types(file, g, deflate);
}
