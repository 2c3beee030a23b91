/* SPDX-License-Identifier: BSD-3-Clause */
/* trajectory_parts.c, trajectory_rows.c, trajectory.c: a run cut into segments leaves the data of one that was left
 * alone. A run that is killed is one that is stopped and thrown away; one that goes on is a new one of the same bits
 * whose trajectory sees nothing before its checkpoint. */
#include "verification/support.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <dem/trajectory.h>

#include "base/checkpoint_entries.h"
#include "harness/cleanup_hdf5.h"
#include "output/hdf5_attribute.h"
#include "ask.h"
#include "unit/solids.h"
#include "unit/scratch.h"

static const double interval = 2e-4, end = 30e-4;

static const dem_probe probes[] = {{"corner", DEM_PROBE_NODE, {3, 0}, 1},
                                   {"width", DEM_PROBE_GAUGE, {0, 3}, 3},
                                   {"spring", DEM_PROBE_SPRING, {2, 0}, 5}};
enum { n_probes = sizeof probes / sizeof probes[0] };

/* ---- a folder and a body ---- */

typedef struct place {
    scratch_folder folder;
    dem_model *model;
} place;

static char *name_in(const place *p, const char *name)
{
    return folder_at(&p->folder, name);
}

static bool has(const place *p, const char *name)
{
    return access(name_in(p, name), F_OK) == 0;
}

/* A block falls onto a floor that it slides along. */
static place open_place(void)
{
    place p;
    const double floor[4] = {-1.0, 0.0, 1.0, 0.0}, offset[2] = {0.0, 1.3e-3}, velocity[2] = {1.0, -5.0};
    const dem_obstacle obstacle =
        SIZED(dem_obstacle, .n_points = 2, .points = floor, .restitution = 0.5, .friction = 0.3);
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_solid(0.02, 0.02, 5e-3);
    folder_open(&p.folder);
    dem_lattice_move(&lattice, 0.1, offset);
    assert_ok(dem_lattice_launch(&lattice, velocity));
    assert_ok(dem_model_create(&p.model, &lattice, &obstacle, 1));
    return p;
}

static void sweep(const place *p, const char *name)
{
    (void)unlink(name_in(p, name));
}

/* Nothing was left behind but what a test names. */
static void close_place(place *p)
{
    sweep(p, "run.vtkhdf");
    sweep(p, "run.part.vtkhdf");
    sweep(p, "run.obstacle.vtkhdf");
    sweep(p, "run.body.vtkhdf");
    sweep(p, "quiet.vtkhdf");
    sweep(p, "quiet.obstacle.vtkhdf");
    sweep(p, "quiet.body.vtkhdf");
    dem_model_destroy(p->model);
    folder_close(&p->folder);
}

static void copy_file(const place *p, const char *from, const char *to)
{
    char *source = name_in(p, from), *target = name_in(p, to);
    struct stat about;
    FILE *in = fopen(source, "rb"), *out = fopen(target, "wb");
    assert_true(in != NULL && out != NULL && fstat(fileno(in), &about) == 0);
    CLEANUP(free_memory) char *bytes = malloc((size_t)about.st_size);
    assert_non_null(bytes);
    assert_int_equal(fread(bytes, 1, (size_t)about.st_size, in), about.st_size);
    assert_int_equal(fwrite(bytes, 1, (size_t)about.st_size, out), about.st_size);
    (void)fclose(in);
    (void)fclose(out);
}

/* ---- names that change ---- */

int __real_rename(const char *from, const char *to);
int __wrap_rename(const char *from, const char *to);
int __real_unlink(const char *path);
int __wrap_unlink(const char *path);

/* Of rename() and unlink(): before that call the process ends, that call fails; 0: none. */
static int calls, fatal, failing;

static bool is_well(void)
{
    if (++calls == fatal) _exit(2);
    errno = EIO;
    return calls != failing;
}

int __wrap_rename(const char *from, const char *to)
{
    return is_well() ? __real_rename(from, to) : -1;
}

int __wrap_unlink(const char *path)
{
    return is_well() ? __real_unlink(path) : -1;
}

/* ---- a run, from a checkpoint to where it is killed ---- */

/* A checkpoint and its place: accepted steps, the one at t = 0 included. */
typedef struct point {
    dem_index step;
    dem_checkpoint *checkpoint;
} point;

static void drop_point(const point *p)
{
    dem_checkpoint_destroy(p->checkpoint);
}

/* Steps at which something happens; 0: never. */
typedef struct plan {
    dem_index checkpoint; /* one is taken, */
    dem_index segment;    /* its segment is made: at once, or later; */
    dem_index kill;
} plan;

typedef struct session {
    plan plan;
    dem_index from, steps; /* what is seen begins behind `from` */
    dem_trajectory *trajectory;
    dem_observer to;
    dem_checkpoint *checkpoint;
} session;

/* The segment that was finished last, for a process that watches this one. */
static int own_progress, *progress = &own_progress;

static dem_status see_frame(void *context, const dem_simulation *simulation)
{
    const session *s = context;
    return s->steps < s->from ? DEM_OK : s->to.frame(s->to.context, simulation);
}

static dem_status see_event(void *context, const dem_simulation *simulation, const dem_event *event)
{
    const session *s = context;
    if (s->steps < s->from || s->to.event == NULL) return DEM_OK;
    return s->to.event(s->to.context, simulation, event);
}

static dem_status see_step(void *context, const dem_simulation *simulation)
{
    session *s = context;
    if (s->steps++ >= s->from) assert_ok(s->to.step(s->to.context, simulation));
    if (s->steps == s->plan.checkpoint) assert_ok(s->to.checkpoint(s->to.context, simulation, s->checkpoint));
    if (s->steps == s->plan.segment) {
        assert_ok(dem_trajectory_segment(s->trajectory, s->checkpoint));
        ++*progress;
    }
    return s->steps == s->plan.kill ? DEM_STOPPED : DEM_OK;
}

