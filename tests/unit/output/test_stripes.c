/* SPDX-License-Identifier: BSD-3-Clause */
/* stripes.c, stripe_file.c, simulation/shared_orders.c: a trajectory whose arrays ranks write to several files, as a
 * whole and in segments, is read as one of a process alone. */
#include "harness/rank_threads.h"
#include "simulation/led_run.h"
#include "unit/same_frames.h"
#include "unit/scratch.h"
#include "unit/simulation/runs.h"
#include "verification/rank_runs.h"

#include <dirent.h>

#include <dem/reader.h>
#include <dem/trajectory.h>

#include "output/hdf5_file.h"

enum { N_RANKS = 3, TEXT = 256 };

enum { SEEN = 3 };

/* A part and its stripes, which are copied after each frame and read: what another process sees. */
typedef struct looks {
    const char *from[SEEN], *to[SEEN];
    int n, n_good;
} looks;

typedef struct written {
    const dem_model *model;
    dem_options options;
    const char *path;
    int writers;
    double t_end, interval; /* s */
    bool stays_open;
    bool has_part_alone; /* and no segment */
    bool is_left;        /* with a part, as by a kill */
    looks *looks;        /* NULL: nobody looks */
    char failure[TEXT];  /* empty: none */
} written;

static bool copy_file(const char *from, const char *to)
{
    char buffer[4096];
    FILE *in = fopen(from, "rb"), *out = fopen(to, "wb");
    bool good = in != NULL && out != NULL;
    for (size_t n; good && (n = fread(buffer, 1, sizeof buffer, in)) > 0;) good = fwrite(buffer, 1, n, out) == n;
    if (in != NULL) (void)fclose(in);
    return out != NULL && fclose(out) == 0 && good;
}

/* Whether the last of n frames is the present state. */
static bool is_last_frame(const char *path, dem_index n, const dem_simulation *s)
{
    dem_reader *reader = NULL;
    dem_index found = 0;
    dem_state state = {.struct_size = sizeof state};
    const size_t bytes = 2 * (size_t)dem_model_lattice(dem_simulation_model(s))->n_nodes * sizeof(double);
    double *x = calloc(1, bytes);
    bool good = x != NULL && dem_simulation_state(s, &state) == DEM_OK && dem_reader_open(&reader, path) == DEM_OK;
    if (good) (void)dem_reader_times(reader, &found);
    good = good && found == n && dem_reader_positions(reader, n - 1, x) == DEM_OK && memcmp(x, state.x, bytes) == 0;
    dem_reader_close(reader);
    free(x);
    return good;
}

static dem_status look(void *context, const dem_simulation *s)
{
    looks *l = context;
    bool good = true;
    for (int k = 0; k < SEEN; k++) good = copy_file(l->from[k], l->to[k]) && good;
    l->n++;
    l->n_good += good && is_last_frame(l->to[0], l->n, s);
    return DEM_OK;
}

/* The segment ends at a checkpoint that is behind: frames are left for the part. */
static dem_status follow(dem_simulation *s, dem_trajectory *t, const written *w)
{
    dem_observer observer = {.struct_size = sizeof observer};
    const dem_observer looker = {
        .struct_size = sizeof looker, .interval = w->interval, .frame = look, .context = w->looks};
    dem_status status = dem_trajectory_observer(t, &observer);
    if (status == DEM_OK) status = dem_simulation_observe(s, &observer);
    if (status == DEM_OK && w->looks != NULL) status = dem_simulation_observe(s, &looker);
    if (status == DEM_OK) status = dem_simulation_advance(s, 0.5 * w->t_end);
    if (status == DEM_OK && !w->has_part_alone) status = dem_trajectory_segment(t, dem_simulation_checkpoint(s));
    if (status == DEM_OK) status = dem_simulation_advance(s, w->t_end);
    return status == DEM_OK && !w->is_left ? dem_trajectory_finish(t) : status;
}

/* \param leads  ranks that make the run; NULL: this process alone does */
static dem_status write_run(const written *w, const ranks *leads)
{
    dem_simulation *s = NULL;
    dem_trajectory *t = NULL;
    dem_trajectory_options options = dem_trajectory_options_default();
    options.frame_interval = w->interval;
    options.writers = w->writers;
    options.stays_open = w->stays_open;
    dem_status status = dem_simulation_create(&s, w->model, &w->options);
    if (status == DEM_OK && leads != NULL) status = dem_private_lead(s, leads, &w->options, NULL);
    if (status == DEM_OK) status = dem_trajectory_create(&t, w->path, s, &options);
    if (status == DEM_OK) status = follow(s, t, w);
    dem_trajectory_destroy(t);
    dem_simulation_destroy(s);
    return status;
}

static void write_as_leader(const ranks *r, void *context)
{
    written *w = context;
    if (write_run(w, r) != DEM_OK) (void)snprintf(w->failure, TEXT, "%s", dem_status_message());
}

