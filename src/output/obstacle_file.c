/* SPDX-License-Identifier: BSD-3-Clause */
/* Obstacles in files, twice: as they were given, in the group /obstacles of a trajectory, from which they can be read
 * back; and as a VTKHDF grid of lines of its own, NAME.obstacle.vtkhdf, for ParaView (docs/output.md). Obstacles that
 * move are drawn where they are at each frame. Fields of motions go through dem_motion_field_at(), so a new kind of
 * motion needs no change here. The geometry of obstacles is in obstacle/. */
#include "output/obstacle_file.h"

#include "base/grow.h"
#include "base/status.h"
#include "lattice/lattice.h"
#include "output/hdf5_attribute.h"
#include "output/hdf5_untrusted.h"
#include "output/vtk_grid.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Restitution and friction, as attributes of the obstacle's group. */
static dem_status write_law(const hdf5_file *file, const char *group, const dem_obstacle *o)
{
    const char *law = o->friction_law == DEM_FRICTION_PAPER ? "paper" : "coulomb";
    TRY(hdf5_write_attribute(file, group, "restitution", HDF5_F64, 1, &o->restitution));
    TRY(hdf5_write_attribute(file, group, "friction", HDF5_F64, 1, &o->friction));
    return hdf5_write_attribute_text(file, group, "friction_law", law);
}

enum { NAME = 80 }; /* of a dataset */

/* The dataset of a field of a motion. */
static void name_field(char name[NAME], const char *group, const dem_motion_field *field)
{
    (void)snprintf(name, NAME, "%s/%s", group, field->name);
}

/* What is known of a motion by a function: its bounds. Their presence is its mark. */
static dem_status write_bounds(const hdf5_file *file, const char *group, const dem_obstacle *o)
{
    char name[NAME];
    const double bounds[3] = {o->most_speed, o->most_acceleration, o->longest_step};
    (void)snprintf(name, NAME, "%s/bounds", group);
    if (o->motion == NULL) return DEM_OK;
    return hdf5_write(file, (hdf5_rows){name, HDF5_F64, 1, {0}, 0, 0}, 3, bounds);
}

/* The fields of the motions that the obstacle has; one at rest has none of these datasets. */
static dem_status write_motion(const hdf5_file *file, const char *group, const dem_obstacle *o)
{
    const dem_motion_field *field;
    TRY(write_bounds(file, group, o));
    for (dem_index k = 0; (field = dem_motion_field_at(k)) != NULL; k++) {
        char name[NAME];
        name_field(name, group, field);
        const hdf5_rows rows = {name, HDF5_F64, 1, {0}, 0, 0};
        if (!dem_obstacle_moves(o, field)) continue;
        TRY(hdf5_write(file, rows, (hsize_t)field->n, (const char *)o + field->offset));
    }
    return DEM_OK;
}

static dem_index count(const dem_model *model)
{
    dem_model_size size = {.struct_size = sizeof size};
    (void)dem_model_sizes(model, &size);
    return size.n_obstacles;
}

/* The points at t = 0, with law and motion: from these obstacle_file_read() makes the same obstacle. */
dem_status obstacle_file_write(const hdf5_file *file, const dem_model *model)
{
    const dem_index n_obstacles = count(model);
    for (dem_index o = 0; o < n_obstacles; o++) {
        const dem_obstacle *obstacle = dem_model_obstacle(model, o);
        char group[48], points[64];
        (void)snprintf(group, sizeof group, "/obstacles/%lld", (long long)o);
        (void)snprintf(points, sizeof points, "%s/points", group);
        const hdf5_rows rows = {points, HDF5_F64, 2, {2}, 0, 0};
        TRY(hdf5_write(file, rows, (hsize_t)obstacle->n_points, obstacle->points));
        TRY(write_law(file, group, obstacle));
        TRY(write_motion(file, group, obstacle));
    }
    return DEM_OK;
}

/* ---- reading ---- */

/* Only the two names of laws are accepted. What the numbers must be is checked by check(). */
static dem_status read_law(const hdf5_file *file, const char *group, dem_obstacle *o)
{
    char law[16];
    TRY(hdf5_untrusted_read_attribute(file, group, "restitution", HDF5_F64, &o->restitution));
    TRY(hdf5_untrusted_read_attribute(file, group, "friction", HDF5_F64, &o->friction));
    TRY(hdf5_untrusted_read_attribute_text(file, group, "friction_law", law, sizeof law));
    if (strcmp(law, "paper") == 0)
        o->friction_law = DEM_FRICTION_PAPER;
    else if (strcmp(law, "coulomb") != 0)
        return hdf5_untrusted_refuse(file, group, "friction_law is neither coulomb nor paper");
    return DEM_OK;
}

