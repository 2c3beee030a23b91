/* SPDX-License-Identifier: BSD-3-Clause */
/* trajectory.c, history.c, hdf5_file.c: what a run leaves on disk, looked at through HDF5 itself. */
#include "harness/cleanup_hdf5.h"
#include "harness/motion.h"
#include "unit/close.h"
#include "unit/scratch.h"

#include <dem/trajectory.h>

#include <fcntl.h>
#include <hdf5.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

/* A block in a folder of its own, falling onto two obstacles. */
typedef struct run {
    scratch_folder folder;
    const char *path, *part, *obstacle, *body;
    dem_model *model;
    dem_simulation *simulation;
    dem_trajectory *trajectory;
} run;

static const double interval = 1e-4;

static int exists(const char *path)
{
    return access(path, F_OK) == 0;
}

static void make_model(run *r, int n_obstacles)
{
    const double floor[8] = {-1.0, 0.0, -0.5, 0.0, 0.5, 0.0, 1.0, 0.0}, far[4] = {4.0, -1.0, 5.0, -1.0};
    const double offset[2] = {0.0, 3e-4}, velocity[2] = {1.0, -5.0};
    const dem_obstacle obstacles[2] = {
        {.struct_size = sizeof(dem_obstacle), .n_points = 4, .points = floor, .restitution = 0.5},
        {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = far, .restitution = 0.25}};
    const dem_material rubber = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 0.4, .density = 1050.0,
                                      .thickness = 1.0, .guard = 0.02);
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    assert_int_equal(dem_lattice_rectangle(&lattice, 0.02, 0.02, 5e-3), DEM_OK);
    assert_int_equal(dem_lattice_assemble(&lattice, &rubber), DEM_OK);
    dem_lattice_move(&lattice, 0.1, offset);
    lattice.x[1] += 2e-3;
    assert_int_equal(dem_lattice_launch(&lattice, velocity), DEM_OK);
    lattice.position = malloc(2 * (size_t)lattice.n_nodes * sizeof(double));
    assert_non_null(lattice.position);
    for (dem_index i = 0; i < 2 * lattice.n_nodes; i++) lattice.position[i] = lattice.x[i] + (i % 2 ? 5e-3 : 0.0);
    assert_int_equal(dem_model_create(&r->model, &lattice, obstacles, n_obstacles), DEM_OK);
}

static void make_point(run *r)
{
    double x[2] = {0.25, 0.5}, mass = 2.0;
    dem_lattice lattice = dem_lattice_empty();
    lattice.n_nodes = 1, lattice.x = x, lattice.mass = &mass;
    assert_int_equal(dem_model_create(&r->model, &lattice, NULL, 0), DEM_OK);
}

static void make_simulation(run *r)
{
    dem_options options = dem_options_default();
    options.spacing = 5e-3, options.max_step = 2e-5, options.v_scale = 5.0;
    assert_int_equal(dem_simulation_create(&r->simulation, r->model, &options), DEM_OK);
}

static void make_folder(run *r)
{
    *r = (run){.path = NULL};
    folder_open(&r->folder);
    r->path = folder_file(&r->folder, "run.vtkhdf");
    r->part = folder_file(&r->folder, "run.part.vtkhdf");
    r->obstacle = folder_file(&r->folder, "run.obstacle.vtkhdf");
    r->body = folder_file(&r->folder, "run.body.vtkhdf");
}

static dem_trajectory_options every_frame(void)
{
    dem_trajectory_options options = dem_trajectory_options_default();
    options.frame_interval = interval;
    return options;
}

static void open_trajectory(run *r, const dem_trajectory_options *options)
{
    assert_int_equal(dem_trajectory_create(&r->trajectory, r->path, r->simulation, options), DEM_OK);
    const dem_observer observer = ask_trajectory_observer(r->trajectory);
    assert_int_equal(dem_simulation_observe(r->simulation, &observer), DEM_OK);
}

static run begin(const dem_trajectory_options *options)
{
    run r;
    make_folder(&r);
    make_model(&r, 2);
    make_simulation(&r);
    open_trajectory(&r, options);
    return r;
}

/* With every frame. */
static run begin_usual(void)
{
    const dem_trajectory_options options = every_frame();
    return begin(&options);
}

static void end(run *r)
{
    dem_trajectory_destroy(r->trajectory);
    dem_simulation_destroy(r->simulation);
    dem_model_destroy(r->model);
    folder_close(&r->folder);
}

/* ---- looking into the file ---- */

typedef struct table {
    hsize_t extent[3]; /* 1 beyond the rank */
    double *value;
} table;

static table read_table(const char *path, const char *name)
{
    table t = {{1, 1, 1}, NULL};
    CLEANUP(free_h5) const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    assert_true(file >= 0);
    CLEANUP(free_h5) const hid_t dataset = H5Dopen2(file, name, H5P_DEFAULT);
    if (dataset < 0) fail_msg("%s: no %s", path, name);
    CLEANUP(free_h5) const hid_t space = H5Dget_space(dataset);
    assert_true(H5Sget_simple_extent_ndims(space) <= 3);
    (void)H5Sget_simple_extent_dims(space, t.extent, NULL);
    t.value = calloc((size_t)(t.extent[0] * t.extent[1] * t.extent[2]) + 1, sizeof *t.value);
    assert_non_null(t.value);
    assert_true(H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, t.value) >= 0);
    return t;
}