static dem_trajectory_options everything(void)
{
    dem_trajectory_options options = dem_trajectory_options_default();
    options.frame_interval = interval, options.events = 1, options.fields = DEM_FIELD_ALL;
    options.breaks = options.fragments = true;
    options.n_probes = n_probes, options.probes = probes;
    return options;
}

static void note_all(dem_trajectory *trajectory)
{
    assert_ok(dem_trajectory_note(trajectory, "title", "first"));
    assert_ok(dem_trajectory_note(trajectory, "deck", "&run /\n"));
    assert_ok(dem_trajectory_note(trajectory, "title", "cut"));
}

static dem_simulation *make_simulation(const place *p)
{
    dem_options options = dem_options_default();
    options.spacing = 5e-3, options.max_step = 2e-5, options.v_scale = 5.0;
    dem_simulation *simulation = support_simulation(p->model, &options);
    return simulation;
}

static void watch(dem_simulation *simulation, session *s, dem_peaks *peaks)
{
    const dem_observer watching = ask_peaks_observer(peaks);
    s->to = ask_trajectory_observer(s->trajectory);
    const dem_observer seeing = SIZED(dem_observer, .interval = s->to.interval, .frame = see_frame, .step = see_step,
                                      .event = see_event, .context = s);
    assert_ok(dem_simulation_observe(simulation, &watching));
    assert_ok(dem_simulation_observe(simulation, &seeing));
}

/* Runs from a point, or from the start, to the end or where it is killed.  \return the point of its checkpoint */
static point run_until(const place *p, const char *name, dem_trajectory_options options, const point *from, plan todo,
                       double t_end)
{
    session s = {.plan = todo, .from = from != NULL ? from->step : 0};
    CLEANUP(free_simulation) dem_simulation *simulation = make_simulation(p);
    CLEANUP(free_peaks) dem_peaks *peaks;
    const char *path = name_in(p, name);
    assert_ok(dem_checkpoint_create(&s.checkpoint));
    assert_ok(dem_peaks_create(&peaks, p->model, 4));
    options.peaks = peaks;
    assert_ok(from != NULL ? dem_trajectory_resume(&s.trajectory, path, simulation, &options, from->checkpoint)
                           : dem_trajectory_create(&s.trajectory, path, simulation, &options));
    note_all(s.trajectory);
    watch(simulation, &s, peaks);
    assert_int_equal(dem_simulation_advance(simulation, t_end), todo.kill > 0 ? DEM_STOPPED : DEM_OK);
    if (todo.kill == 0) assert_ok(dem_trajectory_finish(s.trajectory));
    dem_trajectory_destroy(s.trajectory);
    return (point){todo.checkpoint, s.checkpoint};
}

static point run(const place *p, const char *name, const point *from, plan todo)
{
    return run_until(p, name, everything(), from, todo, end);
}

static void run_quietly(const place *p)
{
    const point last = run(p, "quiet.vtkhdf", NULL, (plan){0, 0, 0});
    dem_checkpoint_destroy(last.checkpoint);
}

/* ---- the same data ---- */

typedef struct pair {
    hid_t other;
    int objects, datasets;
} pair;

static void *read_all(hid_t dataset, size_t *size)
{
    CLEANUP(free_h5) const hid_t type = H5Dget_type(dataset), space = H5Dget_space(dataset);
    *size = (size_t)H5Sget_simple_extent_npoints(space) * H5Tget_size(type);
    char *bytes = calloc(*size + 1, 1);
    assert_non_null(bytes);
    assert_true(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes) >= 0);
    return bytes;
}

static void assert_same_dataset(hid_t a, hid_t b, const char *name)
{
    hsize_t extent[2][3] = {{0}, {0}};
    const hid_t type[2] = {H5Dget_type(a), H5Dget_type(b)}, space[2] = {H5Dget_space(a), H5Dget_space(b)};
    if (H5Tequal(type[0], type[1]) <= 0) fail_msg("%s: types differ", name);
    for (int k = 0; k < 2; k++) (void)H5Sget_simple_extent_dims(space[k], extent[k], NULL);
    if (memcmp(extent[0], extent[1], sizeof extent[0]) != 0)
        fail_msg("%s: %llu rows and %llu", name, (unsigned long long)extent[0][0], (unsigned long long)extent[1][0]);
    size_t size[2];
    void *bytes[2] = {read_all(a, &size[0]), read_all(b, &size[1])};
    if (size[0] != size[1] || memcmp(bytes[0], bytes[1], size[0]) != 0) fail_msg("%s: bytes differ", name);
    for (int k = 0; k < 2; k++) {
        free(bytes[k]);
        (void)H5Sclose(space[k]);
        (void)H5Tclose(type[k]);
    }
}

static herr_t compare_attribute(hid_t object, const char *name, const H5A_info_t *info, void *other)
{
    char value[2][256] = {"", ""};
    (void)info;
    for (int k = 0; k < 2; k++) {
        CLEANUP(free_h5) const hid_t id = H5Aopen(k == 0 ? object : *(hid_t *)other, name, H5P_DEFAULT);
        if (id < 0) fail_msg("only one file has the attribute %s", name);
        CLEANUP(free_h5) const hid_t type = H5Aget_type(id);
        assert_true(H5Aget_storage_size(id) <= sizeof value[k]);
        assert_true(H5Aread(id, type, value[k]) >= 0);
    }
    if (memcmp(value[0], value[1], sizeof value[0]) != 0) fail_msg("attribute %s differs", name);
    return 0;
}

static herr_t compare_object(hid_t root, const char *name, const H5L_info_t *info, void *context)
{
    pair *p = context;
    (void)info;
    CLEANUP(free_h5) const hid_t a = H5Oopen(root, name, H5P_DEFAULT), b = H5Oopen(p->other, name, H5P_DEFAULT);
    hid_t other = b;
    if (a < 0 || b < 0) fail_msg("%s is in one file only", name);
    assert_int_equal(H5Iget_type(a), H5Iget_type(b));
    assert_true(H5Aiterate2(a, H5_INDEX_NAME, H5_ITER_INC, NULL, compare_attribute, &other) >= 0);
    p->objects++;
    p->datasets += H5Iget_type(a) == H5I_DATASET;
    if (H5Iget_type(a) == H5I_DATASET) assert_same_dataset(a, b, name);
    return 0;
}

