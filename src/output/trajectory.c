/* SPDX-License-Identifier: BSD-3-Clause */
/* A run as an observer that writes VTKHDF files: what is written when, what a checkpoint has to hold of it, and how a
 * run goes on with the same files (docs/output.md lists all datasets).
 *   accepted step    a row of the history and of the probes that are due, in memory
 *   event, break     a row of the events or breaks, in memory
 *   frame            writes buffered rows and the frame to the part, and flushes it: it may be looked at in between
 *   checkpoint       an entry with the numbers of rows, and with what the next rows depend on
 *   segment          cuts the rows of a checkpoint off, before the program publishes it
 *   finish           joins all rows and the peaks in one file
 * Which files there are, and that none of them is lost when the process is killed, is in trajectory_parts.c; what a
 * file contains is in trajectory_rows.c; reading back is in trajectory_reader.c. */
#include <dem/trajectory.h>

#include "base/rank_order.h"
#include "base/status.h"
#include "base/struct_size.h"
#include "output/body_file.h"
#include "output/hdf5_attribute.h"
#include "output/obstacle_file.h"
#include "output/trajectory_parts.h"
#include "output/vtk_grid.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct dem_trajectory {
    trajectory_rows rows;
    segments segments;
    hdf5_file part; /* paused, if it is open */
    bool open;
    int finished;
};

/* The name of the finished file, and that of the part which is written until then. */
static const char *path_of(const dem_trajectory *t)
{
    return t->segments.names[PARTS_WHOLE];
}

static const char *part_of(const dem_trajectory *t)
{
    return t->segments.names[PARTS_PART];
}

/* ---- the part ---- */

/* It may be open from the frame before. Room is reserved for so many bytes. */
static dem_status open_part(dem_trajectory *t, hsize_t bytes)
{
    if (t->open) return hdf5_resume(&t->part, bytes);
    TRY(hdf5_open_write(&t->part, part_of(t), bytes));
    t->part.team = t->rows.team;
    if (t->rows.options.stays_open) hdf5_keep(&t->part);
    return DEM_OK;
}

/* The file is whole on the disk then. After a failure it is opened anew the next time. */
static dem_status leave_part(dem_trajectory *t, dem_status status)
{
    if (!t->rows.options.stays_open) return hdf5_close(&t->part, status);
    status = hdf5_pause(&t->part, status);
    t->open = status == DEM_OK;
    return status;
}

/* Before the file is renamed or read. */
static dem_status close_part(dem_trajectory *t)
{
    if (!t->open) return DEM_OK;
    t->open = false;
    return hdf5_close_paused(&t->part);
}

/* ---- following a run ---- */

/* Buffered rows go first: a frame in the file has all rows of the history before it. */
static dem_status append_frame(dem_trajectory *t, const hdf5_file *file, const dem_simulation *simulation)
{
    TRY(trajectory_rows_flush(&t->rows, file));
    TRY(fragment_table_append(&t->rows.fragments, file, t->rows.frames.n));
    return frames_append(&t->rows.frames, file, simulation);
}

/* Adds rows and the frame to the part. Room for both is reserved by opening. The frame counts only if the part has been
 * flushed; a frame at the same instant again, as a resumed run shows it, is not added. */
static dem_status on_frame(void *context, const dem_simulation *simulation)
{
    dem_trajectory *t = context;
    frames *f = &t->rows.frames;
    dem_progress now = {.struct_size = sizeof now};
    CHECK(!t->finished, DEM_ERROR_ARGUMENT, "%s is finished and takes no more frames", path_of(t));
    TRY(dem_simulation_progress(simulation, &now));
    /* frames.before counts those in segments, so that the first frame of a resumed run is compared as well. */
    if (f->before + f->n > 0 && now.t == f->last) return DEM_OK;
    TRY(fragment_table_measure(&t->rows.fragments, simulation));
    const hsize_t of_fragments = fragment_table_bytes(&t->rows.fragments);
    /* While the part is closed, for the file of one stripe may be this process's. */
    TRY(trajectory_parts_append(&t->segments, &t->rows, simulation));
    TRY(open_part(t, trajectory_rows_flush_bytes(&t->rows) + of_fragments + frames_bytes(f)));
    TRY(leave_part(t, append_frame(t, &t->part, simulation)));
    f->n++;
    f->last = now.t;
    return DEM_OK;
}

