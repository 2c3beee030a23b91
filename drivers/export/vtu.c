/* SPDX-License-Identifier: BSD-3-Clause */
#include "vtu.h"

#include <stdlib.h>
#include <string.h>

#include "piece.h"

enum { ENDING = 32 };

static const char series[] = ".pvd", obstacles_file[] = ".obstacle.vtu", obstacles_series[] = ".obstacle.pvd";
static const double line = 3.0; /* VTK_LINE */

static void name_frame(char ending[ENDING], const char *of, dem_index frame)
{
    (void)snprintf(ending, ENDING, "%s_%04lld.vtu", of, (long long)frame);
}

/* ---- lines ---- */

typedef struct lines {
    dem_index n;
    double *ends, *offsets, *types; /* [n][2], [n], [n] */
} lines;

static void free_lines(lines *l)
{
    free(l->ends);
    free(l->offsets);
    free(l->types);
}

/* Without their ends; free after a failure too. */
static bool make_lines(lines *out, const task *t, dem_index n)
{
    *out = (lines){n, task_allocate(t, 2 * n, sizeof(double)), task_allocate(t, n, sizeof(double)),
                   task_allocate(t, n, sizeof(double))};
    if (out->ends == NULL || out->offsets == NULL || out->types == NULL) return false;
    for (dem_index k = 0; k < n; k++) {
        out->offsets[k] = 2.0 * (double)(k + 1);
        out->types[k] = line;
    }
    return true;
}

static piece_array *put_lines(piece_array *at, const lines *l)
{
    *at++ = (piece_array){PIECE_CELLS, "connectivity", DEM_READER_I64, 1, 2 * l->n, l->ends, NULL};
    *at++ = (piece_array){PIECE_CELLS, "offsets", DEM_READER_I64, 1, l->n, l->offsets, NULL};
    *at++ = (piece_array){PIECE_CELLS, "types", DEM_READER_U8, 1, l->n, l->types, NULL};
    return at;
}

/* ---- frames ---- */

/* What the files of all frames are made of. */
typedef struct frame_writer {
    const task *task;
    lines springs;
    double *x, *points;         /* [n_nodes][2], [n_nodes][3] m */
    double *scratch, *energies; /* as of a piece; [columns] */
    piece_array *arrays;
    dem_index n_arrays;
} frame_writer;

static void free_frame_writer(frame_writer *r)
{
    free_lines(&r->springs);
    free(r->x);
    free(r->points);
    free(r->scratch);
    free(r->energies);
    free(r->arrays);
}

/* Time, and what the table of the frames has. */
static piece_array *put_fields(piece_array *at, const frame_writer *r)
{
    dem_index n = 0, k = 0;
    const dem_reader_column *columns = dem_reader_columns(r->task->reader, &n);
    *at++ = (piece_array){PIECE_FIELD, "TimeValue", DEM_READER_F64, 1, 1, r->energies, NULL};
    for (dem_index c = 0; c < n; c++)
        if (strcmp(columns[c].table, "frames") == 0 && columns[c].width == 1)
            *at++ = (piece_array){PIECE_FIELD, columns[c].name, columns[c].type, 1, 1, &r->energies[++k], NULL};
    return at;
}

static bool read_fields(const frame_writer *r, dem_index frame)
{
    dem_index n_frames = 0, n = 0, k = 0;
    const dem_reader_column *columns = dem_reader_columns(r->task->reader, &n);
    r->energies[0] = dem_reader_times(r->task->reader, &n_frames)[frame];
    for (dem_index c = 0; c < n; c++)
        if (strcmp(columns[c].table, "frames") == 0 && columns[c].width == 1 &&
            !task_holds(r->task, dem_reader_read_rows(r->task->reader, &columns[c], frame, 1, &r->energies[++k])))
            return false;
    return true;
}

