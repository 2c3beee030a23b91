/* SPDX-License-Identifier: BSD-3-Clause */
/* trajectory_reader.c: what an observer beside the trajectory saw is what is read back; damaged files are refused. */
#include "verification/support.h"

#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <dem/reader.h>
#include <dem/trajectory.h>

#include "harness/cleanup_hdf5.h"
#include "output/hdf5_rows.h"
#include "harness/motion.h"
#include "unit/solids.h"
#include "unit/scratch.h"

static const double interval = 1e-4;
enum { MOST_SHOTS = 16 };

static const dem_probe probes[] = {{"corner", DEM_PROBE_NODE, {3, 0}, 1}, {"width", DEM_PROBE_GAUGE, {0, 3}, 3}};
static const double hill[6] = {-1.0, -0.001, 0.0, 0.0, 1.0, 0.0}, far[4] = {4.0, -1.0, 5.0, -1.0};

/* ---- a run, and what was seen of it ---- */

typedef struct shot {
    double t;
    double *x, *v, *stress, *strain, *force;
    unsigned char *broken; /* [n_triangles] */
} shot;

typedef struct run {
    scratch_folder folder;
    const char *path, *part, *segment, *obstacle;
    dem_model *model;
    dem_simulation *simulation;
    dem_trajectory *trajectory;
    dem_peaks *peaks;
    shot shots[MOST_SHOTS];
    dem_index n_shots;
} run;

static double *copy_of(const double *values, dem_index n)
{
    double *copy = calloc((size_t)n + 1, sizeof *copy);
    assert_non_null(copy);
    if (values != NULL) memcpy(copy, values, (size_t)n * sizeof *copy);
    return copy;
}

static unsigned char *flags_of(dem_index n)
{
    unsigned char *flags = calloc((size_t)n + 1, sizeof *flags);
    assert_non_null(flags);
    return flags;
}

static dem_status see_frame(void *context, const dem_simulation *simulation)
{
    run *r = context;
    const dem_model_size size = ask_sizes(r->model);
    motion state;
    motion_see(simulation, &state);
    assert_true(r->n_shots < MOST_SHOTS);
    shot *s = &r->shots[r->n_shots++];
    s->t = state.t;
    s->x = copy_of(state.x, 2 * size.n_nodes);
    s->v = copy_of(state.v, 2 * size.n_nodes);
    s->stress = copy_of(NULL, 3 * size.n_nodes);
    s->strain = copy_of(NULL, size.n_springs);
    s->force = copy_of(NULL, size.n_springs);
    s->broken = flags_of(size.n_triangles);
    dem_simulation_stress(simulation, s->stress);
    dem_simulation_strains(simulation, s->strain);
    dem_simulation_forces(simulation, s->force);
    assert_ok(dem_simulation_broken(simulation, s->broken, NULL));
    return DEM_OK;
}

static void make_folder(run *r)
{
    *r = (run){.path = NULL};
    folder_open(&r->folder);
    r->path = folder_file(&r->folder, "run.vtkhdf");
    r->part = folder_file(&r->folder, "run.part.vtkhdf");
    r->segment = folder_file(&r->folder, "run.00001.vtkhdf");
    r->obstacle = folder_file(&r->folder, "run.obstacle.vtkhdf");
    (void)folder_file(&r->folder, "run.body.vtkhdf");
}

static void start(run *r, dem_trajectory_options options)
{
    dem_options how = dem_options_default();
    how.spacing = 5e-3, how.max_step = 2e-5, how.v_scale = 5.0, how.checkpoint_steps = 8;
    const dem_observer watching = SIZED(dem_observer, .interval = interval, .frame = see_frame, .context = r);
    assert_ok(dem_simulation_create(&r->simulation, r->model, &how));
    assert_ok(dem_peaks_create(&r->peaks, r->model, 2));
    if (options.peaks != NULL) options.peaks = r->peaks;
    assert_ok(dem_trajectory_create(&r->trajectory, r->path, r->simulation, &options));
    const dem_observer writing = ask_trajectory_observer(r->trajectory), peaking = ask_peaks_observer(r->peaks);
    assert_ok(dem_simulation_observe(r->simulation, &peaking));
    assert_ok(dem_simulation_observe(r->simulation, &writing));
    assert_ok(dem_simulation_observe(r->simulation, &watching));
}

/* Two blocks fall, turned, onto a hill. */
static void begin(run *r, const dem_trajectory_options *options)
{
    const dem_obstacle obstacles[2] = {
        {.struct_size = sizeof(dem_obstacle), .n_points = 3, .points = hill, .restitution = 0.5, .friction = 0.3},
        SIZED(dem_obstacle, .n_points = 2, .points = far, .restitution = 0.25, .friction = 0.75,
              .friction_law = DEM_FRICTION_PAPER)};
    const double offset[2] = {0.0, 1.3e-3}, aside[2] = {0.05, 2e-3}, velocity[2] = {1.0, -5.0};
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_solid(0.02, 0.02, 5e-3), other = make_solid(0.01, 0.01, 5e-3);
    make_folder(r);
    dem_lattice_move(&lattice, 0.1, offset);
    dem_lattice_move(&other, 0.1, aside);
    assert_ok(dem_lattice_append(&lattice, &other));
    assert_ok(dem_lattice_launch(&lattice, velocity));
    assert_ok(dem_model_create(&r->model, &lattice, obstacles, 2));
    start(r, *options);
}