static double read_cell(const char *path, const char *name, hsize_t index)
{
    const table t = read_table(path, name);
    assert_true(index < t.extent[0] * t.extent[1] * t.extent[2]);
    const double value = t.value[index];
    free(t.value);
    return value;
}

static hsize_t count_rows(const char *path, const char *name)
{
    const table t = read_table(path, name);
    free(t.value);
    return t.extent[0];
}

static int64_t count_steps(const char *path)
{
    int64_t n = -1;
    CLEANUP(free_h5) const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    CLEANUP(free_h5) const hid_t attribute = H5Aopen_by_name(file, "/VTKHDF/Steps", "NSteps", H5P_DEFAULT, H5P_DEFAULT);
    assert_true(H5Aread(attribute, H5T_NATIVE_INT64, &n) >= 0);
    return n;
}

static size_t stored_size(const char *path, const char *name)
{
    CLEANUP(free_h5)
    const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT), dataset = H5Dopen2(file, name, H5P_DEFAULT);
    CLEANUP(free_h5) const hid_t type = H5Dget_type(dataset);
    const size_t size = H5Tget_size(type);
    return size;
}

static int has(const char *path, const char *name)
{
    CLEANUP(free_h5) const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    const int found = H5Lexists(file, name, H5P_DEFAULT) > 0;
    return found;
}

/* ---- frames ---- */

static void assert_last_frame_is_the_state(const run *r, hsize_t n_frames, double tolerance)
{
    const dem_lattice *lattice = dem_model_lattice(r->model);
    const hsize_t n = (hsize_t)lattice->n_nodes, first = 3 * n * (n_frames - 1);
    const table points = read_table(r->path, "/VTKHDF/Points");
    const table moved = read_table(r->path, "/VTKHDF/PointData/displacement");
    const table velocity = read_table(r->path, "/VTKHDF/PointData/velocity");
    motion state;
    motion_see(r->simulation, &state);
    assert_int_equal(points.extent[0], n * n_frames);
    assert_int_equal(points.extent[1], 3);
    for (hsize_t k = 0; k < 3 * n; k++) {
        const hsize_t node = k / 3, d = k % 3;
        const double x = d == 2 ? 0.0 : state.x[2 * node + d], v = d == 2 ? 0.0 : state.v[2 * node + d];
        assert_true(points.value[first + k] == x);
        assert_close(moved.value[first + k], d == 2 ? 0.0 : x - lattice->x[2 * node + d], tolerance);
        assert_close(velocity.value[first + k], v, 1e2 * tolerance);
    }
    free(points.value);
    free(moved.value);
    free(velocity.value);
}

static void assert_last_strain_is_the_states(const run *r, hsize_t n_frames, double tolerance)
{
    const dem_lattice *lattice = dem_model_lattice(r->model);
    const hsize_t m = (hsize_t)lattice->n_springs, first = m * (n_frames - 1);
    const table strain = read_table(r->path, "/VTKHDF/CellData/strain");
    const table force = read_table(r->path, "/VTKHDF/CellData/force");
    const dem_strain extremes = ask_strain(r->simulation);
    assert_int_equal(strain.extent[0], m * n_frames);
    double least = INFINITY, most = -INFINITY;
    for (hsize_t k = first; k < first + m; k++) {
        least = fmin(least, strain.value[k]);
        most = fmax(most, strain.value[k]);
        assert_close(force.value[k], lattice->stiffness[k - first] * strain.value[k], 1e7 * tolerance);
    }
    assert_close(least, extremes.min, tolerance);
    assert_close(most, extremes.max, tolerance);
    free(strain.value);
    free(force.value);
}

TEST(a_frame_holds_the_state)
{
    for (int is_double = 0; is_double <= 1; is_double++) {
        dem_trajectory_options options = every_frame();
        options.double_precision = is_double, options.deflate = is_double ? 0 : 9;
        CLEANUP(end) run r = begin(&options);
        assert_int_equal(dem_simulation_advance(r.simulation, 10 * interval), DEM_OK);
        assert_int_equal(dem_trajectory_finish(r.trajectory), DEM_OK);
        assert_int_equal(count_steps(r.path), 11);
        for (hsize_t f = 0; f < 11; f++)
            assert_close(read_cell(r.path, "/VTKHDF/Steps/Values", f), (double)f * interval, 1e-18);
        assert_int_equal(stored_size(r.path, "/VTKHDF/Points"), 8);
        assert_int_equal(stored_size(r.path, "/VTKHDF/PointData/velocity"), is_double ? 8 : 4);
        assert_last_frame_is_the_state(&r, 11, is_double ? 0.0 : 1e-8);
        assert_last_strain_is_the_states(&r, 11, is_double ? 1e-15 : 1e-7);
    }
}