static bool allocate(frame_writer *r)
{
    const dem_lattice *l = dem_reader_lattice(r->task->reader);
    dem_index n_arrays = 0, n_columns = 0, largest = 0;
    const dem_reader_array *arrays = dem_reader_arrays(r->task->reader, &n_arrays);
    (void)dem_reader_columns(r->task->reader, &n_columns);
    for (dem_index k = 0; k < n_arrays; k++) {
        const dem_index size = (arrays[k].of_springs ? l->n_springs : l->n_nodes) * arrays[k].components;
        largest = size > largest ? size : largest;
    }
    r->x = task_allocate(r->task, 2 * l->n_nodes, sizeof *r->x);
    r->points = task_allocate(r->task, 3 * l->n_nodes, sizeof *r->points);
    r->scratch = task_allocate(r->task, largest, sizeof *r->scratch);
    r->energies = task_allocate(r->task, 1 + n_columns, sizeof *r->energies);
    r->arrays = task_allocate(r->task, n_arrays + n_columns + 5, sizeof *r->arrays);
    return r->x != NULL && r->points != NULL && r->scratch != NULL && r->energies != NULL && r->arrays != NULL;
}

static bool make_frame_writer(frame_writer *r, const task *t)
{
    const dem_lattice *l = dem_reader_lattice(t->reader);
    dem_index n = 0;
    const dem_reader_array *arrays = dem_reader_arrays(t->reader, &n);
    *r = (frame_writer){.task = t};
    if (!make_lines(&r->springs, t, l->n_springs) || !allocate(r)) return false;
    for (dem_index k = 0; k < 2 * l->n_springs; k++) r->springs.ends[k] = (double)l->ends[k];
    piece_array *at = put_lines(put_fields(r->arrays, r), &r->springs);
    *at++ = (piece_array){PIECE_POINTS, "Points", DEM_READER_F64, 3, l->n_nodes, r->points, NULL};
    for (dem_index k = 0; k < n; k++)
        *at++ = (piece_array){arrays[k].of_springs ? PIECE_CELL_DATA : PIECE_POINT_DATA,
                              arrays[k].name,
                              arrays[k].type,
                              arrays[k].components,
                              arrays[k].of_springs ? l->n_springs : l->n_nodes,
                              NULL,
                              &arrays[k]};
    r->n_arrays = at - r->arrays;
    return true;
}

static bool write_frame(const frame_writer *r, dem_index frame)
{
    char ending[ENDING];
    const dem_lattice *l = dem_reader_lattice(r->task->reader);
    const piece p = {l->n_nodes, l->n_springs, r->n_arrays, r->arrays, frame, r->scratch};
    name_frame(ending, "", frame);
    if (!read_fields(r, frame) || !task_holds(r->task, dem_reader_positions(r->task->reader, frame, r->x)))
        return false;
    for (dem_index i = 0; i < l->n_nodes; i++) memcpy(r->points + 3 * i, r->x + 2 * i, 2 * sizeof *r->x);
    return piece_write(r->task, ending, &p);
}

static bool write_frames(const task *t)
{
    frame_writer r;
    bool good = make_frame_writer(&r, t);
    for (size_t k = 0; good && k < t->frames.n; k++) good = write_frame(&r, t->frames.frame[k]);
    free_frame_writer(&r);
    return good;
}

/* The files of the frames, with their times; `of` is what their endings begin with. */
static bool write_series(const task *t, const char *name, const char *of)
{
    sheet s;
    char ending[ENDING];
    dem_index n = 0;
    const double *times = dem_reader_times(t->reader, &n);
    if (!sheet_open(&s, t, "", name)) return false;
    sheet_print(&s, "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n");
    for (size_t k = 0; k < t->frames.n; k++) {
        name_frame(ending, of, t->frames.frame[k]);
        sheet_print(&s, "<DataSet timestep=\"%.17g\" part=\"0\" file=\"", times[t->frames.frame[k]]);
        piece_print_text(&s, t->name);
        sheet_print(&s, "%s\"/>\n", ending);
    }
    sheet_print(&s, "</Collection>\n</VTKFile>\n");
    return sheet_close(&s, true);
}

/* ---- obstacles ---- */

/* The polylines as one grid. */
typedef struct outlines {
    const task *task;
    dem_index n, n_points;
    lines segments;
    double *flat, *points, *owner; /* [n_points][2], [n_points][3] m; [n_segments] obstacle of each */
} outlines;

static void free_outlines(outlines *o)
{
    free_lines(&o->segments);
    free(o->flat);
    free(o->points);
    free(o->owner);
}

static const dem_obstacle *outline_of(const outlines *o, dem_index k)
{
    return dem_reader_obstacle(o->task->reader, k);
}

