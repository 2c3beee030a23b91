/* SPDX-License-Identifier: BSD-3-Clause */
/* Reads a trajectory back (dem/reader.h): lists frames, arrays and tables when it is opened, and reads them on demand.
 *   /VTKHDF/Steps/Values              the times of the frames
 *   /VTKHDF/PointData, CellData       arrays of nodes, of springs
 *   /VTKHDF/FieldData                 the table "frames", a row for each frame
 *   /fracture/triangles               which triangles are broken in each frame
 *   /history, /events, /breaks        tables of these names
 *   /fragments                        likewise, and which of its rows are of which frame
 *   /probes/NAME, /most_stressed/...  tables "probes/NAME", ...
 *   /lattice, /obstacles              read by lattice_file.c and obstacle_file.c
 * The file may be any: it is checked as in hdf5_untrusted.c, and since it is closed between calls and may have been
 * replaced, each dataset is measured again whenever some of it is read. A run that is going on may be read as well:
 * then the numbers of rows may differ by what is just being written, and the smallest counts. Writing is in
 * trajectory.c. */
#include <dem/reader.h>
#include <dem/trajectory.h>

#include "base/grow.h"
#include "base/status.h"
#include "lattice/lattice.h"
#include "output/frames.h"
#include "output/hdf5_untrusted.h"
#include "output/motion_record.h"
#include "output/obstacle_file.h"
#include "output/units.h"
#include "output/vtk_grid.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NAME = 64, TABLE = sizeof "probes/" + NAME, PATH = TABLE + NAME + 32, MOST_COMPONENTS = 9 };

/* Numbers of a row of a table: no run has more bodies or obstacles. */
static const hsize_t most_width = 1 << 24;

/* The names in a group, collected by take_name(). */
typedef struct names {
    const hdf5_file *file;
    const char *group;
    char (*list)[NAME];
    dem_index n, capacity;
} names;

/* What a reader has listed. Views that are handed out point into it and end with it. */
struct dem_reader {
    char *path;
    dem_lattice lattice;
    dem_obstacle *obstacles;
    dem_index n_obstacles;
    motion_record *records; /* [n_obstacles] of those that a program moved; NULL: none yet */
    double *times;
    dem_index n_frames;
    bool knows_triangles;       /* whether the file tells which are broken */
    dem_index *fragment_offset; /* [n_frames + 1] first row of a frame in the table of fragments; NULL: there is none */
    dem_reader_array *arrays;
    dem_index n_arrays, room_arrays;
    dem_reader_column *columns;
    dem_index n_columns, room_columns;
    char **texts; /* names that arrays and columns point to */
    dem_index n_texts, room_texts;
};

/* Arrays of frames may stand in stripes. */
static dem_status open_run(hdf5_file *out, const dem_reader *reader)
{
    TRY(hdf5_untrusted_open(out, reader->path));
    out->takes_stripes = true;
    return DEM_OK;
}

/* ---- names ---- */

/* Keeps a copy of a text for as long as the reader lives. */
static dem_status keep(dem_reader *reader, const char *text, const char **out)
{
    CHECK(grow_array((void **)&reader->texts, &reader->room_texts, reader->n_texts + 1, sizeof *reader->texts),
          DEM_ERROR_MEMORY, "out of memory");
    char *copy = strdup(text);
    CHECK_MEMORY(copy);
    reader->texts[reader->n_texts++] = copy;
    *out = copy;
    return DEM_OK;
}

/* A name that could break a message, a table or the name of a file in two is refused. */
static dem_status take_name(void *context, const char *name)
{
    names *all = context;
    char printable[HDF5_UNTRUSTED_PRINTABLE];
    hdf5_untrusted_print(printable, name);
    bool fits = *name != '\0' && strlen(name) < NAME;
    for (const char *c = name; fits && *c != '\0'; c++) fits = *c > ' ' && *c <= '~' && strchr("\"',\\", *c) == NULL;
    CHECK(fits, DEM_ERROR_IO, "%s: %s: %s is no name of 1 to %d letters, digits and signs", all->file->path, all->group,
          printable, NAME - 1);
    CHECK(grow_array((void **)&all->list, &all->capacity, all->n + 1, NAME), DEM_ERROR_MEMORY, "out of memory");
    (void)snprintf(all->list[all->n++], NAME, "%s", name);
    return DEM_OK;
}

