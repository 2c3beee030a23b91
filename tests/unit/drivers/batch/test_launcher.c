/* SPDX-License-Identifier: BSD-3-Clause */
/* launcher.c: how many processes were started is read from the environment, and a serial job is one. */
#define _POSIX_C_SOURCE 200809L
#include "unit/close.h"

#include <stdlib.h>
#include <string.h>

#include "launcher.h"

static const char *const all[] = {"OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK", "PMI_SIZE",     "PMI_RANK",
                                  "MV2_COMM_WORLD_SIZE",  "MV2_COMM_WORLD_RANK",  "SLURM_NTASKS", "SLURM_NPROCS",
                                  "SLURM_STEP_NUM_TASKS", "SLURM_PROCID",         "SLURM_JOB_ID", "PMIX_RANK"};

/* In an environment of these variables, "NAME=VALUE NAME=VALUE". */
static launcher find_in(const char *environment)
{
    char text[256];
    (void)strncpy(text, environment, sizeof text - 1);
    text[sizeof text - 1] = '\0';
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) (void)unsetenv(all[k]);
    for (char *word = strtok(text, " "); word != NULL; word = strtok(NULL, " ")) {
        char *value = strchr(word, '=');
        *value = '\0';
        assert_int_equal(setenv(word, value + 1, 1), 0);
    }
    return launcher_find();
}

static void assert_found(const char *environment, const char *variable, long processes, bool reports)
{
    const launcher l = find_in(environment);
    assert_string_equal(l.variable, variable);
    assert_int_equal(l.processes, processes);
    assert_int_equal(l.reports, reports);
}

TEST(launchers_say_how_many_they_have_started)
{
    assert_found("OMPI_COMM_WORLD_SIZE=4 OMPI_COMM_WORLD_RANK=0 PMIX_RANK=0", "OMPI_COMM_WORLD_SIZE", 4, true);
    assert_found("OMPI_COMM_WORLD_SIZE=4 OMPI_COMM_WORLD_RANK=3 PMIX_RANK=3", "OMPI_COMM_WORLD_SIZE", 4, false);
    assert_found("PMI_SIZE=2 PMI_RANK=0", "PMI_SIZE", 2, true);
    assert_found("MV2_COMM_WORLD_SIZE=16 MV2_COMM_WORLD_RANK=2", "MV2_COMM_WORLD_SIZE", 16, false);
    assert_found("SLURM_STEP_NUM_TASKS=8 SLURM_PROCID=0 SLURM_JOB_ID=7", "SLURM_STEP_NUM_TASKS", 8, true);
    assert_found("SLURM_STEP_NUM_TASKS=8 SLURM_PROCID=5 SLURM_JOB_ID=7", "SLURM_STEP_NUM_TASKS", 8, false);
}

TEST(open_mpi_makes_terminals)
{
    const launcher of_open_mpi = find_in("OMPI_COMM_WORLD_SIZE=1 OMPI_COMM_WORLD_RANK=0");
    const launcher of_srun = find_in("SLURM_STEP_NUM_TASKS=1 SLURM_PROCID=0"), none = find_in("SLURM_JOB_ID=7");
    assert_true(launcher_makes_terminal(&of_open_mpi));
    assert_false(launcher_makes_terminal(&of_srun));
    assert_false(launcher_makes_terminal(&none));
}

/* The first of several processes cannot know of the others by this one: the second speaks. */
TEST(a_rank_alone_tells_of_those_below_it)
{
    assert_found("PMIX_RANK=0", "PMIX_RANK", 1, false);
    assert_found("PMIX_RANK=1", "PMIX_RANK", 2, true);
    assert_found("PMIX_RANK=2", "PMIX_RANK", 3, false);
    const launcher one = find_in("PMIX_RANK=2"), known = find_in("PMI_SIZE=2 PMI_RANK=0 PMIX_RANK=0");
    assert_false(launcher_knows_all(&one));
    assert_true(launcher_knows_all(&known));
}

TEST(a_serial_job_is_one_process)
{
    assert_int_equal(find_in("").processes, 1);
    assert_null(find_in("").variable);
    /* A script of sbatch --ntasks=8 that starts the program by itself, and then by srun -n 1. */
    assert_int_equal(find_in("SLURM_JOB_ID=7 SLURM_NTASKS=8 SLURM_NPROCS=8 SLURM_PROCID=0").processes, 1);
    assert_int_equal(find_in("SLURM_JOB_ID=7 SLURM_NTASKS=1 SLURM_STEP_NUM_TASKS=1 SLURM_PROCID=0").processes, 1);
    /* mpirun -n 1 on two machines, whose daemons srun has started. */
    assert_int_equal(find_in("OMPI_COMM_WORLD_SIZE=1 OMPI_COMM_WORLD_RANK=0 SLURM_STEP_NUM_TASKS=2").processes, 1);
    assert_int_equal(find_in("OMPI_COMM_WORLD_SIZE=many PMI_SIZE=-3 MV2_COMM_WORLD_SIZE=").processes, 1);
    assert_int_equal(find_in("OMPI_COMM_WORLD_SIZE=0 PMI_SIZE=99999999999").processes, 1);
}
