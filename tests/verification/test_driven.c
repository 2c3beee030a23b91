/* SPDX-License-Identifier: BSD-3-Clause */
/* A node on obstacles that oscillate and turn: closed forms of its way, of the force that holds it, and of the work of
 * the obstacle. Tolerances of 1e-8 and less are those of the integrator at rtol 1e-12 over the time of the run. */
#include <math.h>
#include <stdbool.h>

#include "base/ramp.h"
#include "harness/motion.h"
#include "support.h"

static const double g = 9.81, mass = 2.0;

static void open_node(support_run *run, const double x[2], const double v[2], const dem_obstacle *obstacle,
                      double gravity)
{
    dem_options options = support_options();
    options.gravity[1] = -gravity;
    options.spacing = options.v_scale = 1.0;
    options.max_step = 0.01;
    options.rtol = 1e-12;
    options.penetration_tolerance = 1e-13;
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_lattice(1, x, &mass, 0, NULL, 0.0, 0.0, NULL);
    support_start(&lattice, NULL, v);
    support_open(run, &lattice, obstacle, 1, &options);
}

/* Forces are those of the last accepted step: its time, and the contact's force there. */
typedef struct pressing {
    double t, force[2], normal[2][2];
} pressing;

static dem_status note_step(void *context, const dem_simulation *simulation)
{
    pressing *p = context;
    motion s;
    motion_see(simulation, &s);
    p->t = s.t;
    for (dem_index c = 0; c < s.n_contacts && c < 2; c++) {
        p->force[c] = s.contacts[c].force;
        for (int d = 0; d < 2; d++) p->normal[c][d] = s.contacts[c].normal[d];
    }
    return DEM_OK;
}

/* A node, open_node(), whose contact forces are noted at every step. */
static void open_watched(support_run *run, pressing *p, const double x[2], const double v[2],
                         const dem_obstacle *obstacle, double gravity)
{
    const dem_observer observer = {.struct_size = sizeof observer, .step = note_step, .context = p};
    *p = (pressing){.t = 0.0};
    open_node(run, x, v, obstacle, gravity);
    assert_ok(dem_simulation_observe(run->simulation, &observer));
}

static double kinetic_of(const double v[2])
{
    return 0.5 * mass * (v[0] * v[0] + v[1] * v[1]);
}

/* Energy gained is work done: the ledger closes, and with eta = 0 nothing is lost but at impacts. */
static void check_work(const motion *s, double gained, double tolerance)
{
    assert_close(s->energy.obstacle - s->energy.impact - s->energy.friction, gained, tolerance);
}

/* ---- turning ---- */

/* The groove opens towards the pivot, which presses the node into its corner with m Omega^2 r. */
TEST(a_node_in_the_corner_of_a_turning_obstacle_goes_round_with_it)
{
    const double spin = 2.0, r = 1.5, t = 7.0, x[2] = {r, 0.0}, v[2] = {0.0, spin * r};
    const double groove[6] = {r - 0.5, -0.5, r, 0.0, r - 0.5, 0.5};
    const dem_obstacle obstacle = SIZED(dem_obstacle, .n_points = 3, .points = groove, .spin = spin);
    CLEANUP(support_close) support_run run;
    pressing last;
    open_watched(&run, &last, x, v, &obstacle, 0.0);
    const motion s = support_at(&run, t);
    assert_int_equal(s.n_contacts, 2);
    assert_close(s.x[0], r * cos(spin * t), 1e-8);
    assert_close(s.x[1], r * sin(spin * t), 1e-8);
    assert_close(s.v[0], -spin * r * sin(spin * t), 1e-8);
    for (int d = 0; d < 2; d++) {
        const double pull = last.force[0] * last.normal[0][d] + last.force[1] * last.normal[1][d],
                     inward = d == 0 ? -cos(spin * last.t) : -sin(spin * last.t);
        assert_close(pull, mass * spin * spin * r * inward, 1e-8);
    }
    check_work(&s, 0.0, 1e-8);
}