TEST(offsets_tell_where_a_frame_begins)
{
    CLEANUP(end) run r = begin_usual();
    const dem_model_size size = ask_sizes(r.model);
    const struct {
        const char *name;
        dem_index per_frame;
    } offsets[] = {{"PointOffsets", size.n_nodes},
                   {"CellOffsets", 0},
                   {"ConnectivityIdOffsets", 0},
                   {"PartOffsets", 0},
                   {"PointDataOffsets/displacement", size.n_nodes},
                   {"PointDataOffsets/id", 0},
                   {"PointDataOffsets/body", 0},
                   {"CellDataOffsets/broken", size.n_springs},
                   {"CellDataOffsets/vtkGhostType", size.n_springs},
                   {"FieldDataOffsets/friction_energy", 1},
                   {"FieldDataOffsets/damping_energy", 1},
                   {"FieldDataOffsets/contacts", 1}};
    assert_int_equal(dem_simulation_advance(r.simulation, 3 * interval), DEM_OK);
    assert_int_equal(dem_trajectory_finish(r.trajectory), DEM_OK);
    for (size_t k = 0; k < sizeof offsets / sizeof offsets[0]; k++) {
        char name[64];
        (void)snprintf(name, sizeof name, "/VTKHDF/Steps/%s", offsets[k].name);
        for (hsize_t f = 0; f < 4; f++)
            assert_close(read_cell(r.path, name, f), (double)((dem_index)f * offsets[k].per_frame), 0.0);
    }
    assert_close(read_cell(r.path, "/VTKHDF/Steps/NumberOfParts", 3), 1.0, 0.0);
}

TEST(a_frame_is_not_written_twice)
{
    CLEANUP(end) run r = begin_usual();
    const dem_observer observer = ask_trajectory_observer(r.trajectory);
    assert_int_equal(dem_simulation_advance(r.simulation, 2.5 * interval), DEM_OK);
    assert_int_equal(count_steps(r.part), 3);
    for (int k = 0; k < 2; k++) {
        assert_int_equal(observer.frame(observer.context, r.simulation), DEM_OK);
        assert_int_equal(count_steps(r.part), 4);
    }
}

/* An observer after the trajectory's, so the frame is there already. */
static dem_status look_at_part(void *context, const dem_simulation *simulation)
{
    run *r = context;
    motion state;
    motion_see(simulation, &state);
    const int64_t n = count_steps(r->part);
    assert_close(read_cell(r->part, "/VTKHDF/Steps/Values", (hsize_t)n - 1), state.t, 0.0);
    assert_true(read_cell(r->part, "/history/t", count_rows(r->part, "/history/t") - 1) <= state.t);
    assert_false(exists(r->path));
    return DEM_OK;
}

/* A long run, so that their rows go to the file in several parts. */
TEST(probes_and_peaks_are_in_the_file_in_the_end)
{
    const dem_probe probes[2] = {{"node", DEM_PROBE_NODE, {3, 0}, 1}, {"gauge", DEM_PROBE_GAUGE, {0, 3}, 4}};
    dem_peaks *peaks;
    for (int with_frames = 0; with_frames < 2; with_frames++) {
        CLEANUP(end) run r;
        dem_trajectory_options options = every_frame();
        make_folder(&r);
        make_model(&r, 2);
        make_simulation(&r);
        assert_int_equal(dem_peaks_create(&peaks, r.model, 2), DEM_OK);
        const dem_observer observer = ask_peaks_observer(peaks);
        assert_int_equal(dem_simulation_observe(r.simulation, &observer), DEM_OK);
        options.frame_interval = with_frames ? interval : 0.0;
        options.n_probes = 2, options.probes = probes, options.peaks = peaks, options.most_stressed = 4;
        open_trajectory(&r, &options);
        assert_int_equal(dem_simulation_advance(r.simulation, 300 * interval), DEM_OK);
        assert_int_equal(dem_trajectory_finish(r.trajectory), DEM_OK);
        const hsize_t rows = count_rows(r.path, "/history/t");
        assert_true(rows > 1024);
        assert_int_equal(count_rows(r.path, "/probes/node/t"), rows);
        assert_int_equal(count_rows(r.path, "/probes/gauge/strain"), (rows + 3) / 4);
        assert_close(read_cell(r.path, "/probes/node/t", rows - 1), read_cell(r.path, "/history/t", rows - 1), 0.0);
        assert_int_equal(count_rows(r.path, "/most_stressed/nodes/node"), 4);
        if (with_frames) assert_int_equal(count_rows(r.path, "/VTKHDF/Steps/CellDataOffsets/peak_strain"), 301);
        dem_peaks_destroy(peaks);
    }
}

/* So many steps that its buffer is full several times, between rows of the history and without frames. */
TEST(a_probe_has_a_row_for_every_step_whatever_the_history_has)
{
    const dem_probe probe = {.name = "first", .kind = DEM_PROBE_NODE, .number = {0, 0}, .every = 1};
    dem_trajectory_options options = dem_trajectory_options_default();
    options.history_interval = 1.0, options.n_probes = 1, options.probes = &probe;
    run r = begin(&options);
    dem_counts counts = {.struct_size = sizeof counts};
    assert_int_equal(dem_simulation_advance(r.simulation, 2600 * 2e-5), DEM_OK);
    assert_int_equal(dem_simulation_counts(r.simulation, &counts), DEM_OK);
    assert_true(counts.steps >= 2600);
    assert_int_equal(dem_trajectory_finish(r.trajectory), DEM_OK);
    assert_int_equal(count_rows(r.path, "/history/t"), 1);
    const table t = read_table(r.path, "/probes/first/t");
    assert_int_equal(t.extent[0], counts.steps);
    for (hsize_t k = 1; k < t.extent[0]; k++) assert_true(t.value[k] > t.value[k - 1]);
    free(t.value);
    end(&r);
}

TEST(the_part_can_be_looked_at_while_the_run_goes_on)
{
    CLEANUP(end) run r = begin_usual();
    const dem_observer observer = SIZED(dem_observer, .interval = interval, .frame = look_at_part, .context = &r);
    assert_int_equal(dem_simulation_observe(r.simulation, &observer), DEM_OK);
    assert_int_equal(dem_simulation_advance(r.simulation, 3 * interval), DEM_OK);
}