/* The points belong to the obstacle as soon as they are allocated, so that a later failure frees them. */
static dem_status read_points(const hdf5_file *file, const char *name, dem_obstacle *o)
{
    hdf5_untrusted_shape shape;
    TRY(hdf5_untrusted_measure(file, name, HDF5_F64, &shape));
    if (shape.rank != 2 || shape.extent[1] != 2) return hdf5_untrusted_refuse(file, name, "is not of shape [n][2]");
    double *points = lattice_zeros((dem_index)shape.extent[0], 2 * sizeof *points);
    CHECK_MEMORY(points);
    o->n_points = (dem_index)shape.extent[0];
    o->points = points;
    return hdf5_untrusted_read(file, name, HDF5_F64, (hdf5_untrusted_rows){0, shape.extent[0], 0}, points);
}

/* A field that is missing keeps its 0: no such motion. */
static dem_status read_field(const hdf5_file *file, const char *group, const dem_motion_field *field, dem_obstacle *o)
{
    char name[NAME];
    bool present = false;
    hdf5_untrusted_shape shape;
    const hsize_t n = (hsize_t)field->n;
    name_field(name, group, field);
    TRY(hdf5_untrusted_find(file, name, &present));
    if (!present) return DEM_OK;
    TRY(hdf5_untrusted_measure(file, name, HDF5_F64, &shape));
    if (shape.rank != 1 || shape.extent[0] != n)
        return hdf5_untrusted_refuse(file, name, n == 1 ? "is not of shape [1]" : "is not of shape [2]");
    return hdf5_untrusted_read(file, name, HDF5_F64, (hdf5_untrusted_rows){0, n, 0}, (char *)o + field->offset);
}

/* A motion by a function comes back with its bounds alone. */
static dem_status read_bounds(const hdf5_file *file, const char *group, dem_obstacle *o)
{
    char name[NAME];
    bool present = false;
    double bounds[3] = {0.0, 0.0, 0.0};
    hdf5_untrusted_shape shape;
    (void)snprintf(name, NAME, "%s/bounds", group);
    TRY(hdf5_untrusted_find(file, name, &present));
    if (!present) return DEM_OK;
    TRY(hdf5_untrusted_measure(file, name, HDF5_F64, &shape));
    if (shape.rank != 1 || shape.extent[0] != 3) return hdf5_untrusted_refuse(file, name, "is not of shape [3]");
    TRY(hdf5_untrusted_read(file, name, HDF5_F64, (hdf5_untrusted_rows){0, 3, 0}, bounds));
    if (!(bounds[0] > 0.0 && isfinite(bounds[0]) && bounds[1] >= 0.0 && isfinite(bounds[1])))
        return hdf5_untrusted_refuse(file, name, "has a bound that is no speed or acceleration");
    if (!(bounds[2] >= 0.0 && isfinite(bounds[2])))
        return hdf5_untrusted_refuse(file, name, "has a longest step that is no time");
    o->most_speed = bounds[0];
    o->most_acceleration = bounds[1];
    o->longest_step = bounds[2];
    return DEM_OK;
}

static dem_status read_motion(const hdf5_file *file, const char *group, dem_obstacle *o)
{
    const dem_motion_field *field;
    TRY(read_bounds(file, group, o));
    for (dem_index k = 0; (field = dem_motion_field_at(k)) != NULL; k++) TRY(read_field(file, group, field, o));
    return DEM_OK;
}

/* The obstacle must be one that a model would take; its message gets file and group in front. */
static dem_status check(const hdf5_file *file, const char *group, const dem_obstacle *o)
{
    char reason[256];
    dem_index segments[2];
    /* Which segments meet is in the message already. */
    const dem_status status = dem_obstacle_check(o, segments);
    if (status == DEM_OK || status == DEM_ERROR_MEMORY) return status;
    (void)snprintf(reason, sizeof reason, "%s", dem_status_message());
    return hdf5_untrusted_refuse(file, group, reason);
}

/* Everything is read before the obstacle is checked as a whole. */
static dem_status read_obstacle(const hdf5_file *file, const char *group, dem_obstacle *out)
{
    char points[64];
    bool present = false;
    (void)snprintf(points, sizeof points, "%s/points", group);
    TRY(hdf5_untrusted_find(file, points, &present));
    if (!present) return hdf5_untrusted_refuse(file, points, "is missing");
    TRY(read_points(file, points, out));
    TRY(read_law(file, group, out));
    TRY(read_motion(file, group, out));
    return check(file, group, out);
}