static void begin_point(run *r, const dem_trajectory_options *options)
{
    double x[2] = {0.25, 0.5}, mass = 2.0;
    dem_lattice lattice = dem_lattice_empty();
    make_folder(r);
    lattice = dem_lattice_empty();
    lattice.n_nodes = 1, lattice.x = x, lattice.mass = &mass;
    assert_ok(dem_model_create(&r->model, &lattice, NULL, 0));
    start(r, *options);
}

static void advance(run *r, double frames)
{
    assert_ok(dem_simulation_advance(r->simulation, frames * interval));
}

static void make(run *r, const dem_trajectory_options *options)
{
    begin(r, options);
    advance(r, 10.0);
    assert_ok(dem_trajectory_finish(r->trajectory));
}

static void end(run *r)
{
    for (dem_index k = 0; k < r->n_shots; k++) {
        const shot *s = &r->shots[k];
        free(s->x), free(s->v), free(s->stress), free(s->strain), free(s->force), free(s->broken);
    }
    dem_trajectory_destroy(r->trajectory);
    dem_peaks_destroy(r->peaks);
    dem_simulation_destroy(r->simulation);
    dem_model_destroy(r->model);
    folder_close(&r->folder);
}

static dem_trajectory_options everything(void)
{
    static dem_peaks *const wanted = (dem_peaks *)&wanted; /* replaced by the run's own */
    dem_trajectory_options options = dem_trajectory_options_default();
    options.frame_interval = interval, options.double_precision = 1, options.events = 1;
    options.fields = DEM_FIELD_ALL, options.n_probes = 2, options.probes = probes, options.peaks = wanted;
    return options;
}

static void make_whole(run *r)
{
    const dem_trajectory_options options = everything();
    make(r, &options);
}

static dem_reader *open_reader(const char *path)
{
    dem_reader *reader;
    assert_ok(dem_reader_open(&reader, path));
    return reader;
}

/* ---- frames ---- */

static double *read_array(const dem_reader *reader, const char *name, dem_index frame)
{
    const dem_lattice *l = dem_reader_lattice(reader);
    const dem_reader_array *a = dem_reader_array_find(reader, name);
    if (a == NULL) fail_msg("there is no %s", name);
    double *values = copy_of(NULL, (a->of_springs ? l->n_springs : l->n_nodes) * a->components);
    assert_ok(dem_reader_read(reader, a, frame, values));
    return values;
}

/* Of a double in single precision. */
static double rounding(double value)
{
    return (double)FLT_EPSILON * fabs(value) / 2.0 + FLT_TRUE_MIN;
}

static void assert_shown(const dem_reader *reader, const char *name, dem_index frame, const double *expected,
                         dem_index n, double roundings)
{
    if (dem_reader_array_find(reader, name) == NULL) return;
    CLEANUP(free_memory) double *values = read_array(reader, name, frame);
    for (dem_index k = 0; k < n; k++) assert_close(values[k], expected[k], roundings * rounding(expected[k]));
}

static void assert_broken(const dem_reader *reader, dem_index frame, const unsigned char *expected)
{
    const dem_index n = dem_reader_lattice(reader)->n_triangles;
    CLEANUP(free_memory) unsigned char *broken = flags_of(n);
    memset(broken, 2, (size_t)n);
    assert_ok(dem_reader_broken_triangles(reader, frame, broken));
    assert_memory_equal(broken, expected, (size_t)n);
}

static void assert_frame(const dem_reader *reader, const run *r, dem_index frame, double roundings)
{
    const dem_model_size size = ask_sizes(r->model);
    const shot *s = &r->shots[frame];
    const dem_index n = size.n_nodes;
    double *x = copy_of(NULL, 2 * n), *spread = copy_of(NULL, 6 * n), direction[2];
    assert_ok(dem_reader_positions(reader, frame, x));
    assert_memory_equal(x, s->x, 2 * (size_t)n * sizeof *x);
    for (dem_index i = 0; i < n; i++) memcpy(spread + 3 * i, s->v + 2 * i, 2 * sizeof *x);
    assert_shown(reader, "velocity", frame, spread, 3 * n, roundings);
    memset(spread, 0, 6 * (size_t)n * sizeof *x);
    for (dem_index k = 0; k < 2 * n; k++) spread[k / 2 * 3 + k % 2] = s->x[k] - dem_reader_lattice(reader)->x[k];
    assert_shown(reader, "displacement", frame, spread, 3 * n, roundings);
    memset(spread, 0, 6 * (size_t)n * sizeof *x);
    for (dem_index i = 0; i < n; i++) {
        memcpy(spread + 6 * i, s->stress + 3 * i, 2 * sizeof *x);
        spread[6 * i + 3] = s->stress[3 * i + 2];
    }
    assert_shown(reader, "stress", frame, spread, 6 * n, roundings);
    for (dem_index i = 0; i < n; i++) spread[i] = dem_stress_von_mises(s->stress + 3 * i);
    assert_shown(reader, "von_mises", frame, spread, n, roundings);
    for (dem_index i = 0; i < n; i++) dem_stress_principal(s->stress + 3 * i, spread + 2 * i, direction);
    assert_shown(reader, "principal_stress", frame, spread, 2 * n, roundings);
    assert_shown(reader, "strain", frame, s->strain, size.n_springs, roundings);
    assert_shown(reader, "force", frame, s->force, size.n_springs, roundings);
    assert_broken(reader, frame, s->broken);
    free(x);
    free(spread);
}