/* Every object of a is in b and the same. */
static int compare(const char *a, const char *b)
{
    const hid_t files[2] = {H5Fopen(a, H5F_ACC_RDONLY, H5P_DEFAULT), H5Fopen(b, H5F_ACC_RDONLY, H5P_DEFAULT)};
    if (files[0] < 0 || files[1] < 0) fail_msg("%s or %s cannot be opened", a, b);
    pair p = {.other = files[1]};
    hid_t root = H5Oopen(files[1], "/", H5P_DEFAULT);
    assert_true(H5Aiterate2(files[0], H5_INDEX_NAME, H5_ITER_INC, NULL, compare_attribute, &root) >= 0);
    assert_true(H5Lvisit(files[0], H5_INDEX_NAME, H5_ITER_INC, compare_object, &p) >= 0);
    (void)H5Oclose(root);
    (void)H5Fclose(files[0]);
    (void)H5Fclose(files[1]);
    assert_true(p.datasets > 50);
    return p.objects;
}

static void assert_same_data(const place *p, const char *a, const char *b)
{
    assert_int_equal(compare(name_in(p, a), name_in(p, b)), compare(name_in(p, b), name_in(p, a)));
}

static dem_index count_rows(const place *p, const char *name, const char *dataset)
{
    hsize_t n = 0;
    hdf5_file file;
    assert_ok(hdf5_open_read(&file, name_in(p, name)));
    assert_ok(hdf5_close(&file, hdf5_count_rows(&file, dataset, &n)));
    return (dem_index)n;
}

/* ---- cut and joined ---- */

enum { most_sessions = 4 };

typedef struct story {
    const char *what; /* it is */
    struct {
        int from; /* the session whose checkpoint it goes on from, -1: none */
        plan plan;
    } sessions[most_sessions]; /* the last of them is not killed */
} story;

static void tell(const place *p, const story *s)
{
    point points[most_sessions] = {{0, NULL}};
    bool ended = false;
    for (int k = 0; k < most_sessions && !ended; k++) {
        const int from = s->sessions[k].from;
        points[k] = run(p, "run.vtkhdf", from >= 0 ? &points[from] : NULL, s->sessions[k].plan);
        ended = s->sessions[k].plan.kill == 0;
    }
    for (int k = 0; k < most_sessions; k++) dem_checkpoint_destroy(points[k].checkpoint);
}

TEST(a_run_that_was_cut_has_the_data_of_one_that_was_not)
{
    static const story stories[] = {
        {"killed right behind the segment", {{-1, {40, 40, 40}}, {0, {70, 70, 70}}, {1, {0, 0, 0}}}},
        {"rows behind the checkpoint", {{-1, {40, 58, 58}}, {0, {90, 117, 117}}, {1, {0, 0, 0}}}},
        {"killed long after the segment", {{-1, {40, 40, 95}}, {0, {70, 81, 99}}, {1, {0, 0, 0}}}},
        {"a checkpoint at t = 0, one before the first frame", {{-1, {1, 1, 1}}, {0, {2, 9, 9}}, {1, {0, 0, 0}}}},
        {"segments and no kill", {{-1, {64, 75, 0}}}},
        {"a segment without its checkpoint",
         {{-1, {40, 40, 60}}, {0, {70, 70, 80}}, {0, {71, 73, 85}}, {2, {0, 0, 0}}}},
        {"no segment yet", {{-1, {40, 0, 60}}, {-1, {30, 30, 50}}, {1, {0, 0, 0}}}},
    };
    CLEANUP(close_place) place p = open_place();
    run_quietly(&p);
    assert_true(count_rows(&p, "quiet.vtkhdf", "/history/t") > 130);
    assert_true(count_rows(&p, "quiet.vtkhdf", "/events/t") > 20);
    for (size_t k = 0; k < sizeof stories / sizeof stories[0]; k++) {
        tell(&p, &stories[k]);
        assert_same_data(&p, "quiet.vtkhdf", "run.vtkhdf");
        assert_false(has(&p, "run.part.vtkhdf"));
        assert_false(has(&p, "run.00001.vtkhdf"));
    }
}

/* As a version before the grid of triangles would have written it. */
static void make_old(const place *p, const char *name)
{
    static const char *const later[] = {"/bodies", "/VTKHDF/CellData/vtkGhostType",
                                        "/VTKHDF/Steps/CellDataOffsets/vtkGhostType"};
    hdf5_file file;
    assert_ok(hdf5_open_write(&file, name_in(p, name), 0));
    for (size_t k = 0; k < sizeof later / sizeof *later; k++)
        assert_true(H5Ldelete(file.id, later[k], H5P_DEFAULT) >= 0);
    assert_ok(hdf5_close(&file, DEM_OK));
}

/* From its segment, and from the whole of it. */
TEST(a_run_of_before_there_was_a_grid_of_triangles_goes_on)
{
    CLEANUP(close_place) place p = open_place();
    run_quietly(&p);
    CLEANUP(drop_point) const point a = run(&p, "run.vtkhdf", NULL, (plan){40, 40, 70});
    make_old(&p, "run.00001.vtkhdf");
    sweep(&p, "run.body.vtkhdf");
    CLEANUP(drop_point) const point b = run(&p, "run.vtkhdf", &a, (plan){0, 0, 0});
    assert_same_data(&p, "quiet.vtkhdf", "run.vtkhdf");
    assert_true(has(&p, "run.body.vtkhdf"));
    make_old(&p, "run.vtkhdf");
    CLEANUP(drop_point) const point c = run(&p, "run.vtkhdf", &a, (plan){0, 0, 0});
    assert_same_data(&p, "quiet.vtkhdf", "run.vtkhdf");
}