/* A plate through the pivot starts to turn by a ramp, and lifts a node that sticks to it: across the plate it takes
 * m (g cos q + q'' r), and the work is what the node gains. */
TEST(friction_takes_a_node_along_when_a_plate_starts_to_turn)
{
    static const double plate[4] = {-9.0, 0.0, 9.0, 0.0};
    const double spin = 1.1, r = 1.5, ramp = 1.5, x[2] = {r, 0.0}, v[2] = {0.0, 0.0};
    const dem_obstacle obstacle =
        SIZED(dem_obstacle, .n_points = 2, .points = plate, .friction = 9.0, .spin = spin, .ramp = ramp);
    CLEANUP(support_close) support_run run;
    pressing last;
    open_watched(&run, &last, x, v, &obstacle, g);
    for (int k = 1; k <= 8; k++) {
        const double t = 0.25 * k, angle = spin * ramp_area(ramp, t), rate = spin * ramp_value(ramp, t);
        const motion s = support_at(&run, t);
        assert_int_equal(s.n_contacts, 1);
        assert_int_equal(s.contacts[0].state, DEM_CONTACT_STICK);
        assert_close(s.x[0], r * cos(angle), 1e-8);
        assert_close(s.x[1], r * sin(angle), 1e-8);
        assert_close(last.force[0],
                     mass * (g * cos(spin * ramp_area(ramp, last.t)) + spin * ramp_slope(ramp, last.t) * r), 1e-8);
        check_work(&s, 0.5 * mass * rate * rate * r * r + mass * g * r * sin(angle), 1e-8);
    }
}

/* A bead pushed by a line that turns: r'' = Omega^2 r, N = 2 m Omega r', and the work is the energy gained. Without an
 * outward speed nothing presses at first; the contact closes when the bead has fallen back by the tolerance. Errors
 * grow as the way does, by 26; found are 1e-11 m, 1e-11 m/s, 5e-11 N and 7e-10 J. */
TEST(a_bead_on_a_turning_line_goes_out_as_cosh)
{
    static const double paddle[4] = {0.0, 0.0, 90.0, 0.0}, outward[2] = {0.0, 0.7};
    const double spin = 1.3, r0 = 0.8, t = 2.5, c = cosh(spin * t), h = sinh(spin * t);
    for (int k = 0; k < 2; k++) {
        const double x[2] = {r0, 0.0}, v[2] = {outward[k], spin * r0};
        const double r = r0 * c + outward[k] / spin * h, rate = spin * r0 * h + outward[k] * c;
        const dem_obstacle obstacle = SIZED(dem_obstacle, .n_points = 2, .points = paddle, .spin = spin);
        CLEANUP(support_close) support_run run;
        pressing last;
        open_watched(&run, &last, x, v, &obstacle, 0.0);
        const motion s = support_at(&run, t);
        assert_int_equal(s.n_contacts, 1);
        assert_close(s.x[0], r * cos(spin * t), 1e-8);
        assert_close(s.x[1], r * sin(spin * t), 1e-8);
        assert_close(s.v[0], rate * cos(spin * t) - spin * r * sin(spin * t), 1e-8);
        assert_close(s.v[1], rate * sin(spin * t) + spin * r * cos(spin * t), 1e-8);
        const double rate_then = spin * r0 * sinh(spin * last.t) + outward[k] * cosh(spin * last.t);
        assert_close(last.force[0], 2.0 * mass * spin * rate_then, 1e-8);
        check_work(&s, 0.5 * mass * (rate * rate + spin * spin * r * r) - kinetic_of(v), 1e-8); /* of 359 and 1005 J */
    }
}

