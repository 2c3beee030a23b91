/* SPDX-License-Identifier: BSD-3-Clause */
/* Damping of springs and of masses: two masses along their spring and turning about each other, a falling node, a free
 * plate. Along a spring (1) is linear in the distance and so is its damping: the closed forms of the damped oscillator
 * hold at any amplitude. The runs use rtol 1e-13; the errors allowed have test_pair's reason, below 1e-11 m over such
 * times, but where another stands beside them. */
#include "harness/cleanup_gsl.h"
#include "harness/motion.h"
#include "support.h"

#include <stdlib.h>

#include <gsl/gsl_rng.h>

static const double stiffness = 100.0, rest_length = 1.0, reduced_mass = 0.75; /* of 1 and 3 kg */
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

static void damp(dem_lattice *lattice, double viscosity)
{
    lattice->viscosity = malloc((size_t)lattice->n_springs * sizeof *lattice->viscosity);
    assert_non_null(lattice->viscosity);
    for (dem_index k = 0; k < lattice->n_springs; k++) lattice->viscosity[k] = viscosity;
}

typedef struct pair {
    double viscosity;    /* N s */
    double mass_damping; /* 1/s */
    double distance;     /* m, at the start, along x */
    double relative[2];  /* m/s, of the second mass relative to the first */
    double drift;        /* m/s, of the centre of mass, along x */
} pair;

/* The centre of mass starts in the origin. */
static void open_pair(support_run *run, const pair *p)
{
    const double x[4] = {-0.75 * rest_length, 0.0, 0.25 * rest_length, 0.0};
    const double start[4] = {-0.75 * p->distance, 0.0, 0.25 * p->distance, 0.0};
    const double v[4] = {p->drift - 0.75 * p->relative[0], -0.75 * p->relative[1], p->drift + 0.25 * p->relative[0],
                         0.25 * p->relative[1]};
    dem_options options = tight_options();
    options.mass_damping = p->mass_damping;
    CLEANUP(dem_lattice_free)
    dem_lattice lattice = support_lattice(2, x, two_masses, 1, joined, rest_length, stiffness, NULL);
    support_start(&lattice, start, v);
    damp(&lattice, p->viscosity);
    support_open(run, &lattice, NULL, 0, &options);
}

/* u'' + rate u' + omega^2 u = 0 from u(0) = a, u'(0) = b; at the time t.  \param[out] u  u, u' */
static void oscillator(double rate, double omega, const double start[2], double t, double u[2])
{
    const double a = start[0], b = start[1], half = 0.5 * rate, square = omega * omega - half * half;
    const double q = sqrt(fabs(square)), decay = exp(-half * t);
    const double c = square > 0.0 ? cos(q * t) : cosh(q * t);
    const double s = square > 0.0 ? sin(q * t) / q : (square < 0.0 ? sinh(q * t) / q : t);
    u[0] = decay * (a * c + (b + half * a) * s);
    u[1] = decay * (b * c - (half * b + omega * omega * a) * s);
}

/* Compares with the closed form at some times up to `end`. */
static void follow_oscillator(const pair *p, double end)
{
    const double omega = sqrt(stiffness / rest_length / reduced_mass);
    const double rate = p->viscosity / rest_length / reduced_mass + p->mass_damping;
    const double start[2] = {p->distance - rest_length, p->relative[0]};
    CLEANUP(support_close) support_run run;
    open_pair(&run, p);
    for (int k = 1; k <= 20; k++) {
        double u[2];
        const double t = end * (double)k / 20.0;
        const motion state = support_at(&run, t);
        oscillator(rate, omega, start, t, u);
        assert_close(state.x[2] - state.x[0], rest_length + u[0], 1e-11);
        assert_close(state.v[2] - state.v[0], u[1], omega * 1e-11);
        assert_close(state.x[1], 0.0, 0.0);
        const double centre = 0.25 * state.x[0] + 0.75 * state.x[2];
        const double way = p->mass_damping > 0.0 ? -expm1(-p->mass_damping * t) / p->mass_damping : t;
        assert_close(centre, p->drift * way, 1e-11);
    }
}

