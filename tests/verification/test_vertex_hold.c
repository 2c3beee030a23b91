/* SPDX-License-Identifier: BSD-3-Clause */
/* Lasting contacts of obstacle vertices with edges of bodies: a triangle that turns on a fixed point against the
 * constrained equations of the same masses and springs, integrated by GSL; blocks at rest on two apexes, sliding over
 * them, and falling off one. */
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>

#include "harness/motion.h"
#include "support.h"

/* ---- a triangle on a fixed point ---- */

enum { A, B, C };

/* Three masses, three springs, the edge AB on a point at the origin. Without stick the force on the edge is N (n - mu
 * sign t), along n if mu is 0; with it the place on the edge stays. */
typedef struct triangle {
    double mass[3], rest[3], stiffness[3]; /* springs AB, BC, CA */
    double g[2], mu;
    int slide; /* of sliding: of the body along the edge from A to B; 0: sticks */
    double s;  /* where it sticks */
} triangle;

static void spring_forces(const triangle *q, const double *x, double *f)
{
    for (int i = 0; i < 3; i++)
        for (int d = 0; d < 2; d++) f[2 * i + d] = q->mass[i] * q->g[d];
    for (int k = 0; k < 3; k++) {
        const int i = k, j = (k + 1) % 3;
        const double w[2] = {x[2 * j] - x[2 * i], x[2 * j + 1] - x[2 * i + 1]}, length = hypot(w[0], w[1]);
        const double pull = q->stiffness[k] * (length - q->rest[k]) / q->rest[k] / length;
        for (int d = 0; d < 2; d++) {
            f[2 * i + d] += pull * w[d];
            f[2 * j + d] -= pull * w[d];
        }
    }
}

/* Sliding: the area G = (b - a) x (0 - a) stays 0. With its gradients, grad G.x'' + 2 (b' - a') x (-a') = 0 is linear
 * in the force along n. */
static double normal_force(const triangle *q, const double *x, const double *v, const double *f, double push[4])
{
    const double w[2] = {x[2] - x[0], x[3] - x[1]}, length = hypot(w[0], w[1]);
    const double t[2] = {w[0] / length, w[1] / length}, s = -(x[0] * t[0] + x[1] * t[1]) / length;
    const double share[2] = {1.0 - s, s};
    const double gradient[4] = {x[1] + w[1], -x[0] - w[0], -x[1], x[0]};
    double by_push = 0.0, free = -2.0 * ((v[2] - v[0]) * v[1] - (v[3] - v[1]) * v[0]);
    for (int i = 0; i < 2; i++) {
        push[2 * i] = share[i] * (-t[1] - q->mu * q->slide * t[0]);
        push[2 * i + 1] = share[i] * (t[0] - q->mu * q->slide * t[1]);
        for (int d = 0; d < 2; d++) {
            by_push += gradient[2 * i + d] * push[2 * i + d] / q->mass[i];
            free += gradient[2 * i + d] * f[2 * i + d] / q->mass[i];
        }
    }
    return -free / by_push;
}

/* Sticking: the point at share s of AB stays. Components of the force that does it, along n and t. */
static void sticking_force(const triangle *q, const double *x, const double *f, double r[2])
{
    const double share[2] = {1.0 - q->s, q->s}, w[2] = {x[2] - x[0], x[3] - x[1]}, length = hypot(w[0], w[1]);
    const double mobility = share[0] * share[0] / q->mass[A] + share[1] * share[1] / q->mass[B];
    double force[2];
    for (int d = 0; d < 2; d++)
        force[d] = -(share[0] * f[d] / q->mass[A] + share[1] * f[2 + d] / q->mass[B]) / mobility;
    r[0] = (-w[1] * force[0] + w[0] * force[1]) / length;
    r[1] = (w[0] * force[0] + w[1] * force[1]) / length;
}

static int constrained(double time, const double *y, double *out, void *context)
{
    const triangle *q = context;
    double f[6], push[4];
    (void)time;
    spring_forces(q, y, f);
    if (q->slide != 0) {
        const double n = normal_force(q, y, y + 6, f, push);
        for (int k = 0; k < 4; k++) f[k] += n * push[k];
    } else {
        const double w[2] = {y[2] - y[0], y[3] - y[1]}, length = hypot(w[0], w[1]), share[2] = {1.0 - q->s, q->s};
        double r[2];
        sticking_force(q, y, f, r);
        for (int k = 0; k < 4; k++)
            f[k] += share[k / 2] * (k % 2 == 0 ? r[1] * w[0] - r[0] * w[1] : r[1] * w[1] + r[0] * w[0]) / length;
    }
    for (int k = 0; k < 6; k++) {
        out[k] = y[6 + k];
        out[6 + k] = f[k] / q->mass[k / 2];
    }
    return GSL_SUCCESS;
}

