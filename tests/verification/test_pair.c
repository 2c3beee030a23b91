/* SPDX-License-Identifier: BSD-3-Clause */
/* Two masses on one spring, along it and rotating; one mass between two fixed ends. Exact values from quadrature of
 * the energy integral (rows a1 to a3 of docs/verification.md). Tolerances are those of the table; the runs use rtol
 * 1e-13, whose error over these times is below 1e-11 m. A time error is measured as a velocity over an acceleration
 * at a turning point. */
#include "harness/motion.h"
#include "support.h"

static const double stiffness = 100.0, rest_length = 1.0;
static const double two_masses[2] = {1.0, 3.0};
static const dem_index joined[2] = {0, 1};

static dem_options tight_options(void)
{
    dem_options options = support_options();
    options.gravity[1] = 0.0;
    options.rtol = 1e-13;
    options.v_scale = 1.0;
    return options;
}

/* A pair with its centre of mass at rest in the origin, `distance` apart along x, with relative velocity (0,
 * relative). */
static void open_pair(support_run *run, double distance, double relative)
{
    const double x[4] = {-0.75 * rest_length, 0.0, 0.25 * rest_length, 0.0};
    const double start[4] = {-0.75 * distance, 0.0, 0.25 * distance, 0.0},
                 v[4] = {0.0, -0.75 * relative, 0.0, 0.25 * relative};
    const dem_options options = tight_options();
    CLEANUP(dem_lattice_free)
    dem_lattice lattice = support_lattice(2, x, two_masses, 1, joined, rest_length, stiffness, NULL);
    support_start(&lattice, start, v);
    support_open(run, &lattice, NULL, 0, &options);
}

static void separation(const motion *state, double d[2], double u[2])
{
    for (int k = 0; k < 2; k++) {
        d[k] = state->x[2 + k] - state->x[k];
        u[k] = state->v[2 + k] - state->v[k];
    }
}

TEST(a_collinear_pair_has_the_harmonic_period_at_any_amplitude)
{
    const double period = 0.544139809270265, amplitudes[2] = {1e-3, 0.3}, omega = 2.0 * M_PI / period;
    for (int k = 0; k < 2; k++) {
        CLEANUP(support_close) support_run run;
        double d[2], u[2];
        open_pair(&run, 1.0 + amplitudes[k], 0.0);
        const motion state = support_at(&run, 10.0 * period);
        separation(&state, d, u);
        assert_close(u[0] / (omega * omega * amplitudes[k]) / (10.0 * period), 0.0, 1e-8);
        assert_close((d[0] - 1.0) / amplitudes[k], 1.0, 1e-8);
    }
}

TEST(a_rotating_pair_turns_at_the_exact_time_angle_and_distance)
{
    static const double speed[3] = {0.5, 2.0, 5.0}, other_turn[3] = {0.805792167598, 0.880505568874, 1.1383462295};
    static const double period[3] = {0.54175230220117, 0.51478871808614, 0.45436992222068};
    static const double angle[3] = {0.34276879750215, 1.1813598398255, 1.9961595833541};
    for (int k = 0; k < 3; k++) {
        CLEANUP(support_close) support_run run;
        double d[2], u[2];
        open_pair(&run, 1.2, speed[k]);
        motion state = support_at(&run, 0.5 * period[k]);
        separation(&state, d, u);
        assert_close(atan2(d[1], d[0]), 0.5 * angle[k], 1e-7);
        assert_close(hypot(d[0], d[1]), other_turn[k], 1e-7);
        state = support_at(&run, period[k]);
        separation(&state, d, u);
        const double r = hypot(d[0], d[1]), radial = (d[0] * u[0] + d[1] * u[1]) / r;
        const double across = (d[0] * u[1] - d[1] * u[0]) / r;
        const double acceleration = across * across / r - stiffness * (r - rest_length) / rest_length / 0.75;
        assert_close(atan2(d[1], d[0]), angle[k], 1e-7);
        assert_close(r, 1.2, 1e-7);
        assert_close(radial / acceleration / period[k], 0.0, 1e-7);
    }
}

TEST(a_mass_between_fixed_ends_swings_across_with_the_exact_period)
{
    static const double amplitude[4] = {0.01, 0.1, 0.5, 1.0};
    static const double period[4] = {74.1651848905, 7.43822303668, 1.58707476235, 0.92396292578};
    static const double x[6] = {-1.0, 0.0, 0.0, 0.0, 1.0, 0.0}, mass[3] = {1.0, 1.0, 1.0};
    static const dem_index ends[4] = {0, 1, 1, 2};
    static const unsigned char fixed[3] = {1, 0, 1};
    const dem_options options = tight_options();
    for (int k = 0; k < 4; k++) {
        const double start[6] = {-1.0, 0.0, 0.0, amplitude[k], 1.0, 0.0};
        CLEANUP(support_close) support_run run;
        CLEANUP(dem_lattice_free)
        dem_lattice lattice = support_lattice(3, x, mass, 2, ends, rest_length, stiffness, fixed);
        support_start(&lattice, start, NULL);
        support_open(&run, &lattice, NULL, 0, &options);
        motion state = support_at(&run, 0.75 * period[k]); /* upwards through the middle */
        assert_true(state.v[3] > 0.0);
        assert_close(state.x[3] / state.v[3] / (0.75 * period[k]), 0.0, 1e-7);
        assert_close(state.x[2], 0.0, 1e-12);
        assert_close(state.x[0], -1.0, 0.0);
        state = support_at(&run, period[k]);
        assert_close(state.x[3] / amplitude[k], 1.0, 1e-7);
    }
}