static void assert_frames(const dem_reader *reader, const run *r, double roundings)
{
    dem_index n = 0;
    const double *times = dem_reader_times(reader, &n);
    assert_int_equal(n, r->n_shots);
    for (dem_index k = 0; k < n; k++) {
        assert_true(times[k] == r->shots[k].t);
        assert_frame(reader, r, k, roundings);
    }
}

TEST(frames_are_what_was_seen)
{
    for (int in_double = 0; in_double < 2; in_double++) {
        dem_trajectory_options options = everything();
        options.double_precision = in_double;
        CLEANUP(end) run r;
        make(&r, &options);
        CLEANUP(free_reader) dem_reader *reader = open_reader(r.path);
        assert_int_equal(r.n_shots, 11);
        assert_frames(reader, &r, in_double ? 0.0 : 1.0);
        const dem_reader_array *v = dem_reader_array_find(reader, "velocity");
        assert_int_equal(v->type, in_double ? DEM_READER_F64 : DEM_READER_F32);
    }
}

TEST(any_fields_may_be_there)
{
    const uint32_t some[] = {0, DEM_FIELD_VELOCITY | DEM_FIELD_FORCE, DEM_FIELD_STRAIN | DEM_FIELD_PRINCIPAL};
    for (size_t k = 0; k < sizeof some / sizeof some[0]; k++) {
        dem_trajectory_options options = everything();
        options.fields = some[k], options.deflate = 0;
        CLEANUP(end) run r;
        make(&r, &options);
        CLEANUP(free_reader) dem_reader *reader = open_reader(r.path);
        assert_frames(reader, &r, 0.0);
        assert_int_equal(dem_reader_array_find(reader, "velocity") != NULL, (some[k] & DEM_FIELD_VELOCITY) != 0);
        assert_int_equal(dem_reader_array_find(reader, "strain") != NULL, (some[k] & DEM_FIELD_STRAIN) != 0);
        assert_null(dem_reader_array_find(reader, "stress"));
    }
}

/* ---- what is broken ---- */

static void break_triangles(const run *r, dem_index first, dem_index n)
{
    const dem_index triangles[] = {first, first + 1, first + 2};
    assert_ok(dem_simulation_break(r->simulation, triangles, n, NULL, 0));
}

/* Some break behind frame 3, one more of the other body behind frame 7. */
static void make_breaking(run *r)
{
    const dem_trajectory_options options = everything();
    begin(r, &options);
    advance(r, 3.5);
    break_triangles(r, 4, 3);
    advance(r, 7.5);
    break_triangles(r, ask_sizes(r->model).n_triangles - 1, 1);
    advance(r, 10.0);
    assert_ok(dem_trajectory_finish(r->trajectory));
}

TEST(triangles_are_broken_in_the_frames_in_which_they_were)
{
    CLEANUP(end) run r;
    make_breaking(&r);
    CLEANUP(free_reader) dem_reader *reader = open_reader(r.path);
    assert_frames(reader, &r, 0.0);
    const unsigned char *broken = r.shots[10].broken;
    assert_true(broken[4] == 1 && broken[6] == 1 && broken[ask_sizes(r.model).n_triangles - 1] == 1);
    assert_int_equal(r.shots[7].broken[ask_sizes(r.model).n_triangles - 1], 0);
}

/* As versions before wrote it. */
TEST(in_a_file_without_flags_all_triangles_are_whole)
{
    CLEANUP(end) run r;
    make_breaking(&r);
    const hid_t file = H5Fopen(r.path, H5F_ACC_RDWR, H5P_DEFAULT);
    assert_true(H5Ldelete(file, "/fracture", H5P_DEFAULT) >= 0);
    (void)H5Fclose(file);
    CLEANUP(free_reader) dem_reader *reader = open_reader(r.path);
    CLEANUP(free_memory) unsigned char *none = flags_of(ask_sizes(r.model).n_triangles);
    assert_broken(reader, 10, none);
}

TEST(any_number_but_0_is_a_flag)
{
    CLEANUP(end) run r;
    make_breaking(&r);
    const dem_index n = ask_sizes(r.model).n_triangles;
    CLEANUP(free_memory) unsigned char *flags = flags_of(11 * n);
    hdf5_file file;
    for (dem_index k = 0; k < 11 * n; k++) flags[k] = (unsigned char)(k % 5 * 60);
    assert_ok(hdf5_open_write(&file, r.path, 4096));
    assert_ok(
        hdf5_append(&file, &(hdf5_rows){"/fracture/triangles", HDF5_U8, 1, {0}, 0, 0}, 0, (hsize_t)(11 * n), flags));
    assert_ok(hdf5_close(&file, DEM_OK));
    CLEANUP(free_reader) dem_reader *reader = open_reader(r.path);
    for (dem_index k = 0; k < 11 * n; k++) flags[k] = flags[k] != 0;
    for (dem_index frame = 0; frame < 11; frame++) assert_broken(reader, frame, flags + frame * n);
}

/* ---- arrays ---- */

