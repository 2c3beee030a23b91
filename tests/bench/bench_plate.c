/* SPDX-License-Identifier: BSD-3-Clause */
/* A free plate of equilateral triangles that vibrates (W1): what an evaluation of the forces costs by itself, and a run
 * with all that belongs to it, in ns of CPU time per spring and evaluation, the least of several turns.
 *
 *      bench_plate NODES                                      a table
 *      bench_plate NODES METHOD KERNEL THREADS STEPS [FILE]   one run of fixed steps, its state at the end into FILE
 *      bench_plate NODES threads METHOD THREADS THREAD_NODES TURNS
 *                                                             wall time of a run in threads beside one without
 *      bench_plate NODES lammps FILE                          the same plate as a data file of LAMMPS
 *
 * A run prints: nodes, springs, step in s, evaluations, CPU and wall time in s, total energy at start and end in J. */
#define _XOPEN_SOURCE 700 /* M_PI */
#include <math.h>
#include <string.h>

#include "base/aligned.h"
#include "forces/kernel.h"
#include "ask.h"
#include "plate.h"

static const double spacing = 5e-3, peak_strain = 0.03;

/* ---- the plate ---- */

/* A standing wave of twelve spacings. */
static void launch(dem_lattice *l)
{
    const double w = 2.0 * M_PI / (12.0 * spacing);
    const double speed = peak_strain * spacing * sqrt(9.0 / 8.0) / plate_period(spacing);
    double mean[2] = {0.0, 0.0};
    for (dem_index i = 0; i < l->n_nodes; i++) {
        const double x = w * l->x[2 * i], y = w * l->x[2 * i + 1];
        l->velocity[2 * i] = speed * cos(x) * cos(0.5 * y);
        l->velocity[2 * i + 1] = speed * cos(y) * cos(0.5 * x);
        for (int c = 0; c < 2; c++) mean[c] += l->velocity[2 * i + c] / (double)l->n_nodes;
    }
    for (dem_index k = 0; k < 2 * l->n_nodes; k++) l->velocity[k] -= mean[k % 2];
}

/* Rest lengths are `spacing`, or each its own: the distance of its nodes, which differs in the last digits. */
static dem_lattice make_plate(dem_index nodes, bool own)
{
    const dem_index columns = (dem_index)fmax(4.0, round(sqrt((double)nodes * sqrt(3.0) / 2.0)));
    const dem_index rows = (dem_index)fmax(4.0, round((double)nodes / (double)columns));
    dem_lattice l = plate_make(columns, rows, spacing);
    for (dem_index k = 0; own && k < l.n_springs; k++) {
        const double *a = l.x + 2 * l.ends[2 * k], *b = l.x + 2 * l.ends[2 * k + 1];
        l.rest_length[k] = hypot(b[0] - a[0], b[1] - a[1]);
    }
    launch(&l);
    return l;
}

static dem_model *compile(dem_index nodes, bool own)
{
    dem_lattice lattice = make_plate(nodes, own);
    dem_model *model;
    ask(dem_model_create(&model, &lattice, NULL, 0));
    dem_lattice_free(&lattice);
    return model;
}

/* ---- forces alone ---- */

static double time_kernel(const dem_model *model, dem_kernel kind)
{
    const dem_index n = model->lattice.n_nodes;
    const long rounds = (long)(2e7 / (double)model->lattice.n_springs) + 1;
    const forces acting = {.model = model};
    double *state = aligned_zeros(2 * (size_t)n), *a = aligned_zeros(2 * (size_t)n), least = INFINITY;
    must(state != NULL && a != NULL, "out of memory");
    memcpy(state, model->lattice.position, 2 * (size_t)n * sizeof *state);
    const kernel_state y = {.x = state, .v = state, .a = a};
    kernel k;
    ask(kernel_create(&k, model, kind, NULL));
    for (int turn = 0; turn < 7; turn++) {
        const double start = seconds(CLOCK_PROCESS_CPUTIME_ID);
        for (long r = 0; r < rounds; r++) must(isfinite(kernel_accelerate(&k, &acting, &y)), "not finite");
        least = fmin(least, seconds(CLOCK_PROCESS_CPUTIME_ID) - start);
    }
    kernel_destroy(&k);
    free(state);
    free(a);
    return 1e9 * least / (double)rounds / (double)model->lattice.n_springs;
}