/* Alphabetical, but for time, which comes first in every table. */
static int compare_names(const void *a, const void *b)
{
    const char *one = a, *other = b;
    /* Negative if `one` is the time. */
    const int first = (strcmp(other, "t") == 0) - (strcmp(one, "t") == 0);
    return first != 0 ? first : strcmp(one, other);
}

/* The names in a group, sorted; none if it is not there. The list must be freed, after a failure too. */
static dem_status list_names(names *out, const hdf5_file *file, const char *group)
{
    bool present = false;
    *out = (names){.file = file, .group = group};
    TRY(hdf5_untrusted_find(file, group, &present));
    if (present) TRY(hdf5_untrusted_list(file, group, take_name, out));
    if (out->n > 0) qsort(out->list, (size_t)out->n, sizeof *out->list, compare_names);
    return DEM_OK;
}

/* The type of the numbers in the file, in the terms of the public interface. */
static dem_reader_type type_of(hdf5_kind kind)
{
    static const dem_reader_type types[] = {
        [HDF5_F64] = DEM_READER_F64, [HDF5_F32] = DEM_READER_F32, [HDF5_I64] = DEM_READER_I64,
        [HDF5_I32] = DEM_READER_I32, [HDF5_I8] = DEM_READER_I8,   [HDF5_U8] = DEM_READER_U8};
    return types[kind];
}

/* ---- frames ---- */

/* Numbers of an array in one frame, by component. */
static dem_index count_of(const dem_reader *reader, int of_springs)
{
    return of_springs ? reader->lattice.n_springs : reader->lattice.n_nodes;
}

/* Whether so many rows are those of all frames at least: one frame more may be in the making. */
static bool holds_frames(const dem_reader *reader, hsize_t rows, dem_index in_frame)
{
    return in_frame == 0 || rows / (hsize_t)in_frame >= (hsize_t)reader->n_frames;
}

/* NSteps says how many frames are whole; the dataset may have more rows. Times must be finite and ascending, as the
 * public interface promises. */
static dem_status read_times(dem_reader *reader, const hdf5_file *file)
{
    static const char name[] = STEPS "/Values";
    hdf5_untrusted_shape shape;
    dem_index n = 0;
    TRY(hdf5_untrusted_read_attribute(file, STEPS, "NSteps", HDF5_I64, &n));
    TRY(hdf5_untrusted_measure(file, name, HDF5_F64, &shape));
    CHECK(shape.rank == 1 && n >= 0 && (hsize_t)n <= shape.extent[0], DEM_ERROR_IO,
          "%s: %s: is not of shape [%lld], as NSteps says", file->path, name, (long long)n);
    reader->times = lattice_zeros(n, sizeof *reader->times);
    CHECK_MEMORY(reader->times);
    TRY(hdf5_untrusted_read(file, name, HDF5_F64, (hdf5_untrusted_rows){0, (hsize_t)n, 0}, reader->times));
    for (dem_index k = 0; k < n; k++)
        if (!isfinite(reader->times[k]) || (k > 0 && reader->times[k] <= reader->times[k - 1]))
            return hdf5_untrusted_refuse(file, name, "is not finite and ascending");
    reader->n_frames = n;
    return DEM_OK;
}

/* Points are the only array that every file with frames must have. */
static dem_status check_positions(const dem_reader *reader, const hdf5_file *file)
{
    hdf5_untrusted_shape shape;
    TRY(hdf5_untrusted_measure(file, GRID "Points", HDF5_F64, &shape));
    CHECK(shape.rank == 2 && shape.extent[1] == 3 && holds_frames(reader, shape.extent[0], reader->lattice.n_nodes),
          DEM_ERROR_IO, "%s: " GRID "Points: is not of shape [%lld frames of %lld][3]", file->path,
          (long long)reader->n_frames, (long long)reader->lattice.n_nodes);
    return DEM_OK;
}

/* Whether an array is the same in all frames: by its number of rows, or, since a single frame cannot tell, by its
 * name. */
static bool is_constant(const dem_reader *reader, const char *name, hsize_t rows, dem_index in_frame)
{
    static const char peak[] = "peak_";
    return strcmp(name, "id") == 0 || strcmp(name, "body") == 0 || strncmp(name, peak, sizeof peak - 1) == 0 ||
           (reader->n_frames > 1 && in_frame > 0 && rows == (hsize_t)in_frame);
}