/* As another process sees it: through the bytes in the file system. */
static void copy_bytes(const char *from, const char *to)
{
    char buffer[4096];
    FILE *in = fopen(from, "rb"), *out = fopen(to, "wb");
    assert_true(in != NULL && out != NULL);
    for (size_t n; (n = fread(buffer, 1, sizeof buffer, in)) > 0;) assert_int_equal(fwrite(buffer, 1, n, out), n);
    assert_int_equal(fclose(in), 0);
    assert_int_equal(fclose(out), 0);
}

static dem_status look_at_bytes(void *context, const dem_simulation *simulation)
{
    const run *r = context;
    motion state;
    motion_see(simulation, &state);
    copy_bytes(r->part, r->path);
    const int64_t n = count_steps(r->path);
    assert_close(read_cell(r->path, "/VTKHDF/Steps/Values", (hsize_t)n - 1), state.t, 0.0);
    assert_int_equal(count_rows(r->path, "/VTKHDF/Points"), n * dem_model_lattice(r->model)->n_nodes);
    return DEM_OK;
}

TEST(a_part_that_stays_open_is_whole_after_every_frame)
{
    enum { RESERVED = 1 << 20 }; /* at least, before a frame is written */
    dem_trajectory_options options = every_frame();
    options.stays_open = true;
    CLEANUP(end) run r = begin(&options);
    const dem_observer observer = SIZED(dem_observer, .interval = interval, .frame = look_at_bytes, .context = &r);
    struct stat about;
    assert_int_equal(dem_simulation_observe(r.simulation, &observer), DEM_OK);
    assert_int_equal(dem_simulation_advance(r.simulation, 3 * interval), DEM_OK);
    assert_int_equal(stat(r.part, &about), 0);
    assert_in_range(about.st_size, 1, RESERVED - 1);
    assert_int_equal(dem_trajectory_finish(r.trajectory), DEM_OK);
    assert_int_equal(count_steps(r.path), 4);
    assert_last_frame_is_the_state(&r, 4, 1e-8);
}

TEST(a_reader_does_not_stop_the_run)
{
    CLEANUP(end) run r = begin_usual();
    const int lock = open(r.part, O_RDONLY);
    assert_int_equal(flock(lock, LOCK_SH), 0); /* as HDF5 does for a reader */
    assert_int_equal(dem_simulation_advance(r.simulation, interval), DEM_OK);
    assert_int_equal(count_steps(r.part), 2);
    (void)close(lock);
}

TEST(a_body_of_one_node_has_points_and_no_cells)
{
    const dem_trajectory_options options = every_frame();
    CLEANUP(end) run r;
    make_folder(&r);
    make_point(&r);
    make_simulation(&r);
    open_trajectory(&r, &options);
    assert_int_equal(dem_simulation_advance(r.simulation, 2 * interval), DEM_OK);
    assert_int_equal(dem_trajectory_finish(r.trajectory), DEM_OK);
    assert_int_equal(count_rows(r.path, "/VTKHDF/Points"), 3);
    assert_int_equal(count_rows(r.path, "/VTKHDF/Types"), 0);
    assert_int_equal(count_rows(r.path, "/VTKHDF/CellData/strain"), 0);
    assert_last_frame_is_the_state(&r, 3, 1e-8);
    assert_false(exists(r.obstacle));
    assert_false(exists(r.body));
}

/* ---- history ---- */

TEST(history_has_a_row_for_every_accepted_step)
{
    CLEANUP(end) run r = begin_usual();
    assert_int_equal(dem_simulation_advance(r.simulation, 20 * interval), DEM_OK);
    assert_int_equal(dem_trajectory_finish(r.trajectory), DEM_OK);
    const table t = read_table(r.path, "/history/t"), h = read_table(r.path, "/history/h");
    const hsize_t n = t.extent[0];
    for (hsize_t k = 1; k < n; k++) assert_close(t.value[k] - t.value[k - 1], h.value[k], 1e-12);
    assert_close(t.value[0], 0.0, 0.0);
    assert_true(n > 50);
    static const char *const columns[] = {"kinetic",
                                          "elastic",
                                          "area",
                                          "guard",
                                          "gravity",
                                          "impact",
                                          "friction",
                                          "damping",
                                          "projection",
                                          "contacts",
                                          "impacts",
                                          "steps",
                                          "events",
                                          "late",
                                          "guarded",
                                          "inverted",
                                          "area_min",
                                          "evaluations",
                                          "strain_min",
                                          "strain_max",
                                          "body_centre",
                                          "body_velocity",
                                          "body_angular_momentum",
                                          "obstacle_reaction",
                                          "obstacle_point",
                                          "obstacle_impulse",
                                          "obstacle_friction_impulse",
                                          "obstacle_contacts",
                                          "obstacle_displacement",
                                          "obstacle_angle",
                                          "obstacle_power"};
    for (size_t c = 0; c < sizeof columns / sizeof columns[0]; c++) {
        char name[64];
        (void)snprintf(name, sizeof name, "/history/%s", columns[c]);
        assert_int_equal(count_rows(r.path, name), n);
    }
    free(t.value);
    free(h.value);
}