static void integrate(triangle *q, double *y, double from, double to)
{
    gsl_odeiv2_system system = {constrained, NULL, 12, q};
    gsl_odeiv2_driver *driver = gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_rk8pd, 1e-4, 1e-14, 1e-13);
    assert_non_null(driver);
    assert_int_equal(gsl_odeiv2_driver_apply(driver, &from, to, y), GSL_SUCCESS);
    gsl_odeiv2_driver_free(driver);
}

/* Velocity of the point of AB that is at the origin, along AB, and its share. */
static double slip_speed(const double *y, double *s)
{
    const double w[2] = {y[2] - y[0], y[3] - y[1]}, square = w[0] * w[0] + w[1] * w[1];
    *s = -(y[0] * w[0] + y[1] * w[1]) / square;
    return ((1.0 - *s) * (y[6] * w[0] + y[7] * w[1]) + *s * (y[8] * w[0] + y[9] * w[1])) / sqrt(square);
}

/* > 0 as long as the contact slides its way, or friction holds. */
static double margin(const triangle *q, const double *y, double *tangential)
{
    double f[6], r[2], s;
    if (q->slide != 0) return q->slide * slip_speed(y, &s);
    spring_forces(q, y, f);
    sticking_force(q, y, f, r);
    *tangential = r[1];
    return q->mu * r[0] - fabs(r[1]);
}

/* From sliding to sticking, or to sliding the other way; from sticking to sliding against what held. */
static void change(triangle *q, const double *y)
{
    double tangential = 0.0;
    const bool slid = q->slide != 0;
    q->slide = 0;
    if (slid) (void)slip_speed(y, &q->s);
    if (margin(q, y, &tangential) > 0.0 && slid) return;
    q->slide = tangential > 0.0 ? -1 : 1;
}

/* As integrate(), with the changes between sliding and sticking bisected to 1e-13 s; returns how many. */
static int integrate_changes(triangle *q, double *y, double from, double to)
{
    double start[12], tangential;
    int n = 0;
    for (const double dt = 5e-4; from < to - 1e-15;) {
        double lo = 0.0, hi = fmin(dt, to - from);
        memcpy(start, y, sizeof start);
        integrate(q, y, 0.0, hi);
        if (margin(q, y, &tangential) > 0.0) {
            from += hi;
            continue;
        }
        while (hi - lo > 1e-13) {
            const double middle = 0.5 * (lo + hi);
            memcpy(y, start, sizeof start);
            integrate(q, y, 0.0, middle);
            *(margin(q, y, &tangential) > 0.0 ? &lo : &hi) = middle;
        }
        from += hi;
        change(q, y);
        n++;
    }
    return n;
}

/* A triangle of sides 1 with AB on the origin at share s, turned by `angle`; it moves so that the point of AB there
 * goes along the edge at `slide` m/s while it turns at `spin` rad/s. */
static void place_triangle(double s, double angle, double slide, double spin, double *y)
{
    const double c = cos(angle), e = sin(angle), h = sqrt(0.75);
    const double local[6] = {-s, 0.0, 1.0 - s, 0.0, 0.5 - s, h};
    for (int i = 0; i < 3; i++) {
        y[2 * i] = c * local[2 * i] - e * local[2 * i + 1];
        y[2 * i + 1] = e * local[2 * i] + c * local[2 * i + 1];
        y[6 + 2 * i] = slide * c - spin * y[2 * i + 1];
        y[6 + 2 * i + 1] = slide * e + spin * y[2 * i];
    }
}

static const double tip[6] = {-2.0, -8.0, 0.0, 0.0, 2.0, -8.0};

static void open_triangle(support_run *run, const triangle *q, const double *y, double rtol)
{
    const dem_index ends[6] = {A, B, B, C, C, A}, corners[3] = {A, B, C};
    const dem_obstacle obstacle = SIZED(dem_obstacle, .n_points = 3, .points = tip, .restitution = 0.0,
                                        .friction = q->mu, .friction_law = DEM_FRICTION_COULOMB);
    dem_options options = support_options();
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_lattice(3, y, q->mass, 3, ends, 1.0, 1.0, NULL);
    memcpy(lattice.rest_length, q->rest, sizeof q->rest);
    memcpy(lattice.stiffness, q->stiffness, sizeof q->stiffness);
    lattice.n_triangles = 1;
    lattice.triangles = malloc(sizeof corners);
    assert_non_null(lattice.triangles);
    memcpy(lattice.triangles, corners, sizeof corners);
    support_start(&lattice, NULL, y + 6);
    options.gravity[0] = q->g[0];
    options.gravity[1] = q->g[1];
    options.spacing = options.v_scale = 1.0;
    options.rtol = rtol;
    options.penetration_tolerance = 1e-12;
    support_open(run, &lattice, &obstacle, 1, &options);
}

/* Worst of the ledger at accepted steps. */
typedef struct ledger {
    double start, worst;
} ledger;

static dem_status weigh(void *context, const dem_simulation *simulation)
{
    ledger *l = context;
    l->worst = fmax(l->worst, fabs(ask_energy(simulation).ledger - l->start));
    return DEM_OK;
}