/* Thrown by a turning line, at any eta: the impact reverses the velocity relative to the line's point. */
TEST(a_turning_line_hits_with_the_velocity_of_its_point)
{
    static const double paddle[4] = {0.0, 0.0, 9.0, 0.0}, v[2] = {0.0, 0.0}, eta[3] = {0.0, 0.5, 1.0};
    const double spin = 1.3, r = 2.0, angle = 0.4, x[2] = {r * cos(angle), r * sin(angle)};
    for (int k = 0; k < 3; k++) {
        const dem_obstacle obstacle =
            SIZED(dem_obstacle, .n_points = 2, .points = paddle, .spin = spin, .restitution = eta[k]);
        CLEANUP(support_close) support_run run;
        open_node(&run, x, v, &obstacle, 0.0);
        (void)support_at(&run, 0.4 / spin + 1e-6);
        const double speed = (1.0 + eta[k]) * spin * r;
        assert_int_equal(run.n_impacts, 1);
        assert_close(run.impacts[0].t, angle / spin, 1e-12);
        assert_close(run.impacts[0].after[0], -speed * sin(angle), 1e-11);
        assert_close(run.impacts[0].after[1], speed * cos(angle), 1e-11);
        assert_close(run.impacts[0].energy, 0.5 * mass * (1.0 - eta[k] * eta[k]) * spin * spin * r * r, 1e-11);
        assert_close(ask_energy(run.simulation).obstacle, mass * (1.0 + eta[k]) * spin * spin * r * r, 1e-11);
    }
}

/* ---- oscillating ---- */

static dem_obstacle make_table(const double line[4], double amplitude, double frequency, double phase, double eta)
{
    return (dem_obstacle){.struct_size = sizeof(dem_obstacle),
                          .n_points = 2,
                          .points = line,
                          .restitution = eta,
                          .amplitude = {0.0, amplitude},
                          .frequency = frequency,
                          .phase = phase};
}

static const double level[4] = {-9.0, 0.0, 9.0, 0.0};

/* It rests while A omega^2 < g, with N = m (g + y''). */
TEST(a_table_that_oscillates_gently_carries_a_node)
{
    const double amplitude = 0.2, omega = 2.0 * M_PI, t = 3.3, x[2] = {0.0, 0.0}, v[2] = {0.0, amplitude * omega};
    const dem_obstacle table = make_table(level, amplitude, 1.0, 0.0, 0.0);
    CLEANUP(support_close) support_run run;
    pressing last;
    open_watched(&run, &last, x, v, &table, g);
    for (int k = 1; k <= 10; k++) {
        const double phase = omega * t * k / 10.0;
        const motion s = support_at(&run, t * k / 10.0);
        assert_int_equal(s.n_contacts, 1);
        assert_close(s.x[1], amplitude * sin(phase), 1e-9);
        assert_close(s.v[1], amplitude * omega * cos(phase), 1e-9);
        assert_close(last.force[0], mass * (g - amplitude * omega * omega * sin(omega * last.t)), 1e-8);
        check_work(&s, kinetic_of(s.v) + mass * g * s.x[1] - kinetic_of(v), 1e-8);
    }
}

/* It is thrown off where the table's acceleration passes -g on the way up. */
TEST(a_table_that_oscillates_fast_throws_a_node_where_its_acceleration_passes_g)
{
    const double amplitude = 0.6, omega = 2.0 * M_PI, x[2] = {0.0, 0.0}, v[2] = {0.0, amplitude * omega};
    const dem_obstacle table = make_table(level, amplitude, 1.0, 0.0, 0.0);
    const double phase = asin(g / (amplitude * omega * omega)), start = phase / omega,
                 speed = amplitude * omega * cos(phase);
    CLEANUP(support_close) support_run run;
    open_node(&run, x, v, &table, g);
    motion s = support_at(&run, start - 1e-4);
    assert_int_equal(s.n_contacts, 1);
    s = support_at(&run, start + 0.1);
    assert_int_equal(s.n_contacts, 0);
    assert_close(s.x[1], amplitude * sin(phase) + 0.1 * speed - 0.5 * g * 0.01, 1e-10);
    assert_close(s.v[1], speed - 0.1 * g, 1e-10);
}

/* ---- a node that bounces on the table ---- */

/* The exact map of a node that bounces with eta on a table at A sin(omega t), omega = 2 pi: the next impact after one
 * at t with the velocity v, found by steps and then Newton's method. */