/* Groups are numbered from 0 without holes, and the first missing one ends the list. After a failure, too, what there
 * is is [*n]. */
static dem_status read_all(const hdf5_file *file, dem_obstacle **out, dem_index *n)
{
    dem_index capacity = 0;
    for (bool present = true; present;) {
        char group[48];
        (void)snprintf(group, sizeof group, "/obstacles/%lld", (long long)*n);
        TRY(hdf5_untrusted_find(file, group, &present));
        if (!present) break;
        CHECK(grow_array((void **)out, &capacity, *n + 1, sizeof **out), DEM_ERROR_MEMORY, "out of memory");
        (*out)[*n] = (dem_obstacle){.struct_size = sizeof(dem_obstacle)};
        TRY(read_obstacle(file, group, &(*out)[(*n)++]));
    }
    return DEM_OK;
}

/* *out and *n are set only if all obstacles are in order. */
dem_status obstacle_file_read(const hdf5_file *file, dem_obstacle **out, dem_index *n)
{
    dem_obstacle *all = NULL;
    dem_index n_all = 0;
    const dem_status status = read_all(file, &all, &n_all);
    if (status == DEM_OK) {
        *out = all;
        *n = n_all;
    } else {
        obstacle_file_free(all, n_all);
    }
    return status;
}

/* The points are const for users of an obstacle, and were allocated by read_points(). */
void obstacle_file_free(dem_obstacle *obstacles, dem_index n)
{
    for (dem_index o = 0; o < n; o++) free((void *)(uintptr_t)obstacles[o].points);
    free(obstacles);
}

/* ---- writing for ParaView ---- */

bool obstacle_file_moves(const dem_model *model)
{
    bool any = false;
    for (dem_index o = count(model) - 1; o >= 0; o--)
        any = any || dem_obstacle_moves(dem_model_obstacle(model, o), NULL);
    return any;
}

/* All polylines as one grid of lines, in which no point belongs to two obstacles. */
typedef struct outline {
    const dem_model *model;
    grid grid;
    double *flat;   /* [n_points][2] */
    double *points; /* [n_points][3] */
    dem_index *ends;
    int32_t *owner; /* [n_cells] the obstacle of each segment */
} outline;

static void free_outline(outline *o)
{
    free(o->flat);
    free(o->points);
    free(o->ends);
    free(o->owner);
}

/* After a failure *out must not be used. */
static dem_status allocate_outline(outline *out, const dem_model *model, dem_index n_points, dem_index n_segments)
{
    outline o = {.model = model, .grid = {"/VTKHDF", n_points, n_segments, 2}};
    o.flat = calloc((size_t)n_points, 2 * sizeof *o.flat);
    o.points = calloc((size_t)n_points, 3 * sizeof *o.points);
    o.ends = calloc((size_t)n_segments, 2 * sizeof *o.ends);
    o.owner = calloc((size_t)n_segments, sizeof *o.owner);
    *out = o;
    if (o.flat != NULL && o.points != NULL && o.ends != NULL && o.owner != NULL) return DEM_OK;
    free_outline(&o);
    return status_fail(DEM_ERROR_MEMORY, "out of memory");
}

/* Each segment is a cell from a point to the next one; the last point of an obstacle has no segment to the next
 * obstacle. */
static dem_status make_outline(outline *out, const dem_model *model)
{
    const dem_index n_obstacles = count(model);
    dem_index n_points = 0, point = 0, segment = 0;
    for (dem_index o = 0; o < n_obstacles; o++) n_points += dem_model_obstacle(model, o)->n_points;
    TRY(allocate_outline(out, model, n_points, n_points - n_obstacles));
    for (dem_index o = 0; o < n_obstacles; o++)
        for (dem_index p = 0; p < dem_model_obstacle(model, o)->n_points; p++, point++) {
            /* The first point of an obstacle ends no segment. */
            if (p == 0) continue;
            out->ends[2 * segment] = point - 1;
            out->ends[2 * segment + 1] = point;
            out->owner[segment++] = (int32_t)o;
        }
    return DEM_OK;
}

