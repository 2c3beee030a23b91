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

typedef struct written {
    const dem_model *model;
    dem_options options;
    const char *path;
    int writers;
    bool stays_open;
    bool has_part_alone; /* and no segment */
    bool is_left;        /* with a part, as by a kill */
    char failure[TEXT];  /* empty: none */
} written;

/* The segment ends at a checkpoint that is behind: frames are left for the part. */
static dem_status follow(dem_simulation *s, dem_trajectory *t, const written *w)
{
    dem_observer observer = {.struct_size = sizeof observer};
    dem_status status = dem_trajectory_observer(t, &observer);
    if (status == DEM_OK) status = dem_simulation_observe(s, &observer);
    if (status == DEM_OK) status = dem_simulation_advance(s, 0.5 * t_whole);
    if (status == DEM_OK && !w->has_part_alone) status = dem_trajectory_segment(t, dem_simulation_checkpoint(s));
    if (status == DEM_OK) status = dem_simulation_advance(s, t_whole);
    return status == DEM_OK && !w->is_left ? dem_trajectory_finish(t) : status;
}

/* \param leads  ranks that make the run; NULL: this process alone does */
static dem_status write_run(const written *w, const ranks *leads)
{
    dem_simulation *s = NULL;
    dem_trajectory *t = NULL;
    dem_trajectory_options options = dem_trajectory_options_default();
    options.frame_interval = 2e-4;
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
    written w = {.model = model, .options = dem_options_default(), .path = path, .writers = writers};
    w.options.checkpoint_steps = 8;
    return w;
}

static void check_stripes(bool stays_open, bool has_part_alone)
{
    scratch_folder folder;
    folder_open(&folder);
    const char *one = folder_file(&folder, "one.vtkhdf"), *led = folder_file(&folder, "led.vtkhdf");
    (void)folder_file(&folder, "led.1of2.h5");
    (void)folder_file(&folder, "led.2of2.h5");
    (void)folder_file(&folder, "one.body.vtkhdf");
    (void)folder_file(&folder, "led.body.vtkhdf");
    dem_model *model = make_falling(0.5);
    written alone = prepare(model, one, 0), shared = prepare(model, led, 2);
    shared.stays_open = stays_open;
    shared.has_part_alone = has_part_alone;
    assert_ok(write_run(&alone, NULL));
    rank_runs_lead(N_RANKS, NULL, write_as_leader, &shared);
    assert_string_equal(shared.failure, "");
    (void)unlink(folder_at(&folder, "one.obstacle.vtkhdf"));
    (void)unlink(folder_at(&folder, "led.obstacle.vtkhdf"));
    same_frames_check(one, led);
    dem_model_destroy(model);
    folder_close(&folder);
}

TEST(stripes_of_a_whole_and_of_a_segment_read_as_the_files_of_one_process)
{
    check_stripes(false, false);
}

TEST(and_so_do_those_that_stay_open_between_frames)
{
    check_stripes(true, false);
}

TEST(and_so_do_those_of_a_part_alone)
{
    check_stripes(true, true);
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
