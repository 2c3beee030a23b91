/* SPDX-License-Identifier: BSD-3-Clause */
/* A run as a VTKHDF file: which dataset is where, and when it is written. docs/output.md lists them all. */
#include <dem/trajectory.h>

#include "events.h"
#include "frames.h"
#include "hdf5_file.h"
#include "history.h"
#include "lattice_file.h"
#include "obstacle_file.h"
#include "peaks_file.h"
#include "probe.h"
#include "status.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct dem_trajectory {
    char *path, *part, *obstacle, *obstacle_part; /* names: one allocation */
    dem_trajectory_options options;
    const dem_lattice *lattice; /* the model's */
    dem_index n_obstacles;
    int finished;
    frames frames;
    history history;
    table events;  /* without columns unless wanted */
    probe *probes; /* [options.n_probes] */
};

static const char suffix[] = ".vtkhdf";

/* ---- following a run ---- */

static dem_status flush_tables(dem_trajectory *t, const hdf5_file *file)
{
    TRY(table_flush(&t->history.table, file));
    for (dem_index k = 0; k < t->options.n_probes; k++) TRY(table_flush(&t->probes[k].table, file));
    return table_flush(&t->events, file);
}

static dem_status append_frame(dem_trajectory *t, const hdf5_file *file, const dem_simulation *simulation)
{
    TRY(flush_tables(t, file));
    return frames_append(&t->frames, file, simulation);
}

/* Bounds of what is added, in bytes: deflate never lengthens. */
static hsize_t tables_bytes(const dem_trajectory *t)
{
    hsize_t bytes = table_bytes(&t->history.table) + table_bytes(&t->events);
    for (dem_index k = 0; k < t->options.n_probes; k++) bytes += table_bytes(&t->probes[k].table);
    return bytes;
}

static hsize_t start_bytes(const dem_model *model)
{
    const dem_model_size size = dem_model_sizes(model);
    return 104 * (hsize_t)size.n_nodes + 65 * (hsize_t)size.n_springs + 56 * (hsize_t)size.n_triangles +
           32 * (hsize_t)size.n_segments + 4096 * (hsize_t)size.n_obstacles;
}

static dem_status on_frame(void *context, const dem_simulation *simulation)
{
    dem_trajectory *t = context;
    dem_state state = {.struct_size = sizeof state};
    hdf5_file file;
    CHECK(!t->finished, DEM_ERROR_ARGUMENT, "%s is finished and takes no more frames", t->path);
    dem_simulation_state(simulation, &state);
    if (t->frames.n > 0 && state.t == t->frames.last) return DEM_OK;
    TRY(hdf5_open_write(&file, t->part, tables_bytes(t) + frames_bytes(&t->frames)));
    TRY(hdf5_close(&file, append_frame(t, &file, simulation)));
    t->frames.n++;
    t->frames.last = state.t;
    return DEM_OK;
}

static dem_status flush(dem_trajectory *t)
{
    hdf5_file file;
    TRY(hdf5_open_write(&file, t->part, tables_bytes(t)));
    return hdf5_close(&file, flush_tables(t, &file));
}

static dem_status on_step(void *context, const dem_simulation *simulation)
{
    dem_trajectory *t = context;
    CHECK(!t->finished, DEM_ERROR_ARGUMENT, "%s is finished and takes no more steps", t->path);
    if (t->history.table.buffered == TABLE_ROWS) TRY(flush(t)); /* no probe has more rows */
    history_record(&t->history, simulation);
    for (dem_index k = 0; k < t->options.n_probes; k++) probe_record(&t->probes[k], simulation);
    return DEM_OK;
}

static dem_status on_event(void *context, const dem_simulation *simulation, const dem_event *event)
{
    dem_trajectory *t = context;
    (void)simulation;
    CHECK(!t->finished, DEM_ERROR_ARGUMENT, "%s is finished and takes no more events", t->path);
    if (t->events.buffered == TABLE_ROWS) TRY(flush(t));
    events_record(&t->events, event);
    return DEM_OK;
}

/* ---- creation ---- */

static dem_status write_start(const dem_trajectory *t, const hdf5_file *file, const dem_model *model)
{
    const dem_lattice *lattice = dem_model_lattice(model);
    if (t->options.frame_interval > 0.0) TRY(frames_create(&t->frames, file, lattice));
    TRY(lattice_file_write(file, lattice, t->options.deflate));
    TRY(obstacle_file_write(file, model));
    if (t->options.events) TRY(events_create(&t->events, file));
    for (dem_index k = 0; k < t->options.n_probes; k++) TRY(probe_create(&t->probes[k], file));
    return table_create(&t->history.table, file);
}