TEST(history_tells_bodies_and_obstacles_apart)
{
    CLEANUP(end) run r = begin_usual();
    assert_int_equal(dem_simulation_advance(r.simulation, 20 * interval), DEM_OK);
    assert_int_equal(dem_trajectory_finish(r.trajectory), DEM_OK);
    const table impulse = read_table(r.path, "/history/obstacle_impulse");
    const table velocity = read_table(r.path, "/history/body_velocity");
    const hsize_t last = impulse.extent[0] - 1;
    const double gained = velocity.value[2 * last + 1] - velocity.value[1], t = read_cell(r.path, "/history/t", last);
    assert_int_equal(impulse.extent[1], 2);
    assert_int_equal(impulse.extent[2], 2);
    assert_int_equal(velocity.extent[1], 1);
    assert_close(velocity.value[0], 1.0, 1e-12);
    assert_true(impulse.value[4 * last + 1] > 0.0);
    assert_close(impulse.value[4 * last + 1], dem_model_mass(r.model) * (gained + 9.81 * t), 1e-3);
    assert_close(impulse.value[4 * last + 3], 0.0, 0.0);
    free(impulse.value);
    free(velocity.value);
}

TEST(without_frames_there_is_only_the_history)
{
    const dem_trajectory_options options = dem_trajectory_options_default();
    CLEANUP(end) run r = begin(&options);
    assert_int_equal(dem_simulation_advance(r.simulation, 0.03), DEM_OK);
    assert_true(count_rows(r.part, "/history/t") >= 1024); /* what filled the buffer */
    assert_int_equal(dem_trajectory_finish(r.trajectory), DEM_OK);
    const hsize_t n = count_rows(r.path, "/history/t");
    assert_close(read_cell(r.path, "/history/steps", n - 1), (double)n - 1.0, 0.0);
    assert_false(has(r.path, "/VTKHDF"));
    assert_true(has(r.path, "/lattice"));
}

/* ---- events ---- */

static dem_trajectory_options with_events(void)
{
    dem_trajectory_options options = every_frame();
    options.events = 1;
    return options;
}

TEST(every_event_has_a_row_in_the_order_of_time)
{
    const dem_trajectory_options options = with_events();
    CLEANUP(end) run r = begin(&options);
    assert_int_equal(dem_simulation_advance(r.simulation, 20 * interval), DEM_OK);
    assert_int_equal(dem_trajectory_finish(r.trajectory), DEM_OK);
    const table t = read_table(r.path, "/events/t"), kind = read_table(r.path, "/events/kind");
    dem_index impacts = 0;
    for (hsize_t k = 0; k < t.extent[0]; k++) {
        impacts += kind.value[k] == DEM_EVENT_IMPACT;
        assert_true(k == 0 || t.value[k] >= t.value[k - 1]);
    }
    const hsize_t last = count_rows(r.path, "/history/t") - 1;
    assert_true(impacts > 2);
    assert_close(read_cell(r.path, "/history/impacts", last), (double)impacts, 0.0);
    free(t.value);
    free(kind.value);
}

TEST(events_are_written_only_where_they_are_wanted)
{
    CLEANUP(end) run r = begin_usual();
    assert_null(ask_trajectory_observer(r.trajectory).event);
    assert_int_equal(dem_trajectory_finish(r.trajectory), DEM_OK);
    assert_false(has(r.path, "/events"));
}

TEST(without_an_event_the_table_is_there_and_empty)
{
    const dem_trajectory_options options = with_events();
    CLEANUP(end) run r = begin(&options);
    assert_int_equal(dem_trajectory_finish(r.trajectory), DEM_OK);
    assert_int_equal(count_rows(r.path, "/events/x"), 0);
}

TEST(events_reach_the_file_with_a_frame_or_a_full_buffer)
{
    const dem_trajectory_options options = with_events();
    CLEANUP(end) run r = begin(&options);
    const dem_observer observer = ask_trajectory_observer(r.trajectory);
    const hsize_t full = 1024;
    dem_event event = {.kind = DEM_EVENT_SLIP};
    for (hsize_t k = 0; k <= full; k++) {
        event.t = (double)k;
        assert_int_equal(observer.event(observer.context, r.simulation, &event), DEM_OK);
    }
    assert_int_equal(count_rows(r.part, "/events/t"), full);
    assert_int_equal(observer.frame(observer.context, r.simulation), DEM_OK);
    assert_int_equal(count_rows(r.part, "/events/t"), full + 1);
    assert_close(read_cell(r.part, "/events/t", full), (double)full, 0.0);
    event.t += 1.0;
    assert_int_equal(observer.event(observer.context, r.simulation, &event), DEM_OK);
    assert_int_equal(dem_trajectory_finish(r.trajectory), DEM_OK);
    assert_int_equal(count_rows(r.path, "/events/kind"), full + 2);
    assert_int_equal(observer.event(observer.context, r.simulation, &event), DEM_ERROR_ARGUMENT);
    assert_non_null(strstr(dem_status_message(), "is finished and takes no more events"));
}

TEST(a_lost_event_is_not_published)
{
    const dem_trajectory_options options = with_events();
    CLEANUP(end) run r = begin(&options);
    const hid_t file = H5Fopen(r.part, H5F_ACC_RDWR, H5P_DEFAULT);
    assert_true(H5Ldelete(file, "/events/energy", H5P_DEFAULT) >= 0);
    (void)H5Fclose(file);
    assert_int_equal(dem_trajectory_finish(r.trajectory), DEM_ERROR_IO);
    assert_non_null(strstr(dem_status_message(), "/events/energy: cannot be opened"));
    assert_false(exists(r.path));
}

