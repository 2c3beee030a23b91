/* SPDX-License-Identifier: BSD-3-Clause */
/* Runs in several threads at once are the runs one after the other: random bodies in fields of force, by both methods
 * of contact, each with a trajectory, events and segments of its own, with readings of it and of what is not there; the
 * same bits and the same files. `test_together [ROUNDS [FIRST_SEED]]`. */
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <dem/trajectory.h>

#include "harness/motion.h"
#include "field.h"

enum { n_jobs = 4 };

static long n_rounds = 1, first_seed = 1;

/* One run. What is wanted of its thread is looked at when that has ended: failing asserts do not leave threads. */
typedef struct job {
    unsigned long seed;
    const char *folder;
    scene scene;
    field field;
    dem_model *model;
    dem_status status;
    char message[512], missing[512]; /* of its failure; of the reading of a file that is not there */
    double *state;                   /* [4 n_nodes] at the end, */
    dem_energy energy;               /* and there, too */
    char path[64];
} job;

static void name(const job *j, const char *ending, char out[64])
{
    (void)snprintf(out, 64, "%s/%lu%s", j->folder, j->seed, ending);
}

static dem_status go(job *j, dem_simulation *simulation, dem_trajectory *trajectory)
{
    const dem_observer observer = ask_trajectory_observer(trajectory);
    dem_status status = dem_simulation_observe(simulation, &observer);
    for (int part = 1; part <= 4 && status == DEM_OK; part++) {
        status = dem_simulation_advance(simulation, 0.02 * part * j->scene.t_end);
        if (status == DEM_OK && part < 4)
            status = dem_trajectory_segment(trajectory, dem_simulation_checkpoint(simulation));
    }
    return status == DEM_OK ? dem_trajectory_finish(trajectory) : status;
}

static dem_status read_again(job *j)
{
    char nowhere[64];
    dem_lattice lattice = dem_lattice_empty();
    name(j, ".nowhere", nowhere);
    if (dem_lattice_read(&lattice, nowhere) == DEM_OK) return DEM_ERROR_IO;
    (void)snprintf(j->missing, sizeof j->missing, "%s", dem_status_message());
    const dem_status status = dem_lattice_read(&lattice, j->path);
    if (status == DEM_OK) dem_lattice_free(&lattice);
    return status;
}

static void keep(job *j, const dem_simulation *simulation)
{
    const size_t n = 2 * (size_t)j->scene.body.n_nodes;
    motion s;
    motion_see(simulation, &s);
    j->energy = s.energy;
    if (j->state == NULL) return;
    memcpy(j->state, s.x, n * sizeof *s.x);
    memcpy(j->state + n, s.v, n * sizeof *s.v);
}

static void *run(void *context)
{
    job *j = context;
    CLEANUP(free_simulation) dem_simulation *simulation = NULL;
    CLEANUP(free_trajectory) dem_trajectory *trajectory = NULL;
    dem_trajectory_options options = dem_trajectory_options_default();
    options.frame_interval = 0.004 * j->scene.t_end;
    options.events = 1;
    name(j, ".vtkhdf", j->path);
    j->status = dem_simulation_create(&simulation, j->model, &j->scene.options);
    if (j->status == DEM_OK) j->status = dem_trajectory_create(&trajectory, j->path, simulation, &options);
    if (j->status == DEM_OK) j->status = go(j, simulation, trajectory);
    if (j->status == DEM_OK) keep(j, simulation);
    if (j->status == DEM_OK) j->status = read_again(j);
    if (j->status != DEM_OK) (void)snprintf(j->message, sizeof j->message, "%s", dem_status_message());
    return NULL;
}

/* ---- one after the other, and at once ---- */

