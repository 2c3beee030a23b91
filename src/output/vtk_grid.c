/* SPDX-License-Identifier: BSD-3-Clause */
/* A VTKHDF UnstructuredGrid of lines: version, type, counts, and the cells by their connectivity. Frames (frames.c) and
 * obstacles (obstacle_file.c) add points and data of their own. Names and codes are those of VTK's file format. */
#include "output/vtk_grid.h"

#include "base/status.h"
#include "output/hdf5_attribute.h"

#include <stdlib.h>
#include <string.h>

/* VTK's code for a cell that is a line between two points. */
enum { VTK_LINE = 3 };

static dem_status write_numbers(const hdf5_file *file, const char *name, int deflate, dem_index count,
                                const dem_index *data)
{
    return hdf5_write(file, (hdf5_rows){name, HDF5_I64, 1, {0}, 0, deflate}, (hsize_t)count, data);
}

/* Cell k has the entries offsets[k] to offsets[k + 1] - 1 of the connectivity: two each. */
static dem_status write_offsets(const hdf5_file *file, const grid *g, int deflate)
{
    dem_index *offsets = malloc((size_t)(g->n_cells + 1) * sizeof *offsets);
    CHECK_MEMORY(offsets);
    for (dem_index k = 0; k <= g->n_cells; k++) offsets[k] = 2 * k;
    const dem_status status = write_numbers(file, GRID "Offsets", deflate, g->n_cells + 1, offsets);
    free(offsets);
    return status;
}

/* One code for each cell. */
static dem_status write_types(const hdf5_file *file, const grid *g, int deflate)
{
    unsigned char *types = malloc((size_t)g->n_cells + 1);
    CHECK_MEMORY(types);
    memset(types, VTK_LINE, (size_t)g->n_cells);
    const hdf5_rows rows = {GRID "Types", HDF5_U8, 1, {0}, 0, deflate};
    const dem_status status = hdf5_write(file, rows, (hsize_t)g->n_cells, types);
    free(types);
    return status;
}

/* The grid is one part, so each of the three counts is an array of one number. */
dem_status vtk_grid_write(const hdf5_file *file, const grid *g, int deflate)
{
    static const dem_index version[2] = {2, 0};
    const dem_index n_ends = 2 * g->n_cells;
    TRY(hdf5_write_attribute(file, "/VTKHDF", "Version", HDF5_I64, 2, version));
    TRY(hdf5_write_attribute_text(file, "/VTKHDF", "Type", "UnstructuredGrid"));
    TRY(write_numbers(file, GRID "NumberOfPoints", 0, 1, &g->n_points));
    TRY(write_numbers(file, GRID "NumberOfCells", 0, 1, &g->n_cells));
    TRY(write_numbers(file, GRID "NumberOfConnectivityIds", 0, 1, &n_ends));
    TRY(write_numbers(file, GRID "Connectivity", deflate, n_ends, g->ends));
    TRY(write_offsets(file, g, deflate));
    return write_types(file, g, deflate);
}
