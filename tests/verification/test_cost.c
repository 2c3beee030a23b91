/* SPDX-License-Identifier: BSD-3-Clause */
/* What an accuracy costs in a long free vibration (row h): evaluations of the forces, error of positions, drift of the
 * energy, beside those of an independent program, no worse than three times its errors at equal evaluations. Its
 * initial motion, bending and stretch of 5 %, is not known in detail; ours is that of support_block(), and positions
 * are compared with GSL's. The largest step is not capped: the tolerance rules. 'long' as argument: 200 ms by all
 * methods. */
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "triplets.h"

#include "harness/motion.h"
#include "support.h"

static const double spacing = 5e-3, speed = 4.9 /* m/s, what 5 % of strain is at the speed of sound: v_scale */,
                    allowed = 3.0;
static bool is_long;

typedef struct point {
    double evaluations, position, energy; /* rms error over the spacing; |E/E0 - 1|; 0: not compared */
} point;

typedef struct cost {
    point end;
    double energy_most; /* |E/E0 - 1| at any step */
} cost;

/* A line of the table: a step omega h for a method of fixed steps, else a tolerance. The energy of Dormand and
 * Prince's pair is not compared: it grows in long steps and is damped in short ones, and passes 0 between. */
typedef struct line {
    dem_method method;
    double setting;
    point known[3]; /* at 2, 20 and 200 ms */
} line;

static const line lines[] = {
    {DEM_METHOD_VERLET, 1.0, {{100, 2.9e-3, 4e-3}, {1000, 1.9e-2, 4e-3}, {9995, 0, 2e-3}}},
    {DEM_METHOD_VERLET, 0.25, {{400, 1.9e-4, 2.6e-4}, {3998, 2.2e-3, 2e-4}, {39978, 0, 2.7e-4}}},
    {DEM_METHOD_RK4, 1.0, {{400, 1.6e-4, 6e-4}, {4000, 2.2e-3, 1.5e-2}, {39980, 0, 0.155}}},
    {DEM_METHOD_FEHLBERG45, 1e-3, {{282, 7.7e-4, 3e-3}, {3510, 4.6e-3, 8.2e-2}, {57516, 0, 14.2}}},
    {DEM_METHOD_FEHLBERG45, 1e-4, {{420, 1e-4, 5e-4}, {4944, 7.8e-4, 9e-3}, {70152, 0, 0.4}}},
    {DEM_METHOD_FEHLBERG45, 1e-6, {{990, 9.6e-7, 7e-6}, {11718, 8.8e-6, 1.1e-4}, {155526, 0, 2.8e-3}}},
    {DEM_METHOD_FEHLBERG45, 1e-8, {{2460, 9.4e-9, 8e-8}, {29334, 9.5e-8, 1.2e-6}, {0, 0, 0}}},
    {DEM_METHOD_DOPRI45, 1e-4, {{441, 7.8e-5, 0}, {5117, 5e-4, 0}, {65751, 0, 0}}},
    {DEM_METHOD_DOPRI45, 1e-6, {{1057, 5.8e-7, 0}, {12439, 4e-6, 0}, {0, 0, 0}}},
};
enum { n_lines = sizeof lines / sizeof *lines };

static const double durations[3] = {2e-3, 20e-3, 200e-3};

static bool is_fixed(dem_method method)
{
    return method == DEM_METHOD_VERLET || method == DEM_METHOD_RK4;
}

/* ---- the table ---- */

/* The power law through two points, at x. */
static double power_law(double x, double x1, double y1, double x2, double y2)
{
    return y1 * pow(x / x1, log(y2 / y1) / log(x2 / x1));
}

static double value_of(const line *l, int duration, bool energy)
{
    const point *p = &l->known[duration];
    return energy ? p->energy : p->position;
}

/* What the table has at as many evaluations; between, or beyond, the two nearest lines of an adaptive method by a power
 * law. 0: nothing. */
static double known_at(const line *l, int duration, double evaluations, bool energy)
{
    const line *a = NULL, *b = NULL;
    if (is_fixed(l->method)) return value_of(l, duration, energy);
    for (const line *m = lines; m < lines + n_lines; m++) {
        if (m->method != l->method || !(value_of(m, duration, energy) > 0.0)) continue;
        if (b != NULL && b->known[duration].evaluations > evaluations) break;
        a = b;
        b = m;
    }
    if (a == NULL) return 0.0;
    return power_law(evaluations, a->known[duration].evaluations, value_of(a, duration, energy),
                     b->known[duration].evaluations, value_of(b, duration, energy));
}

/* ---- the runs ---- */

typedef struct drift {
    double start, most;
} drift;

static dem_status follow(void *context, const dem_simulation *simulation)
{
    drift *d = context;
    const double energy = ask_energy(simulation).motion;
    if (!(d->start > 0.0)) d->start = energy;
    d->most = fmax(d->most, fabs(energy / d->start - 1.0));
    return DEM_OK;
}