/* VTK's names: points are nodes, cells are springs. */
static const char *set_of(int of_springs)
{
    return of_springs ? "CellData" : "PointData";
}

/* Adds an array to the list if its shape is that of one value, or up to MOST_COMPONENTS, for each node or spring. */
static dem_status add_array(dem_reader *reader, const hdf5_file *file, int of_springs, const char *name)
{
    char path[PATH];
    hdf5_untrusted_shape shape;
    const dem_index in_frame = count_of(reader, of_springs);
    (void)snprintf(path, sizeof path, GRID "%s/%s", set_of(of_springs), name);
    TRY(hdf5_untrusted_measure(file, path, HDF5_F64, &shape));
    const hsize_t rows = shape.extent[0];
    dem_reader_array a = {.unit = units_of(NULL, name),
                          .type = type_of(shape.stored),
                          .of_springs = of_springs,
                          .components = (int)shape.extent[1],
                          .constant = is_constant(reader, name, rows, in_frame)};
    CHECK(shape.rank >= 1 && shape.rank <= 2 && shape.extent[1] >= 1 && shape.extent[1] <= MOST_COMPONENTS &&
              (a.constant ? rows == (hsize_t)in_frame : holds_frames(reader, rows, in_frame)),
          DEM_ERROR_IO, "%s: %s: is not of shape [%lld times %lld] or [..][1 to %d]", file->path, path,
          a.constant ? 1LL : (long long)reader->n_frames, (long long)in_frame, MOST_COMPONENTS);
    /* The list of names is freed by the caller. */
    TRY(keep(reader, name, &a.name));
    CHECK(grow_array((void **)&reader->arrays, &reader->room_arrays, reader->n_arrays + 1, sizeof a), DEM_ERROR_MEMORY,
          "out of memory");
    reader->arrays[reader->n_arrays++] = a;
    return DEM_OK;
}

/* All arrays of nodes, or of springs, but for what only tells VTK which of these are broken. */
static dem_status add_arrays(dem_reader *reader, const hdf5_file *file, int of_springs)
{
    char group[PATH];
    names all;
    (void)snprintf(group, sizeof group, GRID "%s", set_of(of_springs));
    dem_status status = list_names(&all, file, group);
    for (dem_index k = 0; k < all.n && status == DEM_OK; k++)
        if (strcmp(all.list[k], FRAMES_HIDDEN) != 0) status = add_array(reader, file, of_springs, all.list[k]);
    free(all.list);
    return status;
}

/* In a file of an older version no triangle is known to be broken. */
static dem_status find_broken_triangles(dem_reader *reader, const hdf5_file *file)
{
    static const char name[] = FRAMES_BROKEN_TRIANGLES;
    const dem_index in_frame = reader->lattice.n_triangles;
    hdf5_untrusted_shape shape;
    TRY(hdf5_untrusted_find(file, name, &reader->knows_triangles));
    if (!reader->knows_triangles) return DEM_OK;
    TRY(hdf5_untrusted_measure(file, name, HDF5_U8, &shape));
    CHECK(shape.rank == 1 && holds_frames(reader, shape.extent[0], in_frame), DEM_ERROR_IO,
          "%s: %s: is not of shape [%lld times %lld]", file->path, name, (long long)reader->n_frames,
          (long long)in_frame);
    return DEM_OK;
}

/* ---- tables ---- */

static const char frames_table[] = "frames", history_table[] = "history", fragments_table[] = "fragments";

/* The table of frames is VTK's field data; the others are groups of their names. */
static void name_table(char path[PATH], const char *table)
{
    if (strcmp(table, frames_table) == 0)
        (void)snprintf(path, PATH, GRID "FieldData");
    else
        (void)snprintf(path, PATH, "/%s", table);
}

/* The path of a column's dataset. */
static void name_column(char path[PATH], const dem_reader_column *column)
{
    name_table(path, column->table);
    const size_t n = strlen(path);
    (void)snprintf(path + n, PATH - n, "/%s", column->name);
}

