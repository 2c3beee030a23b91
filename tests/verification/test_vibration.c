/* SPDX-License-Identifier: BSD-3-Clause */
/* A free block in large vibration against GSL's Runge-Kutta methods and the two-step formula (5) with the same fixed
 * steps: independent integrators, and forces summed spring by spring from the triplets. */
#include <stdlib.h>
#include <string.h>

#include "triplets.h"

#include "harness/motion.h"
#include "support.h"

enum { n_steps = 500 };

/* (5) from rest:  x_1 = x_0 + h^2/2 a_0,  x_{n+1} = 2 x_n - x_{n-1} + h^2 a_n.  \param x  [2 n] */
static void two_step_formula(dem_lattice *block, double h, double *x)
{
    const size_t n = 2 * (size_t)block->n_nodes;
    CLEANUP(free_memory)
    double *y = calloc(2 * n, sizeof *y), *f = malloc(2 * n * sizeof *f), *before = malloc(n * sizeof *before);
    assert_true(y != NULL && f != NULL && before != NULL);
    triplets_start(block, y);
    for (int k = 0; k < n_steps; k++) {
        (void)triplets_derivative(0.0, y, f, block);
        for (size_t c = 0; c < n; c++) {
            const double now = y[c];
            y[c] = k == 0 ? now + 0.5 * h * h * f[n + c] : 2.0 * now - before[c] + h * h * f[n + c];
            before[c] = now;
        }
    }
    memcpy(x, y, n * sizeof *x);
}

static void with_gsl(dem_lattice *block, dem_method method, double h, double *y)
{
    triplets_start(block, y);
    if (method == DEM_METHOD_VERLET)
        two_step_formula(block, h, y);
    else if (method == DEM_METHOD_RK4) /* GSL's takes two steps of half the length it is given */
        triplets_steps(block, gsl_odeiv2_step_rk4, n_steps / 2, 2.0 * h, y);
    else
        triplets_steps(block, gsl_odeiv2_step_rkf45, n_steps, h, y);
}

/* Both take 500 equal steps with the same weights, so that only rounding differs: 500 steps times a few 1e-16 of
 * 0.06 m, times what the motion amplifies. 1e-9 m is what the comparison is asked to hold. */
TEST(fixed_steps_agree_with_gsl)
{
    static const dem_method methods[3] = {DEM_METHOD_FEHLBERG45, DEM_METHOD_RK4, DEM_METHOD_VERLET};
    CLEANUP(dem_lattice_free) dem_lattice block = dem_lattice_empty();
    support_block(&block);
    CLEANUP(free_memory) double *y = malloc(4 * (size_t)block.n_nodes * sizeof *y);
    assert_non_null(y);
    for (int m = 0; m < 3; m++) {
        CLEANUP(support_close) support_run run;
        dem_options options = support_options();
        options.gravity[1] = 0.0;
        options.method = methods[m];
        options.fixed_step = 6e-6; /* omega_max h = 0.3 */
        support_open(&run, &block, NULL, 0, &options);
        with_gsl(&block, methods[m], options.fixed_step, y);
        const motion state = support_at(&run, n_steps * options.fixed_step);
        assert_int_equal(ask_counts(run.simulation).rejected, 0);
        for (dem_index k = 0; k < 2 * block.n_nodes; k++) assert_close(state.x[k], y[k], 1e-9);
        assert_true(state.energy.kinetic > 0.05 * state.energy.elastic); /* caught in motion */
    }
}

static const double period = 1.23e-3; /* 2 L/c, the fundamental one */
static double duration = 2e-3;        /* s; with 'long' 100 periods */

/* A free body keeps its linear momentum to rounding, its angular momentum and energy to the tolerance: row d allows
 * 1e-6 of the energy in 100 fundamental periods at rtol 1e-9; found in as many: 1.9e-7. */
TEST(a_free_body_keeps_its_momenta_and_energy)
{
    CLEANUP(dem_lattice_free) dem_lattice block = dem_lattice_empty();
    CLEANUP(support_close) support_run run;
    dem_options options = support_options();
    const double velocity[2] = {3.0, -2.0};
    support_block(&block);
    assert_ok(dem_lattice_launch(&block, velocity));
    options.gravity[1] = 0.0;
    options.rtol = 1e-9;
    support_open(&run, &block, NULL, 0, &options);
    const dem_energy before = ask_energy(run.simulation);
    const dem_body_motion start = ask_body(run.simulation, 0);
    const motion state = support_at(&run, duration);
    const dem_body_motion end = ask_body(run.simulation, 0);
    for (int k = 0; k < 2; k++) {
        assert_close(end.velocity[k], velocity[k], 1e-12 * 3.0);
        assert_close(end.centre[k], start.centre[k] + duration * velocity[k], 1e-12);
    }
    assert_close(end.angular_momentum[2], start.angular_momentum[2], 1e-8 * end.mass * 0.06 * 3.0);
    assert_close((state.energy.kinetic + state.energy.elastic) / (before.kinetic + before.elastic), 1.0,
                 1e-6 / 100.0 * duration / period);
}

int main(int argc, char **argv)
{
    if (argc > 1 && strcmp(argv[1], "long") == 0) duration = 100.0 * period;
    return test_run();
}