/* omega = 11.55/s; the damping ratios rate/(2 omega) are 0.12 and 0.06 + 0.04 = 0.10. */
TEST(a_damped_spring_swings_as_the_closed_form_at_any_amplitude)
{
    const pair pairs[4] = {{2.0, 0.0, 1.001, {0.0, 0.0}, 0.0},
                           {2.0, 0.0, 1.3, {0.0, 0.0}, 0.0},
                           {2.0, 0.0, 0.9, {3.0, 0.0}, 0.5},
                           {1.0, 1.0, 1.2, {-1.0, 0.0}, 0.5}};
    for (int k = 0; k < 4; k++) follow_oscillator(&pairs[k], 3.0);
}

/* Damping ratios 2 and, to rounding, 1: 2 sqrt(100 * 0.75) N s. */
TEST(an_overdamped_spring_creeps_back_as_the_closed_form)
{
    const double critical = 2.0 * sqrt(stiffness * rest_length * reduced_mass);
    const pair pairs[3] = {{2.0 * critical, 0.0, 1.4, {0.0, 0.0}, 0.0},
                           {2.0 * critical, 0.0, 0.8, {5.0, 0.0}, -0.3},
                           {critical, 0.0, 1.4, {-2.0, 0.0}, 0.0}};
    for (int k = 0; k < 3; k++) follow_oscillator(&pairs[k], 1.5);
}

/* v(t) = g/alpha + (v0 - g/alpha) exp(-alpha t). */
TEST(a_node_under_mass_damping_falls_at_last_with_g_over_alpha)
{
    const double x[2] = {1.0, 2.0}, v[2] = {3.0, 1.0}, g = -9.81, alpha = 2.5, mass = 0.3;
    dem_options options = support_options();
    CLEANUP(support_close) support_run run;
    options.rtol = 1e-13;
    options.spacing = options.v_scale = 1.0;
    options.max_step = 0.05;
    options.mass_damping = alpha;
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_lattice(1, x, &mass, 0, NULL, 0.0, 0.0, NULL);
    support_start(&lattice, NULL, v);
    support_open(&run, &lattice, NULL, 0, &options);
    for (int k = 1; k <= 10; k++) {
        const double t = 0.4 * (double)k, lost = -expm1(-alpha * t);
        const motion state = support_at(&run, t);
        assert_close(state.v[0], v[0] * (1.0 - lost), 1e-11);
        assert_close(state.v[1], v[1] + (g / alpha - v[1]) * lost, 1e-11);
        assert_close(state.x[0], x[0] + v[0] * lost / alpha, 1e-11);
        assert_close(state.x[1], x[1] + g / alpha * t + (v[1] - g / alpha) * lost / alpha, 1e-11);
    }
}

/* At 1.2 m the spring pulls with 20 N = mu d w^2. The orbit is the exact solution for every viscosity. */
TEST(a_pair_that_turns_at_constant_distance_is_not_damped)
{
    const double distance = 1.2, w = sqrt(stiffness * (distance - rest_length) / rest_length / reduced_mass / distance);
    const pair p = {5.0, 0.0, distance, {0.0, w * distance}, 0.0};
    CLEANUP(support_close) support_run run;
    open_pair(&run, &p);
    for (int k = 1; k <= 20; k++) {
        const double t = M_PI / w * (double)k; /* ten turns */
        const motion state = support_at(&run, t);
        assert_close(state.x[2] - state.x[0], k % 2 == 0 ? distance : -distance, 1e-11);
        assert_close(state.x[3] - state.x[1], 0.0, 1e-10); /* an error of the speed adds up over the way of 75 m */
    }
}

/* Its angular momentum is L = mu d u for ever; it ends where E (r - d0)/d0 = L^2/(mu r^3). The ring of the spring, rate
 * c/(d0 mu) and slower by the turning, has decayed by exp(-40) and more at the end. */
