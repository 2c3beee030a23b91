/* SPDX-License-Identifier: BSD-3-Clause */
/* A chain of 20 springs that bounces to and fro between two rigid walls, eta = 1, for 20 ms: about 100 impacts of its
 * ends, exact dE = 0. Engines that locate contacts, beside an independent program at equal evaluations; and what
 * becomes of the paper's way, which cuts the step to t = d1/(d1 - d2) (7) and takes it again, with Verlet's two-step
 * formula (5), and with one-step methods. The other program's chain is not known in detail. Ours: 21 equal masses 5 mm
 * apart, waves at 97.59 m/s, 5 m/s, at first 5 mm from either wall; the chain is linear, so only the ratio of the last
 * two counts. */
#include <stdbool.h>
#include <string.h>

#include "ask.h"
#include "support.h"

enum { n_masses = 21, most_impacts = 3000 };

static const double spacing = 5e-3, wave_speed = 97.59, force = 1e7 /* N, E_ij */, speed = 5.0, gap = 5e-3,
                    t_end = 20e-3, allowed = 3.0;

static double mass(void)
{
    return force * spacing / (wave_speed * wave_speed); /* c = d0 sqrt(k/m), k = E_ij/d0 */
}

static double omega_max(void)
{
    return 2.0 * wave_speed / spacing;
}

/* ---- with located contacts ---- */

typedef struct line {
    dem_method method;
    double setting;            /* omega h or rtol */
    double evaluations, drift; /* of the other program */
} line;

/* Runge and Kutta's drift at omega h = 0.1 is not compared: 2.2e-6 there, 1.2e-5 here. It is damping of the shortest
 * waves, by (omega h)^6/144 a step, of which the two motions need not have the same. */
static const line lines[] = {
    {DEM_METHOD_VERLET, 1.0, 915, 0.17},          {DEM_METHOD_VERLET, 0.5, 1687, 1.8e-2},
    {DEM_METHOD_VERLET, 0.25, 3254, 3.2e-3},      {DEM_METHOD_VERLET, 0.1, 7932, 3.9e-4},
    {DEM_METHOD_RK4, 1.0, 3684, 8.6e-2},          {DEM_METHOD_RK4, 0.5, 6736, 7.9e-3},
    {DEM_METHOD_RK4, 0.25, 13000, 2.2e-4},        {DEM_METHOD_RK4, 0.1, 31816, 0.0},
    {DEM_METHOD_FEHLBERG45, 1e-3, 4728, 0.14},    {DEM_METHOD_FEHLBERG45, 1e-4, 6162, 1.5e-2},
    {DEM_METHOD_FEHLBERG45, 1e-6, 13074, 2.0e-4}, {DEM_METHOD_FEHLBERG45, 1e-8, 30462, 2.1e-6},
};
enum { n_lines = sizeof lines / sizeof *lines };

/* What the table has at as many evaluations; between two lines of an adaptive method by a power law. */
static double drift_at(const line *l, double evaluations)
{
    if (l->method != DEM_METHOD_FEHLBERG45) return l->drift;
    const line *b = lines + n_lines - 3;
    while (b < lines + n_lines - 1 && b->evaluations < evaluations) b++;
    const line *a = b - 1;
    return a->drift *
           pow(evaluations / a->evaluations, log(b->drift / a->drift) / log(b->evaluations / a->evaluations));
}

static void make_chain(dem_lattice *chain)
{
    double x[2 * n_masses] = {0.0}, m[n_masses], v[2 * n_masses] = {0.0};
    dem_index ends[2 * (n_masses - 1)];
    for (int i = 0; i < n_masses; i++) {
        x[2 * i] = i * spacing;
        m[i] = mass();
        v[2 * i] = speed;
        if (i > 0) ends[2 * i - 2] = i - 1;
        if (i > 0) ends[2 * i - 1] = i;
    }
    *chain = support_lattice(n_masses, x, m, n_masses - 1, ends, spacing, force, NULL);
    support_start(chain, NULL, v);
}

