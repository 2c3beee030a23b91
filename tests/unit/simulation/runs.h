/* SPDX-License-Identifier: BSD-3-Clause */
/* Short runs of a point mass and of a small rectangle, and states by value to compare them to the last bit. */
#ifndef DEM_TEST_RUNS_H
#define DEM_TEST_RUNS_H

#include "harness/motion.h"
#include "verification/support.h"

#include <string.h>

static const double floor_points[4] = {-1.0, 0.0, 1.0, 0.0};

/* One node of 2 kg at (0, height) over a floor. */
static inline dem_model *make_point_at(double height, const double v[2], double restitution)
{
    const double x[2] = {0.0, height}, mass = 2.0;
    const dem_obstacle obstacle = {
        .struct_size = sizeof(dem_obstacle), .n_points = 2, .points = floor_points, .restitution = restitution};
    dem_lattice lattice = support_lattice(1, x, &mass, 0, NULL, 0.0, 0.0, NULL);
    support_start(&lattice, NULL, v);
    dem_model *model = support_model(&lattice, &obstacle, 1);
    dem_lattice_free(&lattice);
    return model;
}

static inline dem_model *make_point(const double v[2], double restitution)
{
    return make_point_at(1.0, v, restitution);
}

static inline dem_options point_options(void)
{
    dem_options options = dem_options_default();
    options.spacing = 1.0;
    options.max_step = 0.03;
    return options;
}

static inline dem_simulation *simulate(const dem_model *model, const dem_options *options)
{
    dem_simulation *simulation = support_simulation(model, options);
    return simulation;
}

/* ---- a small rectangle falling on a slope ---- */

static const double spacing = 0.01, slope_points[6] = {-0.5, 0.1, 0.0, 0.0, 0.5, -0.2};
static const double t_whole = 6e-3; /* s */

static inline void make_rectangle(dem_lattice *lattice, double clearance)
{
    const dem_material rubber = {.struct_size = sizeof(dem_material),
                                 .youngs_modulus = 1e7,
                                 .poissons_ratio = 1.0 / 3.0,
                                 .density = 1050.0,
                                 .thickness = 1.0,
                                 .guard = 0.02};
    const double up[2] = {0.01, clearance};
    assert_ok(dem_lattice_rectangle(lattice, 0.03, 0.04, spacing));
    assert_ok(dem_lattice_assemble(lattice, &rubber));
    dem_lattice_move(lattice, 0.0, up);
}

static inline dem_model *make_falling(double restitution)
{
    const dem_obstacle slope = {
        .struct_size = sizeof(dem_obstacle), .n_points = 3, .points = slope_points, .restitution = restitution};
    const double down[2] = {0.5, -4.0};
    dem_lattice lattice = dem_lattice_empty();
    make_rectangle(&lattice, 0.006);
    assert_ok(dem_lattice_launch(&lattice, down));
    dem_model *model = support_model(&lattice, &slope, 1);
    dem_lattice_free(&lattice);
    return model;
}

/* A state by value: positions and velocities of all nodes, and the ledger. */
typedef struct snapshot {
    double t, y[4 * 40];
    dem_index n;
    dem_energy energy;
    dem_counts counts;
} snapshot;

static inline snapshot snap(const dem_simulation *simulation)
{
    snapshot s = {.n = 2 * ask_sizes(dem_simulation_model(simulation)).n_nodes};
    motion state;
    motion_see(simulation, &state);
    assert_true(s.n <= 80);
    s.t = state.t;
    memcpy(s.y, state.x, (size_t)s.n * sizeof(double));
    memcpy(s.y + s.n, state.v, (size_t)s.n * sizeof(double));
    s.energy = state.energy;
    s.counts = ask_counts(simulation);
    return s;
}

static inline void assert_same(const snapshot *a, const snapshot *b)
{
    assert_int_equal(a->n, b->n);
    assert_memory_equal(&a->t, &b->t, sizeof a->t);
    assert_memory_equal(a->y, b->y, 2 * (size_t)a->n * sizeof(double));
    assert_memory_equal(&a->energy, &b->energy, sizeof a->energy);
    assert_memory_equal(&a->counts, &b->counts, sizeof a->counts);
}

/* A run to the end in one go. */
static inline snapshot run_with(const dem_model *model, const dem_options *options)
{
    dem_simulation *simulation = simulate(model, options);
    assert_ok(dem_simulation_advance(simulation, t_whole));
    const snapshot s = snap(simulation);
    dem_simulation_destroy(simulation);
    return s;
}

static inline snapshot run_whole(const dem_model *model)
{
    const dem_options options = dem_options_default();
    return run_with(model, &options);
}

#endif