/* Moves the buffered rows to the part. */
static dem_status flush(dem_trajectory *t)
{
    TRY(open_part(t, trajectory_rows_flush_bytes(&t->rows)));
    return leave_part(t, trajectory_rows_flush(&t->rows, &t->part));
}

/* All buffers are emptied when one is full. A probe may have more rows than the history, which has none of some
 * steps. */
static dem_status on_step(void *context, const dem_simulation *simulation)
{
    dem_trajectory *t = context;
    trajectory_rows *r = &t->rows;
    CHECK(!t->finished, DEM_ERROR_ARGUMENT, "%s is finished and takes no more steps", path_of(t));
    if (trajectory_rows_are_full(r)) TRY(flush(t));
    TRY(history_record(&r->history, simulation));
    for (dem_index k = 0; k < r->options.n_probes; k++) TRY(probe_record(&r->probes[k], simulation));
    return DEM_OK;
}

/* Events have a buffer of their own, since a step may have many. */
static dem_status on_event(void *context, const dem_simulation *simulation, const dem_event *event)
{
    dem_trajectory *t = context;
    (void)simulation;
    CHECK(!t->finished, DEM_ERROR_ARGUMENT, "%s is finished and takes no more events", path_of(t));
    if (t->rows.events.buffered == TABLE_ROWS) TRY(flush(t));
    event_table_record(&t->rows.events, event);
    return DEM_OK;
}

/* So have breaks, which may be many in a step, too. */
static dem_status on_break(void *context, const dem_simulation *simulation, const dem_break *what)
{
    dem_trajectory *t = context;
    (void)simulation;
    CHECK(!t->finished, DEM_ERROR_ARGUMENT, "%s is finished and takes no more breaks", path_of(t));
    history_forget(&t->rows.history);
    if (t->rows.breaks.buffered == TABLE_ROWS) TRY(flush(t));
    break_table_record(&t->rows.breaks, what);
    return DEM_OK;
}

/* Rows that are left go to the part, before it and its stripes are read or renamed. */
static dem_status close_files(dem_trajectory *t)
{
    TRY(flush(t));
    TRY(close_part(t));
    return stripes_close(&t->rows.stripes, &t->rows.frames);
}

/* ---- checkpoints ---- */

/* Names of the entries in a checkpoint. */
static const char entry[] = "trajectory", probes_entry[] = "trajectory.probes", interval_entry[] = "trajectory.history";

/* What a checkpoint keeps of a trajectory, as bytes of an entry. All members are of 8 bytes, so that there are no
 * gaps. */
typedef struct progress {
    int64_t rows[ROWS_PROBES]; /* so far, over all segments */
    int64_t n_probes, fields, double_precision, events, breaks,
        fragments; /* of the options, which have to be these again */
    double frame_interval;
    double last_frame, last_row; /* s */
    double start, largest;       /* J, of the history */
} progress;

/* Rows are counted over all files of the run and the buffers: a resumed run keeps exactly these and drops later
 * ones. */
static progress read_progress(const dem_trajectory *t)
{
    const trajectory_rows *r = &t->rows;
    const dem_trajectory_options *o = &r->options;
    progress m = {.n_probes = o->n_probes,
                  .fields = o->fields,
                  .double_precision = o->double_precision != 0,
                  .events = o->events != 0,
                  .breaks = o->breaks != 0,
                  .fragments = o->fragments != 0,
                  .frame_interval = o->frame_interval,
                  .last_frame = r->frames.last,
                  .last_row = r->history.last,
                  .start = r->history.start,
                  .largest = r->history.largest};
    /* Rows of probes are in entries of their own, since their number is not fixed. */
    for (int k = 0; k < ROWS_PROBES; k++) m.rows[k] = (int64_t)trajectory_rows_total(r, k);
    return m;
}