/* ---- a segment ---- */

static double first_time(const place *p, const char *name, const char *dataset)
{
    const hdf5_rows rows = {dataset, HDF5_F64, 1, {0, 0}, 0, 0};
    double t;
    hdf5_file file;
    assert_ok(hdf5_open_read(&file, name_in(p, name)));
    assert_ok(hdf5_close(&file, hdf5_read(&file, &rows, 0, 1, &t)));
    return t;
}

static void assert_begins_at(const place *p, const char *name, const char *dataset, dem_index first)
{
    const hdf5_rows rows = {dataset, HDF5_F64, 1, {0, 0}, 0, 0};
    double t;
    hdf5_file file;
    assert_ok(hdf5_open_read(&file, name_in(p, "quiet.vtkhdf")));
    assert_ok(hdf5_close(&file, hdf5_read(&file, &rows, (hsize_t)first, 1, &t)));
    assert_close(first_time(p, name, dataset), t, 0.0);
}

/* As ParaView sees it: offsets count within the file. */
static void assert_is_whole(const place *p, const char *name)
{
    const dem_index frames = count_rows(p, name, "/VTKHDF/Steps/Values"), n = ask_sizes(p->model).n_nodes;
    const hdf5_rows rows = {"/VTKHDF/Steps/PointOffsets", HDF5_I64, 1, {0, 0}, 0, 0};
    char text[16];
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    hdf5_file file;
    assert_true(frames > 0);
    assert_int_equal(count_rows(p, name, "/VTKHDF/Points"), frames * n);
    assert_ok(hdf5_open_read(&file, name_in(p, name)));
    for (dem_index k = 0; k < frames; k++) {
        dem_index offset = -1;
        assert_ok(hdf5_read(&file, &rows, (hsize_t)k, 1, &offset));
        assert_int_equal(offset, k * n);
    }
    assert_ok(hdf5_close(&file, hdf5_expect_attribute(&file, "/VTKHDF/Steps", "NSteps", frames)));
    assert_ok(dem_trajectory_read_note(name_in(p, name), "title", text, sizeof text));
    assert_string_equal(text, "cut");
    assert_ok(dem_lattice_read(&lattice, name_in(p, name)));
}

/* Three sessions: what is in the part when the last of them is killed. */
TEST(a_segment_is_a_file_of_its_own_with_just_the_rows_up_to_its_checkpoint)
{
    CLEANUP(close_place) place p = open_place();
    run_quietly(&p);
    CLEANUP(drop_point)
    const point a = run(&p, "run.vtkhdf", NULL, (plan){40, 58, 58}), b = run(&p, "run.vtkhdf", &a, (plan){80, 80, 80});
    CLEANUP(drop_point) const point c = run(&p, "run.vtkhdf", &b, (plan){110, 130, 130});
    const char *const names[] = {"run.00001.vtkhdf", "run.00002.vtkhdf", "run.00003.vtkhdf", "run.part.vtkhdf"};
    const dem_index rows[] = {40, 40, 30, 20};
    dem_index frames = 0, steps = 0, events = 0, corner = 0;
    for (int k = 0; k < 4; k++) {
        assert_int_equal(count_rows(&p, names[k], "/history/t"), rows[k]);
        assert_is_whole(&p, names[k]);
        assert_begins_at(&p, names[k], "/history/t", steps);
        assert_begins_at(&p, names[k], "/probes/corner/t", corner);
        assert_begins_at(&p, names[k], "/VTKHDF/Steps/Values", frames);
        if (count_rows(&p, names[k], "/events/t") > 0) assert_begins_at(&p, names[k], "/events/t", events);
        steps += rows[k];
        corner += count_rows(&p, names[k], "/probes/corner/t");
        frames += count_rows(&p, names[k], "/VTKHDF/Steps/Values");
        events += count_rows(&p, names[k], "/events/t");
        sweep(&p, names[k]);
    }
}

/* A trajectory that has seen the first steps of a run. */
typedef struct opened {
    dem_simulation *simulation;
    dem_trajectory *trajectory;
    dem_observer observer;
    dem_checkpoint *checkpoint;
} opened;

static opened open_run(const place *p, const dem_trajectory_options *options)
{
    opened o;
    o.simulation = make_simulation(p);
    assert_ok(dem_trajectory_create(&o.trajectory, name_in(p, "run.vtkhdf"), o.simulation, options));
    o.observer = ask_trajectory_observer(o.trajectory);
    assert_ok(dem_simulation_observe(o.simulation, &o.observer));
    assert_ok(dem_simulation_advance(o.simulation, 2 * interval));
    assert_ok(dem_checkpoint_create(&o.checkpoint));
    assert_ok(o.observer.checkpoint(o.observer.context, o.simulation, o.checkpoint));
    return o;
}

static void close_run(opened *o)
{
    dem_checkpoint_destroy(o->checkpoint);
    dem_trajectory_destroy(o->trajectory);
    dem_simulation_destroy(o->simulation);
}

static void assert_says(const char *words)
{
    if (strstr(dem_status_message(), words) == NULL) fail_msg("\"%s\" lacks \"%s\"", dem_status_message(), words);
}

