/* SPDX-License-Identifier: BSD-3-Clause */
/* A short run written to a file and opened as a trajectory: a block falls on a slope, and a loose node flies by. Some
 * of its triangles may break. */
#ifndef DEM_TEST_TRAJECTORY_FIXTURE_H
#define DEM_TEST_TRAJECTORY_FIXTURE_H

#include "ask.h"
#include "unit/close.h"
#include "unit/scratch.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include <dem/reader.h>
#include <dem/trajectory.h>

enum { TRAJECTORY_FIXTURE_FRAMES = 6, TRAJECTORY_FIXTURE_BROKEN = 4 };

static const double trajectory_fixture_slope[4] = {-1.0, -0.011, 1.0, 0.009};

typedef struct trajectory_fixture {
    scratch_folder folder;
    const char *path;
    dem_reader *reader;
} trajectory_fixture;

#define trajectory_fixture_ok(status) assert_int_equal(status, DEM_OK)

static inline dem_lattice trajectory_fixture_lattice(void)
{
    const dem_material rubber = {.struct_size = sizeof(dem_material),
                                 .youngs_modulus = 1e6,
                                 .poissons_ratio = 1.0 / 3.0,
                                 .density = 1000,
                                 .thickness = 1,
                                 .guard = 0.02};
    const double velocity[2] = {0.5, -2.0}, at[2] = {0.03, 0.01}, none[1] = {1e-3};
    dem_lattice block = dem_lattice_empty(), loose = dem_lattice_empty();
    trajectory_fixture_ok(dem_lattice_rectangle(&block, 0.02, 0.02, 4e-3));
    trajectory_fixture_ok(dem_lattice_assemble(&block, &rubber));
    loose = dem_lattice_empty();
    loose.n_nodes = 1;
    loose.x = malloc(sizeof at), loose.mass = malloc(sizeof none);
    loose.x[0] = at[0], loose.x[1] = at[1], loose.mass[0] = none[0];
    trajectory_fixture_ok(dem_lattice_append(&block, &loose));
    dem_lattice_free(&loose);
    trajectory_fixture_ok(dem_lattice_launch(&block, velocity));
    return block;
}

/** The first triangles break behind frame 2. */
static inline void trajectory_fixture_break(dem_simulation *simulation)
{
    static const dem_index first[TRAJECTORY_FIXTURE_BROKEN] = {0, 1, 2, 3};
    trajectory_fixture_ok(dem_simulation_advance(simulation, 2.5 * 2e-4));
    trajectory_fixture_ok(dem_simulation_break(simulation, first, TRAJECTORY_FIXTURE_BROKEN, NULL, 0));
}

/** Frames every 2e-4 s. */
static inline trajectory_fixture trajectory_fixture_run(bool breaks)
{
    const dem_obstacle slope = {
        .struct_size = sizeof(dem_obstacle), .n_points = 2, .points = trajectory_fixture_slope, .restitution = 0.5};
    const dem_options options = dem_options_default();
    dem_trajectory_options how = dem_trajectory_options_default();
    dem_lattice block = trajectory_fixture_lattice();
    dem_model *model;
    dem_simulation *simulation;
    dem_trajectory *file;
    trajectory_fixture f;
    folder_open(&f.folder);
    f.path = folder_file(&f.folder, "run.vtkhdf");
    (void)folder_file(&f.folder, "run.obstacle.vtkhdf");
    (void)folder_file(&f.folder, "run.body.vtkhdf");
    how.frame_interval = 2e-4;
    trajectory_fixture_ok(dem_model_create(&model, &block, &slope, 1));
    trajectory_fixture_ok(dem_simulation_create(&simulation, model, &options));
    trajectory_fixture_ok(dem_trajectory_create(&file, f.path, simulation, &how));
    const dem_observer observer = ask_trajectory_observer(file);
    trajectory_fixture_ok(dem_simulation_observe(simulation, &observer));
    if (breaks) trajectory_fixture_break(simulation);
    trajectory_fixture_ok(dem_simulation_advance(simulation, (TRAJECTORY_FIXTURE_FRAMES - 1) * 2e-4));
    trajectory_fixture_ok(dem_trajectory_finish(file));
    dem_trajectory_destroy(file);
    dem_simulation_destroy(simulation);
    dem_model_destroy(model);
    dem_lattice_free(&block);
    trajectory_fixture_ok(dem_reader_open(&f.reader, f.path));
    return f;
}

static inline trajectory_fixture trajectory_fixture_open(void)
{
    return trajectory_fixture_run(false);
}

/** The path of a file beside it. */
static inline char *trajectory_fixture_beside(const trajectory_fixture *f, const char *name)
{
    return folder_at(&f->folder, name);
}

/** The trajectory and its folder are gone; what else was written there must be gone before. */
static inline void trajectory_fixture_close(trajectory_fixture *f)
{
    dem_reader_close(f->reader);
    folder_close(&f->folder);
}

/** For a group of tests, whose state it is. */
static inline int trajectory_fixture_begin(void **state)
{
    static trajectory_fixture f;
    f = trajectory_fixture_open();
    *state = &f;
    return 0;
}

static inline int trajectory_fixture_end(void **state)
{
    trajectory_fixture_close(*state);
    return 0;
}

#endif
