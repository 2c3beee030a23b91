/* SPDX-License-Identifier: BSD-3-Clause */
/* The impact window: point masses whose impacts it takes together or closes, against closed forms; and a lattice on
 * rough ground, whose momentum, ledger and depth do not know of it. Tolerances of 1e-12 to 1e-10 are the integrator's
 * at rtol 1e-12. */
#include <stdlib.h>

#include "harness/motion.h"
#include "support.h"

static const double g = 9.81, floor_points[4] = {-4.0, 0.0, 4.0, 0.0};

/* n masses of 2 kg above a level floor, each a body of its own, at rest at these heights (m). */
static void open_masses(support_run *run, dem_index n, const double *height, double eta, double window)
{
    double x[8], mass[4];
    const dem_obstacle level = SIZED(dem_obstacle, .n_points = 2, .points = floor_points, .restitution = eta);
    dem_options options = support_options();
    for (dem_index i = 0; i < n; i++) {
        x[2 * i] = 0.5 * (double)i;
        x[2 * i + 1] = height[i];
        mass[i] = 2.0;
    }
    options.spacing = options.v_scale = 1.0;
    options.max_step = 0.01;
    options.rtol = 1e-12;
    options.penetration_tolerance = 1e-13;
    options.window = window;
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_lattice(n, x, mass, 0, NULL, 0.0, 0.0, NULL);
    lattice.body = malloc((size_t)n * sizeof *lattice.body);
    assert_non_null(lattice.body);
    for (dem_index i = 0; i < n; i++) lattice.body[i] = (int32_t)i;
    support_open(run, &lattice, &level, 1, &options);
}

/* The first arrives after sqrt(2/g) s with sqrt(2 g); 1 mm behind it the second needs 0.23 ms more, the third, 10 mm
 * behind, 2.3 ms. A window of 1 ms turns the second where it is: y = 1 mm + eta v t - g t^2/2 from there. */
TEST(what_is_taken_together_rebounds_where_it_is)
{
    const double height[3] = {1.0, 1.001, 1.01}, eta = 0.5, first = sqrt(2.0 / g), v = sqrt(2.0 * g);
    for (int k = 0; k < 2; k++) {
        CLEANUP(support_close) support_run run;
        open_masses(&run, 3, height, eta, k == 0 ? 1e-3 : 0.0);
        const double start = ask_energy(run.simulation).ledger;
        const double t = first + 0.1, own = sqrt(2.0 * height[1] / g);
        const double early = 1e-3 + eta * v * 0.1 - 0.5 * g * 0.01,
                     late = eta * g * own * (t - own) - 0.5 * g * (t - own) * (t - own);
        const motion s = support_at(&run, t);
        assert_close(s.x[1], eta * v * 0.1 - 0.5 * g * 0.01, 1e-11);
        assert_close(s.x[3], k == 0 ? early : late, 1e-11);
        assert_int_equal(run.n_impacts, 3);
        assert_int_equal(ask_counts(run.simulation).early, k == 0 ? 1 : 0);
        assert_int_equal(ask_counts(run.simulation).events, k == 0 ? 2 : 3);
        assert_close(s.energy.ledger, start, 1e-10);
    }
}

/* Plastic, the second stops 1 mm above the floor and falls from there: it comes down sqrt(2 mm/g) later, with
 * sqrt(2 g 1 mm), and lies on the floor from then on. */
TEST(what_is_taken_together_without_rebound_stays_above_until_it_has_fallen)
{
    const double height[2] = {1.0, 1.001}, first = sqrt(2.0 / g), fall = sqrt(2e-3 / g);
    CLEANUP(support_close) support_run run;
    open_masses(&run, 2, height, 0.0, 1e-3);
    assert_close(support_at(&run, first + 0.5 * fall).x[3], 1e-3 * 0.75, 1e-12);
    assert_int_equal(ask_counts(run.simulation).closings, 1);
    assert_close(support_at(&run, first + 2.0 * fall).x[3], 0.0, 1e-12);
    assert_int_equal(ask_counts(run.simulation).closings, 2);
    assert_int_equal(run.n_impacts, 3);
    assert_close(run.impacts[2].t, first + fall, 1e-11);
    assert_close(run.impacts[2].before[1], -sqrt(2.0 * g * 1e-3), 1e-10);
}

/* Rebounds of eta^n sqrt(2 g): the first whose hop of 2 v/g is at most twice the window is none. With 10 ms that is
 * the 6th, 0.5^6 4.43 m/s = 0.069 m/s < 0.098 m/s. Without a window it goes on. */
TEST(a_hop_of_less_than_twice_the_window_is_the_last)
{
    const double height = 1.0, total = sqrt(2.0 / g) * (1.0 + 2.0 * (0.5 + 0.25 + 0.125 + 0.0625 + 0.03125));
    for (int k = 0; k < 2; k++) {
        CLEANUP(support_close) support_run run;
        open_masses(&run, 1, &height, 0.5, k == 0 ? 0.01 : 0.0);
        const motion s = support_at(&run, 2.0);
        assert_close(s.x[1], 0.0, 1e-12);
        assert_int_equal(s.n_contacts, 1);
        if (k == 0) assert_int_equal(run.n_impacts, 6);
        if (k == 1) assert_true(run.n_impacts > 12);
        assert_close(run.impacts[5].t, total, 1e-10);
        assert_close(run.impacts[5].after[1], k == 0 ? 0.0 : pow(0.5, 6.0) * sqrt(2.0 * g), 1e-9);
    }
}

/* ---- a lattice ---- */