TEST(the_segment_of_a_checkpoint_is_made_once)
{
    CLEANUP(close_place) place p = open_place();
    const dem_trajectory_options options = everything();
    CLEANUP(close_run) opened o = open_run(&p, &options);
    for (int k = 0; k < 2; k++) assert_ok(dem_trajectory_segment(o.trajectory, o.checkpoint));
    assert_true(has(&p, "run.00001.vtkhdf"));
    assert_false(has(&p, "run.00002.vtkhdf"));
    CLEANUP(free_checkpoint) dem_checkpoint *later = NULL, *empty = NULL;
    assert_ok(dem_checkpoint_create(&later));
    assert_ok(dem_checkpoint_create(&empty));
    assert_ok(dem_simulation_advance(o.simulation, 4 * interval));
    assert_ok(o.observer.checkpoint(o.observer.context, o.simulation, later));
    assert_ok(dem_trajectory_segment(o.trajectory, later));
    assert_int_equal(dem_trajectory_segment(o.trajectory, o.checkpoint), DEM_ERROR_ARGUMENT);
    assert_says("run.part.vtkhdf: the checkpoint is at row 3 of frames, rows 5 to 5 are here");
    assert_int_equal(dem_trajectory_segment(o.trajectory, empty), DEM_ERROR_IO);
    assert_int_equal(dem_trajectory_segment(o.trajectory, NULL), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_trajectory_segment(NULL, later), DEM_ERROR_ARGUMENT);
    assert_ok(dem_trajectory_finish(o.trajectory));
    assert_int_equal(dem_trajectory_segment(o.trajectory, later), DEM_ERROR_ARGUMENT);
    assert_says("is finished and takes no more segments");
}

/* Without frames, events and probes. */
TEST(a_bare_run_is_cut_as_well)
{
    CLEANUP(close_place) place p = open_place();
    dem_trajectory_options options = dem_trajectory_options_default();
    options.fields = 0;
    CLEANUP(drop_point) const point whole = run_until(&p, "quiet.vtkhdf", options, NULL, (plan){0, 0, 0}, end);
    CLEANUP(drop_point) const point a = run_until(&p, "run.vtkhdf", options, NULL, (plan){20, 31, 40}, end);
    CLEANUP(drop_point) const point b = run_until(&p, "run.vtkhdf", options, &a, (plan){0, 0, 0}, end);
    assert_same_data(&p, "quiet.vtkhdf", "run.vtkhdf");
}

/* ---- going on ---- */

/* The first run ends with a frame at its end, which is none of the longer run's. */
TEST(a_finished_run_is_continued_from_its_own_file)
{
    static const double ends[] = {7.3e-4, 12e-4, 21.9e-4};
    CLEANUP(close_place) place p = open_place();
    run_quietly(&p);
    for (size_t k = 0; k < sizeof ends / sizeof ends[0]; k++) {
        CLEANUP(drop_point)
        const point a = run_until(&p, "run.vtkhdf", everything(), NULL, (plan){25, k == 2 ? 27 : 0, 0}, ends[k]);
        CLEANUP(drop_point) const point b = run(&p, "run.vtkhdf", &a, (plan){70, 75, 75});
        assert_true(has(&p, "run.vtkhdf") && has(&p, "run.00001.vtkhdf") && has(&p, "run.00002.vtkhdf"));
        assert_true(count_rows(&p, "run.vtkhdf", "/VTKHDF/Steps/Values") < 23);
        CLEANUP(drop_point) const point c = run(&p, "run.vtkhdf", &b, (plan){0, 0, 0});
        assert_same_data(&p, "quiet.vtkhdf", "run.vtkhdf");
    }
}

static void assert_resume_fails(const place *p, const point *from, dem_trajectory_options options, dem_status status,
                                const char *words)
{
    CLEANUP(free_simulation) dem_simulation *simulation = make_simulation(p);
    dem_trajectory *trajectory = NULL;
    assert_int_equal(
        dem_trajectory_resume(&trajectory, name_in(p, "run.vtkhdf"), simulation, &options, from->checkpoint), status);
    assert_null(trajectory);
    assert_says(words);
}

TEST(other_options_are_refused)
{
    CLEANUP(close_place) place p = open_place();
    dem_probe other[n_probes];
    CLEANUP(drop_point) const point a = run(&p, "run.vtkhdf", NULL, (plan){40, 40, 45});
    const point none = {0, NULL};
    dem_trajectory_options options = everything();
    options.fields = DEM_FIELD_STRESS;
    assert_resume_fails(&p, &a, options, DEM_ERROR_ARGUMENT, "fields is 4, in the run that is to go on it is 1023");
    options = everything(), options.double_precision = 1;
    assert_resume_fails(&p, &a, options, DEM_ERROR_ARGUMENT, "double_precision is 1");
    options = everything(), options.events = 0;
    assert_resume_fails(&p, &a, options, DEM_ERROR_ARGUMENT, "events is 0");
    options = everything(), options.frame_interval = 0.25;
    assert_resume_fails(&p, &a, options, DEM_ERROR_ARGUMENT, "frame_interval is 0.25");
    options = everything(), options.n_probes = 1;
    assert_resume_fails(&p, &a, options, DEM_ERROR_ARGUMENT, "n_probes is 1, in the run that is to go on it is 3");
    options = everything(), options.probes = other;
    for (int k = 0; k < 4; k++) {
        memcpy(other, probes, sizeof other);
        if (k == 0) other[1].name = "height";
        if (k == 1) other[1].every++;
        if (k == 2) other[1].number[1]--;
        if (k == 3) other[1].kind = DEM_PROBE_NODE;
        assert_resume_fails(&p, &a, options, DEM_ERROR_ARGUMENT, "is none of those of the run that is to go on");
    }
    assert_resume_fails(&p, &none, everything(), DEM_ERROR_ARGUMENT, "the checkpoint is NULL");
    dem_checkpoint *empty;
    assert_ok(dem_checkpoint_create(&empty));
    assert_resume_fails(&p, &(point){0, empty}, everything(), DEM_ERROR_IO, "trajectory");
    dem_checkpoint_destroy(empty);
    CLEANUP(drop_point) const point b = run(&p, "run.vtkhdf", &a, (plan){0, 0, 0}); /* nothing has changed */
}

/* What becomes of segment 2 of two, and of what is said then. */
static void lose(const place *p)
{
    sweep(p, "run.00002.vtkhdf");
}

static void damage(const place *p)
{
    assert_int_equal(truncate(name_in(p, "run.00002.vtkhdf"), 3000), 0);
}

static void take_the_first(const place *p)
{
    copy_file(p, "run.00001.vtkhdf", "run.00002.vtkhdf");
}

