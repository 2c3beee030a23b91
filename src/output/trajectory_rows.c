/* SPDX-License-Identifier: BSD-3-Clause */
/* What a file of a trajectory holds, be it the whole run or a part of it: what every file has (lattice, obstacles,
 * notes), and rows of some kinds, frames and those of tables. This file treats all kinds alike: creating, flushing,
 * counting, copying and verifying go over them in one order. Frames are in frames.c, tables in table.c; which rows are
 * in which file is decided in trajectory_parts.c. */
#include "output/trajectory_rows.h"

#include "base/status.h"
#include "output/lattice_file.h"
#include "output/obstacle_file.h"
#include "output/peaks_file.h"

#include <stdlib.h>
#include <string.h>

/* Every kind of rows but the frames is a table. */
static const table *table_of(const trajectory_rows *r, int kind)
{
    if (kind == ROWS_HISTORY) return &r->history.table;
    if (kind == ROWS_EVENTS) return &r->events;
    return kind == ROWS_BREAKS ? &r->breaks : &r->probes[kind - ROWS_PROBES].table;
}

/* The same of a trajectory that may change. */
static table *table_to_change(trajectory_rows *r, int kind)
{
    return (table *)table_of(r, kind);
}

/* Without an interval there are no frames, and no group /VTKHDF. */
static bool has_frames(const trajectory_rows *r)
{
    return r->options.frame_interval > 0.0;
}

/* ---- creation ---- */

/* Two probes of one name would be one group. */
static dem_status make_probes(trajectory_rows *r)
{
    const dem_probe *given = r->options.probes;
    r->probes = calloc((size_t)r->options.n_probes + 1, sizeof *r->probes);
    CHECK_MEMORY(r->probes);
    for (dem_index k = 0; k < r->options.n_probes; k++) {
        TRY(probe_init(&r->probes[k], &given[k], &r->lattice));
        for (dem_index q = 0; q < k; q++)
            CHECK(strcmp(given[q].name, given[k].name) != 0, DEM_ERROR_ARGUMENT, "two probes have the name %s",
                  given[k].name);
    }
    return DEM_OK;
}

/* The simulation's own threads are not seen here. Neither team is at work while the other is. */
static void create_team(trajectory_rows *r, const dem_simulation *simulation)
{
    dem_options o = {.struct_size = sizeof o};
    (void)dem_simulation_options(simulation, &o);
    r->team = team_create(o.threads, 1);
}

/* The options are kept, but for the caller's list of probes: each probe has a copy of its own. */
dem_status trajectory_rows_init(trajectory_rows *out, const dem_simulation *simulation,
                                const dem_trajectory_options *options)
{
    out->model = dem_simulation_model(simulation);
    out->lattice = dem_private_lattice_source(out->model);
    out->options = *options;
    /* Events and breaks count as kinds even if they are not wanted: their tables then have no columns. */
    out->n_kinds = ROWS_PROBES + (int)options->n_probes;
    create_team(out, simulation);
    frames_init(&out->frames, out->model, options);
    if (!has_frames(out)) out->frames.n_stripes = 0;
    out->stripes = (stripes){out->frames.n_stripes, simulation, NULL, options->stays_open, out->lattice, 0};
    if (out->stripes.n > 0) TRY(stripes_run(&out->stripes.run, &out->lattice));
    if (has_frames(out) && options->fragments) TRY(fragment_table_init(&out->fragments, out->model));
    TRY(make_probes(out));
    out->options.probes = NULL; /* the caller's */
    if (options->events) TRY(event_table_init(&out->events));
    if (options->breaks) TRY(break_table_init(&out->breaks));
    TRY(history_init(&out->history, simulation, options->breaks));
    out->history.interval = options->history_interval;
    return DEM_OK;
}

void trajectory_rows_free(trajectory_rows *r)
{
    team_destroy(r->team);
    history_free(&r->history);
    table_free(&r->events);
    table_free(&r->breaks);
    for (dem_index k = 0; r->probes != NULL && k < r->options.n_probes; k++) probe_free(&r->probes[k]);
    free(r->probes);
    fragment_table_free(&r->fragments);
    provenance_free(&r->provenance);
}

/* A new file with everything but rows. */
dem_status trajectory_rows_create(const trajectory_rows *r, const hdf5_file *file)
{
    if (has_frames(r)) TRY(frames_create(&r->frames, file, &r->lattice));
    TRY(fragment_table_create(&r->fragments, file));
    TRY(lattice_file_write(file, &r->lattice, r->options.deflate));
    TRY(obstacle_file_write(file, r->model));
    if (r->options.events) TRY(event_table_create(&r->events, file));
    TRY(table_create(&r->breaks, file));
    for (dem_index k = 0; k < r->options.n_probes; k++) TRY(probe_create(&r->probes[k], file));
    TRY(table_create(&r->history.table, file));
    return provenance_write(&r->provenance, file);
}