TEST(arrays_are_listed_with_what_they_are)
{
    const dem_reader_array expected[] = {
        {"body", "", DEM_READER_I32, 0, 1, 1},
        {"contact_force", "N", DEM_READER_F64, 0, 3, 0},
        {"contact_pressure", "Pa", DEM_READER_F64, 0, 1, 0},
        {"damage", "1", DEM_READER_F64, 0, 1, 0},
        {"displacement", "m", DEM_READER_F64, 0, 3, 0},
        {"fragment", "", DEM_READER_I64, 0, 1, 0},
        {"id", "", DEM_READER_I64, 0, 1, 1},
        {"peak_stress", "Pa", DEM_READER_F64, 0, 6, 1},
        {"peak_von_mises", "Pa", DEM_READER_F64, 0, 1, 1},
        {"peak_von_mises_time", "s", DEM_READER_F64, 0, 1, 1},
        {"principal_stress", "Pa", DEM_READER_F64, 0, 2, 0},
        {"stress", "Pa", DEM_READER_F64, 0, 6, 0},
        {"velocity", "m/s", DEM_READER_F64, 0, 3, 0},
        {"von_mises", "Pa", DEM_READER_F64, 0, 1, 0},
        {"broken", "", DEM_READER_U8, 1, 1, 0},
        {"force", "N", DEM_READER_F64, 1, 1, 0},
        {"peak_strain", "1", DEM_READER_F64, 1, 1, 1},
        {"peak_strain_time", "s", DEM_READER_F64, 1, 1, 1},
        {"strain", "1", DEM_READER_F64, 1, 1, 0},
    };
    const dem_trajectory_options options = everything();
    for (int frames = 1; frames <= 10; frames += 9) { /* of one frame only the names tell what is constant */
        CLEANUP(end) run r;
        begin(&r, &options);
        dem_index n = 0;
        advance(&r, frames == 1 ? 0.5 : 9.0);
        assert_ok(dem_trajectory_finish(r.trajectory));
        CLEANUP(free_reader) dem_reader *reader = open_reader(r.path);
        (void)dem_reader_times(reader, &n);
        assert_int_equal(n, frames);
        const dem_reader_array *arrays = dem_reader_arrays(reader, &n);
        assert_int_equal(n, sizeof expected / sizeof expected[0]);
        for (dem_index k = 0; k < n; k++) {
            assert_string_equal(arrays[k].name, expected[k].name);
            assert_string_equal(arrays[k].unit, expected[k].unit);
            assert_int_equal(arrays[k].type, expected[k].type);
            assert_int_equal(arrays[k].of_springs, expected[k].of_springs);
            assert_int_equal(arrays[k].components, expected[k].components);
            assert_int_equal(arrays[k].constant, expected[k].constant);
        }
    }
}

TEST(constants_are_the_same_in_all_frames)
{
    CLEANUP(end) run r;
    make_whole(&r);
    CLEANUP(free_reader) dem_reader *reader = open_reader(r.path);
    const dem_lattice *l = dem_model_lattice(r.model);
    const dem_node_peak *nodes = dem_peaks_nodes(r.peaks);
    const dem_spring_peak *springs = dem_peaks_springs(r.peaks);
    for (dem_index frame = 0; frame < 11; frame += 10) {
        double *id = read_array(reader, "id", frame), *body = read_array(reader, "body", frame);
        double *most = read_array(reader, "peak_von_mises", frame), *strain = read_array(reader, "peak_strain", frame);
        double *when = read_array(reader, "peak_strain_time", frame);
        for (dem_index i = 0; i < l->n_nodes; i++) {
            assert_close(id[i], (double)i, 0.0);
            assert_close(body[i], (double)l->body[i], 0.0);
            assert_close(most[i], nodes[i].von_mises, 0.0);
        }
        for (dem_index k = 0; k < l->n_springs; k++) {
            assert_close(strain[k], springs[k].strain, 0.0);
            assert_close(when[k], springs[k].t, 0.0);
        }
        free(id), free(body), free(most), free(strain), free(when);
    }
}

/* ---- tables ---- */

static void column_path(char path[160], const dem_reader_column *c)
{
    const int frames = strcmp(c->table, "frames") == 0;
    (void)snprintf(path, 160, "/%s/%s", frames ? "VTKHDF/FieldData" : c->table, c->name);
}

/* All of a dataset, by HDF5 itself. */
static double *read_plainly(const char *path, const dem_reader_column *c)
{
    char name[160];
    column_path(name, c);
    CLEANUP(free_h5)
    const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT), dataset = H5Dopen2(file, name, H5P_DEFAULT);
    if (dataset < 0) fail_msg("%s: no %s", path, name);
    CLEANUP(free_h5) const hid_t space = H5Dget_space(dataset);
    const hssize_t n = H5Sget_simple_extent_npoints(space);
    assert_int_equal(n, c->n_rows * c->width);
    double *values = copy_of(NULL, (dem_index)n);
    assert_true(H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0);
    return values;
}

static void assert_column(const dem_reader *reader, const char *path, const dem_reader_column *c)
{
    CLEANUP(free_memory) double *plain = read_plainly(path, c), *values = copy_of(NULL, c->n_rows * c->width);
    assert_ok(dem_reader_read_column(reader, c, values));
    assert_memory_equal(values, plain, (size_t)(c->n_rows * c->width) * sizeof *values);
    if (c->n_rows > 2) {
        assert_ok(dem_reader_read_rows(reader, c, 1, c->n_rows - 2, values));
        assert_memory_equal(values, plain + c->width, (size_t)((c->n_rows - 2) * c->width) * sizeof *values);
    }
}