static void change(const place *p, const char *dataset, dem_index rows, dem_index index, double value)
{
    const hdf5_rows column = {dataset, HDF5_F64, 1, {0, 0}, 0, 0};
    hdf5_file file;
    assert_ok(hdf5_open_write(&file, name_in(p, "run.00002.vtkhdf"), 0));
    if (rows > 0)
        assert_ok(hdf5_append(&file, &column, (hsize_t)index, 1, &value));
    else
        assert_true(H5Ldelete(file.id, dataset, H5P_DEFAULT) >= 0);
    assert_ok(hdf5_close(&file, DEM_OK));
}

static void lose_a_row(const place *p)
{
    change(p, "/history/closure", 49, 48, 0.0);
}

static void lose_a_column(const place *p)
{
    change(p, "/probes/corner/stress", 0, 0, 0.0);
}

static void take_anothers(const place *p)
{
    change(p, "/history/t", 50, 49, 1.0);
}

TEST(a_segment_that_is_not_right_is_named)
{
    static const struct {
        void (*spoil)(const place *p);
        const char *words;
    } cases[] = {
        {lose, "run.00002.vtkhdf is missing"},
        {damage, "run.00002.vtkhdf: cannot be opened ("},
        {take_the_first, "run.00002.vtkhdf: /: segment is 1, 2 was written"},
        {lose_a_row, "run.00002.vtkhdf: /history/closure: has 49 rows, 50 were written"},
        {lose_a_column, "run.00002.vtkhdf: /probes/corner/stress: cannot be opened ("},
        {take_anothers, "run.00002.vtkhdf: is of another run: row 49 of its history is at t = 1 s"},
    };
    CLEANUP(close_place) place p = open_place();
    CLEANUP(drop_point)
    const point a = run(&p, "run.vtkhdf", NULL, (plan){40, 40, 45}), b = run(&p, "run.vtkhdf", &a, (plan){90, 90, 99});
    copy_file(&p, "run.00002.vtkhdf", "kept");
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        cases[k].spoil(&p);
        assert_resume_fails(&p, &b, everything(), DEM_ERROR_IO, cases[k].words);
        copy_file(&p, "kept", "run.00002.vtkhdf");
    }
    copy_file(&p, "kept", "run.00001.vtkhdf"); /* more rows than there are up to the first checkpoint */
    assert_resume_fails(&p, &a, everything(), DEM_ERROR_IO, "run.00001.vtkhdf: /: segment is 2, 1 was written");
    copy_file(&p, "run.part.vtkhdf", "run.vtkhdf"); /* an unfinished one is no help */
    lose(&p);
    sweep(&p, "run.00001.vtkhdf");
    assert_resume_fails(&p, &b, everything(), DEM_ERROR_IO, "run.00001.vtkhdf is missing, and ");
    assert_says("run.vtkhdf does not hold its rows");
    sweep(&p, "kept");
}

/* A checkpoint between two segments: the second of them goes beyond it. */
TEST(a_checkpoint_that_no_segment_ends_at_is_refused)
{
    CLEANUP(close_place) place p = open_place();
    CLEANUP(drop_point)
    const point a = run(&p, "run.vtkhdf", NULL, (plan){40, 40, 45}), b = run(&p, "run.vtkhdf", NULL, (plan){30, 0, 35});
    CLEANUP(drop_point) const point c = run(&p, "run.vtkhdf", NULL, (plan){40, 40, 45});
    assert_resume_fails(&p, &b, everything(), DEM_ERROR_IO, "run.00001.vtkhdf: has history beyond row 30");
    sweep(&p, "run.00001.vtkhdf");
}

/* ---- whose files they are ---- */

TEST(a_new_run_removes_the_segments_of_an_old_one_and_nothing_else)
{
    CLEANUP(close_place) place p = open_place();
    const dem_trajectory_options options = everything();
    CLEANUP(drop_point) const point a = run(&p, "run.vtkhdf", NULL, (plan){40, 40, 45});
    CLEANUP(drop_point) const point b = run(&p, "run.vtkhdf", &a, (plan){90, 90, 99});
    copy_file(&p, "run.part.vtkhdf", "run.00003.vtkhdf"); /* a file of another run, say */
    copy_file(&p, "run.part.vtkhdf", "run.vtkhdf.new");
    copy_file(&p, "run.part.vtkhdf", "run.part.vtkhdf.new");
    opened o = open_run(&p, &options);
    assert_false(has(&p, "run.00001.vtkhdf") || has(&p, "run.00002.vtkhdf"));
    assert_false(has(&p, "run.vtkhdf.new") || has(&p, "run.part.vtkhdf.new"));
    assert_true(has(&p, "run.00003.vtkhdf"));
    assert_int_equal(rename(name_in(&p, "run.00003.vtkhdf"), name_in(&p, "run.00001.vtkhdf")), 0);
    assert_int_equal(dem_trajectory_segment(o.trajectory, o.checkpoint), DEM_ERROR_IO);
    assert_says("run.00001.vtkhdf is in the way of a segment of that name");
    assert_ok(dem_trajectory_finish(o.trajectory));
    assert_true(has(&p, "run.00001.vtkhdf"));
    close_run(&o);
    sweep(&p, "run.00001.vtkhdf");
}

/* What a kill leaves that hits a run while it removes what it has joined. */
TEST(a_whole_stands_for_segments_that_are_gone)
{
    CLEANUP(close_place) place p = open_place();
    run_quietly(&p);
    const point a = run(&p, "run.vtkhdf", NULL, (plan){40, 40, 45});
    copy_file(&p, "run.00001.vtkhdf", "kept");
    const point b = run(&p, "run.vtkhdf", &a, (plan){90, 90, 0});
    copy_file(&p, "kept", "run.00001.vtkhdf");
    const point c = run(&p, "run.vtkhdf", &b, (plan){120, 125, 125});
    assert_int_equal(count_rows(&p, "run.00001.vtkhdf", "/history/t"), 90);
    assert_int_equal(count_rows(&p, "run.00002.vtkhdf", "/history/t"), 30);
    const point d = run(&p, "run.vtkhdf", &c, (plan){0, 0, 0});
    assert_same_data(&p, "quiet.vtkhdf", "run.vtkhdf");
    const point all[] = {a, b, c, d};
    for (int k = 0; k < 4; k++) dem_checkpoint_destroy(all[k].checkpoint);
    sweep(&p, "kept");
}