/* ---- lattice, obstacles, notes ---- */

TEST(the_lattice_comes_back)
{
    CLEANUP(end) run r = begin_usual();
    CLEANUP(dem_lattice_free) dem_lattice back = dem_lattice_empty();
    assert_int_equal(dem_trajectory_finish(r.trajectory), DEM_OK);
    assert_int_equal(dem_lattice_read(&back, r.path), DEM_OK);
    const dem_lattice *lattice = dem_model_lattice(r.model);
    const size_t n = (size_t)lattice->n_nodes, m = (size_t)lattice->n_springs, t = (size_t)lattice->n_triangles;
    assert_int_equal(back.n_nodes, n);
    assert_int_equal(back.n_springs, m);
    assert_int_equal(back.n_triangles, t);
    assert_memory_equal(back.x, lattice->x, 2 * n * sizeof(double));
    assert_memory_equal(back.mass, lattice->mass, n * sizeof(double));
    assert_memory_equal(back.ends, lattice->ends, 2 * m * sizeof(dem_index));
    assert_memory_equal(back.rest_length, lattice->rest_length, m * sizeof(double));
    assert_memory_equal(back.stiffness, lattice->stiffness, m * sizeof(double));
    assert_memory_equal(back.triangles, lattice->triangles, 3 * t * sizeof(dem_index));
    assert_memory_equal(back.guard, lattice->guard, t * sizeof(double));
    assert_memory_equal(back.area_stiffness, lattice->area_stiffness, t * sizeof(double));
    assert_memory_equal(back.flags, lattice->flags, n);
    assert_memory_equal(back.body, lattice->body, n * sizeof(int32_t));
    assert_memory_equal(back.position, lattice->position, 2 * n * sizeof(double));
    assert_memory_equal(back.velocity, lattice->velocity, 2 * n * sizeof(double));
}

TEST(obstacles_are_in_a_file_beside_the_run)
{
    CLEANUP(end) run r = begin_usual();
    const double ends[8] = {0, 1, 1, 2, 2, 3, 4, 5}, owner[4] = {0, 0, 0, 1};
    const table connectivity = read_table(r.obstacle, "/VTKHDF/Connectivity");
    const table obstacle = read_table(r.obstacle, "/VTKHDF/CellData/obstacle");
    assert_int_equal(connectivity.extent[0], 8);
    assert_int_equal(obstacle.extent[0], 4);
    assert_memory_equal(connectivity.value, ends, sizeof ends);
    assert_memory_equal(obstacle.value, owner, sizeof owner);
    assert_close(read_cell(r.obstacle, "/VTKHDF/Points", 3 * 4), 4.0, 0.0);
    assert_close(read_cell(r.part, "/obstacles/1/points", 2), 5.0, 0.0);
    free(connectivity.value);
    free(obstacle.value);
}

/* While it goes on, and when it is finished. */
TEST(a_file_beside_the_run_shows_its_triangles)
{
    CLEANUP(end) run r = begin_usual();
    const hsize_t n = (hsize_t)dem_model_lattice(r.model)->n_triangles;
    assert_int_equal(count_rows(r.body, "/VTKHDF/Types"), n);
    assert_int_equal(dem_simulation_advance(r.simulation, 2 * interval), DEM_OK);
    assert_int_equal(count_rows(r.body, "/VTKHDF/CellData/vtkGhostType"), 3 * n);
    assert_int_equal(dem_trajectory_finish(r.trajectory), DEM_OK);
    assert_false(exists(r.part));
    assert_int_equal(count_rows(r.body, "/VTKHDF/CellData/vtkGhostType"), 3 * n);
    assert_int_equal(count_rows(r.body, "/VTKHDF/Points"), count_rows(r.path, "/VTKHDF/Points"));
}

TEST(notes_are_kept_and_replaced)
{
    CLEANUP(end) run r = begin_usual();
    char text[16] = "unchanged";
    assert_int_equal(dem_trajectory_note(r.trajectory, "deck", "first and longer"), DEM_OK);
    assert_int_equal(dem_trajectory_note(r.trajectory, "deck", "&run\n/\n"), DEM_OK);
    assert_int_equal(dem_trajectory_note(r.trajectory, "nothing", ""), DEM_OK);
    assert_int_equal(dem_trajectory_finish(r.trajectory), DEM_OK);
    assert_int_equal(dem_trajectory_read_note(r.path, "deck", text, 7), DEM_ERROR_ARGUMENT);
    assert_string_equal(text, "unchanged");
    assert_int_equal(dem_trajectory_read_note(r.path, "deck", text, 8), DEM_OK);
    assert_string_equal(text, "&run\n/\n");
    assert_int_equal(dem_trajectory_read_note(r.path, "nothing", text, sizeof text), DEM_OK);
    assert_string_equal(text, "");
    assert_int_equal(dem_trajectory_read_note(r.path, "absent", text, sizeof text), DEM_ERROR_IO);
    assert_non_null(strstr(dem_status_message(), "/provenance/absent"));
    assert_int_equal(dem_trajectory_read_note("none.vtkhdf", "deck", text, sizeof text), DEM_ERROR_IO);
}

/* ---- the same run makes the same bytes ---- */

static char *read_bytes(const char *path, size_t *size)
{
    struct stat about;
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    assert_int_equal(fstat(fileno(file), &about), 0);
    char *bytes = malloc((size_t)about.st_size);
    assert_non_null(bytes);
    *size = fread(bytes, 1, (size_t)about.st_size, file);
    assert_int_equal(*size, about.st_size);
    (void)fclose(file);
    return bytes;
}

