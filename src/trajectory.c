/* SPDX-License-Identifier: BSD-3-Clause */
/* A run as a VTKHDF file: which dataset is where, and when it is written. docs/output.md lists them all. */
#include <dem/trajectory.h>

#include "events.h"
#include "grid.h"
#include "hdf5_file.h"
#include "history.h"
#include "lattice_file.h"
#include "obstacle_file.h"
#include "status.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define STEPS GRID "Steps/"

struct dem_trajectory {
    char *path, *part, *obstacle, *obstacle_part; /* names: one allocation */
    dem_trajectory_options options;
    dem_index n_nodes, n_springs, n_obstacles;
    dem_index frames;
    double last; /* t of the last frame, s */
    int finished;
    double *scratch; /* [3 max(n_nodes, n_springs)] */
    history history;
    table events; /* without columns unless wanted */
};

static const char suffix[] = ".vtkhdf";

/* ---- what is written at every frame ---- */

enum of { NONE, ONE, NODES, SPRINGS };

enum array { POINTS, DISPLACEMENT, VELOCITY, STRAIN, FORCE, BROKEN, N_ARRAYS };

static const struct array_layout {
    const char *name;
    hdf5_kind kind; /* HDF5_F32: as the options say */
    enum of of;
    int components;
} arrays[N_ARRAYS] = {
    [POINTS] = {GRID "Points", HDF5_F64, NODES, 3},
    [DISPLACEMENT] = {GRID "PointData/displacement", HDF5_F32, NODES, 3},
    [VELOCITY] = {GRID "PointData/velocity", HDF5_F32, NODES, 3},
    [STRAIN] = {GRID "CellData/strain", HDF5_F32, SPRINGS, 1},
    [FORCE] = {GRID "CellData/force", HDF5_F32, SPRINGS, 1},
    [BROKEN] = {GRID "CellData/broken", HDF5_U8, SPRINGS, 1},
};

/* In the order of field_values(). */
static const char *const fields[] = {
    GRID "FieldData/kinetic_energy",  GRID "FieldData/elastic_energy", GRID "FieldData/area_energy",
    GRID "FieldData/guard_energy",    GRID "FieldData/gravity_energy", GRID "FieldData/impact_energy",
    GRID "FieldData/friction_energy", GRID "FieldData/damping_energy", GRID "FieldData/projection_energy",
    GRID "FieldData/boundary_energy", GRID "FieldData/contacts",
};
enum { N_FIELDS = sizeof fields / sizeof fields[0] };

/* Where the data of frame f begin: at row f times the number of what they tell of. */
static const struct offset {
    const char *name;
    int rank;
    enum of of;
} offsets[] = {
    {STEPS "PartOffsets", 1, NONE},
    {STEPS "PointOffsets", 1, NODES},
    {STEPS "CellOffsets", 2, NONE},
    {STEPS "ConnectivityIdOffsets", 2, NONE},
    {STEPS "PointDataOffsets/displacement", 1, NODES},
    {STEPS "PointDataOffsets/velocity", 1, NODES},
    {STEPS "PointDataOffsets/id", 1, NONE},
    {STEPS "PointDataOffsets/body", 1, NONE},
    {STEPS "CellDataOffsets/strain", 1, SPRINGS},
    {STEPS "CellDataOffsets/force", 1, SPRINGS},
    {STEPS "CellDataOffsets/broken", 1, SPRINGS},
    {STEPS "FieldDataOffsets/kinetic_energy", 1, ONE},
    {STEPS "FieldDataOffsets/elastic_energy", 1, ONE},
    {STEPS "FieldDataOffsets/area_energy", 1, ONE},
    {STEPS "FieldDataOffsets/guard_energy", 1, ONE},
    {STEPS "FieldDataOffsets/gravity_energy", 1, ONE},
    {STEPS "FieldDataOffsets/impact_energy", 1, ONE},
    {STEPS "FieldDataOffsets/friction_energy", 1, ONE},
    {STEPS "FieldDataOffsets/damping_energy", 1, ONE},
    {STEPS "FieldDataOffsets/projection_energy", 1, ONE},
    {STEPS "FieldDataOffsets/boundary_energy", 1, ONE},
    {STEPS "FieldDataOffsets/contacts", 1, ONE},
};
enum { N_OFFSETS = sizeof offsets / sizeof offsets[0] };

static dem_index count_of(const dem_trajectory *t, enum of of)
{
    const dem_index count[] = {[NONE] = 0, [ONE] = 1, [NODES] = t->n_nodes, [SPRINGS] = t->n_springs};
    return count[of];
}

/* A chunk is a frame, so that no frame touches another's. */
static hdf5_rows array_rows(const dem_trajectory *t, enum array a)
{
    const struct array_layout *l = &arrays[a];
    const hdf5_kind kind = l->kind == HDF5_F32 && t->options.double_precision ? HDF5_F64 : l->kind;
    return (hdf5_rows){
        l->name,           kind, l->components > 1 ? 2 : 1, {(hsize_t)l->components}, (hsize_t)count_of(t, l->of),
        t->options.deflate};
}