static void open_run(support_run *run, const dem_lattice *chain, const line *l)
{
    const double right = (n_masses - 1) * spacing + gap;
    const double points[2][4] = {{right, -1.0, right, 1.0}, {-gap, 1.0, -gap, -1.0}};
    const dem_obstacle walls[2] = {
        {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = points[0], .restitution = 1.0},
        {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = points[1], .restitution = 1.0}};
    dem_options options = support_options();
    options.gravity[1] = 0.0;
    options.method = l->method;
    options.penetration_tolerance =
        1e-12; /* the work of pressed ends on their way back through it is below what is compared */
    options.window = 0.0;
    options.max_step = 1e-3; /* no cap */
    if (l->method == DEM_METHOD_FEHLBERG45)
        options.rtol = l->setting;
    else
        options.fixed_step = l->setting / omega_max();
    support_open(run, chain, walls, 2, &options);
}

TEST(located_contacts_keep_the_energy_as_known)
{
    CLEANUP(dem_lattice_free) dem_lattice chain = dem_lattice_empty();
    make_chain(&chain);
    for (const line *l = lines; l < lines + n_lines; l++) {
        CLEANUP(support_close) support_run run;
        open_run(&run, &chain, l);
        const double start = ask_energy(run.simulation).motion;
        const double drift = support_at(&run, t_end).energy.motion / start - 1.0;
        const double evaluations = (double)ask_counts(run.simulation).evaluations;
        dem_method_traits method = {.struct_size = sizeof method};
        assert_ok(dem_method_describe(&method, l->method));
        print_message("# %-10s %-6g %6.0f evaluations, %lld impacts: energy %+.2e\n", method.name, l->setting,
                      evaluations, (long long)run.n_impacts, drift);
        if (l->drift > 0.0 && !(fabs(drift) <= allowed * drift_at(l, evaluations)))
            fail_msg("energy %+.2e, %.2e known", drift, drift_at(l, evaluations));
    }
}

/* ---- with steps cut to the contact ---- */

typedef enum way { AS_PRINTED, UNEQUAL_STEPS, VELOCITY_VERLET, RUNGE_KUTTA } way;

typedef struct chain_state {
    double x[n_masses], v[n_masses];
    double before[n_masses], h_before; /* x of the step before, and its length: for the two-step formula */
} chain_state;

static void accelerate(const double *x, double *a)
{
    const double k = force / (spacing * mass());
    memset(a, 0, n_masses * sizeof *a);
    for (int i = 0; i + 1 < n_masses; i++) {
        const double pull = k * (x[i + 1] - x[i] - spacing);
        a[i] += pull;
        a[i + 1] -= pull;
    }
}

static double energy_of(const chain_state *s)
{
    double sum = 0.0;
    for (int i = 0; i < n_masses; i++) sum += 0.5 * mass() * s->v[i] * s->v[i];
    for (int i = 0; i + 1 < n_masses; i++)
        sum += 0.5 * force / spacing * (s->x[i + 1] - s->x[i] - spacing) * (s->x[i + 1] - s->x[i] - spacing);
    return sum;
}

/* (5), or  x_{n+1} = x_n + (x_n - x_{n-1}) h/h' + a_n h (h + h')/2  after a step h'. */
static void step_two(chain_state *s, double h, bool unequal)
{
    const double was = s->h_before, share = unequal ? h / was : 1.0, square = unequal ? 0.5 * h * (h + was) : h * h;
    double a[n_masses];
    if (!(h > 0.0)) return;
    accelerate(s->x, a);
    for (int i = 0; i < n_masses; i++) {
        const double x = s->x[i];
        s->x[i] = x + (x - s->before[i]) * share + a[i] * square;
        s->before[i] = x;
        s->v[i] = (s->x[i] - x) / h;
    }
    s->h_before = h;
}

static void step_velocity_verlet(chain_state *s, double h)
{
    double a[n_masses], b[n_masses];
    accelerate(s->x, a);
    for (int i = 0; i < n_masses; i++) s->x[i] += h * s->v[i] + 0.5 * h * h * a[i];
    accelerate(s->x, b);
    for (int i = 0; i < n_masses; i++) s->v[i] += 0.5 * h * (a[i] + b[i]);
}

static void step_runge_kutta(chain_state *s, double h)
{
    static const double at[4] = {0.0, 0.5, 0.5, 1.0}, weight[4] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
    const chain_state start = *s;
    double dx[n_masses] = {0.0}, dv[n_masses] = {0.0}, x[n_masses];
    for (int k = 0; k < 4; k++) {
        for (int i = 0; i < n_masses; i++) x[i] = start.x[i] + at[k] * h * dx[i];
        for (int i = 0; i < n_masses; i++) dx[i] = start.v[i] + at[k] * h * dv[i];
        accelerate(x, dv);
        for (int i = 0; i < n_masses; i++) {
            s->x[i] += weight[k] * h * dx[i];
            s->v[i] += weight[k] * h * dv[i];
        }
    }
}