/* ---- failures ---- */

static void run_on(const place *p, opened *o, const char *name)
{
    assert_ok(dem_simulation_advance(o->simulation, 8 * interval));
    assert_ok(dem_trajectory_finish(o->trajectory));
    if (strcmp(name, "run.vtkhdf") != 0) assert_int_equal(rename(name_in(p, "run.vtkhdf"), name_in(p, name)), 0);
    close_run(o);
}

/* Without or with rows behind the checkpoint, each renaming in turn; then it works, or is not tried again. */
TEST(a_segment_that_fails_changes_nothing)
{
    CLEANUP(close_place) place p = open_place();
    const dem_trajectory_options options = everything();
    opened o = open_run(&p, &options);
    run_on(&p, &o, "quiet.vtkhdf");
    for (int k = 0; k < 4; k++) {
        o = open_run(&p, &options);
        if (k % 2) assert_ok(dem_simulation_advance(o.simulation, 4 * interval));
        for (failing = 1; failing <= 2; failing++) {
            calls = 0;
            assert_int_equal(dem_trajectory_segment(o.trajectory, o.checkpoint), DEM_ERROR_IO);
            assert_says("cannot be renamed to");
            assert_false(has(&p, "run.00001.vtkhdf") || has(&p, "run.vtkhdf.new") || has(&p, "run.part.vtkhdf.new"));
            assert_int_equal(count_rows(&p, "run.part.vtkhdf", "/VTKHDF/Steps/Values"), k % 2 ? 5 : 3);
        }
        failing = 0;
        if (k < 2) assert_ok(dem_trajectory_segment(o.trajectory, o.checkpoint));
        assert_int_equal(has(&p, "run.00001.vtkhdf"), k < 2);
        run_on(&p, &o, "run.vtkhdf");
        assert_same_data(&p, "quiet.vtkhdf", "run.vtkhdf");
    }
}

TEST(a_finish_that_failed_works_the_second_time)
{
    CLEANUP(close_place) place p = open_place();
    CLEANUP(free_peaks) dem_peaks *peaks;
    dem_trajectory_options options = everything();
    assert_ok(dem_peaks_create(&peaks, p.model, 1));
    options.peaks = peaks;
    opened o = open_run(&p, &options);
    run_on(&p, &o, "quiet.vtkhdf");
    for (int segmented = 0; segmented < 2; segmented++) {
        o = open_run(&p, &options);
        if (segmented) assert_ok(dem_trajectory_segment(o.trajectory, o.checkpoint));
        assert_ok(dem_simulation_advance(o.simulation, 8 * interval));
        calls = 0, failing = 1;
        assert_int_equal(dem_trajectory_finish(o.trajectory), DEM_ERROR_IO);
        assert_says("cannot be renamed to");
        assert_false(has(&p, "run.vtkhdf"));
        failing = 0;
        run_on(&p, &o, "run.vtkhdf");
        assert_same_data(&p, "quiet.vtkhdf", "run.vtkhdf");
        sweep(&p, "run.vtkhdf");
    }
}

/* ---- killed whenever a name changes ---- */

static const plan first = {20, 24, 30}, second = {40, 40, 0};
static const double short_end = 9e-4;

/* Another process makes two segments and finishes.  \return whether it came to its end */
static bool run_in_child(const place *p, int deadly)
{
    int how = 0;
    *progress = 0;
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        calls = 0, fatal = deadly;
        const point a = run_until(p, "run.vtkhdf", everything(), NULL, first, short_end);
        const point b = run_until(p, "run.vtkhdf", everything(), &a, second, short_end);
        _exit(b.checkpoint != NULL ? 0 : 1);
    }
    assert_int_equal(waitpid(child, &how, 0), child);
    if (!WIFEXITED(how) || WEXITSTATUS(how) == 1) fail_msg("the run that was to be killed failed");
    return WEXITSTATUS(how) == 0;
}

/* It goes on from a checkpoint that may be on the disk then: in turn from that of the last segment that was finished,
 * and from the one before. */
TEST(a_kill_between_two_names_loses_nothing)
{
    CLEANUP(close_place) place p = open_place();
    FILE *shared = tmpfile();
    assert_true(shared != NULL && ftruncate(fileno(shared), sizeof *progress) == 0);
    progress = mmap(NULL, sizeof *progress, PROT_READ | PROT_WRITE, MAP_SHARED, fileno(shared), 0);
    assert_true(progress != MAP_FAILED);
    CLEANUP(drop_point)
    const point whole = run_until(&p, "quiet.vtkhdf", everything(), NULL, (plan){0, 0, 0}, short_end);
    point points[3] = {{0, NULL}};
    points[1] = run_until(&p, "run.vtkhdf", everything(), NULL, first, short_end);
    points[2] = run_until(&p, "run.vtkhdf", everything(), &points[1], second, short_end);
    assert_same_data(&p, "quiet.vtkhdf", "run.vtkhdf");
    int n = 1;
    for (; sweep(&p, "run.vtkhdf"), !run_in_child(&p, n); n++) {
        const int last = *progress > n % 2 ? *progress - n % 2 : 0;
        const point done =
            run_until(&p, "run.vtkhdf", everything(), last > 0 ? &points[last] : NULL, (plan){0, 0, 0}, short_end);
        assert_same_data(&p, "quiet.vtkhdf", "run.vtkhdf");
        assert_false(has(&p, "run.00001.vtkhdf") || has(&p, "run.00002.vtkhdf") || has(&p, "run.part.vtkhdf") ||
                     has(&p, "run.part.vtkhdf.new") || has(&p, "run.vtkhdf.new"));
        dem_checkpoint_destroy(done.checkpoint);
    }
    assert_true(n > 12);
    sweep(&p, "run.obstacle.part.vtkhdf");
    sweep(&p, "run.body.part.vtkhdf");
    for (int k = 1; k < 3; k++) dem_checkpoint_destroy(points[k].checkpoint);
    assert_int_equal(munmap(progress, sizeof *progress), 0);
    progress = &own_progress;
    (void)fclose(shared);
}

