/* SPDX-License-Identifier: BSD-3-Clause */
/* The polylines twice: as the model has them, and as one grid. */
#include "obstacle_file.h"

#include "grid.h"
#include "status.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static dem_status write_law(const hdf5_file *file, const char *group, const dem_obstacle *o)
{
    const char *law = o->friction_law == DEM_FRICTION_PAPER ? "paper" : "coulomb";
    TRY(hdf5_write_attribute(file, group, "restitution", HDF5_F64, 1, &o->restitution));
    TRY(hdf5_write_attribute(file, group, "friction", HDF5_F64, 1, &o->friction));
    return hdf5_write_attribute_text(file, group, "friction_law", law);
}

dem_status obstacle_file_write(const hdf5_file *file, const dem_model *model)
{
    dem_index n_obstacles = 0;
    const dem_obstacle *obstacles = dem_model_obstacles(model, &n_obstacles);
    for (dem_index o = 0; o < n_obstacles; o++) {
        char group[48], points[64];
        (void)snprintf(group, sizeof group, "/obstacles/%lld", (long long)o);
        (void)snprintf(points, sizeof points, "%s/points", group);
        const hdf5_rows rows = {points, HDF5_F64, 2, {2}, 0, 0};
        TRY(hdf5_write(file, rows, (hsize_t)obstacles[o].n_points, obstacles[o].points));
        TRY(write_law(file, group, &obstacles[o]));
    }
    return DEM_OK;
}

/* The polylines as one grid. */
typedef struct outline {
    grid grid;
    double *points; /* [n_points][3] */
    dem_index *ends;
    int32_t *owner; /* [n_cells] the obstacle of each segment */
} outline;

static void free_outline(outline *o)
{
    free(o->points);
    free(o->ends);
    free(o->owner);
}

static dem_status allocate_outline(outline *out, dem_index n_points, dem_index n_segments)
{
    outline o = {.grid = {n_points, n_segments, NULL}};
    o.points = calloc((size_t)n_points, 3 * sizeof *o.points);
    o.ends = calloc((size_t)n_segments, 2 * sizeof *o.ends);
    o.owner = calloc((size_t)n_segments, sizeof *o.owner);
    o.grid.ends = o.ends;
    *out = o;
    if (o.points != NULL && o.ends != NULL && o.owner != NULL) return DEM_OK;
    free_outline(&o);
    return status_fail(DEM_ERROR_MEMORY, "out of memory");
}

static dem_status make_outline(outline *out, const dem_model *model)
{
    dem_index n_obstacles = 0, n_points = 0, point = 0, segment = 0;
    const dem_obstacle *obstacles = dem_model_obstacles(model, &n_obstacles);
    for (dem_index o = 0; o < n_obstacles; o++) n_points += obstacles[o].n_points;
    TRY(allocate_outline(out, n_points, n_points - n_obstacles));
    for (dem_index o = 0; o < n_obstacles; o++)
        for (dem_index p = 0; p < obstacles[o].n_points; p++, point++) {
            memcpy(out->points + 3 * point, obstacles[o].points + 2 * p, 2 * sizeof *out->points);
            if (p == 0) continue;
            out->ends[2 * segment] = point - 1;
            out->ends[2 * segment + 1] = point;
            out->owner[segment++] = (int32_t)o;
        }
    return DEM_OK;
}

static dem_status write_outline(const hdf5_file *file, const outline *o, int deflate)
{
    const hdf5_rows points = {GRID "Points", HDF5_F64, 2, {3}, 0, deflate};
    const hdf5_rows owner = {GRID "CellData/obstacle", HDF5_I32, 1, {0}, 0, deflate};
    TRY(grid_write(file, &o->grid, deflate));
    TRY(hdf5_write(file, points, (hsize_t)o->grid.n_points, o->points));
    return hdf5_write(file, owner, (hsize_t)o->grid.n_cells, o->owner);
}

dem_status obstacle_file_publish(const char *part, const char *path, const dem_model *model, int deflate)
{
    outline o;
    hdf5_file file;
    TRY(make_outline(&o, model));
    dem_status status = hdf5_open_new(&file, part, 64 * (hsize_t)o.grid.n_points);
    if (status == DEM_OK) status = hdf5_close(&file, write_outline(&file, &o, deflate));
    if (status == DEM_OK) status = hdf5_publish(part, path);
    if (status != DEM_OK) (void)unlink(part);
    free_outline(&o);
    return status;
}