static double highest_frequency(const dem_lattice *block)
{
    double omega;
    CLEANUP(free_model) dem_model *model = support_model(block, NULL, 0);
    assert_ok(dem_model_omega(model, &omega));
    return omega;
}

/* The reference: positions [2 n] at the end; NULL: not compared. */
static cost run_line(const dem_lattice *block, const line *l, double t, const double *reference)
{
    CLEANUP(support_close) support_run run;
    drift d = {0};
    cost c = {0};
    dem_options options = support_options();
    const dem_observer observer = {.struct_size = sizeof(dem_observer), .step = follow, .context = &d};
    options.gravity[1] = 0.0;
    options.checkpoint_steps = 0; /* each takes an evaluation */
    options.method = l->method;
    options.v_scale = speed;
    options.max_step = t;
    if (is_fixed(l->method))
        options.fixed_step = l->setting / highest_frequency(block);
    else
        options.rtol = l->setting;
    support_open(&run, block, NULL, 0, &options);
    assert_ok(dem_simulation_observe(run.simulation, &observer));
    const motion state = support_at(&run, t);
    for (dem_index k = 0; k < 2 * block->n_nodes && reference != NULL; k++)
        c.end.position += (state.x[k] - reference[k]) * (state.x[k] - reference[k]);
    c.end.position = sqrt(c.end.position / (double)block->n_nodes) / spacing;
    c.end.energy = fabs(state.energy.motion / d.start - 1.0);
    c.end.evaluations = (double)ask_counts(run.simulation).evaluations;
    c.energy_most = d.most;
    return c;
}

static void compare(const line *l, int duration, const cost *c)
{
    dem_method_traits method = {.struct_size = sizeof method};
    assert_ok(dem_method_describe(&method, l->method));
    print_message("# %-10s %-6g %5g ms: %6.0f evaluations, energy %.2e at the end, %.2e at most", method.name,
                  l->setting, 1e3 * durations[duration], c->end.evaluations, c->end.energy, c->energy_most);
    if (c->end.position > 0.0) print_message(", positions %.2e spacings", c->end.position);
    print_message("\n");
    const double energy = known_at(l, duration, c->end.evaluations, true);
    const double position = known_at(l, duration, c->end.evaluations, false);
    if (energy > 0.0 && !(c->end.energy <= allowed * energy))
        fail_msg("energy off by %.2e, %.2e known at %.0f evaluations", c->end.energy, energy, c->end.evaluations);
    if (position > 0.0 && c->end.position > 0.0 && !(c->end.position <= allowed * position))
        fail_msg("positions off by %.2e, %.2e known at %.0f evaluations", c->end.position, position,
                 c->end.evaluations);
    if (is_fixed(l->method)) /* a step more than the table: t lies inside the last one */
        assert_close(c->end.evaluations, l->known[duration].evaluations, 0.002 * c->end.evaluations + 2.0);
}

static void compare_all(int duration)
{
    CLEANUP(dem_lattice_free) dem_lattice block = dem_lattice_empty();
    support_block(&block);
    CLEANUP(free_memory) double *y = malloc(4 * (size_t)block.n_nodes * sizeof *y);
    assert_non_null(y);
    triplets_start(&block, y);
    triplets_reach(&block, durations[duration], y);
    for (const line *l = lines; l < lines + n_lines; l++) {
        const cost c = run_line(&block, l, durations[duration], y);
        compare(l, duration, &c);
    }
}

TEST(errors_at_2_ms_are_those_known)
{
    compare_all(0);
}

TEST(errors_at_20_ms_are_those_known)
{
    compare_all(1);
}

/* A thousand periods of the slowest vibration. Verlet's energy stays where it is, Fehlberg's grows. */
TEST(energies_at_200_ms_are_those_known)
{
    CLEANUP(dem_lattice_free) dem_lattice block = dem_lattice_empty();
    support_block(&block);
    for (const line *l = lines; l < lines + n_lines; l++) {
        const bool verlet = l->method == DEM_METHOD_VERLET;
        const bool named = verlet || (l->method == DEM_METHOD_FEHLBERG45 && l->setting == 1e-6);
        if (!named && (!is_long || !(value_of(l, 2, true) > 0.0))) continue;
        const cost c = run_line(&block, l, durations[2], NULL);
        compare(l, 2, &c);
        if (verlet) assert_true(c.energy_most < (l->setting == 1.0 ? 5e-3 : 3e-4));
        if (named && !verlet) assert_true(c.energy_most < allowed * 2.8e-3);
    }
}

int main(int argc, char **argv)
{
    is_long = argc > 1 && strcmp(argv[1], "long") == 0;
    return test_run();
}
