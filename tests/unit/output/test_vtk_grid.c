/* SPDX-License-Identifier: BSD-3-Clause */
/* vtk_grid.c: two lines over three points, looked at through HDF5 itself. */
#include "verification/support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <unistd.h>

#include "output/vtk_grid.h"
#include "unit/output/found.h"
#include "unit/scratch.h"

static const char *path;

static hdf5_file write_one(const grid *g, const dem_index *corners, int deflate)
{
    hdf5_file file;
    assert_ok(hdf5_open_new(&file, path, 4096));
    assert_ok(vtk_grid_write_here(&file, g, corners, deflate));
    return file;
}

TEST(cells_are_lines_between_points)
{
    const dem_index ends[4] = {0, 1, 2, 1};
    const grid g = {"/VTKHDF", 3, 2, 2};
    hdf5_file file = write_one(&g, ends, 1);
    found_reals(&file, GRID "NumberOfPoints", (const double[]){3}, 1);
    found_reals(&file, GRID "NumberOfCells", (const double[]){2}, 1);
    found_reals(&file, GRID "NumberOfConnectivityIds", (const double[]){4}, 1);
    found_reals(&file, GRID "Connectivity", (const double[]){0, 1, 2, 1}, 4);
    found_reals(&file, GRID "Offsets", (const double[]){0, 2, 4}, 3);
    found_reals(&file, GRID "Types", (const double[]){3, 3}, 2); /* VTK's number of a line */
    assert_ok(hdf5_close(&file, DEM_OK));
}

TEST(cells_are_triangles_in_any_group)
{
    const dem_index corners[6] = {0, 1, 2, 2, 1, 3};
    const grid g = {"/others", 4, 2, 3};
    hdf5_file file = write_one(&g, corners, 1);
    found_reals(&file, "/others/NumberOfPoints", (const double[]){4}, 1);
    found_reals(&file, "/others/NumberOfCells", (const double[]){2}, 1);
    found_reals(&file, "/others/NumberOfConnectivityIds", (const double[]){6}, 1);
    found_reals(&file, "/others/Connectivity", (const double[]){0, 1, 2, 2, 1, 3}, 6);
    found_reals(&file, "/others/Offsets", (const double[]){0, 3, 6}, 3);
    found_reals(&file, "/others/Types", (const double[]){5, 5}, 2); /* VTK's number of a triangle */
    assert_ok(hdf5_close(&file, DEM_OK));
}

TEST(a_grid_may_have_no_cells)
{
    const grid g = {"/VTKHDF", 1, 0, 2};
    hdf5_file file = write_one(&g, NULL, 0);
    found_reals(&file, GRID "Connectivity", NULL, 0);
    found_reals(&file, GRID "Offsets", (const double[]){0}, 1);
    found_reals(&file, GRID "Types", NULL, 0);
    assert_ok(hdf5_close(&file, DEM_OK));
}

SCRATCH_GROUP({&path, "a.h5"});