TEST(tables_are_what_hdf5_finds)
{
    CLEANUP(end) run r;
    make_whole(&r);
    CLEANUP(free_reader) dem_reader *reader = open_reader(r.path);
    dem_index n = 0, tables = 0;
    const dem_reader_column *columns = dem_reader_columns(reader, &n);
    const char *table = "";
    for (dem_index k = 0; k < n; k++) {
        assert_column(reader, r.path, &columns[k]);
        assert_ptr_equal(dem_reader_column_find(reader, columns[k].table, columns[k].name), &columns[k]);
        if (strcmp(columns[k].table, table) != 0) {
            tables++;
            table = columns[k].table;
            if (strcmp(table, "frames") != 0 && strncmp(table, "most", 4) != 0)
                assert_string_equal(columns[k].name, "t");
        } else {
            assert_int_equal(columns[k].n_rows, columns[k - 1].n_rows);
        }
    }
    assert_int_equal(tables, 7); /* frames, history, events, two probes, two lists */
    assert_int_equal(n, 14 + 52 + 15 + 5 + 3 + 5 + 5);
}

static void expect_column(const dem_reader *reader, const dem_reader_column *expected)
{
    const dem_reader_column *c = dem_reader_column_find(reader, expected->table, expected->name);
    if (c == NULL) fail_msg("there is no %s/%s", expected->table, expected->name);
    assert_string_equal(c->unit, expected->unit);
    assert_int_equal(c->type, expected->type);
    assert_int_equal(c->items, expected->items);
    assert_int_equal(c->components, expected->components);
    assert_int_equal(c->width, expected->items * expected->components);
}

TEST(columns_have_items_and_components)
{
    const dem_reader_column expected[] = {
        {"frames", "kinetic_energy", "J", DEM_READER_F64, 0, 1, 1, 0},
        {"history", "t", "s", DEM_READER_F64, 0, 1, 1, 0},
        {"history", "steps", "", DEM_READER_I64, 0, 1, 1, 0},
        {"history", "gap_min", "m", DEM_READER_F64, 0, 1, 1, 0},
        {"history", "pairs", "", DEM_READER_I64, 0, 1, 1, 0},
        {"history", "body_centre", "m", DEM_READER_F64, 0, 2, 2, 0},
        {"history", "body_angular_momentum", "kg m^2/s", DEM_READER_F64, 0, 2, 1, 0},
        {"history", "obstacle_reaction", "N", DEM_READER_F64, 0, 2, 2, 0},
        {"events", "kind", "", DEM_READER_I8, 0, 1, 1, 0},
        {"events", "normal", "1", DEM_READER_F64, 0, 1, 2, 0},
        {"probes/corner", "stress", "Pa", DEM_READER_F64, 0, 1, 3, 0},
        {"probes/width", "length", "m", DEM_READER_F64, 0, 1, 1, 0},
        {"most_stressed/nodes", "x", "m", DEM_READER_F64, 0, 1, 2, 0},
    };
    CLEANUP(end) run r;
    make_whole(&r);
    CLEANUP(free_reader) dem_reader *reader = open_reader(r.path);
    for (size_t k = 0; k < sizeof expected / sizeof expected[0]; k++) expect_column(reader, &expected[k]);
    assert_null(dem_reader_column_find(reader, "history", "kind"));
}

/* ---- the model ---- */

TEST(lattice_and_obstacles_are_the_models)
{
    CLEANUP(end) run r;
    make_whole(&r);
    CLEANUP(free_reader) dem_reader *reader = open_reader(r.path);
    const dem_lattice *l = dem_reader_lattice(reader), *own = dem_model_lattice(r.model);
    const dem_index n = dem_reader_n_obstacles(reader);
    assert_int_equal(l->n_nodes, own->n_nodes);
    assert_memory_equal(l->x, own->x, 2 * (size_t)own->n_nodes * sizeof *own->x);
    assert_memory_equal(l->velocity, own->velocity, 2 * (size_t)own->n_nodes * sizeof *own->x);
    assert_memory_equal(l->stiffness, own->stiffness, (size_t)own->n_springs * sizeof *own->x);
    assert_int_equal(n, ask_sizes(r.model).n_obstacles);
    assert_null(dem_reader_obstacle(reader, n));
    assert_null(dem_reader_obstacle(reader, -1));
    for (dem_index k = 0; k < n; k++) {
        const dem_obstacle *o = dem_reader_obstacle(reader, k), *given = dem_model_obstacle(r.model, k);
        assert_int_equal(o->n_points, given->n_points);
        assert_memory_equal(o->points, given->points, 2 * (size_t)o->n_points * sizeof *own->x);
        assert_close(o->restitution, given->restitution, 0.0);
        assert_close(o->friction, given->friction, 0.0);
        assert_int_equal(o->friction_law, given->friction_law);
    }
}

/* ---- runs of other kinds ---- */

TEST(a_point_without_springs_and_obstacles_is_read)
{
    dem_trajectory_options options = everything();
    options.n_probes = 0;
    CLEANUP(end) run r;
    begin_point(&r, &options);
    double values[6];
    advance(&r, 10.0);
    assert_ok(dem_trajectory_finish(r.trajectory));
    CLEANUP(free_reader) dem_reader *reader = open_reader(r.path);
    assert_frames(reader, &r, 0.0);
    const dem_reader_array *force = dem_reader_array_find(reader, "force");
    assert_false(force->constant);
    assert_ok(dem_reader_read(reader, force, 10, values));
    assert_int_equal(dem_reader_n_obstacles(reader), 0);
    assert_null(dem_reader_column_find(reader, "history", "obstacle_reaction"));
}