static void open_job(job *j, unsigned long seed, const char *folder)
{
    *j = (job){.seed = seed, .folder = folder};
    scene_random(&j->scene, seed);
    field_random(&j->field, &j->scene, seed);
    j->scene.options.contact = seed % 2 == 0 ? DEM_CONTACT_LOCAL : DEM_CONTACT_EXACT;
    j->scene.options.threads = 1 + (seed % 4 == 0);
    j->scene.options.thread_nodes = 1;
    j->scene.options.checkpoint_steps = 20;
    j->scene.options.force = field_act;
    j->scene.options.force_context = &j->field;
    j->state = calloc(4 * (size_t)j->scene.body.n_nodes, sizeof *j->state);
    assert_non_null(j->state);
    assert_ok(dem_model_create(&j->model, &j->scene.body, j->scene.obstacles, j->scene.n));
}

static void close_job(job *j)
{
    static const char *const endings[] = {".vtkhdf", ".obstacle.vtkhdf", ".body.vtkhdf"};
    for (size_t k = 0; k < sizeof endings / sizeof *endings; k++) {
        char path[64];
        name(j, endings[k], path);
        (void)unlink(path);
    }
    dem_model_destroy(j->model);
    scene_free(&j->scene);
    free(j->state);
}

static unsigned char *contents(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    assert_int_equal(fseek(file, 0, SEEK_END), 0);
    *size = (size_t)ftell(file);
    unsigned char *bytes = malloc(*size + 1);
    assert_non_null(bytes);
    rewind(file);
    assert_int_equal(fread(bytes, 1, *size, file), *size);
    (void)fclose(file);
    return bytes;
}

static void compare_files(const job *a, const job *b, const char *ending)
{
    char here[64], there[64];
    size_t n_here, n_there;
    name(a, ending, here);
    name(b, ending, there);
    unsigned char *one = contents(here, &n_here), *other = contents(there, &n_there);
    if (n_here != n_there || memcmp(one, other, n_here) != 0)
        fail_msg("%s: %zu bytes, %s: %zu bytes, are not the same", here, n_here, there, n_there);
    free(one);
    free(other);
}

/* What the message of each says is its own. */
static void check_message(const job *j)
{
    char nowhere[64];
    name(j, ".nowhere", nowhere);
    assert_non_null(strstr(j->missing, nowhere));
}

TEST(runs_at_once_are_runs_one_after_the_other)
{
    static char after[] = "together_after_XXXXXX", at_once[] = "together_at_once_XXXXXX";
    assert_non_null(mkdtemp(after));
    assert_non_null(mkdtemp(at_once));
    for (long round = 0; round < n_rounds; round++) {
        job alone[n_jobs], together[n_jobs];
        pthread_t threads[n_jobs];
        for (int k = 0; k < n_jobs; k++) {
            const unsigned long seed = (unsigned long)(first_seed + round * n_jobs + k);
            open_job(&alone[k], seed, after);
            open_job(&together[k], seed, at_once);
            (void)run(&alone[k]);
        }
        for (int k = 0; k < n_jobs; k++) assert_int_equal(pthread_create(&threads[k], NULL, run, &together[k]), 0);
        for (int k = 0; k < n_jobs; k++) assert_int_equal(pthread_join(threads[k], NULL), 0);
        for (int k = 0; k < n_jobs; k++) {
            if (alone[k].status != DEM_OK) fail_msg("seed %lu alone: %s", alone[k].seed, alone[k].message);
            if (together[k].status != DEM_OK) fail_msg("seed %lu: %s", together[k].seed, together[k].message);
            const size_t size = 4 * (size_t)alone[k].scene.body.n_nodes * sizeof(double);
            assert_memory_equal(alone[k].state, together[k].state, size);
            assert_memory_equal(&alone[k].energy, &together[k].energy, sizeof alone[k].energy);
            check_message(&together[k]);
            compare_files(&alone[k], &together[k], ".vtkhdf");
            compare_files(&alone[k], &together[k], ".obstacle.vtkhdf");
            close_job(&alone[k]);
            close_job(&together[k]);
        }
    }
    assert_int_equal(rmdir(after), 0);
    assert_int_equal(rmdir(at_once), 0);
}

int main(int argc, char **argv)
{
    if (argc > 1) n_rounds = atol(argv[1]);
    if (argc > 2) first_seed = atol(argv[2]);
    return test_run();
}