static chain_state after_step(const chain_state *before, way how, double h)
{
    chain_state s = *before;
    if (how == VELOCITY_VERLET)
        step_velocity_verlet(&s, h);
    else if (how == RUNGE_KUTTA)
        step_runge_kutta(&s, h);
    else
        step_two(&s, h, how == UNEQUAL_STEPS);
    return s;
}

static double gap_of(const chain_state *s, int end)
{
    return end == 0 ? s->x[0] + gap : (n_masses - 1) * spacing + gap - s->x[n_masses - 1];
}

/* (7); the end that touches, or -1. */
static int first_contact(const chain_state *before, const chain_state *after, double *share)
{
    int found = -1;
    *share = 1.0;
    for (int end = 0; end < 2; end++) {
        const double d1 = gap_of(before, end), d2 = gap_of(after, end);
        if (d1 < 0.0 || d2 >= 0.0 || d1 / (d1 - d2) >= *share) continue;
        *share = d1 / (d1 - d2);
        found = end;
    }
    return found;
}

/* Onto the wall and (8). The two-step formula learns of it by the place before. */
static void reflect(chain_state *s, int end)
{
    const int i = end == 0 ? 0 : n_masses - 1;
    s->x[i] += end == 0 ? -gap_of(s, end) : gap_of(s, end);
    s->before[i] = s->x[i] + s->v[i] * s->h_before;
    s->v[i] = -s->v[i];
}

typedef struct outcome {
    double t;     /* s, reached: with most_impacts it stays where it is */
    double drift; /* energy over that at the start - 1 */
} outcome;

static outcome cut_steps(way how, double h)
{
    chain_state s = {.h_before = h};
    outcome o = {0};
    for (int i = 0; i < n_masses; i++) {
        s.x[i] = i * spacing;
        s.v[i] = speed;
        s.before[i] = s.x[i] - h * speed; /* at rest length: no acceleration yet */
    }
    const double start = energy_of(&s);
    for (int n_impacts = 0; o.t < t_end && n_impacts < most_impacts;) {
        double share;
        chain_state next = after_step(&s, how, h);
        const int end = first_contact(&s, &next, &share);
        if (end >= 0) next = after_step(&s, how, share * h);
        if (end >= 0) reflect(&next, end);
        n_impacts += end >= 0;
        o.t += share * h;
        s = next;
    }
    o.drift = energy_of(&s) / start - 1.0;
    return o;
}

static const double steps[4] = {1.0, 0.5, 0.25, 0.1}; /* omega h */

/* A cut step in the formula as it stands gives every mass a wrong velocity. For unequal steps the formula is sound, but
 * its velocity, the way of the last step over its length, is of first order. In both an end that is pressed on a wall
 * bounces in ever shorter steps: time stands still after thousands of impacts, and no step is short enough. */
TEST(the_two_step_formula_fails_at_contacts)
{
    for (int k = 0; k < 4; k++) {
        const outcome printed = cut_steps(AS_PRINTED, steps[k] / omega_max());
        const outcome unequal = cut_steps(UNEQUAL_STEPS, steps[k] / omega_max());
        print_message("# (5) at %-4g: stands at %.2f ms, energy %+.1e; for unequal steps at %.2f ms, %+.1e\n", steps[k],
                      1e3 * printed.t, printed.drift, 1e3 * unequal.t, unequal.drift);
        assert_true(printed.t < 0.5 * t_end);
        assert_true(unequal.t < 0.5 * t_end);
    }
}

/* So it is the two-step form that fails, not Verlet's method: with its velocity of second order it bears the same cuts.
 * Its error is that of (7), h^2, as is Runge and Kutta's then. */
TEST(velocity_verlet_bears_cut_steps)
{
    for (int k = 0; k < 4; k++) {
        const outcome verlet = cut_steps(VELOCITY_VERLET, steps[k] / omega_max());
        const outcome kutta = cut_steps(RUNGE_KUTTA, steps[k] / omega_max());
        print_message("# cut at %-4g: velocity Verlet %+.2e, Runge and Kutta %+.2e at %.1f ms\n", steps[k],
                      verlet.drift, kutta.drift, 1e3 * kutta.t);
        assert_true(verlet.t >= t_end);
        assert_true(fabs(verlet.drift) < allowed * lines[k].drift);
    }
}
