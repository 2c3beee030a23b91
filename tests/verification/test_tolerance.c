/* SPDX-License-Identifier: BSD-3-Clause */
/* Whether a smaller tolerance pays (row i): the rms error of the positions falls by at least 30 for each 100 in rtol;
 * exactly proportional steps would make it 100. Steps are not capped. Reference: rtol 1e-12. */
#include <stdlib.h>
#include <string.h>

#include "harness/motion.h"
#include "support.h"

static const double rtol[4] = {1e-12, 1e-5, 1e-7, 1e-9};

static dem_options options_of(double t, double tolerance)
{
    dem_options options = support_options();
    options.rtol = tolerance;
    options.max_step = t;
    options.v_scale = 1.0;
    options.window = 0.0;
    options.penetration_tolerance = 1e-12; /* as deep are impacts late, whatever rtol: below all errors */
    return options;
}

/* Positions at t.  \param[out] x  [2 n] */
static void run_to(const dem_lattice *body, const dem_obstacle *floor, double t, double tolerance, double *x)
{
    CLEANUP(support_close) support_run run;
    const dem_options options = options_of(t, tolerance);
    support_open(&run, body, floor, floor != NULL, &options);
    const motion state = support_at(&run, t);
    memcpy(x, state.x, 2 * (size_t)body->n_nodes * sizeof *x);
    if (floor != NULL) {
        const dem_counts counts = ask_counts(run.simulation);
        assert_true(counts.impacts > 3 && counts.slips + counts.sticks > 10 && state.energy.friction > 0.5);
    }
}

/* The root mean square distance of n nodes. */
static double error_of(const double *x, const double *reference, dem_index n)
{
    double sum = 0.0;
    for (dem_index c = 0; c < 2 * n; c++) sum += (x[c] - reference[c]) * (x[c] - reference[c]);
    return sqrt(sum / (double)n);
}

static void check_errors(const dem_lattice *body, const dem_obstacle *floor, double t)
{
    const size_t n = 2 * (size_t)body->n_nodes;
    double *x = malloc(2 * n * sizeof *x), before = 0.0;
    assert_non_null(x);
    for (int k = 0; k < 4; k++) {
        run_to(body, floor, t, rtol[k], x + (k > 0 ? n : 0));
        const double error = k > 0 ? error_of(x + n, x, body->n_nodes) : 0.0;
        if (k > 0) print_message("# rtol %g: error %.2e m\n", rtol[k], error);
        if (k > 1) assert_true(before > 30.0 * error);
        before = error;
    }
    free(x);
}

TEST(the_error_of_a_free_block_falls_with_the_tolerance)
{
    CLEANUP(dem_lattice_free) dem_lattice block = dem_lattice_empty();
    support_block(&block);
    check_errors(&block, NULL, 2e-3);
}

/* It lands at 5 m/s with 2 m/s across, flat or on a corner, plastically, mu = 0.3; nodes slide, turn and stick. */
TEST(the_error_of_a_block_dropped_with_friction_falls_too)
{
    static const double angles[2] = {0.0, 0.3}, velocity[2] = {2.0, -5.0}, points[4] = {-1.0, 0.0, 1.0, 0.0};
    const dem_obstacle floor =
        SIZED(dem_obstacle, .n_points = 2, .points = points, .restitution = 0.0, .friction = 0.3);
    const dem_material rubber = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0,
                                      .density = 1050.0, .thickness = 1.0, .guard = 0.0);
    for (int k = 0; k < 2; k++) {
        const double none[2] = {0.0, 0.0};
        double lowest = 1.0;
        CLEANUP(dem_lattice_free) dem_lattice block = support_rectangle(0.05, 0.05, 5e-3, &rubber);
        dem_lattice_move(&block, angles[k], none);
        for (dem_index i = 0; i < block.n_nodes; i++) lowest = fmin(lowest, block.x[2 * i + 1]);
        dem_lattice_move(&block, 0.0, (const double[2]){0.0, 1e-4 - lowest});
        assert_ok(dem_lattice_launch(&block, velocity));
        check_errors(&block, &floor, 2e-3);
    }
}

/* ---- bodies in contact ---- */

/* Positions after a collision of blocks.  \param[out] x  [2 n] */
static void collide(const dem_lattice *blocks, double t, double tolerance, double *x)
{
    CLEANUP(support_close) support_run run;
    dem_options options = options_of(t, tolerance);
    options.bodies = DEM_BODIES_ALL;
    options.gravity[1] = 0.0;
    support_open(&run, blocks, NULL, 0, &options);
    const motion middle = support_at(&run, 0.4 * t);
    assert_true(middle.energy.contact > 1e-3);
    memcpy(x, support_at(&run, t).x, 2 * (size_t)blocks->n_nodes * sizeof *x);
    assert_close(ask_energy(run.simulation).contact, 0.0, 0.0);
}

TEST(the_error_of_colliding_blocks_falls_by_five_a_decade)
{
    const double t = 3e-3;
    const dem_material rubber = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0,
                                      .density = 1050.0, .thickness = 1.0, .guard = 0.02);
    CLEANUP(dem_lattice_free)
    dem_lattice blocks = support_squares(0.05, 5e-3, &rubber, (const double[2]){0.37 * 5e-3, 0.055});
    const dem_index n = blocks.n_nodes;
    assert_ok(dem_lattice_launch(&blocks, (const double[2]){0.0, 2.5}));
    for (dem_index i = n / 2; i < n; i++) blocks.velocity[2 * i + 1] = -2.5;
    CLEANUP(free_memory) double *x = malloc(4 * (size_t)n * sizeof *x);
    assert_non_null(x);
    collide(&blocks, t, 1e-12, x);
    double before = INFINITY;
    for (int decade = 4; decade <= 9; decade++) {
        collide(&blocks, t, pow(10.0, -decade), x + 2 * n);
        const double error = error_of(x + 2 * n, x, n);
        print_message("# colliding blocks, rtol 1e-%d: error %.2e spacings\n", decade, error / 5e-3);
        if (decade > 6) assert_true(before > 5.0 * error);
        before = error;
    }
}