TEST(a_run_without_frames_has_its_tables)
{
    dem_trajectory_options options = everything();
    options.frame_interval = 0.0, options.events = 0;
    CLEANUP(end) run r;
    make(&r, &options);
    CLEANUP(free_reader) dem_reader *reader = open_reader(r.path);
    dem_index n = -1;
    double x[64];
    (void)dem_reader_times(reader, &n);
    assert_int_equal(n, 0);
    (void)dem_reader_arrays(reader, &n);
    assert_int_equal(n, 0);
    assert_int_equal(dem_reader_positions(reader, 0, x), DEM_ERROR_ARGUMENT);
    assert_null(dem_reader_column_find(reader, "events", "t"));
    assert_column(reader, r.path, dem_reader_column_find(reader, "history", "kinetic"));
}

TEST(a_part_is_seen_as_it_was_when_it_was_opened)
{
    const dem_trajectory_options options = everything();
    CLEANUP(end) run r;
    begin(&r, &options);
    dem_index n = 0;
    advance(&r, 4.5);
    CLEANUP(free_reader) dem_reader *reader = open_reader(r.part);
    const dem_reader_column *t = dem_reader_column_find(reader, "history", "t");
    CLEANUP(free_memory) double *times = copy_of(NULL, t->n_rows);
    (void)dem_reader_times(reader, &n);
    assert_int_equal(n, 5);
    advance(&r, 8.0);
    (void)dem_reader_times(reader, &n);
    assert_int_equal(n, 5);
    for (dem_index k = 0; k < n; k++) assert_frame(reader, &r, k, 0.0);
    assert_ok(dem_reader_read_column(reader, t, times));
    assert_true(times[t->n_rows - 1] <= 4.0 * interval);
    assert_ok(dem_trajectory_finish(r.trajectory));
    assert_int_equal(dem_reader_positions(reader, 0, r.shots[0].x), DEM_ERROR_IO);
    assert_non_null(strstr(dem_status_message(), "run.part.vtkhdf: cannot be opened"));
}

TEST(segment_and_part_follow_each_other)
{
    const dem_trajectory_options options = everything();
    CLEANUP(end) run r;
    begin(&r, &options);
    dem_index n[2] = {0, 0};
    advance(&r, 6.5);
    assert_ok(dem_trajectory_segment(r.trajectory, dem_simulation_checkpoint(r.simulation)));
    advance(&r, 10.0);
    CLEANUP(free_reader) dem_reader *segment = open_reader(r.segment), *part = open_reader(r.part);
    const double *first = dem_reader_times(segment, &n[0]), *then = dem_reader_times(part, &n[1]);
    assert_true(n[0] > 1 && n[1] > 1);
    assert_int_equal(n[0] + n[1], 11);
    assert_true(first[0] == 0.0 && then[0] == r.shots[n[0]].t);
    assert_frame(segment, &r, n[0] - 1, 0.0);
    CLEANUP(free_memory) double *x = copy_of(NULL, 2 * ask_sizes(r.model).n_nodes);
    assert_ok(dem_reader_positions(part, 0, x));
    assert_memory_equal(x, r.shots[n[0]].x, 2 * (size_t)ask_sizes(r.model).n_nodes * sizeof *x);
}

TEST(what_is_not_there_cannot_be_read)
{
    CLEANUP(end) run r;
    make_whole(&r);
    dem_reader *reader = open_reader(r.path), *other = NULL;
    double values[1024];
    unsigned char broken[256];
    const dem_reader_array *v = dem_reader_array_find(reader, "velocity");
    const dem_reader_column *t = dem_reader_column_find(reader, "history", "t");
    assert_int_equal(dem_reader_positions(reader, 11, values), DEM_ERROR_ARGUMENT);
    assert_non_null(strstr(dem_status_message(), "run.vtkhdf: has no frame 11: there are 11"));
    assert_int_equal(dem_reader_positions(reader, -1, values), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_reader_read(reader, v, 11, values), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_reader_broken_triangles(reader, 11, broken), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_reader_broken_triangles(reader, 10, NULL), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_reader_broken_triangles(NULL, 10, broken), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_reader_read(reader, NULL, 0, values), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_reader_read_column(reader, NULL, values), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_reader_read_rows(reader, t, t->n_rows, 1, values), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_reader_read_rows(reader, t, -1, 1, values), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_reader_read_rows(reader, t, 0, -1, values), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_reader_open(&other, NULL), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_reader_open(&other, r.obstacle), DEM_ERROR_IO); /* which has no lattice */
    assert_int_equal(dem_reader_open(&other, r.folder.path), DEM_ERROR_IO);
    assert_null(other);
    dem_reader_close(reader);
    dem_reader_close(NULL);
}

/* ---- damage ---- */

typedef struct damage {
    const char *name, *reason;
    void (*make)(hid_t file, const char *name);
} damage;

static void drop(hid_t file, const char *name)
{
    assert_true(H5Ldelete(file, name, H5P_DEFAULT) >= 0);
}

/* Another dataset of this name. */
static void put(hid_t file, const char *name, hid_t type, int rank, const hsize_t *extent)
{
    if (H5Lexists(file, name, H5P_DEFAULT) > 0) drop(file, name);
    CLEANUP(free_h5) const hid_t space = H5Screate_simple(rank, extent, NULL);
    CLEANUP(free_h5) const hid_t dataset = H5Dcreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(dataset >= 0);
    if (rank == 1 && (type == H5T_NATIVE_DOUBLE || type == H5T_NATIVE_UINT8) && extent[0] <= 11) {
        const double zero[11] = {0.0};
        assert_true(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, zero) >= 0);
    }
}