/* What an observer follows: the worst. */
typedef struct audit {
    double start, mass, v0[2];
    double deepest, taken, drift, balance; /* m; J, least taken by an impact; J; N s */
    const double *ground;
} audit;

static double depth_below(const double *points, const double x[2])
{
    for (int k = 0; k < 4; k++) {
        const double *a = &points[2 * k], *b = a + 2, slope = (b[1] - a[1]) / (b[0] - a[0]);
        if (x[0] >= a[0] && x[0] <= b[0]) return (a[1] + slope * (x[0] - a[0]) - x[1]) / sqrt(1.0 + slope * slope);
    }
    return -1.0;
}

static dem_status follow(void *context, const dem_simulation *simulation)
{
    audit *a = context;
    motion state;
    motion_see(simulation, &state);
    const dem_body_motion body = ask_body(simulation, 0);
    const dem_obstacle_load load = ask_obstacle(simulation, 0);
    const double momentum[2] = {0.0, -g * state.t * a->mass};
    for (int d = 0; d < 2; d++)
        a->balance = fmax(a->balance, fabs(a->mass * (body.velocity[d] - a->v0[d]) - momentum[d] - load.impulse[d]));
    a->drift = fmax(a->drift, fabs(state.energy.ledger - a->start));
    for (dem_index i = 0; i < ask_sizes(dem_simulation_model(simulation)).n_nodes; i++)
        a->deepest = fmax(a->deepest, depth_below(a->ground, &state.x[2 * i]));
    return DEM_OK;
}

static dem_status note(void *context, const dem_simulation *simulation, const dem_event *event)
{
    audit *a = context;
    (void)simulation;
    a->taken = fmin(a->taken, event->energy);
    return DEM_OK;
}

/* A block of rubber on ground with an apex and a notch, with friction; kappa < 0: the window by default. Returns the
 * velocity with which it rises in the end. */
static double drop_block(double eta, double friction, double kappa, dem_counts *counts)
{
    static const double ground[10] = {-0.2, -0.012, -0.021, 0.0, 0.013, -0.008, 0.04, 0.001, 0.2, -0.01};
    const dem_material rubber = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0,
                                      .density = 1050.0, .thickness = 1.0, .guard = 0.02);
    const dem_obstacle rough =
        SIZED(dem_obstacle, .n_points = 5, .points = ground, .restitution = eta, .friction = friction);
    const double lift[2] = {0.0, 0.0015}, speed[2] = {1.0, -5.0};
    dem_options options = support_options();
    support_run run;
    audit a = {.ground = ground, .v0 = {speed[0], speed[1]}};
    const dem_observer observer =
        SIZED(dem_observer, .interval = 1e-6, .frame = follow, .step = follow, .event = note, .context = &a);
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_rectangle(0.08, 0.06, 0.01, &rubber);
    dem_lattice_move(&lattice, 0.0, lift);
    assert_ok(dem_lattice_launch(&lattice, speed));
    support_open(&run, &lattice, &rough, 1, &options);
    const double omega = dem_model_omega_max(run.model);
    assert_close(ask_options(run.simulation).window, 0.1 / omega, 1e-15 / omega);
    support_close(&run);
    if (kappa >= 0.0) options.window = kappa / omega;
    support_open(&run, &lattice, &rough, 1, &options);
    assert_ok(dem_simulation_observe(run.simulation, &observer));
    a.start = ask_energy(run.simulation).ledger;
    a.mass = dem_model_mass(run.model);
    (void)support_at(&run, 6e-3);
    const double scale = 0.5 * a.mass * 26.0, rise = ask_body(run.simulation, 0).velocity[1];
    *counts = ask_counts(run.simulation);
    print_message("# eta %g, friction %g, kappa %g: rise %.5f m/s, %lld stops, %lld impacts, %lld early, deepest %.1e "
                  "spacings, drift %.1e, momentum %.1e, least taken %.1e\n",
                  eta, friction, kappa, rise, (long long)counts->events, (long long)counts->impacts,
                  (long long)counts->early, a.deepest / 0.01, a.drift / scale, a.balance / (a.mass * 5.0),
                  a.taken / scale);
    assert_true(a.deepest < 1e-5 * 0.01); /* as in test_depth.c: ten penetration tolerances */
    assert_true(a.drift < 1e-3 * scale);  /* half of what is asked for of the decks in 20 ms */
    assert_true(a.balance < 1e-6 * a.mass * 5.0);
    assert_true(a.taken >= -1e-15 * scale); /* rounding: no impact gives energy */
    support_close(&run);
    return rise;
}

/* Of the rebound: 1e-3 where impacts take energy; with eta = 1 the motion is chaotic and only its mean counts, to which
 * halving the spacing makes a difference of several percent. */
TEST(a_block_keeps_its_ledger_closed_and_its_depth_with_any_window)
{
    static const double etas[3] = {0.0, 0.5, 1.0}, kappas[4] = {0.01, -1.0, 0.3, 1.0}, share[3] = {1e-3, 1e-3, 0.03};
    for (int e = 0; e < 6; e++) {
        const double eta = etas[e % 3], friction = e < 3 ? 0.0 : 0.3;
        dem_counts single, counts;
        const double rise = drop_block(eta, friction, 0.0, &single);
        assert_int_equal(single.early, 0);
        for (int k = 0; k < 4; k++) {
            const double other = drop_block(eta, friction, kappas[k], &counts);
            assert_true(counts.events <= single.events);
            if (k > 1) continue;
            assert_close(other, rise, share[e % 3] * rise);
            if (k == 1) assert_true(counts.events < single.events);
        }
    }
}
