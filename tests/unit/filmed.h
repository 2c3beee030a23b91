/* SPDX-License-Identifier: BSD-3-Clause */
/* A short run written to a file and opened as a film: a block falls on a slope, and a loose node flies by. */
#ifndef DEM_TEST_FILMED_H
#define DEM_TEST_FILMED_H

#include "unit/close.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include <dem/film.h>
#include <dem/trajectory.h>

enum { FILMED_FRAMES = 6 };

static const double filmed_slope[4] = {-1.0, -0.011, 1.0, 0.009};

typedef struct filmed {
    char folder[64], path[96];
    dem_film *film;
} filmed;

#define filmed_ok(status) assert_int_equal(status, DEM_OK)

static inline dem_lattice filmed_lattice(void)
{
    const dem_material rubber = {
        .youngs_modulus = 1e6, .poissons_ratio = 1.0 / 3.0, .density = 1000, .thickness = 1, .guard = 0.02};
    const double velocity[2] = {0.5, -2.0}, at[2] = {0.03, 0.01}, none[1] = {1e-3};
    dem_lattice block, loose;
    filmed_ok(dem_lattice_rectangle(&block, 0.02, 0.02, 4e-3));
    filmed_ok(dem_lattice_assemble(&block, &rubber));
    dem_lattice_init(&loose);
    loose.n_nodes = 1;
    loose.x = malloc(sizeof at), loose.mass = malloc(sizeof none);
    loose.x[0] = at[0], loose.x[1] = at[1], loose.mass[0] = none[0];
    filmed_ok(dem_lattice_append(&block, &loose));
    dem_lattice_free(&loose);
    filmed_ok(dem_lattice_launch(&block, velocity));
    return block;
}

/** Frames every 2e-4 s. */
static inline filmed filmed_open(void)
{
    const dem_obstacle slope = {.n_points = 2, .points = filmed_slope, .restitution = 0.5};
    const dem_options options = dem_options_default();
    dem_trajectory_options how = dem_trajectory_options_default();
    dem_lattice block = filmed_lattice();
    dem_model *model;
    dem_simulation *simulation;
    dem_trajectory *file;
    filmed f = {.folder = "test_filmed_XXXXXX"};
    assert_non_null(mkdtemp(f.folder));
    (void)snprintf(f.path, sizeof f.path, "%s/run.vtkhdf", f.folder);
    how.frame_interval = 2e-4;
    filmed_ok(dem_model_create(&model, &block, &slope, 1));
    filmed_ok(dem_simulation_create(&simulation, model, &options));
    filmed_ok(dem_trajectory_create(&file, f.path, simulation, &how));
    const dem_observer observer = dem_trajectory_observer(file);
    filmed_ok(dem_simulation_observe(simulation, &observer));
    filmed_ok(dem_simulation_advance(simulation, (FILMED_FRAMES - 1) * 2e-4));
    filmed_ok(dem_trajectory_finish(file));
    dem_trajectory_destroy(file);
    dem_simulation_destroy(simulation);
    dem_model_destroy(model);
    dem_lattice_free(&block);
    filmed_ok(dem_film_open(&f.film, f.path));
    return f;
}

/** The path of a file beside it. */
static inline char *filmed_beside(const filmed *f, const char *name)
{
    static char path[2][128];
    static int next;
    next = 1 - next;
    (void)snprintf(path[next], sizeof path[next], "%s/%s", f->folder, name);
    return path[next];
}

/** The film and its folder are gone; what else was written there must be gone before. */
static inline void filmed_close(filmed *f)
{
    dem_film_close(f->film);
    (void)remove(f->path);
    (void)remove(filmed_beside(f, "run.obstacle.vtkhdf"));
    assert_int_equal(rmdir(f->folder), 0);
}

/** For a group of tests, whose state it is. */
static inline int filmed_begin(void **state)
{
    static filmed f;
    f = filmed_open();
    *state = &f;
    return 0;
}

static inline int filmed_end(void **state)
{
    filmed_close(*state);
    return 0;
}

#endif