static written prepare(const dem_model *model, const char *path, int writers)
{
    written w = {.model = model,
                 .options = dem_options_default(),
                 .path = path,
                 .writers = writers,
                 .t_end = t_whole,
                 .interval = 2e-4};
    w.options.checkpoint_steps = 8;
    return w;
}

/* \param shared  what 2 of the ranks write */
static void check_stripes(written shared)
{
    scratch_folder folder;
    written alone = shared;
    folder_open(&folder);
    alone.path = folder_file(&folder, "one.vtkhdf");
    alone.writers = 0;
    shared.path = folder_file(&folder, "led.vtkhdf");
    (void)folder_file(&folder, "led.1of2.h5");
    (void)folder_file(&folder, "led.2of2.h5");
    (void)folder_file(&folder, "one.body.vtkhdf");
    (void)folder_file(&folder, "led.body.vtkhdf");
    assert_ok(write_run(&alone, NULL));
    rank_runs_lead(N_RANKS, NULL, write_as_leader, &shared);
    assert_string_equal(shared.failure, "");
    (void)unlink(folder_at(&folder, "one.obstacle.vtkhdf"));
    (void)unlink(folder_at(&folder, "led.obstacle.vtkhdf"));
    same_frames_check(alone.path, shared.path);
    folder_close(&folder);
}

TEST(stripes_of_a_whole_and_of_a_segment_read_as_the_files_of_one_process)
{
    dem_model *model = make_falling(0.5);
    check_stripes(prepare(model, NULL, 2));
    dem_model_destroy(model);
}

TEST(and_so_do_those_that_stay_open_between_frames)
{
    dem_model *model = make_falling(0.5);
    written w = prepare(model, NULL, 2);
    w.stays_open = true;
    check_stripes(w);
    dem_model_destroy(model);
}

TEST(and_so_do_those_of_a_part_alone)
{
    dem_model *model = make_falling(0.5);
    written w = prepare(model, NULL, 2);
    w.stays_open = w.has_part_alone = true;
    check_stripes(w);
    dem_model_destroy(model);
}

/* Of which arrays go to the writers one by one. */
TEST(and_so_do_those_of_a_large_body)
{
    const dem_material rubber = {.struct_size = sizeof rubber,
                                 .youngs_modulus = 1e7,
                                 .poissons_ratio = 1.0 / 3.0,
                                 .density = 1050.0,
                                 .thickness = 1.0};
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    assert_ok(dem_lattice_rectangle(&lattice, 0.16, 0.16, 1e-3));
    assert_ok(dem_lattice_assemble(&lattice, &rubber));
    assert_in_range(lattice.n_nodes, 25000, 40000);
    dem_model *model = support_model(&lattice, NULL, 0);
    written w = prepare(model, NULL, 2);
    w.stays_open = true;
    w.t_end = 5e-6;
    w.interval = 1e-6;
    check_stripes(w);
    dem_model_destroy(model);
}

TEST(stripes_that_stay_open_are_whole_after_every_frame)
{
    static const char *const names[SEEN] = {"led.part.vtkhdf", "led.00001.1of2.h5", "led.00001.2of2.h5"};
    scratch_folder folder, seen;
    looks l = {.n = 0};
    folder_open(&folder);
    folder_open(&seen);
    dem_model *model = make_falling(0.5);
    written w = prepare(model, folder_file(&folder, "led.vtkhdf"), 2);
    for (int k = 0; k < SEEN; k++) {
        l.from[k] = folder_file(&folder, names[k]);
        l.to[k] = folder_file(&seen, names[k]);
    }
    w.stays_open = w.has_part_alone = w.is_left = true;
    w.looks = &l;
    rank_runs_lead(N_RANKS, NULL, write_as_leader, &w);
    assert_string_equal(w.failure, "");
    assert_in_range(l.n, 31, 32);
    assert_int_equal(l.n_good, l.n);
    (void)unlink(folder_at(&folder, "led.obstacle.vtkhdf"));
    (void)unlink(folder_at(&folder, "led.body.vtkhdf"));
    dem_model_destroy(model);
    folder_close(&seen);
    folder_close(&folder);
}

/* ---- what is in the way ---- */

static const char note[] = "no file of HDF5";

/* A text of a user's that has such a name. */
static void check_text(const char *name)
{
    scratch_folder folder;
    char found[sizeof note];
    folder_open(&folder);
    const char *led = folder_file(&folder, "led.vtkhdf"), *path = folder_file(&folder, name);
    dem_model *model = make_falling(0.5);
    written w = prepare(model, led, 2);
    file_put(path, note, sizeof note);
    rank_runs_lead(N_RANKS, NULL, write_as_leader, &w);
    assert_non_null(strstr(w.failure, name));
    assert_non_null(strstr(w.failure, "is in the way of a stripe of that name"));
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    assert_int_equal(fread(found, 1, sizeof found, file), sizeof found);
    (void)fclose(file);
    assert_string_equal(found, note);
    dem_model_destroy(model);
    folder_close(&folder);
}