/* ---- with the checkpoints of the simulation itself ---- */

static dem_trajectory *follow(const place *p, dem_simulation *simulation, dem_peaks *peaks,
                              const dem_checkpoint *checkpoint)
{
    dem_trajectory_options options = everything();
    dem_trajectory *trajectory;
    options.peaks = peaks;
    assert_ok(checkpoint != NULL
                  ? dem_trajectory_resume(&trajectory, name_in(p, "run.vtkhdf"), simulation, &options, checkpoint)
                  : dem_trajectory_create(&trajectory, name_in(p, "run.vtkhdf"), simulation, &options));
    const dem_observer observers[] = {ask_peaks_observer(peaks), ask_trajectory_observer(trajectory)};
    for (int k = 0; k < 2; k++) assert_ok(dem_simulation_observe(simulation, &observers[k]));
    return trajectory;
}

/* Advances to t, where it is either finished or leaves a segment of the last checkpoint, which is returned.
 * \param breaks  triangles break then; 0: none */
static dem_checkpoint *follow_to(const place *p, const dem_checkpoint *checkpoint, double breaks, double t)
{
    dem_options options = dem_options_default();
    CLEANUP(free_simulation) dem_simulation *simulation;
    CLEANUP(free_peaks) dem_peaks *peaks;
    dem_checkpoint *last = NULL;
    options.spacing = 5e-3, options.max_step = 2e-5, options.v_scale = 5.0, options.checkpoint_steps = 16;
    if (checkpoint != NULL) {
        assert_ok(dem_simulation_resume(&simulation, p->model, &options, checkpoint));
        assert_int_equal(dem_peaks_resume(&peaks, p->model, 5, checkpoint), DEM_ERROR_ARGUMENT);
        assert_ok(dem_peaks_resume(&peaks, p->model, 4, checkpoint));
    } else {
        assert_ok(dem_simulation_create(&simulation, p->model, &options));
        assert_ok(dem_peaks_create(&peaks, p->model, 4));
    }
    CLEANUP(free_trajectory) dem_trajectory *trajectory = follow(p, simulation, peaks, checkpoint);
    if (breaks > 0.0) {
        assert_ok(dem_simulation_advance(simulation, breaks));
        assert_ok(dem_simulation_break(simulation, (const dem_index[]){0, 1, 9}, 3, NULL, 0));
    }
    assert_ok(dem_simulation_advance(simulation, t));
    if (t < end) {
        assert_ok(dem_trajectory_segment(trajectory, dem_simulation_checkpoint(simulation)));
        assert_ok(dem_checkpoint_create(&last));
        assert_ok(checkpoint_entries_copy(last, dem_simulation_checkpoint(simulation)));
    } else
        assert_ok(dem_trajectory_finish(trajectory));
    return last;
}

TEST(a_run_goes_on_from_the_checkpoints_of_its_simulation)
{
    CLEANUP(close_place) place p = open_place();
    assert_null(follow_to(&p, NULL, 0.0, end));
    assert_int_equal(rename(name_in(&p, "run.vtkhdf"), name_in(&p, "quiet.vtkhdf")), 0);
    dem_checkpoint *checkpoint = NULL;
    for (int k = 1; k <= 6; k++) {
        dem_checkpoint *last = follow_to(&p, checkpoint, 0.0, k * end / 6.0);
        dem_checkpoint_destroy(checkpoint);
        checkpoint = last;
    }
    assert_same_data(&p, "quiet.vtkhdf", "run.vtkhdf");
}

/* The sum of the flags of a frame. */
static int count_broken(const place *p, const char *name, dem_index frame)
{
    const hdf5_rows rows = {"/fracture/triangles", HDF5_U8, 1, {0, 0}, 0, 0};
    const hsize_t n = (hsize_t)ask_sizes(p->model).n_triangles;
    CLEANUP(free_memory) unsigned char *broken = calloc(n, 1);
    int sum = 0;
    hdf5_file file;
    assert_non_null(broken);
    assert_ok(hdf5_open_read(&file, name_in(p, name)));
    assert_ok(hdf5_close(&file, hdf5_read(&file, &rows, (hsize_t)frame * n, n, broken)));
    for (hsize_t k = 0; k < n; k++) sum += broken[k];
    return sum;
}

/* Triangles break in the part that becomes the first segment; what goes on shows them broken as well. */
TEST(a_run_that_goes_on_has_its_broken_triangles)
{
    CLEANUP(close_place) place p = open_place();
    assert_null(follow_to(&p, NULL, end / 3.0, end));
    assert_int_equal(rename(name_in(&p, "run.vtkhdf"), name_in(&p, "quiet.vtkhdf")), 0);
    CLEANUP(free_checkpoint) dem_checkpoint *checkpoint = follow_to(&p, NULL, end / 3.0, 2.0 * end / 3.0);
    const dem_index n = count_rows(&p, "run.00001.vtkhdf", "/VTKHDF/Steps/Values");
    assert_int_equal(count_broken(&p, "run.00001.vtkhdf", 0), 0);
    assert_int_equal(count_broken(&p, "run.00001.vtkhdf", n - 1), 3);
    assert_null(follow_to(&p, checkpoint, 0.0, end));
    assert_int_equal(count_broken(&p, "run.vtkhdf", 0), 0);
    assert_int_equal(count_broken(&p, "run.vtkhdf", count_rows(&p, "run.vtkhdf", "/VTKHDF/Steps/Values") - 1), 3);
    assert_same_data(&p, "quiet.vtkhdf", "run.vtkhdf");
}
