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
    char failure[TEXT]; /* empty: none */
} written;

/* The segment ends at a checkpoint that is behind: frames are left for the part. */
static dem_status follow(dem_simulation *s, dem_trajectory *t)
{
    dem_observer observer = {.struct_size = sizeof observer};
    dem_status status = dem_trajectory_observer(t, &observer);
    if (status == DEM_OK) status = dem_simulation_observe(s, &observer);
    if (status == DEM_OK) status = dem_simulation_advance(s, 0.5 * t_whole);
    if (status == DEM_OK) status = dem_trajectory_segment(t, dem_simulation_checkpoint(s));
    if (status == DEM_OK) status = dem_simulation_advance(s, t_whole);
    return status == DEM_OK ? dem_trajectory_finish(t) : status;
}

/* \param leads  ranks that make the run; NULL: this process alone does */
static dem_status write_run(const written *w, const ranks *leads)
{
    dem_simulation *s = NULL;
    dem_trajectory *t = NULL;
    dem_trajectory_options options = dem_trajectory_options_default();
    options.frame_interval = 2e-4;
    options.writers = w->writers;
    dem_status status = dem_simulation_create(&s, w->model, &w->options);
    if (status == DEM_OK && leads != NULL) status = dem_private_lead(s, leads, &w->options, NULL);
    if (status == DEM_OK) status = dem_trajectory_create(&t, w->path, s, &options);
    if (status == DEM_OK) status = follow(s, t);
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

static void touch(const char *path)
{
    file_put(path, "no file of HDF5", 15);
}

TEST(stripes_of_a_whole_and_of_a_segment_read_as_the_files_of_one_process)
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
    touch(folder_at(&folder, "led.00007.3of5.h5")); /* left from a kill */
    assert_ok(write_run(&alone, NULL));
    rank_runs_lead(N_RANKS, NULL, write_as_leader, &shared);
    assert_string_equal(shared.failure, "");
    (void)unlink(folder_at(&folder, "one.obstacle.vtkhdf"));
    (void)unlink(folder_at(&folder, "led.obstacle.vtkhdf"));
    same_frames_check(one, led);
    dem_model_destroy(model);
    folder_close(&folder);
}

TEST(what_has_the_name_of_a_stripe_and_is_none_stays_and_is_in_the_way)
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
