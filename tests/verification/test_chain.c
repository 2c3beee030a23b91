/* SPDX-License-Identifier: BSD-3-Clause */
/* A chain of N equal springs with half end masses against a rigid wall, its first mass plastic (row g). While the
 * first mass is held the others are a chain clamped at one end, in its normal modes:
 *
 *   u_i(t) = sum over j = 1 .. N of A_j sin(phi_j i) sin(omega_j t),  phi_j = (2j - 1) pi/(2N),
 *   omega_j = 2 sqrt(k/m) sin(phi_j/2),  A_j omega_j = -v cot(phi_j/2)/N,
 *
 * since sum of w_i sin^2(phi_j i) = N/2 and sum of w_i sin(phi_j i) = cot(phi_j/2)/2 with w_N = 1/2, else 1. The
 * contact ends where the first spring begins to pull, u_1 = 0; the impulse of the wall till then gives the rebound. */
#include <stdbool.h>

#include "ask.h"
#include "support.h"

enum { most_masses = 161 };

static const double speed = 1.0, length = 1.0, penetration_tolerance = 1e-13,
                    stiffness = 1e4; /* v, L, and E_ij, N: all waves run at c = 100 m/s */

/* What the wall takes from the impact of N springs; time in units of 2 L/c, speed in units of v. */
typedef struct answer {
    double contact, rebound;
} answer;

static double node_mass(int n, int i)
{
    const double c = 100.0, spacing = length / n, m = stiffness * spacing / (c * c); /* c = d0 sqrt(k/m), k = E_ij/d0 */
    return i == 0 || i == n ? 0.5 * m : m;
}

/* Of the modes: displacement and velocity of mass i at tau = t sqrt(k/m), in units of v sqrt(m/k) and of v. */
static double displacement(int n, int i, double tau, double *velocity)
{
    double u = 0.0;
    *velocity = 0.0;
    for (int j = 1; j <= n; j++) {
        const double phi = (2.0 * j - 1.0) * M_PI / (2.0 * n), omega = 2.0 * sin(0.5 * phi);
        const double a = -sin(phi * i) / (tan(0.5 * phi) * n);
        u += a / omega * sin(omega * tau);
        *velocity += a * cos(omega * tau);
    }
    return u;
}

/* The wall is held down till the front is back; a bracket about tau = 2N then holds the root. */
static answer closed_form(int n)
{
    double low = 1.8 * n, high = 2.2 * n, unused, momentum = 0.0, total = 0.0;
    assert_true(displacement(n, 1, low, &unused) < 0.0 && displacement(n, 1, high, &unused) > 0.0);
    for (int k = 0; k < 60; k++) {
        const double middle = 0.5 * (low + high);
        *(displacement(n, 1, middle, &unused) < 0.0 ? &low : &high) = middle;
    }
    for (int i = 0; i <= n; i++) {
        double v = 0.0;
        if (i > 0) (void)displacement(n, i, low, &v);
        momentum += node_mass(n, i) * v;
        total += node_mass(n, i);
    }
    return (answer){low / (2.0 * n), momentum / total};
}

typedef struct impact {
    support_run run;
    double start, release;
    double later; /* N s, impulses of all impacts but the first */
    int n_starts, n_releases;
} impact;

static dem_status note(void *context, const dem_simulation *simulation, const dem_event *event)
{
    impact *s = context;
    (void)simulation;
    if (event->kind == DEM_EVENT_IMPACT && s->n_starts++ == 0)
        s->start = event->t;
    else if (event->kind == DEM_EVENT_IMPACT)
        s->later += hypot(event->impulse[0], event->impulse[1]);
    if (event->kind == DEM_EVENT_RELEASE && s->n_releases++ == 0) s->release = event->t;
    return DEM_OK;
}

/* The chain stands on (0, y) or lies along x, first node towards the wall. */
static void open_chain(impact *s, int n, double height, bool lying)
{
    double x[2 * most_masses] = {0.0}, v[2 * most_masses] = {0.0}, m[most_masses];
    dem_index ends[2 * most_masses];
    static const double ground[4] = {-1.0, 0.0, 1.0, 0.0}, wall[4] = {0.0, 1.0, 0.0, -1.0};
    const dem_obstacle obstacle = {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = lying ? wall : ground};
    const int along = lying ? 0 : 1;
    dem_options options = support_options();
    for (int i = 0; i <= n; i++) {
        x[2 * i + along] = height + length * i / n;
        v[2 * i + along] = -speed;
        m[i] = node_mass(n, i);
        ends[2 * i] = i;
        ends[2 * i + 1] = i + 1;
    }
    options.gravity[1] = 0.0;
    options.rtol = 1e-11;
    options.penetration_tolerance = penetration_tolerance; /* late by 1e-13 s */
    *s = (impact){0};
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_lattice(n + 1, x, m, n, ends, length / n, stiffness, NULL);
    for (int i = 1; i <= n; i++) lattice.flags[i] = 0;
    support_start(&lattice, NULL, v);
    support_open(&s->run, &lattice, &obstacle, 1, &options);
    assert_ok(dem_simulation_observe(
        s->run.simulation, &(dem_observer){.struct_size = sizeof(dem_observer), .event = note, .context = s}));
}