/* Only counts and sums are kept here. The rows themselves get into a segment by dem_trajectory_segment(), which a
 * program calls before it publishes the checkpoint. */
static dem_status on_checkpoint(void *context, const dem_simulation *simulation, dem_checkpoint *checkpoint)
{
    const dem_trajectory *t = context;
    const progress m = read_progress(t);
    const size_t n = (size_t)m.n_probes;
    (void)simulation;
    TRY(dem_checkpoint_put(checkpoint, entry, &m, sizeof m));
    TRY(dem_checkpoint_put(checkpoint, interval_entry, &t->rows.history.interval, sizeof t->rows.history.interval));
    if (n == 0) return DEM_OK;
    probe_progress *probes = malloc(n * sizeof *probes);
    CHECK_MEMORY(probes);
    for (size_t k = 0; k < n; k++) probes[k] = probe_progress_of(&t->rows.probes[k]);
    const dem_status status = dem_checkpoint_put(checkpoint, probes_entry, probes, n * sizeof *probes);
    free(probes);
    return status;
}

/* The rows of a run cannot change their columns half-way, so options that decide these must be the same. */
static dem_status check_same(const char *what, double now, double then)
{
    CHECK(now == then, DEM_ERROR_ARGUMENT, "%s is %.17g, in the run that is to go on it is %.17g", what, now, then);
    return DEM_OK;
}

static dem_status check_options_then(const progress *now, const progress *then)
{
    TRY(check_same("n_probes", (double)now->n_probes, (double)then->n_probes));
    TRY(check_same("fields", (double)now->fields, (double)then->fields));
    TRY(check_same("double_precision", (double)now->double_precision, (double)then->double_precision));
    TRY(check_same("events", (double)now->events, (double)then->events));
    TRY(check_same("breaks", (double)now->breaks, (double)then->breaks));
    TRY(check_same("fragments", (double)now->fragments, (double)then->fragments));
    return check_same("frame_interval", now->frame_interval, then->frame_interval);
}

/* Checkpoints of earlier versions have no such entry, and a row for every accepted step. */
static dem_status check_interval_then(const dem_trajectory *t, const dem_checkpoint *checkpoint)
{
    double then = 0.0;
    size_t size = 0;
    if (dem_checkpoint_find(checkpoint, interval_entry, &size) != NULL)
        TRY(dem_checkpoint_get(checkpoint, interval_entry, &then, sizeof then));
    return check_same("history_interval", t->rows.history.interval, then);
}

/* What a checkpoint says of this trajectory; the probes are a view into it. */
typedef struct checkpointed {
    progress progress;
    const probe_progress *probes; /* [n_probes] */
    hsize_t *rows;                /* [kinds] */
} checkpointed;

/* `rows` must be freed after a failure, too. */
static dem_status read_checkpoint(checkpointed *out, const dem_trajectory *t, const dem_checkpoint *checkpoint)
{
    const progress now = read_progress(t);
    const size_t n = (size_t)now.n_probes;
    size_t size = 0;
    *out = (checkpointed){.rows = calloc((size_t)t->rows.n_kinds, sizeof *out->rows)};
    CHECK_MEMORY(out->rows);
    TRY(dem_checkpoint_get(checkpoint, entry, &out->progress, sizeof out->progress));
    TRY(check_options_then(&now, &out->progress));
    TRY(check_interval_then(t, checkpoint));
    out->probes = dem_checkpoint_find(checkpoint, probes_entry, &size);
    CHECK(n == 0 || (out->probes != NULL && size == n * sizeof *out->probes), DEM_ERROR_IO,
          "the checkpoint has no entry %s of %zu probes", probes_entry, n);
    /* Kinds of rows are numbered frames, history, events, breaks, then the probes. */
    for (int k = 0; k < ROWS_PROBES; k++) out->rows[k] = (hsize_t)out->progress.rows[k];
    for (size_t k = 0; k < n; k++) out->rows[ROWS_PROBES + k] = (hsize_t)out->probes[k].rows;
    return DEM_OK;
}

/* ---- creation ---- */