TEST(what_has_the_name_of_a_stripe_and_is_none_stays_and_is_in_the_way)
{
    check_text("led.00001.2of2.h5");
    check_text("led.2of2.h5");
    check_text("led.1of2.h5.new");
}

TEST(a_file_of_hdf5_that_is_no_stripe_stays_too)
{
    scratch_folder folder;
    hdf5_file other;
    folder_open(&folder);
    const char *led = folder_file(&folder, "led.vtkhdf"), *name = folder_file(&folder, "led.00001.2of2.h5");
    dem_model *model = make_falling(0.5);
    written w = prepare(model, led, 2);
    assert_ok(hdf5_open_new(&other, name, 0));
    assert_ok(hdf5_close(&other, DEM_OK));
    rank_runs_lead(N_RANKS, NULL, write_as_leader, &w);
    assert_non_null(strstr(w.failure, "led.00001.2of2.h5 is in the way of a stripe of that name"));
    assert_ok(hdf5_open_read(&other, name));
    assert_ok(hdf5_close(&other, DEM_OK));
    dem_model_destroy(model);
    folder_close(&folder);
}

/* A run that has left its second stripes, torn, behind a segment. */
static void leave_torn(written *w, const scratch_folder *folder)
{
    enum { LEFT = 9000 };
    w->is_left = true;
    rank_runs_lead(N_RANKS, NULL, write_as_leader, w);
    assert_string_equal(w->failure, "");
    w->is_left = false;
    for (int k = 0; k < 2; k++) {
        hdf5_file file;
        const char *torn = folder_at(folder, k == 0 ? "led.00002.1of2.h5" : "led.00002.2of2.h5");
        assert_int_equal(truncate(torn, LEFT), 0);
        assert_int_equal(hdf5_open_read(&file, torn), DEM_ERROR_IO);
    }
}

static void name_all(scratch_folder *folder, const char *const *names)
{
    for (int k = 0; k < SCRATCH_FILES; k++) (void)folder_file(folder, names[k]);
}

TEST(a_torn_stripe_goes_where_the_run_begins_again)
{
    static const char *const names[SCRATCH_FILES] = {"led.vtkhdf",  "led.body.vtkhdf", "led.obstacle.vtkhdf",
                                                     "led.1of2.h5", "led.2of2.h5",     "left"};
    scratch_folder folder;
    folder_open(&folder);
    name_all(&folder, names);
    dem_model *model = make_falling(0.5);
    written w = prepare(model, folder.files[0], 2);
    leave_torn(&w, &folder);
    file_put(folder_at(&folder, "led.00003.1of3.h5"), "", 0); /* as for a moment when it is made */
    rank_runs_lead(N_RANKS, NULL, write_as_leader, &w);
    assert_string_equal(w.failure, "");
    dem_model_destroy(model);
    folder_close(&folder);
}

TEST(stripes_of_another_run_stay_torn_or_not)
{
    static const char *const names[SCRATCH_FILES] = {"led.vtkhdf",        "led.body.vtkhdf",   "led.obstacle.vtkhdf",
                                                     "led.00001.1of2.h5", "led.00002.1of2.h5", "led.part.vtkhdf"};
    scratch_folder folder;
    folder_open(&folder);
    name_all(&folder, names);
    dem_model *model = make_falling(0.5);
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    make_rectangle(&lattice, 0.007);
    dem_model *another = support_model(&lattice, NULL, 0);
    written w = prepare(model, folder.files[0], 2);
    leave_torn(&w, &folder);
    w.model = another;
    rank_runs_lead(N_RANKS, NULL, write_as_leader, &w);
    assert_non_null(strstr(w.failure, "led.00001.1of2.h5 is in the way of a stripe of that name"));
    for (int k = 0; k < 4; k++) {
        static const char *const stay[] = {"led.00001.1of2.h5", "led.00001.2of2.h5", "led.00002.1of2.h5",
                                           "led.00002.2of2.h5"};
        assert_int_equal(access(folder_at(&folder, stay[k]), F_OK), 0);
    }
    (void)unlink(folder_at(&folder, "led.00001.vtkhdf"));
    (void)unlink(folder_at(&folder, "led.00001.2of2.h5"));
    (void)unlink(folder_at(&folder, "led.00002.2of2.h5"));
    dem_model_destroy(another);
    dem_model_destroy(model);
    folder_close(&folder);
}

TEST(no_more_writers_than_ranks_are_taken)
{
    scratch_folder folder;
    folder_open(&folder);
    dem_model *model = make_falling(0.5);
    written w = prepare(model, folder_file(&folder, "led.vtkhdf"), N_RANKS + 1);
    rank_runs_lead(N_RANKS, NULL, write_as_leader, &w);
    assert_non_null(strstr(w.failure, "4 writers"));
    w.writers = 2;
    assert_int_equal(write_run(&w, NULL), DEM_ERROR_ARGUMENT);
    dem_model_destroy(model);
    folder_close(&folder);
}

int main(void)
{
    return test_run();
}