static dem_status start(const dem_trajectory *t, const dem_model *model)
{
    hdf5_file file;
    dem_status status = hdf5_open_new(&file, t->part, start_bytes(model));
    if (status == DEM_OK) status = hdf5_close(&file, write_start(t, &file, model));
    if (status == DEM_OK && t->n_obstacles > 0)
        status = obstacle_file_publish(t->obstacle_part, t->obstacle, model, t->options.deflate);
    if (status != DEM_OK) (void)unlink(t->part);
    return status;
}

static dem_status check_options(const char *path, const dem_trajectory_options *options)
{
    const size_t length = strlen(path), end = sizeof suffix - 1;
    CHECK(length > end && strcmp(path + length - end, suffix) == 0 && path[length - end - 1] != '/', DEM_ERROR_ARGUMENT,
          "%s: the name of a trajectory ends in %s", path, suffix);
    CHECK(options->struct_size == sizeof *options, DEM_ERROR_ARGUMENT,
          "the options are not from dem_trajectory_options_default()");
    CHECK(isfinite(options->frame_interval), DEM_ERROR_ARGUMENT, "frame_interval is not a finite number");
    CHECK((options->fields & ~(uint32_t)DEM_FIELD_ALL) == 0, DEM_ERROR_ARGUMENT, "fields is 0x%x, with unknown bits",
          options->fields);
    CHECK(options->n_probes >= 0 && (options->n_probes == 0 || options->probes != NULL), DEM_ERROR_ARGUMENT,
          "%lld probes, probes is %s", (long long)options->n_probes, options->probes != NULL ? "given" : "NULL");
    CHECK(options->most_stressed >= 0, DEM_ERROR_ARGUMENT, "most_stressed is %lld; it must be >= 0",
          (long long)options->most_stressed);
    CHECK(options->deflate >= 0 && options->deflate <= 9, DEM_ERROR_ARGUMENT, "deflate is %d, not in 0 to 9",
          options->deflate);
    return DEM_OK;
}

static dem_status make_names(dem_trajectory *t, const char *path)
{
    const size_t size = strlen(path) + sizeof ".obstacle.part";
    const int stem = (int)(strlen(path) - (sizeof suffix - 1));
    t->path = malloc(4 * size);
    CHECK_MEMORY(t->path);
    t->part = t->path + size;
    t->obstacle = t->part + size;
    t->obstacle_part = t->obstacle + size;
    (void)snprintf(t->path, size, "%s", path);
    (void)snprintf(t->part, size, "%.*s.part%s", stem, path, suffix);
    (void)snprintf(t->obstacle, size, "%.*s.obstacle%s", stem, path, suffix);
    (void)snprintf(t->obstacle_part, size, "%.*s.obstacle.part%s", stem, path, suffix);
    return DEM_OK;
}

static dem_status make_probes(dem_trajectory *t)
{
    const dem_probe *given = t->options.probes;
    t->probes = calloc((size_t)t->options.n_probes + 1, sizeof *t->probes);
    CHECK_MEMORY(t->probes);
    for (dem_index k = 0; k < t->options.n_probes; k++) {
        TRY(probe_init(&t->probes[k], &given[k], t->lattice));
        for (dem_index q = 0; q < k; q++)
            CHECK(strcmp(given[q].name, given[k].name) != 0, DEM_ERROR_ARGUMENT, "two probes have the name %s",
                  given[k].name);
    }
    return DEM_OK;
}

static dem_status prepare(dem_trajectory *t, const char *path, const dem_simulation *simulation)
{
    const dem_model *model = dem_simulation_model(simulation);
    t->lattice = dem_model_lattice(model);
    t->n_obstacles = dem_model_sizes(model).n_obstacles;
    TRY(make_names(t, path));
    TRY(frames_init(&t->frames, model, &t->options));
    TRY(make_probes(t));
    if (t->options.events) TRY(events_init(&t->events));
    return history_init(&t->history, simulation);
}

/* ---- the end ---- */

static dem_status write_peaks(const dem_trajectory *t, const hdf5_file *file, const peaks_report *report)
{
    if (t->frames.n > 0) TRY(peaks_file_write_arrays(file, report, &t->frames));
    return peaks_file_write_lists(file, report);
}

static dem_status complete(dem_trajectory *t)
{
    const peaks_report report = {t->options.peaks, t->lattice, t->options.most_stressed};
    hdf5_file file;
    TRY(flush(t));
    if (report.peaks == NULL) return DEM_OK;
    TRY(hdf5_open_write(&file, t->part, peaks_file_bytes(&report, &t->frames)));
    return hdf5_close(&file, write_peaks(t, &file, &report));
}