/* One row a frame. Chunks of several rows, stored plain, are rewritten in place with the same bytes. */
static hdf5_rows frame_rows(const char *name, hdf5_kind kind, int rank)
{
    return (hdf5_rows){name, kind, rank, {1}, 64, 0};
}

static dem_status create_frames(const dem_trajectory *t, const hdf5_file *file)
{
    for (int a = 0; a < N_ARRAYS; a++) {
        const hdf5_rows rows = array_rows(t, (enum array)a);
        TRY(hdf5_create(file, &rows));
    }
    for (int f = 0; f < N_FIELDS; f++) {
        const hdf5_rows rows = frame_rows(fields[f], HDF5_F64, 1);
        TRY(hdf5_create(file, &rows));
    }
    for (int o = 0; o < N_OFFSETS; o++) {
        const hdf5_rows rows = frame_rows(offsets[o].name, HDF5_I64, offsets[o].rank);
        TRY(hdf5_create(file, &rows));
    }
    const hdf5_rows values = frame_rows(STEPS "Values", HDF5_F64, 1);
    const hdf5_rows parts = frame_rows(STEPS "NumberOfParts", HDF5_I64, 1);
    TRY(hdf5_create(file, &values));
    TRY(hdf5_create(file, &parts));
    return hdf5_write_attribute(file, "/VTKHDF/Steps", "NSteps", HDF5_I64, 1, &(dem_index){0});
}

static dem_status append_array(const dem_trajectory *t, const hdf5_file *file, enum array a)
{
    const hdf5_rows rows = array_rows(t, a);
    const hsize_t count = (hsize_t)count_of(t, arrays[a].of);
    return hdf5_append(file, &rows, (hsize_t)t->frames * count, count, t->scratch);
}

/* The plane lies at z = 0 of space. */
static void spread(double *out, dem_index n, const double *values, const double *less)
{
    for (dem_index i = 0; i < n; i++)
        for (int d = 0; d < 3; d++)
            out[3 * i + d] = d == 2 ? 0.0 : values[2 * i + d] - (less != NULL ? less[2 * i + d] : 0.0);
}

static dem_status append_arrays(const dem_trajectory *t, const hdf5_file *file, const dem_simulation *simulation,
                                const dem_state *state)
{
    const dem_lattice *lattice = dem_model_lattice(dem_simulation_model(simulation));
    spread(t->scratch, t->n_nodes, state->x, NULL);
    TRY(append_array(t, file, POINTS));
    spread(t->scratch, t->n_nodes, state->x, lattice->x);
    TRY(append_array(t, file, DISPLACEMENT));
    spread(t->scratch, t->n_nodes, state->v, NULL);
    TRY(append_array(t, file, VELOCITY));
    dem_simulation_strains(simulation, t->scratch);
    TRY(append_array(t, file, STRAIN));
    for (dem_index k = 0; k < t->n_springs; k++) t->scratch[k] *= lattice->stiffness[k];
    TRY(append_array(t, file, FORCE));
    memset(t->scratch, 0, (size_t)t->n_springs); /* springs do not break yet */
    return append_array(t, file, BROKEN);
}

static dem_status append_fields(const dem_trajectory *t, const hdf5_file *file, const dem_state *state)
{
    const dem_energy *e = &state->energy;
    const double values[] = {e->kinetic,
                             e->elastic,
                             e->area,
                             e->guard,
                             e->gravity,
                             e->impact,
                             e->friction,
                             e->damping,
                             e->projection,
                             e->boundary,
                             (double)state->n_contacts};
    for (int f = 0; f < N_FIELDS; f++) {
        const hdf5_rows rows = frame_rows(fields[f], HDF5_F64, 1);
        TRY(hdf5_append(file, &rows, (hsize_t)t->frames, 1, &values[f]));
    }
    return DEM_OK;
}

static dem_status append_steps(const dem_trajectory *t, const hdf5_file *file, double time)
{
    const hdf5_rows values = frame_rows(STEPS "Values", HDF5_F64, 1);
    const hdf5_rows parts = frame_rows(STEPS "NumberOfParts", HDF5_I64, 1);
    for (int o = 0; o < N_OFFSETS; o++) {
        const hdf5_rows rows = frame_rows(offsets[o].name, HDF5_I64, offsets[o].rank);
        const dem_index begin = t->frames * count_of(t, offsets[o].of);
        TRY(hdf5_append(file, &rows, (hsize_t)t->frames, 1, &begin));
    }
    TRY(hdf5_append(file, &parts, (hsize_t)t->frames, 1, &(dem_index){1}));
    return hdf5_append(file, &values, (hsize_t)t->frames, 1, &time);
}

static dem_status flush_tables(dem_trajectory *t, const hdf5_file *file)
{
    TRY(table_flush(&t->history.table, file));
    return table_flush(&t->events, file);
}

