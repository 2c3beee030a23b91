/* SPDX-License-Identifier: BSD-3-Clause */
/* What the contact of bodies with each other takes of a run: two plates of NODES nodes each, one above the other and
 * GAP spacings apart, run towards each other at 5 m/s. In the same run its functions are timed where the time loop
 * calls them. The run is repeated; every call and every step counts with the least time that it has taken.
 *
 *      bench_bodies NODES GAP STEPS METHOD TURNS
 *
 * Prints nodes, surface edges, steps, evaluations, searches for pairs, and how many pairs were evaluated at the end;
 * then, each in microseconds of a call and as its part of the run: the forces, the bound of their stiffness, that of
 * how near surfaces may come without a look, the check of a step, and all of them. */
#include <math.h>
#include <string.h>

#include "ask.h"
#include "plate.h"
#include "simulation/private.h"

static const double spacing = 5e-3, speed = 2.5;

/* ---- times ---- */

enum { EVALUATE, STIFFENING, BOUND_STEP, CHECK_STEP, STEPS, KINDS, MOST = 20000 };

/* The least time, s, of each call of a kind, in the order of calls; of the kind STEPS from one step to the next. */
typedef struct call_times {
    long n;
    double least[MOST];
} call_times;

static call_times times[KINDS];
static double last_step;

static double now(void)
{
    return seconds(CLOCK_MONOTONIC);
}

static void book(int kind, double start)
{
    call_times *c = &times[kind];
    const double spent = now() - start;
    must(c->n < MOST, "too many calls");
    if (!(c->least[c->n] > 0.0 && c->least[c->n] < spent)) c->least[c->n] = spent;
    c->n++;
}

static void begin_turn(void)
{
    for (int k = 0; k < KINDS; k++) times[k].n = 0;
    last_step = now();
}

static double sum_of(int kind)
{
    double sum = 0.0;
    for (long k = 0; k < times[kind].n; k++) sum += times[kind].least[k];
    return sum;
}

/* What it takes to time a call that does nothing. */
static double time_clock(void)
{
    double least = INFINITY;
    for (int k = 0; k < 1000; k++) {
        const double start = now();
        least = fmin(least, now() - start);
    }
    return least;
}

/* ---- the functions of contact ---- */

bool __real_surface_contact_evaluate(surface_contact *c, const double *x);
double __real_surface_contact_stiffening(surface_contact *c, const double *inverse_mass, double harmless,
                                         const double *x, bool is_known);
void __real_surface_contact_bound_step(surface_contact *c, const double *x, const double *v);
surface_contact_fault __real_surface_contact_check_step(const surface_contact *c, const double *x0, const double *x1,
                                                        surface_crossing *crossing);
bool __wrap_surface_contact_evaluate(surface_contact *c, const double *x);
double __wrap_surface_contact_stiffening(surface_contact *c, const double *inverse_mass, double harmless,
                                         const double *x, bool is_known);
void __wrap_surface_contact_bound_step(surface_contact *c, const double *x, const double *v);
surface_contact_fault __wrap_surface_contact_check_step(const surface_contact *c, const double *x0, const double *x1,
                                                        surface_crossing *crossing);

bool __wrap_surface_contact_evaluate(surface_contact *c, const double *x)
{
    const double start = now();
    const bool good = __real_surface_contact_evaluate(c, x);
    book(EVALUATE, start);
    return good;
}

double __wrap_surface_contact_stiffening(surface_contact *c, const double *inverse_mass, double harmless,
                                         const double *x, bool is_known)
{
    const double start = now(), added = __real_surface_contact_stiffening(c, inverse_mass, harmless, x, is_known);
    book(STIFFENING, start);
    return added;
}

void __wrap_surface_contact_bound_step(surface_contact *c, const double *x, const double *v)
{
    const double start = now();
    __real_surface_contact_bound_step(c, x, v);
    book(BOUND_STEP, start);
}

surface_contact_fault __wrap_surface_contact_check_step(const surface_contact *c, const double *x0, const double *x1,
                                                        surface_crossing *crossing)
{
    const double start = now();
    const surface_contact_fault fault = __real_surface_contact_check_step(c, x0, x1, crossing);
    book(CHECK_STEP, start);
    book(STEPS, last_step);
    last_step = now();
    return fault;
}

/* ---- the run ---- */

static dem_model *make_blocks(dem_index nodes, double gap)
{
    dem_lattice both = plate_make_two(nodes, gap, spacing, speed);
    dem_model *model;
    ask(dem_model_create(&model, &both, NULL, 0));
    dem_lattice_free(&both);
    return model;
}

static void run(const dem_model *model, const dem_options *options, double steps, bool is_last)
{
    dem_simulation *simulation;
    ask(dem_simulation_create(&simulation, model, options));
    begin_turn();
    ask(dem_simulation_advance(simulation, steps * ask_options(simulation).max_step));
    const dem_counts counts = ask_counts(simulation);
    const surface_contact *c = simulation->surfaces;
    if (is_last)
        (void)printf("%lld nodes, %lld edges, %lld steps, %lld evaluations, %lld searches, %lld pairs",
                     (long long)model->lattice.n_nodes, (long long)c->surface.surface.n_edges, (long long)counts.steps,
                     (long long)counts.evaluations, (long long)c->candidates.n_made, (long long)c->close.n);
    dem_simulation_destroy(simulation);
}

int main(int argc, char **argv)
{
    static const char *const names[STEPS] = {"forces", "stiffness", "bound", "check"};
    must(argc == 6, "NODES GAP STEPS METHOD TURNS");
    dem_model *model = make_blocks((dem_index)atof(argv[1]), atof(argv[2]));
    dem_options options = dem_options_default();
    options.gravity[1] = 0.0;
    options.bodies = DEM_BODIES_ALL;
    ask(dem_method_find(&options.method, argv[4]));
    const int n_turns = atoi(argv[5]);
    for (int turn = 1; turn <= n_turns; turn++) run(model, &options, atof(argv[3]), turn == n_turns);
    const double clock = time_clock();
    double whole = sum_of(STEPS), sum = 0.0, spent[STEPS];
    for (int k = 0; k < STEPS; k++) {
        spent[k] = sum_of(k) - clock * (double)times[k].n;
        whole -= 2.0 * clock * (double)times[k].n;
        sum += spent[k];
    }
    (void)printf("; step %.2f us", 1e6 * whole / (double)times[STEPS].n);
    for (int k = 0; k < STEPS; k++)
        if (times[k].n > 0)
            (void)printf("; %s %.2f us, %.2f %%", names[k], 1e6 * spent[k] / (double)times[k].n,
                         100.0 * spent[k] / whole);
    (void)printf("; contact %.2f %%\n", 100.0 * sum / whole);
    dem_model_destroy(model);
    return 0;
}