/* An upper bound of what all arrays of the lattice, the obstacles and the notes take. Deflate never lengthens. */
hsize_t trajectory_rows_create_bytes(const trajectory_rows *r)
{
    dem_model_size size = {.struct_size = sizeof size};
    (void)dem_model_sizes(r->model, &size);
    return 104 * (hsize_t)size.n_nodes + 65 * (hsize_t)size.n_springs + 89 * (hsize_t)size.n_triangles +
           32 * (hsize_t)size.n_segments + 4096 * (hsize_t)size.n_obstacles + provenance_bytes(&r->provenance);
}

/* ---- rows ---- */

/* Tables that are not wanted have no columns, and no rows. */
bool trajectory_rows_are_full(const trajectory_rows *r)
{
    bool any = false;
    for (int k = ROWS_HISTORY; k < r->n_kinds; k++) any = any || table_of(r, k)->buffered == TABLE_ROWS;
    return any;
}

/* Frames are never buffered. */
dem_status trajectory_rows_flush(trajectory_rows *r, const hdf5_file *file)
{
    for (int k = ROWS_HISTORY; k < r->n_kinds; k++) TRY(table_flush(table_to_change(r, k), file));
    return DEM_OK;
}

hsize_t trajectory_rows_flush_bytes(const trajectory_rows *r)
{
    hsize_t bytes = 0;
    for (int k = ROWS_HISTORY; k < r->n_kinds; k++) bytes += table_bytes(table_of(r, k));
    return bytes;
}

hsize_t trajectory_rows_total(const trajectory_rows *r, int kind)
{
    return kind == ROWS_FRAMES ? (hsize_t)(r->frames.before + r->frames.n) : table_total(table_of(r, kind));
}

hsize_t trajectory_rows_written(const trajectory_rows *r, int kind)
{
    return kind == ROWS_FRAMES ? (hsize_t)r->frames.n : table_of(r, kind)->written;
}

/* Sets where the rows of a kind stand after a file has been cut or found. */
void trajectory_rows_place(trajectory_rows *r, int kind, hsize_t before, hsize_t written)
{
    if (kind == ROWS_FRAMES) {
        r->frames.before = (dem_index)before;
        r->frames.n = (dem_index)written;
    } else {
        table_to_change(r, kind)->before = before;
        table_to_change(r, kind)->written = written;
    }
}

const char *trajectory_rows_name(const trajectory_rows *r, int kind)
{
    static const char *const names[] = {
        [ROWS_FRAMES] = "frames", [ROWS_HISTORY] = "history", [ROWS_EVENTS] = "events", [ROWS_BREAKS] = "breaks"};
    return kind < ROWS_PROBES ? names[kind] : r->probes[kind - ROWS_PROBES].what.name;
}

/* The same spans are used for all columns of a kind. */
dem_status trajectory_rows_copy(const trajectory_rows *r, const hdf5_file *from, const hdf5_file *to,
                                const hdf5_span *spans)
{
    TRY(frames_copy(&r->frames, from, to, spans[ROWS_FRAMES]));
    TRY(fragment_table_copy(&r->fragments, from, to, spans[ROWS_FRAMES]));
    for (int k = ROWS_HISTORY; k < r->n_kinds; k++) TRY(table_copy(table_of(r, k), from, to, spans[k]));
    return DEM_OK;
}

dem_status trajectory_rows_count(const trajectory_rows *r, const hdf5_file *file, hdf5_span *spans)
{
    spans[ROWS_FRAMES].count = 0;
    if (has_frames(r)) TRY(frames_count(&r->frames, file, &spans[ROWS_FRAMES].count));
    TRY(fragment_table_verify(&r->fragments, file, spans[ROWS_FRAMES].count));
    for (int k = ROWS_HISTORY; k < r->n_kinds; k++) TRY(table_count(table_of(r, k), file, &spans[k].count));
    return DEM_OK;
}

/* The counts of the spans alone are compared. */
dem_status trajectory_rows_verify(const trajectory_rows *r, const hdf5_file *file, const hdf5_span *spans)
{
    if (has_frames(r)) TRY(frames_verify(&r->frames, file, spans[ROWS_FRAMES].count));
    TRY(fragment_table_verify(&r->fragments, file, spans[ROWS_FRAMES].count));
    for (int k = ROWS_HISTORY; k < r->n_kinds; k++) TRY(table_verify(table_of(r, k), file, spans[k].count));
    return DEM_OK;
}

/* ---- the end ---- */

/* Peaks belong to the caller and are read when the run is finished. */
static peaks_report report_of(const trajectory_rows *r)
{
    return (peaks_report){r->options.peaks, r->lattice, r->options.most_stressed};
}

/* Arrays need at least one frame to be shown in; the lists do not. */
dem_status trajectory_rows_write_peaks(const trajectory_rows *r, const hdf5_file *file, hsize_t n)
{
    const peaks_report report = report_of(r);
    if (report.peaks == NULL) return DEM_OK;
    if (n > 0) TRY(peaks_file_write_arrays(file, &report, &r->frames));
    return peaks_file_write_lists(file, &report);
}

hsize_t trajectory_rows_peaks_bytes(const trajectory_rows *r, hsize_t n)
{
    const peaks_report report = report_of(r);
    return report.peaks != NULL ? peaks_file_bytes(&report, n) : 0;
}