/* The second dimension of a dataset of rank 2 is items in the history (bodies, obstacles) and components elsewhere. */
static dem_status add_column(dem_reader *reader, const hdf5_file *file, const char *table, const char *name)
{
    char path[PATH];
    hdf5_untrusted_shape shape;
    dem_reader_column c = {.table = table, .unit = units_of(table, name)};
    TRY(keep(reader, name, &c.name));
    name_column(path, &c);
    TRY(hdf5_untrusted_measure(file, path, HDF5_F64, &shape));
    const hsize_t *extent = shape.extent;
    CHECK(shape.rank >= 1 && extent[1] >= 1 && extent[1] <= most_width && extent[2] >= 1 &&
              extent[2] <= most_width / extent[1],
          DEM_ERROR_IO, "%s: %s: is not of shape [n], [n][..] or [n][..][..]", file->path, path);
    /* Extents beyond the rank are 1 (hdf5_untrusted_measure). */
    const bool of_items = shape.rank == 3 || strcmp(table, history_table) == 0;
    c.type = type_of(shape.stored);
    c.n_rows = (dem_index)extent[0];
    c.items = of_items ? (dem_index)extent[1] : 1;
    c.components = of_items ? (dem_index)extent[2] : (dem_index)extent[1];
    c.width = c.items * c.components;
    CHECK(grow_array((void **)&reader->columns, &reader->room_columns, reader->n_columns + 1, sizeof c),
          DEM_ERROR_MEMORY, "out of memory");
    reader->columns[reader->n_columns++] = c;
    return DEM_OK;
}

/* Of a run that goes on, some columns may have rows that others have not yet: the rows of a table are those that all
 * columns have. */
static void even_rows(dem_reader *reader, dem_index first)
{
    dem_index rows = INT64_MAX;
    for (dem_index k = first; k < reader->n_columns; k++)
        if (reader->columns[k].n_rows < rows) rows = reader->columns[k].n_rows;
    for (dem_index k = first; k < reader->n_columns; k++) reader->columns[k].n_rows = rows;
}

/* Of fragments, where the rows of frames begin is no column. */
static bool is_offset(const char *table, const char *name)
{
    return strcmp(table, fragments_table) == 0 && strcmp(name, strrchr(FRAMES_FRAGMENT_OFFSETS, '/') + 1) == 0;
}

/* A group that is not there is a table without columns. */
static dem_status add_table(dem_reader *reader, const hdf5_file *file, const char *name)
{
    char group[PATH];
    const char *table = NULL;
    const dem_index first = reader->n_columns;
    names all;
    TRY(keep(reader, name, &table));
    name_table(group, table);
    dem_status status = list_names(&all, file, group);
    for (dem_index k = 0; k < all.n && status == DEM_OK; k++)
        if (!is_offset(table, all.list[k])) status = add_column(reader, file, table, all.list[k]);
    free(all.list);
    even_rows(reader, first);
    return status;
}

/* Each group within a group is a table: probes, and the lists of the most stressed. */
static dem_status add_tables(dem_reader *reader, const hdf5_file *file, const char *group)
{
    char path[PATH], table[TABLE + NAME];
    names all;
    name_table(path, group);
    dem_status status = list_names(&all, file, path);
    for (dem_index k = 0; k < all.n && status == DEM_OK; k++) {
        (void)snprintf(table, sizeof table, "%s/%s", group, all.list[k]);
        status = add_table(reader, file, table);
    }
    free(all.list);
    return status;
}

/* One row for each frame that is whole. */
static dem_status add_frames_table(dem_reader *reader, const hdf5_file *file)
{
    const dem_index first = reader->n_columns;
    TRY(add_table(reader, file, frames_table));
    for (dem_index k = first; k < reader->n_columns; k++) {
        CHECK(reader->columns[k].n_rows >= reader->n_frames, DEM_ERROR_IO,
              "%s: " GRID "FieldData: has arrays of %lld rows, of %lld frames", file->path,
              (long long)reader->columns[k].n_rows, (long long)reader->n_frames);
        reader->columns[k].n_rows = reader->n_frames;
    }
    return DEM_OK;
}

/* ---- fragments ---- */