static void observe_ledger(const support_run *run, ledger *l)
{
    const dem_observer observer = {.struct_size = sizeof(dem_observer), .step = weigh, .context = l};
    *l = (ledger){ask_energy(run->simulation).ledger, 0.0};
    assert_ok(dem_simulation_observe(run->simulation, &observer));
}

/* Simulation and reference at one time. Friction is mu N to rounding. */
static void compare(const triangle *q, const double *y, const motion *state, double tolerance)
{
    double f[6], push[4];
    assert_int_equal(state->n_contacts, 1);
    assert_int_equal(state->contacts[0].n_nodes, 2);
    assert_int_equal(state->contacts[0].state, q->slide == 0 ? DEM_CONTACT_STICK : DEM_CONTACT_SLIP);
    for (int i = 0; i < 6; i++) assert_close(state->x[i], y[i], tolerance);
    if (q->slide == 0) return;
    spring_forces(q, y, f);
    assert_true(normal_force(q, y, y + 6, f, push) > 0.0); /* the reference cannot lift off */
    assert_close(state->contacts[0].friction[0], -q->mu * q->slide * state->contacts[0].force,
                 1e-14 * state->contacts[0].force);
}

/* Follows triangle and reference to t_end; returns how often the reference changed between sliding and sticking.
 * Positions are asked to 1e-8 m of 1 m: at rtol 1e-11 the integrator leaves some 1e-11 m, and of the ledger of 10 J
 * some 1e-10 J. */
static int follow(triangle *q, double *y, double t_end)
{
    enum { looks = 40 };
    CLEANUP(support_close) support_run run;
    ledger kept;
    double worst = 0.0;
    int changes = 0;
    open_triangle(&run, q, y, 1e-11);
    observe_ledger(&run, &kept);
    for (int k = 1; k <= looks; k++) {
        changes += integrate_changes(q, y, (k - 1) * t_end / looks, k * t_end / looks);
        const motion state = support_at(&run, k * t_end / looks);
        compare(q, y, &state, 1e-8);
        for (int i = 0; i < 6; i++) worst = fmax(worst, fabs(state.x[i] - y[i]));
    }
    const dem_counts counts = ask_counts(run.simulation);
    print_message("# sign %d, mu %g: off by %.1e m, ledger by %.1e J, %lld steps, %lld events, %lld slips, %lld "
                  "sticks, %d changes\n",
                  q->slide, q->mu, worst, kept.worst, (long long)counts.steps, (long long)counts.events,
                  (long long)counts.slips, (long long)counts.sticks, changes);
    assert_true(kept.worst < 1e-8);
    assert_in_range(counts.slips + counts.sticks - changes, 0, 1); /* what starts at rest, to rounding, sticks */
    assert_int_equal(counts.releases + counts.passings, 0);
    for (dem_index k = 0; k < run.n_impacts; k++) /* at the start it may approach by rounding */
        assert_close(hypot(run.impacts[k].impulse[0], run.impacts[k].impulse[1]), 0.0, 1e-14);
    return changes;
}

static triangle make_triangle(double mu, int sign)
{
    return (triangle){.mass = {1.0, 1.5, 0.4},
                      .rest = {1.0, 1.0, 1.0},
                      .stiffness = {2000.0, 1600.0, 2400.0},
                      .g = {0.0, -9.81},
                      .mu = mu,
                      .slide = sign};
}

/* It turns by up to 0.5 rad and slides by 0.2 m: 2 omega v_t is some 4 m/s^2, a part of the reaction that would be
 * missed at once. */
TEST(a_triangle_slides_over_a_point_as_the_constrained_equations_say)
{
    double y[12];
    for (int k = 0; k < 4; k++)
        for (int sign = -1; sign <= 1; sign += 2)
            for (double spin = -2.0; spin < 2.5; spin += 2.0) {
                triangle q = make_triangle(0.2 * k, sign);
                place_triangle(0.5 - 0.1 * sign, 0.1 * sign, -1.5 * sign, spin, y);
                q.slide = -sign;
                assert_int_equal(follow(&q, y, 0.12), 0);
            }
}

/* Friction holds as long as |T| <= mu N, which is asked of the simulation by its state. */
TEST(a_triangle_turns_on_a_point_where_friction_holds_it)
{
    double y[12];
    for (double spin = -1.0; spin < 1.5; spin += 1.0) {
        triangle q = make_triangle(1.5, 0);
        q.s = 0.6;
        place_triangle(q.s, 0.1, 0.0, spin, y);
        assert_int_equal(follow(&q, y, 0.3), 0);
    }
}

/* Slow enough to stop; its own vibration then breaks it loose and stops it again. */
TEST(a_triangle_stops_and_slips_on_a_point_as_the_reference_does)
{
    double y[12];
    int changes = 0;
    for (int k = 0; k < 6; k++) {
        triangle q = make_triangle(0.1 + 0.1 * k, 1);
        place_triangle(0.5, -0.1, 0.3, 0.5, y);
        y[10] += 1.5;
        changes += follow(&q, y, 0.2);
    }
    assert_true(changes > 6);
}