static void put_flat(hid_t file, const char *name)
{
    put(file, name, H5T_NATIVE_DOUBLE, 1, (const hsize_t[]){11});
}

static void put_text(hid_t file, const char *name)
{
    put(file, name, H5T_C_S1, 1, (const hsize_t[]){11});
}

static void put_few(hid_t file, const char *name)
{
    put(file, name, H5T_NATIVE_UINT8, 1, (const hsize_t[]){11});
}

static void put_huge(hid_t file, const char *name)
{
    put(file, name, H5T_NATIVE_DOUBLE, 2, (const hsize_t[]){(hsize_t)1 << 38, 3});
}

static void put_wide(hid_t file, const char *name)
{
    put(file, name, H5T_NATIVE_DOUBLE, 2, (const hsize_t[]){1, (hsize_t)1 << 50});
}

static void put_none(hid_t file, const char *name)
{
    put(file, name, H5T_NATIVE_DOUBLE, 2, (const hsize_t[]){0, (hsize_t)1 << 50});
}

static void put_deep(hid_t file, const char *name)
{
    put(file, name, H5T_NATIVE_DOUBLE, 4, (const hsize_t[]){1, 1, 1, 1});
}

static void put_deep_flags(hid_t file, const char *name)
{
    put(file, name, H5T_NATIVE_UINT8, 4, (const hsize_t[]){1, 1, 1, 1});
}

static void put_soft(hid_t file, const char *name)
{
    drop(file, name);
    assert_true(H5Lcreate_soft("/lattice", file, name, H5P_DEFAULT, H5P_DEFAULT) >= 0);
}

static void put_group(hid_t file, const char *name)
{
    assert_true(H5Gclose(H5Gcreate2(file, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT)) >= 0);
}