/* Ascending from 0 on, one for each frame and one more; a run that goes on may have another frame already. */
static dem_status read_fragment_offsets(dem_reader *reader, const hdf5_file *file)
{
    static const char name[] = FRAMES_FRAGMENT_OFFSETS;
    const dem_index n = reader->n_frames;
    hdf5_untrusted_shape shape;
    TRY(hdf5_untrusted_measure(file, name, HDF5_I64, &shape));
    CHECK(shape.rank == 1 && shape.extent[0] > (hsize_t)n, DEM_ERROR_IO, "%s: %s: is not of shape [%lld frames + 1]",
          file->path, name, (long long)n);
    reader->fragment_offset = lattice_zeros(n + 1, sizeof *reader->fragment_offset);
    CHECK_MEMORY(reader->fragment_offset);
    TRY(hdf5_untrusted_read(file, name, HDF5_I64, (hdf5_untrusted_rows){0, (hsize_t)n + 1, 0},
                            reader->fragment_offset));
    for (dem_index k = 0; k <= n; k++)
        if (reader->fragment_offset[k] < (k > 0 ? reader->fragment_offset[k - 1] : 0))
            return hdf5_untrusted_refuse(file, name, "is not ascending from 0 on");
    return DEM_OK;
}

/* Its rows are those of whole frames. */
static dem_status add_fragments(dem_reader *reader, const hdf5_file *file)
{
    const dem_index first = reader->n_columns;
    bool present = false;
    TRY(hdf5_untrusted_find(file, FRAMES_FRAGMENT_OFFSETS, &present));
    if (!present) return DEM_OK;
    TRY(read_fragment_offsets(reader, file));
    TRY(add_table(reader, file, fragments_table));
    for (dem_index k = first; k < reader->n_columns; k++) {
        CHECK(reader->columns[k].n_rows >= reader->fragment_offset[reader->n_frames], DEM_ERROR_IO,
              "%s: /fragments: has columns of %lld rows, of %lld fragments", file->path,
              (long long)reader->columns[k].n_rows, (long long)reader->fragment_offset[reader->n_frames]);
        reader->columns[k].n_rows = reader->fragment_offset[reader->n_frames];
    }
    return DEM_OK;
}

/* ---- opening ---- */

/* A run without frames has no such group. */
static dem_status list_frames(dem_reader *reader, const hdf5_file *file)
{
    bool present = false;
    TRY(hdf5_untrusted_find(file, STEPS, &present));
    if (!present) return DEM_OK;
    TRY(read_times(reader, file));
    TRY(check_positions(reader, file));
    TRY(add_arrays(reader, file, 0));
    TRY(add_arrays(reader, file, 1));
    TRY(find_broken_triangles(reader, file));
    TRY(add_fragments(reader, file));
    return add_frames_table(reader, file);
}

/* Obstacles that a program moved get their places from the history. */
static dem_status read_records(dem_reader *reader, const hdf5_file *file)
{
    const dem_index n = reader->n_obstacles;
    reader->records = calloc((size_t)n + 1, sizeof *reader->records);
    CHECK_MEMORY(reader->records);
    for (dem_index k = 0; k < n; k++) {
        dem_obstacle *o = &reader->obstacles[k];
        if (o->most_speed == 0.0) continue;
        TRY(motion_record_read(&reader->records[k], file, k, n));
        o->motion = motion_record_pose;
        o->motion_context = &reader->records[k];
    }
    return DEM_OK;
}

/* A group that is missing is no error: which ones there are depends on the options of the run. */
static dem_status list_all(dem_reader *reader, const hdf5_file *file)
{
    TRY(list_frames(reader, file));
    TRY(add_table(reader, file, history_table));
    TRY(add_table(reader, file, "events"));
    TRY(add_table(reader, file, "breaks"));
    TRY(add_tables(reader, file, "probes"));
    TRY(add_tables(reader, file, "most_stressed"));
    TRY(obstacle_file_read(file, &reader->obstacles, &reader->n_obstacles));
    return read_records(reader, file);
}

/* Lists what the file holds; the lattice is read whole, since counts of nodes and springs are those of arrays. */
static dem_status look(dem_reader *reader, const char *path)
{
    hdf5_file file;
    reader->path = strdup(path);
    CHECK_MEMORY(reader->path);
    reader->lattice = dem_lattice_empty();
    TRY(dem_lattice_read(&reader->lattice, path));
    TRY(open_run(&file, reader));
    return hdf5_close(&file, list_all(reader, &file));
}