/* ---- runs ---- */

typedef struct plan {
    dem_method method;
    dem_kernel kernel;
    int threads;
    dem_index thread_nodes;
    dem_index steps;
    const char *file; /* NULL: none */
} plan;

typedef struct result {
    double step, cpu, wall, energy[2];
    dem_index evaluations;
} result;

static double energy_of(const dem_simulation *simulation)
{
    return ask_energy(simulation).ledger;
}

/* Fehlberg's pair as it comes; else steps of a tenth of sqrt(m/k), as LAMMPS takes. */
static dem_simulation *start(const dem_model *model, const plan *p)
{
    const double tenth = 0.1 * plate_period(spacing);
    dem_options options = dem_options_default();
    dem_simulation *simulation;
    options.gravity[1] = 0.0;
    options.method = p->method;
    options.kernel = p->kernel;
    options.threads = p->threads;
    options.thread_nodes = p->thread_nodes;
    if (p->method == DEM_METHOD_VERLET) options.fixed_step = tenth;
    ask(dem_simulation_create(&simulation, model, &options));
    return simulation;
}

static result take(const dem_model *model, const plan *p)
{
    dem_simulation *simulation = start(model, p);
    result r = {0};
    r.step = ask_options(simulation).max_step;
    r.energy[0] = energy_of(simulation);
    const double cpu = seconds(CLOCK_PROCESS_CPUTIME_ID), wall = seconds(CLOCK_MONOTONIC);
    ask(dem_simulation_advance(simulation, r.step * (double)p->steps));
    r.cpu = seconds(CLOCK_PROCESS_CPUTIME_ID) - cpu;
    r.wall = seconds(CLOCK_MONOTONIC) - wall;
    r.energy[1] = energy_of(simulation);
    r.evaluations = ask_counts(simulation).evaluations;
    if (p->file != NULL) plate_write_state(simulation, p->file);
    dem_simulation_destroy(simulation);
    return r;
}

static double time_run(const dem_model *model, dem_method method)
{
    const double n_springs = (double)model->lattice.n_springs;
    dem_method_traits traits = {.struct_size = sizeof traits};
    ask(dem_method_describe(&traits, method));
    const plan p = {method, DEM_KERNEL_AUTO, 1, 0, (dem_index)(3e7 / n_springs / traits.evaluations) + 2, NULL};
    double least = INFINITY;
    for (int turn = 0; turn < 5; turn++) {
        const result r = take(model, &p);
        least = fmin(least, 1e9 * r.cpu / (double)r.evaluations / n_springs);
    }
    return least;
}

static void print_table(dem_index nodes)
{
    for (int own = 0; own < 2; own++) {
        dem_model *model = compile(nodes, own != 0);
        (void)printf("%lld nodes, %lld springs, %s\n", (long long)model->lattice.n_nodes,
                     (long long)model->lattice.n_springs, own ? "each of its own length" : "of one length");
        for (dem_kernel kind = DEM_KERNEL_PORTABLE; kind <= DEM_KERNEL_AVX512; kind++)
            if (dem_kernel_check(kind) == DEM_OK)
                (void)printf("    forces, %-10s %6.2f ns\n", dem_kernel_name(kind), time_kernel(model, kind));
        (void)printf("    Fehlberg           %6.2f ns\n", time_run(model, DEM_METHOD_FEHLBERG45));
        (void)printf("    Verlet             %6.2f ns\n", time_run(model, DEM_METHOD_VERLET));
        dem_model_destroy(model);
    }
}

/* ---- threads ---- */

enum { MOST_TURNS = 1000 };

typedef struct run {
    dem_simulation *simulation;
    double t, ns[MOST_TURNS]; /* s; wall time of a spring and evaluation by turns */
} run;