static dem_status verify_counts(const dem_trajectory *t, const hdf5_file *file)
{
    TRY(table_verify(&t->history.table, file));
    TRY(table_verify(&t->events, file));
    for (dem_index k = 0; k < t->options.n_probes; k++) TRY(table_verify(&t->probes[k].table, file));
    if (t->options.frame_interval <= 0.0) return DEM_OK;
    return frames_verify(&t->frames, file);
}

static dem_status verify(const dem_trajectory *t)
{
    hdf5_file file;
    TRY(hdf5_open_read(&file, t->part));
    return hdf5_close(&file, verify_counts(t, &file));
}

/* ---- notes ---- */

static dem_status name_note(char *out, size_t size, const char *name)
{
    CHECK(*name != '\0' && strpbrk(name, "/.") == NULL && strlen(name) < 64, DEM_ERROR_ARGUMENT,
          "\"%s\" cannot name a note: 1 to 63 characters, none of them / or .", name);
    (void)snprintf(out, size, "/provenance/%s", name);
    return DEM_OK;
}

/* ---- public ---- */

dem_status dem_trajectory_create(dem_trajectory **out, const char *path, const dem_simulation *simulation,
                                 const dem_trajectory_options *options)
{
    CHECK(out != NULL && path != NULL && simulation != NULL && options != NULL, DEM_ERROR_ARGUMENT,
          "dem_trajectory_create: an argument is NULL");
    TRY(check_options(path, options));
    const dem_model *model = dem_simulation_model(simulation);
    dem_trajectory *t = calloc(1, sizeof *t);
    CHECK_MEMORY(t);
    t->options = *options;
    dem_status status = prepare(t, path, simulation);
    if (status == DEM_OK) status = start(t, model);
    if (status == DEM_OK)
        *out = t;
    else
        dem_trajectory_destroy(t);
    return status;
}

dem_observer dem_trajectory_observer(dem_trajectory *trajectory)
{
    return (dem_observer){trajectory->options.frame_interval,           on_frame, on_step,
                          trajectory->options.events ? on_event : NULL, NULL,     trajectory};
}

dem_status dem_trajectory_note(dem_trajectory *trajectory, const char *name, const char *text)
{
    char path[96];
    hdf5_file file;
    CHECK(trajectory != NULL && name != NULL && text != NULL, DEM_ERROR_ARGUMENT,
          "dem_trajectory_note: an argument is NULL");
    CHECK(!trajectory->finished, DEM_ERROR_ARGUMENT, "%s is finished and takes no more notes", trajectory->path);
    TRY(name_note(path, sizeof path, name));
    TRY(hdf5_open_write(&file, trajectory->part, strlen(text)));
    return hdf5_close(&file, hdf5_write_text(&file, path, text));
}

dem_status dem_trajectory_finish(dem_trajectory *trajectory)
{
    CHECK(trajectory != NULL, DEM_ERROR_ARGUMENT, "dem_trajectory_finish: trajectory is NULL");
    CHECK(!trajectory->finished, DEM_ERROR_ARGUMENT, "%s is finished already", trajectory->path);
    TRY(complete(trajectory));
    TRY(verify(trajectory));
    TRY(hdf5_publish(trajectory->part, trajectory->path));
    trajectory->finished = 1;
    return DEM_OK;
}

void dem_trajectory_destroy(dem_trajectory *trajectory)
{
    if (trajectory == NULL) return;
    history_free(&trajectory->history);
    table_free(&trajectory->events);
    for (dem_index k = 0; trajectory->probes != NULL && k < trajectory->options.n_probes; k++)
        probe_free(&trajectory->probes[k]);
    free(trajectory->probes);
    frames_free(&trajectory->frames);
    free(trajectory->path);
    free(trajectory);
}

dem_status dem_trajectory_read_note(const char *path, const char *name, char *text, size_t size)
{
    char full[96];
    hdf5_file file;
    CHECK(path != NULL && name != NULL && text != NULL, DEM_ERROR_ARGUMENT,
          "dem_trajectory_read_note: an argument is NULL");
    TRY(name_note(full, sizeof full, name));
    TRY(hdf5_open_read(&file, path));
    return hdf5_close(&file, hdf5_read_text(&file, full, text, size));
}

const char *dem_version_hdf5(void)
{
    static _Thread_local char version[32];
    unsigned major = 0, minor = 0, release = 0;
    (void)H5get_libversion(&major, &minor, &release);
    (void)snprintf(version, sizeof version, "%u.%u.%u", major, minor, release);
    return version;
}