/* Points of all obstacles at time t, with z = 0. */
static dem_status place_points(const outline *o, double t)
{
    const dem_index n = count(o->model);
    dem_index first = 0;
    for (dem_index k = 0; k < n; first += dem_model_obstacle(o->model, k++)->n_points)
        TRY(dem_obstacle_points(dem_model_obstacle(o->model, k), t, o->flat + 2 * first));
    for (dem_index i = 0; i < o->grid.n_points; i++) memcpy(o->points + 3 * i, o->flat + 2 * i, 2 * sizeof *o->flat);
    return DEM_OK;
}

/* With times, the points of all steps stand one behind the other, a step in each chunk. Without, there is one set. */
static dem_status write_points(const hdf5_file *file, const outline *o, obstacle_file_times at, int deflate)
{
    const hsize_t n = (hsize_t)o->grid.n_points;
    const hdf5_rows rows = {GRID "Points", HDF5_F64, 2, {3}, n, deflate};
    /* A dataset that grows by a step at a time. */
    if (at.n > 0) TRY(hdf5_create(file, &rows));
    for (dem_index k = 0; k < at.n; k++) {
        TRY(place_points(o, at.t[k]));
        TRY(hdf5_append(file, &rows, (hsize_t)k * n, n, o->points));
    }
    if (at.n > 0) return DEM_OK;
    TRY(place_points(o, 0.0));
    return hdf5_write(file, (hdf5_rows){GRID "Points", HDF5_F64, 2, {3}, 0, deflate}, n, o->points);
}

/* n numbers, `first` and so on by `increment`. */
static dem_status write_row(const hdf5_file *file, hdf5_rows rows, dem_index n, dem_index first, dem_index increment)
{
    dem_index *numbers = malloc((size_t)n * sizeof *numbers);
    CHECK_MEMORY(numbers);
    for (dem_index k = 0; k < n; k++) numbers[k] = first + k * increment;
    const dem_status status = hdf5_write(file, rows, (hsize_t)n, numbers);
    free(numbers);
    return status;
}

/* The steps of the grid: each has points of its own, and the cells of all. Datasets of equal content are links. */
static dem_status write_steps(const hdf5_file *file, const outline *o, obstacle_file_times at)
{
    TRY(hdf5_write_attribute(file, STEPS, "NSteps", HDF5_I64, 1, &at.n));
    TRY(hdf5_write(file, (hdf5_rows){STEPS "/Values", HDF5_F64, 1, {0}, 0, 0}, (hsize_t)at.n, at.t));
    TRY(write_row(file, (hdf5_rows){STEPS "/NumberOfParts", HDF5_I64, 1, {0}, 0, 0}, at.n, 1, 0));
    TRY(write_row(file, (hdf5_rows){STEPS "/PartOffsets", HDF5_I64, 1, {0}, 0, 0}, at.n, 0, 0));
    TRY(write_row(file, (hdf5_rows){STEPS "/PointOffsets", HDF5_I64, 1, {0}, 0, 0}, at.n, 0, o->grid.n_points));
    TRY(write_row(file, (hdf5_rows){STEPS "/CellOffsets", HDF5_I64, 2, {1}, 0, 0}, at.n, 0, 0));
    TRY(hdf5_link(file, STEPS "/ConnectivityIdOffsets", STEPS "/CellOffsets"));
    return hdf5_link(file, STEPS "/CellDataOffsets/obstacle", STEPS "/PartOffsets");
}

static dem_status write_outline(const hdf5_file *file, const outline *o, obstacle_file_times at, int deflate)
{
    const hdf5_rows owner = {GRID "CellData/obstacle", HDF5_I32, 1, {0}, 0, deflate};
    TRY(vtk_grid_write_here(file, &o->grid, o->ends, deflate));
    TRY(write_points(file, o, at, deflate));
    TRY(hdf5_write(file, owner, (hsize_t)o->grid.n_cells, o->owner));
    return at.n > 0 ? write_steps(file, o, at) : DEM_OK;
}

/* Room is reserved for points, cells, and what each step adds. A part that is not whole is removed. */
dem_status obstacle_file_publish(const char *part, const char *path, const dem_model *model, obstacle_file_times at,
                                 int deflate)
{
    outline o;
    hdf5_file file;
    TRY(make_outline(&o, model));
    const hsize_t n = (hsize_t)o.grid.n_points;
    dem_status status = hdf5_open_new(&file, part, 64 * n + (hsize_t)at.n * (24 * n + 64));
    if (status == DEM_OK) status = hdf5_close(&file, write_outline(&file, &o, at, deflate));
    if (status == DEM_OK) status = hdf5_publish(part, path);
    if (status != DEM_OK) (void)unlink(part);
    free_outline(&o);
    return status;
}