static void go_on(run *r, const dem_model *model, dem_index steps, int turn)
{
    const dem_index evaluations = ask_counts(r->simulation).evaluations;
    const double wall = seconds(CLOCK_MONOTONIC);
    r->t += (double)steps * ask_options(r->simulation).max_step;
    ask(dem_simulation_advance(r->simulation, r->t));
    r->ns[turn] = 1e9 * (seconds(CLOCK_MONOTONIC) - wall) / (double)model->lattice.n_springs /
                  (double)(ask_counts(r->simulation).evaluations - evaluations);
}

static double sum(const double *values, size_t n)
{
    double all = 0.0;
    for (size_t k = 0; k < n; k++) all += values[k];
    return all;
}

/* A run alone and one in threads go on in turn for some twenty ms. The first turn does not count. */
static void print_threads(const dem_model *model, const plan *p, int turns)
{
    static run alone, together;
    plan one = *p;
    double ratio[MOST_TURNS];
    must(turns > 0 && turns < MOST_TURNS, "TURNS is out of range");
    one.threads = 1;
    alone.simulation = start(model, &one);
    together.simulation = start(model, p);
    for (int k = 0; k <= turns; k++) {
        go_on(&alone, model, p->steps, k);
        go_on(&together, model, p->steps, k);
        ratio[k] = together.ns[k] / alone.ns[k];
    }
    const size_t n = (size_t)turns;
    const double of_all = sum(together.ns + 1, n) / sum(alone.ns + 1, n);
    (void)printf("%lld nodes: 1 thread %.2f ns, %d threads %.2f ns, ratio %.2f", (long long)model->lattice.n_nodes,
                 median(alone.ns + 1, n), ask_options(together.simulation).threads, median(together.ns + 1, n),
                 median(ratio + 1, n));
    (void)printf(" (%.2f to %.2f), of all %.2f\n", ratio[1 + turns / 10], ratio[turns - turns / 10], of_all);
    dem_simulation_destroy(alone.simulation);
    dem_simulation_destroy(together.simulation);
}

static void compare_threads(dem_index nodes, char **argv)
{
    plan p = {.kernel = DEM_KERNEL_AUTO, .threads = atoi(argv[1]), .thread_nodes = (dem_index)atof(argv[2])};
    ask(dem_method_find(&p.method, argv[0]));
    dem_model *model = compile(nodes, false);
    p.steps = (dem_index)(2e7 / (double)model->lattice.n_springs / (p.method == DEM_METHOD_VERLET ? 2.0 : 20.0)) + 1;
    print_threads(model, &p, atoi(argv[3]));
    dem_model_destroy(model);
}

static void write_lammps(dem_index nodes, const char *path)
{
    dem_lattice plate = make_plate(nodes, false);
    plate_write_lammps(&plate, spacing, 2.0 * spacing, path);
    dem_lattice_free(&plate);
}

int main(int argc, char **argv)
{
    must(argc == 2 || (argc == 4 && strcmp(argv[2], "lammps") == 0) || argc == 6 || argc == 7,
         "NODES [METHOD KERNEL THREADS STEPS [FILE]] or NODES lammps FILE");
    const dem_index nodes = (dem_index)atof(argv[1]);
    if (argc == 2) print_table(nodes);
    if (argc == 4) write_lammps(nodes, argv[3]);
    if (argc < 6) return 0;
    if (strcmp(argv[2], "threads") == 0) {
        must(argc == 7, "NODES threads METHOD THREADS THREAD_NODES TURNS");
        compare_threads(nodes, argv + 3);
        return 0;
    }
    plan p = {.threads = atoi(argv[4]), .steps = atoll(argv[5]), .file = argc == 7 ? argv[6] : NULL};
    ask(dem_method_find(&p.method, argv[2]));
    ask(dem_kernel_find(&p.kernel, argv[3]));
    dem_model *model = compile(nodes, false);
    const result r = take(model, &p);
    (void)printf("nodes %lld\nsprings %lld\nstep %.17g\nevaluations %lld\ncpu %.6f\nwall %.6f\nenergy %.17g %.17g\n",
                 (long long)model->lattice.n_nodes, (long long)model->lattice.n_springs, r.step,
                 (long long)r.evaluations, r.cpu, r.wall, r.energy[0], r.energy[1]);
    dem_model_destroy(model);
    return 0;
}