static double total(dem_energy e)
{
    return e.kinetic + e.elastic;
}

/* At the impact the first spring does not press yet. If the first mass does not stay at once the spring presses it
 * through the penetration tolerance d: from its acceleration omega^2 v t in t = (6 d/(omega^2 v))^(1/3), at the speed
 * 3 d/t. */
static double second_blow(int n)
{
    const double omega = 100.0 * n / length;
    return 3.0 * penetration_tolerance / cbrt(6.0 * penetration_tolerance / (2.0 * omega * omega * speed));
}

/* Contact and rebound as measured. Tolerances of the run: rtol 1e-11 of a spacing, by the speed, over up to a thousand
 * steps in one direction, is 1e-8 of N spacings at the most. */
static answer measure(int n, double height, bool lying)
{
    const double transit = 2.0 * length / 100.0;
    static impact s;
    open_chain(&s, n, height, lying);
    const double initial = total(ask_energy(s.run.simulation));
    (void)support_at(&s.run, height / speed + 2.0 * transit); /* as long again for a second blow */
    assert_close(s.later, 0.0, 1.01 * node_mass(n, 0) * second_blow(n));
    assert_int_equal(s.n_releases, 1);
    assert_close(s.start, height / speed, 1e-12);
    const dem_energy energy = ask_energy(s.run.simulation);
    const dem_body_motion body = ask_body(s.run.simulation, 0);
    const dem_obstacle_load load = ask_obstacle(s.run.simulation, 0);
    assert_close(total(energy) / initial, 1.0 - 0.5 / n, 1e-8);
    assert_close(energy.impact / initial, 0.5 / n, 1e-8);
    assert_close(energy.ledger / initial, 1.0, 1e-8);
    const int along = lying ? 0 : 1;
    assert_close(load.impulse[along], body.mass * (body.velocity[along] + speed), 1e-8 * body.mass * speed);
    assert_close(body.velocity[1 - along], 0.0, 1e-12);
    assert_close(load.impulse[1 - along], 0.0, 1e-12 * body.mass);
    const answer out = {(s.release - s.start) / transit, body.velocity[along] / speed};
    support_close(&s.run);
    return out;
}

typedef struct row {
    int n;
    answer table; /* six digits, of the first two contact times five */
} row;

static const row rows[7] = {{10, {1.02461, 0.928146}},  {20, {1.01615, 0.957383}},   {40, {1.010509, 0.97417}},
                            {80, {1.006736, 0.984139}}, {160, {1.004294, 0.990173}}, {320, {1.002724, 0.993875}},
                            {640, {1.001724, 0.996168}}};

TEST(the_contact_and_rebound_of_a_chain_are_those_of_its_modes_and_of_the_table)
{
    for (int k = 0; k < 7; k++) {
        const answer exact = closed_form(rows[k].n);
        assert_close(exact.contact, rows[k].table.contact, k < 2 ? 5e-6 : 1e-6);
        assert_close(exact.rebound, rows[k].table.rebound, 1e-6);
        if (rows[k].n >= most_masses) continue;
        const answer run = measure(rows[k].n, 0.0, false);
        assert_close(run.contact, exact.contact, 1e-8);
        assert_close(run.rebound, exact.rebound, 1e-8);
    }
}

TEST(a_chain_that_flies_to_a_wall_does_as_one_that_starts_there)
{
    const answer exact = closed_form(20);
    for (int lying = 0; lying < 2; lying++) {
        const answer run = measure(20, 0.0123, lying == 1);
        assert_close(run.contact, exact.contact, 1e-8);
        assert_close(run.rebound, exact.rebound, 1e-8);
    }
}

/* Least squares of ln(excess) on ln N, over sizes that are near the limit of -2/3: from N = 10 on it is -0.63. */
TEST(the_excess_of_the_contact_time_falls_with_the_power_two_thirds_of_the_springs)
{
    double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
    for (int k = 2; k < 7; k++) {
        const double x = log(rows[k].n);
        const double y = log(closed_form(rows[k].n).contact - 1.0); /* of the runs to 1e-8 */
        sx += x;
        sy += y;
        sxx += x * x;
        sxy += x * y;
    }
    assert_close((5.0 * sxy - sx * sy) / (5.0 * sxx - sx * sx), -0.66, 0.03);
}