TEST(two_runs_make_the_same_bytes)
{
    const dem_trajectory_options options = every_frame();
    run r[2];
    char *bytes[2];
    size_t size[2];
    for (int k = 0; k < 2; k++) {
        r[k] = begin(&options);
        assert_int_equal(dem_trajectory_note(r[k].trajectory, "title", "twice"), DEM_OK);
        assert_int_equal(dem_simulation_advance(r[k].simulation, 5 * interval), DEM_OK);
        assert_int_equal(dem_trajectory_finish(r[k].trajectory), DEM_OK);
        bytes[k] = read_bytes(r[k].path, &size[k]);
        if (k == 0) (void)sleep(1); /* modification times would differ now */
    }
    assert_int_equal(size[0], size[1]);
    assert_memory_equal(bytes[0], bytes[1], size[0]);
    for (int k = 0; k < 2; k++) {
        free(bytes[k]);
        end(&r[k]);
    }
}

/* A block large enough for its frames to be packed by several threads, in free fall. */
static run begin_large(int threads)
{
    const dem_material rubber =
        SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 0.4, .density = 1050.0, .thickness = 1.0);
    run r;
    dem_trajectory_options wanted = dem_trajectory_options_default();
    dem_options options = dem_options_default();
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    make_folder(&r);
    assert_int_equal(dem_lattice_rectangle(&lattice, 0.02, 0.02, 2.2e-4), DEM_OK);
    assert_int_equal(dem_lattice_assemble(&lattice, &rubber), DEM_OK);
    lattice.x[1] += 2e-5;
    assert_int_equal(dem_model_create(&r.model, &lattice, NULL, 0), DEM_OK);
    options.threads = threads, options.thread_nodes = 1;
    assert_int_equal(dem_simulation_create(&r.simulation, r.model, &options), DEM_OK);
    wanted.frame_interval = 2e-6;
    open_trajectory(&r, &wanted);
    return r;
}

TEST(any_number_of_threads_makes_the_same_bytes)
{
    char *bytes[3];
    size_t size[3];
    for (int k = 0; k < 3; k++) {
        run r = begin_large(k + 1);
        assert_int_equal(dem_simulation_advance(r.simulation, 5e-6), DEM_OK);
        assert_int_equal(dem_trajectory_finish(r.trajectory), DEM_OK);
        bytes[k] = read_bytes(r.path, &size[k]);
        assert_int_equal(size[k], size[0]);
        assert_memory_equal(bytes[k], bytes[0], size[0]);
        end(&r);
    }
    for (int k = 0; k < 3; k++) free(bytes[k]);
}

/* ---- failures ---- */

TEST(finishing_replaces_an_older_run)
{
    CLEANUP(end) run r = begin_usual();
    FILE *old = fopen(r.path, "w");
    assert_non_null(old);
    (void)fputs("old", old);
    (void)fclose(old);
    assert_int_equal(dem_simulation_advance(r.simulation, interval), DEM_OK);
    assert_int_equal(dem_trajectory_finish(r.trajectory), DEM_OK);
    assert_int_equal(count_steps(r.path), 2);
    assert_false(exists(r.part));
}

TEST(a_finished_trajectory_takes_nothing_more)
{
    CLEANUP(end) run r = begin_usual();
    assert_int_equal(dem_trajectory_finish(r.trajectory), DEM_OK);
    const dem_observer observer = ask_trajectory_observer(r.trajectory);
    assert_int_equal(observer.frame(observer.context, r.simulation), DEM_ERROR_ARGUMENT);
    assert_int_equal(observer.step(observer.context, r.simulation), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_trajectory_note(r.trajectory, "late", "x"), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_trajectory_finish(r.trajectory), DEM_ERROR_ARGUMENT);
}

static void assert_create_fails(const run *r, const char *path, const dem_trajectory_options *options,
                                dem_status status, const char *words)
{
    dem_trajectory *trajectory = NULL;
    assert_int_equal(dem_trajectory_create(&trajectory, path, r->simulation, options), status);
    assert_null(trajectory);
    if (strstr(dem_status_message(), words) == NULL) fail_msg("\"%s\" lacks \"%s\"", dem_status_message(), words);
}