/* A reader that could not list everything is closed again. */
dem_status dem_reader_open(dem_reader **out, const char *path)
{
    CHECK(out != NULL && path != NULL, DEM_ERROR_ARGUMENT, "dem_reader_open: an argument is NULL");
    dem_reader *reader = calloc(1, sizeof *reader);
    CHECK_MEMORY(reader);
    const dem_status status = look(reader, path);
    if (status == DEM_OK)
        *out = reader;
    else
        dem_reader_close(reader);
    return status;
}

void dem_reader_close(dem_reader *reader)
{
    if (reader == NULL) return;
    for (dem_index k = 0; k < reader->n_texts; k++) free(reader->texts[k]);
    free(reader->texts);
    free(reader->columns);
    free(reader->arrays);
    free(reader->times);
    free(reader->fragment_offset);
    for (dem_index k = 0; k < reader->n_obstacles && reader->records != NULL; k++)
        motion_record_free(&reader->records[k]);
    free(reader->records);
    obstacle_file_free(reader->obstacles, reader->n_obstacles);
    dem_lattice_free(&reader->lattice);
    free(reader->path);
    free(reader);
}

/* ---- what there is ---- */

const dem_lattice *dem_reader_lattice(const dem_reader *reader)
{
    return &reader->lattice;
}

dem_index dem_reader_n_obstacles(const dem_reader *reader)
{
    return reader->n_obstacles;
}

const dem_obstacle *dem_reader_obstacle(const dem_reader *reader, dem_index obstacle)
{
    const dem_index n = reader != NULL ? reader->n_obstacles : 0;
    return status_check_number("obstacle", obstacle, n) == DEM_OK ? &reader->obstacles[obstacle] : NULL;
}

const double *dem_reader_times(const dem_reader *reader, dem_index *n_frames)
{
    *n_frames = reader->n_frames;
    return reader->times;
}

const dem_reader_array *dem_reader_arrays(const dem_reader *reader, dem_index *n)
{
    *n = reader->n_arrays;
    return reader->arrays;
}

/* Names are few, and a linear search is enough. Names of arrays of nodes and springs are searched together, nodes
 * first. */
const dem_reader_array *dem_reader_array_find(const dem_reader *reader, const char *name)
{
    for (dem_index k = 0; k < reader->n_arrays; k++)
        if (strcmp(reader->arrays[k].name, name) == 0) return &reader->arrays[k];
    return NULL;
}

const dem_reader_column *dem_reader_columns(const dem_reader *reader, dem_index *n)
{
    *n = reader->n_columns;
    return reader->columns;
}

/* A column is known by its table and its name. */
const dem_reader_column *dem_reader_column_find(const dem_reader *reader, const char *table, const char *name)
{
    for (dem_index k = 0; k < reader->n_columns; k++)
        if (strcmp(reader->columns[k].table, table) == 0 && strcmp(reader->columns[k].name, name) == 0)
            return &reader->columns[k];
    return NULL;
}

/* ---- reading ---- */

/* Reads rows of a dataset, `width` numbers each, if it still has them. */
static dem_status read_checked(const hdf5_file *file, const char *name, hdf5_kind kind, hdf5_untrusted_rows rows,
                               hsize_t width, void *values)
{
    hdf5_untrusted_shape shape;
    bool present = false;
    TRY(hdf5_untrusted_find(file, name, &present));
    if (!present) return hdf5_untrusted_refuse(file, name, "is missing");
    TRY(hdf5_untrusted_measure(file, name, kind, &shape));
    /* The caller's buffer has been made for what was there when the reader was opened. */
    if (shape.rank == 0 || shape.extent[1] * shape.extent[2] != width || shape.extent[0] < rows.first + rows.count)
        return hdf5_untrusted_refuse(file, name, "has another shape than when the reader was opened");
    return hdf5_untrusted_read(file, name, kind, rows, values);
}

/* Opens the file for this one read. */
static dem_status read_rows(const dem_reader *reader, const char *name, hdf5_untrusted_rows rows, dem_index width,
                            double *values)
{
    hdf5_file file;
    TRY(open_run(&file, reader));
    return hdf5_close(&file, read_checked(&file, name, HDF5_F64, rows, (hsize_t)width, values));
}