/* The count of steps comes last: readers believe it. */
static dem_status append_frame(dem_trajectory *t, const hdf5_file *file, const dem_simulation *simulation,
                               const dem_state *state)
{
    const dem_index steps = t->frames + 1;
    TRY(flush_tables(t, file));
    TRY(append_arrays(t, file, simulation, state));
    TRY(append_fields(t, file, state));
    TRY(append_steps(t, file, state->t));
    return hdf5_write_attribute(file, "/VTKHDF/Steps", "NSteps", HDF5_I64, 1, &steps);
}

/* Bounds of what is added, in bytes: deflate never lengthens. */
static hsize_t tables_bytes(const dem_trajectory *t)
{
    return table_bytes(&t->history.table) + table_bytes(&t->events);
}

static hsize_t frame_bytes(const dem_trajectory *t)
{
    return tables_bytes(t) + 72 * (hsize_t)t->n_nodes + 17 * (hsize_t)t->n_springs;
}

static hsize_t start_bytes(const dem_model *model)
{
    const dem_model_size size = dem_model_sizes(model);
    return 104 * (hsize_t)size.n_nodes + 65 * (hsize_t)size.n_springs + 32 * (hsize_t)size.n_triangles +
           32 * (hsize_t)size.n_segments + 4096 * (hsize_t)size.n_obstacles;
}

static dem_status on_frame(void *context, const dem_simulation *simulation)
{
    dem_trajectory *t = context;
    dem_state state = {.struct_size = sizeof state};
    hdf5_file file;
    CHECK(!t->finished, DEM_ERROR_ARGUMENT, "%s is finished and takes no more frames", t->path);
    dem_simulation_state(simulation, &state);
    if (t->frames > 0 && state.t == t->last) return DEM_OK;
    TRY(hdf5_open_write(&file, t->part, frame_bytes(t)));
    TRY(hdf5_close(&file, append_frame(t, &file, simulation, &state)));
    t->frames++;
    t->last = state.t;
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
    if (t->history.table.buffered == TABLE_ROWS) TRY(flush(t));
    history_record(&t->history, simulation);
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

static dem_status write_constants(const hdf5_file *file, const dem_lattice *lattice, int deflate)
{
    const size_t n = (size_t)lattice->n_nodes;
    const hdf5_rows body = {GRID "PointData/body", HDF5_I32, 1, {0}, 0, deflate};
    const hdf5_rows number = {GRID "PointData/id", HDF5_I64, 1, {0}, 0, deflate};
    dem_index *id = malloc(n * sizeof *id);
    CHECK_MEMORY(id);
    for (dem_index i = 0; i < lattice->n_nodes; i++) id[i] = i;
    const dem_status status = hdf5_write(file, number, n, id);
    free(id);
    TRY(status);
    return hdf5_write(file, body, n, lattice->body);
}

static dem_status write_vtk(const dem_trajectory *t, const hdf5_file *file, const dem_lattice *lattice)
{
    const grid g = {t->n_nodes, t->n_springs, lattice->ends};
    TRY(grid_write(file, &g, t->options.deflate));
    TRY(write_constants(file, lattice, t->options.deflate));
    return create_frames(t, file);
}

static dem_status write_start(const dem_trajectory *t, const hdf5_file *file, const dem_model *model)
{
    const dem_lattice *lattice = dem_model_lattice(model);
    if (t->options.frame_interval > 0.0) TRY(write_vtk(t, file, lattice));
    TRY(lattice_file_write(file, lattice, t->options.deflate));
    TRY(obstacle_file_write(file, model));
    if (t->options.events) TRY(events_create(&t->events, file));
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

static dem_status prepare(dem_trajectory *t, const char *path, const dem_simulation *simulation)
{
    const dem_model_size size = dem_model_sizes(dem_simulation_model(simulation));
    const dem_index largest = size.n_nodes > size.n_springs ? size.n_nodes : size.n_springs;
    t->n_nodes = size.n_nodes;
    t->n_springs = size.n_springs;
    t->n_obstacles = size.n_obstacles;
    TRY(make_names(t, path));
    t->scratch = calloc((size_t)largest, 3 * sizeof *t->scratch);
    CHECK_MEMORY(t->scratch);
    if (t->options.events) TRY(events_init(&t->events));
    return history_init(&t->history, simulation);
}

/* ---- the end ---- */

static dem_status verify_counts(const dem_trajectory *t, const hdf5_file *file)
{
    TRY(table_verify(&t->history.table, file));
    TRY(table_verify(&t->events, file));
    if (t->options.frame_interval <= 0.0) return DEM_OK;
    for (int a = 0; a < N_ARRAYS; a++)
        TRY(hdf5_expect_rows(file, arrays[a].name, (hsize_t)(t->frames * count_of(t, arrays[a].of))));
    return hdf5_expect_attribute(file, "/VTKHDF/Steps", "NSteps", t->frames);
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
    return (dem_observer){trajectory->options.frame_interval, on_frame, on_step,
                          trajectory->options.events ? on_event : NULL, trajectory};
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
    TRY(flush(trajectory));
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
    free(trajectory->scratch);
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