/* The first version of the options ended with `probes`. */
static const struct_kind options_kind = {"dem_trajectory_options", STRUCT_SIZE_WITH(dem_trajectory_options, probes),
                                         sizeof(dem_trajectory_options)};

/* The suffix is needed to derive the names of parts and segments. */
static dem_status check_options(const char *path, const dem_trajectory_options *options)
{
    static const char suffix[] = PARTS_SUFFIX;
    const size_t length = strlen(path), end = sizeof suffix - 1;
    /* A suffix alone is no name. */
    CHECK(length > end && strcmp(path + length - end, suffix) == 0 && path[length - end - 1] != '/', DEM_ERROR_ARGUMENT,
          "%s: the name of a trajectory ends in %s", path, suffix);
    CHECK(isfinite(options->frame_interval), DEM_ERROR_ARGUMENT, "frame_interval is not a finite number");
    CHECK(isfinite(options->history_interval) && options->history_interval >= 0.0, DEM_ERROR_ARGUMENT,
          "history_interval is %g s; it must be >= 0, where 0 is every accepted step", options->history_interval);
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

static dem_status check_writers(const dem_simulation *simulation, int writers)
{
    const int ranks = rank_order_ranks(simulation);
    CHECK(writers >= 0 && (writers <= 1 || writers <= ranks), DEM_ERROR_ARGUMENT,
          "%d writers: there may be 1 to as many as ranks make the run, %d", writers, ranks);
    return DEM_OK;
}

/* Files have the rows of all nodes. */
static dem_status check_whole(const dem_simulation *simulation)
{
    dem_index n;
    const dem_index *number;
    const unsigned char *is_own;
    TRY(dem_model_part(dem_simulation_model(simulation), &n, &number, &is_own));
    CHECK(number == NULL, DEM_ERROR_ARGUMENT, "there is no trajectory of a model that ranks share yet");
    return DEM_OK;
}

/* A trajectory in memory, without files yet. The caller's options may be of another version of the library. */
static dem_status prepare(dem_trajectory **out, const char *path, const dem_simulation *simulation,
                          const dem_trajectory_options *options)
{
    CHECK(out != NULL && path != NULL && simulation != NULL && options != NULL, DEM_ERROR_ARGUMENT,
          "a trajectory: an argument is NULL");
    dem_trajectory_options own = dem_trajectory_options_default();
    TRY(struct_size_read(&options_kind, &own, options));
    TRY(check_whole(simulation));
    TRY(check_options(path, &own));
    TRY(check_writers(simulation, own.writers));
    dem_trajectory *t = calloc(1, sizeof *t);
    CHECK_MEMORY(t);
    dem_status status = trajectory_rows_init(&t->rows, simulation, &own);
    if (status == DEM_OK) status = trajectory_parts_init(&t->segments, path, &t->rows);
    if (status == DEM_OK)
        *out = t;
    else
        dem_trajectory_destroy(t);
    return status;
}

/* Leads ParaView to the triangles in a file of the run, if there are any. */
static dem_status show_bodies(const dem_trajectory *t, const char *in)
{
    char *const *names = t->segments.names;
    const frames *f = &t->rows.frames;
    if (f->n_triangles == 0 || t->rows.options.frame_interval <= 0.0) return DEM_OK;
    return body_file_publish(names[PARTS_BODY_PART], names[PARTS_BODY], in);
}

/* Makes the part and the files of obstacles and bodies, and removes segments that are younger than where the run
 * begins. Obstacles are drawn at t = 0 for now; draw_moving() replaces the file at the end. */
static dem_status start(dem_trajectory *t)
{
    const trajectory_rows *r = &t->rows;
    const segments *s = &t->segments;
    TRY(trajectory_parts_open(s, r));
    dem_status status = DEM_OK;
    dem_model_size size = {.struct_size = sizeof size};
    (void)dem_model_sizes(r->model, &size);
    if (size.n_obstacles > 0)
        status = obstacle_file_publish(s->names[PARTS_OBSTACLE_PART], s->names[PARTS_OBSTACLE], r->model,
                                       (obstacle_file_times){0, NULL}, r->options.deflate);
    if (status == DEM_OK) status = show_bodies(t, part_of(t));
    if (status == DEM_OK) status = trajectory_parts_prune(&t->segments);
    if (status != DEM_OK) (void)unlink(part_of(t));
    return status;
}

/* Gives the trajectory to the caller, or destroys what has failed to start. */
static dem_status hand_out(dem_trajectory **out, dem_trajectory *t, dem_status status)
{
    if (status == DEM_OK)
        *out = t;
    else
        dem_trajectory_destroy(t);
    return status;
}

/* Takes the place of a run from its checkpoint. The history's last instant is known before the segments are looked for:
 * they must end with it. */
static dem_status go_on(dem_trajectory *t, const dem_checkpoint *checkpoint)
{
    checkpointed then;
    trajectory_rows *r = &t->rows;
    dem_status status = read_checkpoint(&then, t, checkpoint);
    for (dem_index k = 0; k < r->options.n_probes && status == DEM_OK; k++)
        status = probe_restore(&r->probes[k], &then.probes[k]);
    if (status == DEM_OK) {
        r->frames.last = then.progress.last_frame;
        r->history.last = then.progress.last_row;
        r->history.start = then.progress.start;
        r->history.largest = then.progress.largest;
        status = trajectory_parts_find(&t->segments, r, then.rows);
    }
    free(then.rows);
    return status == DEM_OK ? start(t) : status;
}

/* ---- public ---- */

dem_status dem_trajectory_create(dem_trajectory **out, const char *path, const dem_simulation *simulation,
                                 const dem_trajectory_options *options)
{
    dem_trajectory *t = NULL;
    TRY(prepare(&t, path, simulation, options));
    return hand_out(out, t, start(t));
}

dem_status dem_trajectory_resume(dem_trajectory **out, const char *path, const dem_simulation *simulation,
                                 const dem_trajectory_options *options, const dem_checkpoint *checkpoint)
{
    dem_trajectory *t = NULL;
    CHECK(checkpoint != NULL, DEM_ERROR_ARGUMENT, "dem_trajectory_resume: the checkpoint is NULL");
    TRY(prepare(&t, path, simulation, options));
    return hand_out(out, t, go_on(t, checkpoint));
}

/* Without `events` or `breaks` the simulation need not report any; without probes, which count steps, it need not show
 * those without a row. */
dem_status dem_trajectory_observer(dem_trajectory *trajectory, dem_observer *out)
{
    CHECK(trajectory != NULL && out != NULL, DEM_ERROR_ARGUMENT, "dem_trajectory_observer: %s is NULL",
          trajectory ? "out" : "trajectory");
    const dem_observer own = {.interval = trajectory->rows.options.frame_interval,
                              .frame = on_frame,
                              .step = on_step,
                              .event = trajectory->rows.options.events ? on_event : NULL,
                              .broken = trajectory->rows.options.breaks ? on_break : NULL,
                              .checkpoint = on_checkpoint,
                              .context = trajectory,
                              .step_interval =
                                  trajectory->rows.options.n_probes == 0 ? trajectory->rows.history.interval : 0.0};
    return struct_size_write(&STRUCT_KIND(dem_observer), out, &own);
}

/* Written to the part at once, and kept in memory for the files that follow. */
dem_status dem_trajectory_note(dem_trajectory *trajectory, const char *name, const char *text)
{
    char path[PROVENANCE_PATH];
    CHECK(trajectory != NULL && name != NULL && text != NULL, DEM_ERROR_ARGUMENT,
          "dem_trajectory_note: an argument is NULL");
    CHECK(!trajectory->finished, DEM_ERROR_ARGUMENT, "%s is finished and takes no more notes", path_of(trajectory));
    TRY(provenance_path(path, name));
    /* The room for the header of a dataset is within what hdf5_open_write() adds. */
    TRY(open_part(trajectory, strlen(text)));
    TRY(leave_part(trajectory, hdf5_write_text(&trajectory->part, path, text)));
    return provenance_put(&trajectory->rows.provenance, path, text);
}

/* To be called before the checkpoint is published: afterwards all rows that it counts are in files under final
 * names. */
dem_status dem_trajectory_segment(dem_trajectory *trajectory, const dem_checkpoint *checkpoint)
{
    checkpointed then;
    CHECK(trajectory != NULL && checkpoint != NULL, DEM_ERROR_ARGUMENT, "dem_trajectory_segment: an argument is NULL");
    CHECK(!trajectory->finished, DEM_ERROR_ARGUMENT, "%s is finished and takes no more segments", path_of(trajectory));
    TRY(close_files(trajectory));
    dem_status status = read_checkpoint(&then, trajectory, checkpoint);
    if (status == DEM_OK) status = trajectory_parts_cut(&trajectory->segments, &trajectory->rows, then.rows);
    free(then.rows);
    return status;
}

/* The times of all frames, from the finished file; *out must be freed, after a failure too. */
static dem_status read_times(const dem_trajectory *t, double **out, dem_index *n)
{
    hdf5_file file;
    const hdf5_rows rows = {STEPS "/Values", HDF5_F64, 1, {0}, 0, 0};
    /* After joining the whole has all frames of the run. */
    *n = (dem_index)trajectory_rows_total(&t->rows, ROWS_FRAMES);
    *out = malloc(((size_t)*n + 1) * sizeof **out);
    CHECK_MEMORY(*out);
    TRY(hdf5_open_read(&file, path_of(t)));
    return hdf5_close(&file, hdf5_read(&file, &rows, 0, (hsize_t)*n, *out));
}

/* Draws obstacles where they are at each frame, if some of them move. */
static dem_status draw_moving(const dem_trajectory *t)
{
    char *const *names = t->segments.names;
    double *times = NULL;
    dem_index n = 0;
    if (!obstacle_file_moves(t->rows.model)) return DEM_OK;
    dem_status status = read_times(t, &times, &n);
    if (status == DEM_OK)
        status = obstacle_file_publish(names[PARTS_OBSTACLE_PART], names[PARTS_OBSTACLE], t->rows.model,
                                       (obstacle_file_times){n, times}, t->rows.options.deflate);
    free(times);
    return status;
}

/* Rows that are left, then the whole file, then what is beside it. The whole is published before the parts are
 * removed. */
dem_status dem_trajectory_finish(dem_trajectory *trajectory)
{
    CHECK(trajectory != NULL, DEM_ERROR_ARGUMENT, "dem_trajectory_finish: trajectory is NULL");
    CHECK(!trajectory->finished, DEM_ERROR_ARGUMENT, "%s is finished already", path_of(trajectory));
    TRY(close_files(trajectory));
    TRY(trajectory_parts_join(&trajectory->segments, &trajectory->rows));
    trajectory->finished = 1;
    TRY(show_bodies(trajectory, path_of(trajectory)));
    return draw_moving(trajectory);
}

void dem_trajectory_destroy(dem_trajectory *trajectory)
{
    if (trajectory == NULL) return;
    (void)close_part(trajectory);
    trajectory_rows_free(&trajectory->rows);
    trajectory_parts_free(&trajectory->segments);
    free(trajectory);
}

/* Reads a text of a file that this library has written. */
dem_status dem_trajectory_read_note(const char *path, const char *name, char *text, size_t size)
{
    char full[PROVENANCE_PATH];
    hdf5_file file;
    CHECK(path != NULL && name != NULL && text != NULL, DEM_ERROR_ARGUMENT,
          "dem_trajectory_read_note: an argument is NULL");
    TRY(provenance_path(full, name));
    TRY(hdf5_open_read(&file, path));
    return hdf5_close(&file, hdf5_read_text(&file, full, text, size));
}

/* HDF5 would clean up at the exit of the process, where files must be closed already; the program decides. */
void dem_hdf5_skip_exit(void)
{
    (void)H5dont_atexit();
}

const char *dem_version_hdf5(void)
{
    static _Thread_local char version[32];
    unsigned major = 0, minor = 0, release = 0;
    (void)H5get_libversion(&major, &minor, &release);
    (void)snprintf(version, sizeof version, "%u.%u.%u", major, minor, release);
    return version;
}