/* Frames are numbered from 0. */
static dem_status check_frame(const dem_reader *reader, dem_index frame)
{
    CHECK(frame >= 0 && frame < reader->n_frames, DEM_ERROR_ARGUMENT, "%s: has no frame %lld: there are %lld",
          reader->path, (long long)frame, (long long)reader->n_frames);
    return DEM_OK;
}

/* Of VTK's three components the first two. */
dem_status dem_reader_positions(const dem_reader *reader, dem_index frame, double *x)
{
    CHECK(reader != NULL && x != NULL, DEM_ERROR_ARGUMENT, "dem_reader_positions: an argument is NULL");
    TRY(check_frame(reader, frame));
    const hsize_t n = (hsize_t)reader->lattice.n_nodes;
    return read_rows(reader, GRID "Points", (hdf5_untrusted_rows){(hsize_t)frame * n, n, 2}, 3, x);
}

/* A constant array is read from its only rows, whatever the frame. */
dem_status dem_reader_read(const dem_reader *reader, const dem_reader_array *array, dem_index frame, double *values)
{
    char path[PATH];
    CHECK(reader != NULL && array != NULL && values != NULL, DEM_ERROR_ARGUMENT,
          "dem_reader_read: an argument is NULL");
    if (array->constant)
        frame = 0;
    else
        TRY(check_frame(reader, frame));
    const hsize_t n = (hsize_t)count_of(reader, array->of_springs);
    (void)snprintf(path, sizeof path, GRID "%s/%s", set_of(array->of_springs), array->name);
    return read_rows(reader, path, (hdf5_untrusted_rows){(hsize_t)frame * n, n, 0}, array->components, values);
}

/* Any number but 0 is a flag. */
dem_status dem_reader_broken_triangles(const dem_reader *reader, dem_index frame, unsigned char *triangle)
{
    CHECK(reader != NULL && triangle != NULL, DEM_ERROR_ARGUMENT, "dem_reader_broken_triangles: an argument is NULL");
    TRY(check_frame(reader, frame));
    hdf5_file file;
    const hsize_t n = (hsize_t)reader->lattice.n_triangles;
    const hdf5_untrusted_rows rows = {(hsize_t)frame * n, n, 0};
    memset(triangle, 0, (size_t)n);
    if (!reader->knows_triangles) return DEM_OK;
    TRY(open_run(&file, reader));
    TRY(hdf5_close(&file, read_checked(&file, FRAMES_BROKEN_TRIANGLES, HDF5_U8, rows, 1, triangle)));
    for (hsize_t k = 0; k < n; k++) triangle[k] = triangle[k] != 0;
    return DEM_OK;
}

dem_status dem_reader_fragments(const dem_reader *reader, dem_index frame, dem_index *first, dem_index *count)
{
    CHECK(reader != NULL && first != NULL && count != NULL, DEM_ERROR_ARGUMENT,
          "dem_reader_fragments: an argument is NULL");
    TRY(check_frame(reader, frame));
    const dem_index *offset = reader->fragment_offset;
    *first = offset != NULL ? offset[frame] : 0;
    *count = offset != NULL ? offset[frame + 1] - offset[frame] : 0;
    return DEM_OK;
}

dem_status dem_reader_read_column(const dem_reader *reader, const dem_reader_column *column, double *values)
{
    CHECK(column != NULL, DEM_ERROR_ARGUMENT, "dem_reader_read_column: column is NULL");
    return dem_reader_read_rows(reader, column, 0, column->n_rows, values);
}

/* `first <= n_rows - count` cannot overflow, as `first + count <= n_rows` could. */
dem_status dem_reader_read_rows(const dem_reader *reader, const dem_reader_column *column, dem_index first,
                                dem_index count, double *values)
{
    char path[PATH];
    CHECK(reader != NULL && column != NULL && values != NULL, DEM_ERROR_ARGUMENT,
          "dem_reader_read_rows: an argument is NULL");
    CHECK(first >= 0 && count >= 0 && count <= column->n_rows && first <= column->n_rows - count, DEM_ERROR_ARGUMENT,
          "%s: %s/%s: has no rows %lld to %lld: there are %lld", reader->path, column->table, column->name,
          (long long)first, (long long)(first + count - 1), (long long)column->n_rows);
    name_column(path, column);
    return read_rows(reader, path, (hdf5_untrusted_rows){(hsize_t)first, (hsize_t)count, 0}, column->width, values);
}