/* Free after a failure too. */
static bool make_outlines(outlines *o, const task *t)
{
    *o = (outlines){.task = t};
    o->n = dem_reader_n_obstacles(t->reader);
    for (dem_index k = 0; k < o->n; k++) o->n_points += outline_of(o, k)->n_points;
    o->flat = task_allocate(t, 2 * o->n_points, sizeof *o->flat);
    o->points = task_allocate(t, 3 * o->n_points, sizeof *o->points);
    o->owner = task_allocate(t, o->n_points, sizeof *o->owner);
    if (!make_lines(&o->segments, t, o->n_points - o->n) || !o->flat || !o->points || !o->owner) return false;
    for (dem_index k = 0, point = 0, segment = 0; k < o->n; k++, point++)
        for (dem_index i = 1; i < outline_of(o, k)->n_points; i++, point++) {
            o->segments.ends[2 * segment] = (double)point;
            o->segments.ends[2 * segment + 1] = (double)(point + 1);
            o->owner[segment++] = (double)k;
        }
    return true;
}

/* Where they are at a time: the record of one that a program moved may be damaged. */
static bool write_outlines(const outlines *o, const char *ending, double time)
{
    piece_array arrays[5], *at = put_lines(arrays, &o->segments);
    for (dem_index k = 0, first = 0; k < o->n; first += outline_of(o, k++)->n_points)
        if (!task_holds(o->task, dem_obstacle_points(outline_of(o, k), time, o->flat + 2 * first))) return false;
    for (dem_index i = 0; i < o->n_points; i++) memcpy(o->points + 3 * i, o->flat + 2 * i, 2 * sizeof *o->flat);
    *at++ = (piece_array){PIECE_POINTS, "Points", DEM_READER_F64, 3, o->n_points, o->points, NULL};
    *at++ = (piece_array){PIECE_CELL_DATA, "obstacle", DEM_READER_I32, 1, o->segments.n, o->owner, NULL};
    const piece p = {o->n_points, o->segments.n, at - arrays, arrays, 0, NULL};
    return piece_write(o->task, ending, &p);
}

static bool some_move(const task *t)
{
    bool any = false;
    for (dem_index k = dem_reader_n_obstacles(t->reader) - 1; k >= 0; k--)
        any = any || dem_obstacle_moves(dem_reader_obstacle(t->reader, k), NULL);
    return any;
}

/* Those at rest in one file; if some move, a file for each frame. */
static bool write_obstacles(const task *t)
{
    outlines o;
    dem_index n_times = 0;
    const double *times = dem_reader_times(t->reader, &n_times);
    bool good = make_outlines(&o, t);
    if (good && o.n > 0 && !some_move(t)) good = write_outlines(&o, obstacles_file, 0.0);
    for (size_t k = 0; good && some_move(t) && k < t->frames.n; k++) {
        char ending[ENDING];
        name_frame(ending, ".obstacle", t->frames.frame[k]);
        good = write_outlines(&o, ending, times[t->frames.frame[k]]);
    }
    free_outlines(&o);
    return good && (!some_move(t) || write_series(t, obstacles_series, ".obstacle"));
}

/* ---- all ---- */

static bool frames_are_free(const task *t, const char *of)
{
    bool good = true;
    for (size_t k = 0; good && k < t->frames.n; k++) {
        char ending[ENDING];
        name_frame(ending, of, t->frames.frame[k]);
        good = sheet_is_free(t, "", ending);
    }
    return good;
}

static bool is_free(const task *t)
{
    const dem_index n = dem_reader_n_obstacles(t->reader);
    if (!sheet_is_free(t, "", series) || !frames_are_free(t, "")) return false;
    if (some_move(t)) return sheet_is_free(t, "", obstacles_series) && frames_are_free(t, ".obstacle");
    return n == 0 || sheet_is_free(t, "", obstacles_file);
}

bool vtu_export(const task *t)
{
    if (t->frames.n == 0) {
        outcome_fail(t->outcome, EXIT_INVALID, "dem_export", "%s: has no frames", t->input);
        return false;
    }
    return is_free(t) && write_frames(t) && write_series(t, series, "") && write_obstacles(t);
}