typedef struct bounce {
    double t, v; /* v: m/s, after the impact */
} bounce;

static bounce next_bounce(bounce at, double amplitude, double eta)
{
    const double omega = 2.0 * M_PI, y = amplitude * sin(omega * at.t);
    double flight = 1e-3;
    for (; y + flight * (at.v - 0.5 * g * flight) > amplitude * sin(omega * (at.t + flight)); flight += 1e-3) {
    }
    for (int k = 0; k < 20; k++) {
        const double t = at.t + flight, height = y + flight * (at.v - 0.5 * g * flight) - amplitude * sin(omega * t),
                     rate = at.v - g * flight - amplitude * omega * cos(omega * t);
        flight -= height / rate;
    }
    const double t = at.t + flight, wall = amplitude * omega * cos(omega * t);
    return (bounce){t, wall - eta * (at.v - g * flight - wall)};
}

/* Impacts of the node in units of the period, as phases in [0, 1). */
static double phase_of(const dem_event *impact)
{
    return impact->t - floor(impact->t);
}

/* Lets the node fall from the top of its orbit, half a period before an impact, a little off. Every impact follows from
 * the one before by the exact map. Impacts then get the time at which the table's phase is 0. */
static void bounce_on_table(support_run *run, double acceleration, double t_end)
{
    const double eta = 0.5, omega = 2.0 * M_PI, amplitude = acceleration * g / (omega * omega);
    const double phase = acos(M_PI * (1.0 - eta) / ((1.0 + eta) * acceleration));
    const double x[2] = {0.0, amplitude * sin(phase) + g / 8.0 + 1e-3}, v[2] = {0.0, 0.0};
    const dem_obstacle table = make_table(level, amplitude, 1.0, phase * 180.0 / M_PI - 180.0, eta);
    const double shift = table.phase / 360.0;
    open_node(run, x, v, &table, g);
    (void)support_at(run, t_end);
    for (dem_index k = 0; k + 1 < run->n_impacts; k++) {
        const bounce now = {run->impacts[k].t + shift, run->impacts[k].after[1]};
        const bounce next = next_bounce(now, amplitude, eta);
        assert_close(run->impacts[k + 1].t + shift, next.t, 1e-9);
        assert_close(run->impacts[k + 1].after[1], next.v, 1e-8);
    }
    for (dem_index k = 0; k < run->n_impacts; k++) run->impacts[k].t += shift;
}

/* eta = 1/2: an orbit of one impact a period is stable for 1.04720 < Gamma < 1.52680; the slower eigenvalue of the map
 * is 0.883 at 1.50, so that 120 impacts come to 3e-7 of the first deviation. */
TEST(a_node_on_an_oscillating_table_finds_its_orbit)
{
    static const double acceleration[2] = {1.06, 1.50};
    for (int k = 0; k < 2; k++) {
        CLEANUP(support_close) support_run run;
        bounce_on_table(&run, acceleration[k], 160.0);
        assert_true(run.n_impacts > 140);
        const double phase = acos(M_PI / (3.0 * acceleration[k])) / (2.0 * M_PI);
        for (dem_index q = run.n_impacts - 10; q < run.n_impacts; q++) {
            assert_close(phase_of(&run.impacts[q]), phase, 1e-6 / (2.0 * M_PI));
            assert_close(run.impacts[q].t - run.impacts[q - 1].t, 1.0, 1e-6);
        }
    }
}

/* Above the limit the period doubles. */
TEST(beyond_the_limit_two_impacts_make_a_period)
{
    CLEANUP(support_close) support_run run;
    bounce_on_table(&run, 1.56, 200.0);
    const dem_index n = run.n_impacts;
    assert_true(n > 180);
    for (dem_index q = n - 10; q < n; q++) {
        assert_close(run.impacts[q].t - run.impacts[q - 2].t, 2.0, 1e-6);
        assert_true(fabs(phase_of(&run.impacts[q]) - phase_of(&run.impacts[q - 1])) > 1e-2);
    }
}