TEST(bad_arguments_are_refused)
{
    CLEANUP(end) run r;
    dem_trajectory_options options = every_frame();
    make_folder(&r);
    make_model(&r, 0);
    make_simulation(&r);
    assert_create_fails(&r, "run.h5", &options, DEM_ERROR_ARGUMENT, "run.h5: the name of a trajectory ends in .vtkhdf");
    assert_create_fails(&r, ".vtkhdf", &options, DEM_ERROR_ARGUMENT, "ends in");
    assert_create_fails(&r, "a/.vtkhdf", &options, DEM_ERROR_ARGUMENT, "ends in");
    assert_create_fails(&r, NULL, &options, DEM_ERROR_ARGUMENT, "NULL");
    assert_create_fails(&r, "/no/such/folder/run.vtkhdf", &options, DEM_ERROR_IO,
                        "/no/such/folder/run.part.vtkhdf: cannot be created (No such file or directory)");
    options.deflate = 10;
    assert_create_fails(&r, r.path, &options, DEM_ERROR_ARGUMENT, "deflate is 10, not in 0 to 9");
    options = every_frame(), options.history_interval = -1e-3;
    assert_create_fails(&r, r.path, &options, DEM_ERROR_ARGUMENT, "history_interval is -0.001 s");
    options = every_frame(), options.history_interval = NAN;
    assert_create_fails(&r, r.path, &options, DEM_ERROR_ARGUMENT, "history_interval");
    options = every_frame(), options.frame_interval = NAN;
    assert_create_fails(&r, r.path, &options, DEM_ERROR_ARGUMENT, "frame_interval");
    options = every_frame(), options.fields = 1024 | DEM_FIELD_STRESS;
    assert_create_fails(&r, r.path, &options, DEM_ERROR_ARGUMENT, "fields is 0x404, with unknown bits");
    options = every_frame(), options.most_stressed = -1;
    assert_create_fails(&r, r.path, &options, DEM_ERROR_ARGUMENT, "most_stressed is -1; it must be >= 0");
    options = every_frame(), options.n_probes = 2;
    assert_create_fails(&r, r.path, &options, DEM_ERROR_ARGUMENT, "2 probes, probes is NULL");
    const dem_probe same[2] = {{"p", DEM_PROBE_NODE, {0, 0}, 1}, {"p", DEM_PROBE_SPRING, {0, 0}, 1}};
    options.probes = same;
    assert_create_fails(&r, r.path, &options, DEM_ERROR_ARGUMENT, "two probes have the name p");
    options = every_frame(), options.struct_size = 0;
    assert_create_fails(&r, r.path, &options, DEM_ERROR_ARGUMENT, "dem_trajectory_options: struct_size is 0");
    options = every_frame();
    open_trajectory(&r, &options);
    assert_int_equal(dem_trajectory_note(r.trajectory, "a/b", "x"), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_trajectory_note(r.trajectory, "", "x"), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_trajectory_note(r.trajectory, "a", NULL), DEM_ERROR_ARGUMENT);
    dem_trajectory_destroy(NULL);
}

TEST(a_lost_part_ends_the_run_with_its_name)
{
    CLEANUP(end) run r = begin_usual();
    assert_int_equal(dem_simulation_advance(r.simulation, interval), DEM_OK);
    assert_int_equal(unlink(r.part), 0);
    assert_int_equal(dem_simulation_advance(r.simulation, 2 * interval), DEM_ERROR_IO);
    assert_non_null(strstr(dem_status_message(), "run.part.vtkhdf: cannot be opened (No such file or directory)"));
    assert_int_equal(dem_trajectory_finish(r.trajectory), DEM_ERROR_IO);
    assert_false(exists(r.path));
}

/* Overwrites the middle of the file, where deflated frames lie: HDF5 opens it all the same. */
TEST(a_damaged_part_is_not_published)
{
    CLEANUP(end) run r = begin_usual();
    char junk[4096];
    memset(junk, 0x5a, sizeof junk);
    const hid_t file = H5Fopen(r.part, H5F_ACC_RDONLY, H5P_DEFAULT);
    const hid_t dataset = H5Dopen2(file, "/lattice/x", H5P_DEFAULT);
    haddr_t address = HADDR_UNDEF;
    hsize_t size = 0, first[2];
    unsigned mask;
    const hid_t space = H5Dget_space(dataset);
    assert_true(H5Dget_chunk_info(dataset, space, 0, first, &mask, &address, &size) >= 0);
    (void)H5Sclose(space);
    (void)H5Dclose(dataset);
    (void)H5Fclose(file);
    const int descriptor = open(r.part, O_WRONLY);
    assert_int_equal(pwrite(descriptor, junk, size < sizeof junk ? size : sizeof junk, (off_t)address),
                     size < sizeof junk ? size : sizeof junk);
    (void)close(descriptor);
    assert_int_equal(dem_trajectory_finish(r.trajectory), DEM_ERROR_IO);
    assert_non_null(strstr(dem_status_message(), "lattice/x: cannot be read back"));
    assert_false(exists(r.path));
}

/* RLIMIT_FSIZE stands in for a full disk. */
TEST(a_full_disk_leaves_the_frames_before_it)
{
    CLEANUP(end) run r = begin_usual();
    struct rlimit kept, small;
    struct stat about;
    assert_int_equal(stat(r.part, &about), 0);
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &kept), 0);
    small = kept;
    small.rlim_cur = (rlim_t)about.st_size + (3 << 20);
    void (*handler)(int) = signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    const dem_status status = dem_simulation_advance(r.simulation, 0.5);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &kept), 0);
    (void)signal(SIGXFSZ, handler);
    assert_int_equal(status, DEM_ERROR_IO);
    assert_non_null(strstr(dem_status_message(), "run.part.vtkhdf: there is no room for"));
    const int64_t n = count_steps(r.part);
    assert_true(n > 1);
    assert_close(read_cell(r.part, "/VTKHDF/Steps/Values", (hsize_t)n - 1), (double)(n - 1) * interval, 1e-15);
    assert_int_equal(dem_trajectory_finish(r.trajectory), DEM_OK); /* there is room again */
    assert_int_equal(count_steps(r.path), n);
}

TEST(the_version_is_that_of_the_library)
{
    unsigned number[3];
    char expected[48];
    assert_true(H5get_libversion(&number[0], &number[1], &number[2]) >= 0);
    (void)snprintf(expected, sizeof expected, "%u.%u.%u", number[0], number[1], number[2]);
    assert_string_equal(dem_version_hdf5(), expected);
}