TEST(a_turning_pair_comes_to_the_distance_that_its_angular_momentum_holds)
{
    const pair p = {12.0, 0.0, 1.3, {-2.0, 4.0}, 0.0};
    const double spin = reduced_mass * p.distance * p.relative[1];
    double r = rest_length; /* Newton's */
    CLEANUP(support_close) support_run run;
    for (int k = 0; k < 50; k++)
        r -= (stiffness * (r - rest_length) / rest_length - spin * spin / reduced_mass / (r * r * r)) /
             (stiffness / rest_length + 3.0 * spin * spin / reduced_mass / (r * r * r * r));
    open_pair(&run, &p);
    const motion state = support_at(&run, 10.0);
    const double d[2] = {state.x[2] - state.x[0], state.x[3] - state.x[1]};
    const double u[2] = {state.v[2] - state.v[0], state.v[3] - state.v[1]};
    assert_close(reduced_mass * (d[0] * u[1] - d[1] * u[0]), spin, 1e-10);
    assert_close(hypot(d[0], d[1]), r, 1e-11);
    assert_close(d[0] * u[0] + d[1] * u[1], 0.0, 1e-10);
}

static void throw_plate(dem_lattice *lattice)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    const double spin = 20.0; /* rad/s */
    gsl_rng_set(rng, 11);
    lattice->velocity = malloc(2 * (size_t)lattice->n_nodes * sizeof *lattice->velocity);
    assert_non_null(lattice->velocity);
    for (dem_index i = 0; i < lattice->n_nodes; i++) {
        lattice->velocity[2 * i] = 3.0 - spin * lattice->x[2 * i + 1] + gsl_rng_uniform(rng) - 0.5;
        lattice->velocity[2 * i + 1] = -1.0 + spin * lattice->x[2 * i] + gsl_rng_uniform(rng) - 0.5;
    }
}

/* J, of what moves relative to the mean motion as a rigid body would have it at the same places. */
static double energy_of_vibration(const dem_simulation *simulation, const motion *state)
{
    const dem_lattice *l = dem_model_lattice(dem_simulation_model(simulation));
    const dem_body_motion body = ask_body(simulation, 0);
    double moment = 0.0;
    for (dem_index i = 0; i < l->n_nodes; i++) {
        const double dx = state->x[2 * i] - body.centre[0], dy = state->x[2 * i + 1] - body.centre[1];
        moment += l->mass[i] * (dx * dx + dy * dy);
    }
    const double speed2 = body.velocity[0] * body.velocity[0] + body.velocity[1] * body.velocity[1];
    const double spin = body.angular_momentum[2];
    return state->energy.kinetic - 0.5 * body.mass * speed2 - 0.5 * spin * spin / moment;
}

/* Random velocities of up to 0.5 m/s over those of a thrown, turning plate. The slowest wave, about 3e3/s, loses its
 * energy at the rate tau omega^2 = 1e3/s, all but exp(-30); 1e-12 is also above the rounding of 21 J beside 0.4 J. A
 * sum of forces that vanishes keeps the linear momentum to rounding; the angular one, no linear invariant, has the
 * error of steps of 0.5/omega_max: 1e-10, and below 1e-12 with steps half as long. */
TEST(a_damped_plate_comes_to_turn_rigidly_and_keeps_its_momenta)
{
    const dem_material rubber = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0,
                                      .density = 1050.0, .thickness = 1.0, .damping_time = 1e-4);
    dem_options options = support_options();
    CLEANUP(support_close) support_run run;
    options.gravity[1] = 0.0;
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_rectangle(0.08, 0.06, 0.01, &rubber);
    throw_plate(&lattice);
    support_open(&run, &lattice, NULL, 0, &options);
    motion state = support_at(&run, 0.0);
    const dem_body_motion first = ask_body(run.simulation, 0);
    const double vibration = energy_of_vibration(run.simulation, &state);
    state = support_at(&run, 0.03);
    const dem_body_motion last = ask_body(run.simulation, 0);
    const double scale = first.mass * 3.0;
    for (int k = 0; k < 2; k++)
        assert_close(first.mass * last.velocity[k], first.mass * first.velocity[k], 1e-12 * scale);
    assert_close(last.angular_momentum[2], first.angular_momentum[2], 1e-9 * fabs(first.angular_momentum[2]));
    assert_true(vibration > 0.1 && fabs(first.angular_momentum[2]) > 0.01);
    assert_close(energy_of_vibration(run.simulation, &state) / vibration, 0.0, 1e-12);
}