static void put_attribute(hid_t file, const char *object, const char *name, hsize_t n, int64_t value)
{
    CLEANUP(free_h5) const hid_t space = H5Screate_simple(1, &n, NULL);
    const int64_t values[2] = {value, value};
    (void)H5Adelete_by_name(file, object, name, H5P_DEFAULT);
    CLEANUP(free_h5)
    const hid_t id =
        H5Acreate_by_name(file, object, name, H5T_NATIVE_INT64, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(id >= 0 && H5Awrite(id, H5T_NATIVE_INT64, values) >= 0);
}

static void count_more(hid_t file, const char *name)
{
    (void)name;
    put_attribute(file, "/VTKHDF/Steps", "NSteps", 1, 12);
}

static void count_less_than_none(hid_t file, const char *name)
{
    (void)name;
    put_attribute(file, "/VTKHDF/Steps", "NSteps", 1, -1);
}

static void count_twice(hid_t file, const char *name)
{
    (void)name;
    put_attribute(file, "/VTKHDF/Steps", "NSteps", 2, 11);
}

static void restore_too_much(hid_t file, const char *name)
{
    put_attribute(file, name, "restitution", 1, 2);
}

static void forget_law(hid_t file, const char *name)
{
    assert_true(H5Adelete_by_name(file, name, "friction_law", H5P_DEFAULT) >= 0);
}

static void count_law(hid_t file, const char *name)
{
    put_attribute(file, name, "friction_law", 1, 1);
}

static const damage damages[] = {
    {"/lattice/mass", "/lattice/mass: is missing", drop},
    {"", "/VTKHDF/Steps/Values: is not of shape [12], as NSteps says", count_more},
    {"", "/VTKHDF/Steps/Values: is not of shape [-1], as NSteps says", count_less_than_none},
    {"", "/VTKHDF/Steps: has no attribute NSteps that is an integer", count_twice},
    {"/VTKHDF/Steps/Values", "/VTKHDF/Steps/Values: is not finite and ascending", put_flat},
    {"/VTKHDF/Steps/Values", "/VTKHDF/Steps/Values: is not a readable dataset", drop},
    {"/VTKHDF/Steps", "/VTKHDF/Steps: is a soft or external link", put_soft},
    {"/VTKHDF/Points", "/VTKHDF/Points: is not of shape [11 frames of 35][3]", put_flat},
    {"/VTKHDF/Points", "/VTKHDF/Points: claims more data than the file holds", put_huge},
    {"/VTKHDF/PointData/velocity", "velocity: is not of shape [11 times 35] or [..][1 to 9]", put_flat},
    {"/VTKHDF/PointData/velocity", "velocity: is neither floating-point nor integer", put_text},
    {"/VTKHDF/PointData/velocity", "velocity: has more than 2^44 numbers", put_wide},
    {"/VTKHDF/PointData/velocity", "velocity: is not of shape", put_deep},
    {"/VTKHDF/PointData/velocity", "velocity: is not of shape", put_none},
    {"/VTKHDF/PointData/id", "id: is not of shape [1 times 35]", put_flat},
    {"/VTKHDF/PointData/new", "/VTKHDF/PointData/new: is not a readable dataset", put_group},
    {"/VTKHDF/PointData/a b", "/VTKHDF/PointData: a?b is no name of 1 to 63 letters, digits and signs", put_flat},
    {"/VTKHDF/CellData", "/VTKHDF/CellData: is not a readable group", put_flat},
    {"/fracture/triangles", "/fracture/triangles: is not of shape [11 times 41]", put_few},
    {"/fracture/triangles", "/fracture/triangles: is not of shape [11 times 41]", put_deep_flags},
    {"/fracture/triangles", "/fracture/triangles: is neither integer nor boolean", put_flat},
    {"/fracture/triangles", "/fracture/triangles: is a soft or external link", put_soft},
    {"/fracture", "/fracture: is a soft or external link", put_soft},
    {"/history/t", "/history/t: is neither floating-point nor integer", put_text},
    {"/history/t", "/history/t: is not of shape [n], [n][..] or [n][..][..]", put_deep},
    {"/history/t", "/history/t: is not of shape [n], [n][..] or [n][..][..]", put_none},
    {"/history", "/history: is a soft or external link", put_soft},
    {"/probes/corner", "/probes/corner: is a soft or external link", put_soft},
    {"/obstacles/0/points", "/obstacles/0/points: is not of shape [n][2]", put_flat},
    {"/obstacles/1/points", "/obstacles/1/points: is missing", drop},
    {"/obstacles/1", "/obstacles/1: obstacle 0: restitution", restore_too_much},
    {"/obstacles/1", "/obstacles/1: has no attribute friction_law that is a short string", forget_law},
    {"/obstacles/1", "/obstacles/1: has no attribute friction_law that is a short string", count_law},
};

static void copy_file(const char *from, const char *to)
{
    char command[256];
    (void)snprintf(command, sizeof command, "cp %s %s", from, to);
    assert_int_equal(system(command), 0);
}

TEST(damaged_files_are_refused)
{
    CLEANUP(end) run r;
    make_whole(&r);
    dem_reader *reader = NULL;
    for (size_t k = 0; k < sizeof damages / sizeof damages[0]; k++) {
        copy_file(r.path, r.part);
        const hid_t file = H5Fopen(r.part, H5F_ACC_RDWR, H5P_DEFAULT);
        damages[k].make(file, damages[k].name);
        (void)H5Fclose(file);
        const dem_status status = dem_reader_open(&reader, r.part);
        if (status != DEM_ERROR_IO || strstr(dem_status_message(), "run.part.vtkhdf: ") == NULL ||
            strstr(dem_status_message(), damages[k].reason) == NULL)
            fail_msg("%zu: '%s' where '%s' was expected", k, status == DEM_OK ? "" : dem_status_message(),
                     damages[k].reason);
        assert_null(reader);
    }
}

TEST(what_has_changed_since_is_refused)
{
    CLEANUP(end) run r;
    make_whole(&r);
    CLEANUP(free_reader) dem_reader *reader = open_reader(r.path);
    CLEANUP(free_memory) double *values = copy_of(NULL, 4096);
    CLEANUP(free_memory) unsigned char *broken = flags_of(ask_sizes(r.model).n_triangles);
    const hid_t file = H5Fopen(r.path, H5F_ACC_RDWR, H5P_DEFAULT);
    put_flat(file, "/VTKHDF/PointData/velocity");
    drop(file, "/history/t");
    put_flat(file, "/history/h");
    put_huge(file, "/VTKHDF/Points");
    drop(file, "/fracture/triangles");
    (void)H5Fclose(file);
    assert_int_equal(dem_reader_read(reader, dem_reader_array_find(reader, "velocity"), 3, values), DEM_ERROR_IO);
    assert_non_null(strstr(dem_status_message(), "velocity: has another shape than when the reader was opened"));
    assert_int_equal(dem_reader_read_column(reader, dem_reader_column_find(reader, "history", "t"), values),
                     DEM_ERROR_IO);
    assert_non_null(strstr(dem_status_message(), "/history/t: is missing"));
    assert_int_equal(dem_reader_read_column(reader, dem_reader_column_find(reader, "history", "h"), values),
                     DEM_ERROR_IO);
    assert_non_null(strstr(dem_status_message(), "/history/h: has another shape than when the reader was opened"));
    assert_int_equal(dem_reader_positions(reader, 3, values), DEM_ERROR_IO);
    assert_int_equal(dem_reader_broken_triangles(reader, 3, broken), DEM_ERROR_IO);
    assert_non_null(strstr(dem_status_message(), "/fracture/triangles: is missing"));
}

/* What others have put there is read as well; the rows of a table are those that all columns have. */
TEST(other_arrays_and_uneven_tables_are_read)
{
    CLEANUP(end) run r;
    make_whole(&r);
    const dem_index n = ask_sizes(r.model).n_springs;
    hdf5_file file;
    double values[11], *mine = copy_of(NULL, 2 * n);
    for (dem_index k = 0; k < 2 * n; k++) mine[k] = (double)k;
    assert_ok(hdf5_open_write(&file, r.path, 4096));
    assert_ok(hdf5_write(&file, (hdf5_rows){"/VTKHDF/CellData/mine", HDF5_F32, 2, {2}, 0, 0}, (hsize_t)n, mine));
    put_flat(file.id, "/history/short");
    assert_ok(hdf5_close(&file, DEM_OK));
    CLEANUP(free_reader) dem_reader *reader = open_reader(r.path);
    CLEANUP(free_memory) double *found = read_array(reader, "mine", 7);
    assert_memory_equal(found, mine, 2 * (size_t)n * sizeof *mine);
    assert_true(dem_reader_array_find(reader, "mine")->constant);
    assert_int_equal(dem_reader_column_find(reader, "history", "t")->n_rows, 11);
    assert_ok(dem_reader_read_column(reader, dem_reader_column_find(reader, "history", "t"), values));
    free(mine);
}
