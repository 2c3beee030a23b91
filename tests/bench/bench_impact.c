/* SPDX-License-Identifier: BSD-3-Clause */
/* A rectangle of 8 x 13 cm falls on a flat floor (W2): 10 m/s, tilted by 0.03, every impact by itself.
 *
 *      bench_impact SPACING TIME TURNS METHOD CONTACT RTOL STEP TOLERANCE [FILE [ETA FRICTION DAMPING [GUARD]]]
 *      bench_impact SPACING lammps FILE
 *
 * As many runs as TURNS; if that is 0, for half a second, two at least, in turns with the clocks inside of the step,
 * which take time themselves, and without. STEP is the longest step, of Verlet's method the step, times omega_max;
 * TOLERANCE is the penetration tolerance in spacings, DAMPING the damping time in s, GUARD the
 * strength of the folding guard over E h. The state at the end goes into FILE. Elastic, without friction, undamped and
 * without a guard unless the last four say else. Prints: nodes, springs, evaluations, steps, events, impacts, late
 * ones; the least CPU time of a run in s and, of method local, what of it went into finding contact events inside steps
 * and into taking them. With `lammps`: the body as a data file of LAMMPS. */
#include <math.h>
#include <string.h>

#include "events/event_queue.h"
#include "ask.h"
#include "plate.h"

static const double least_time = 0.5; /* s */

typedef struct law {
    double restitution, friction, damping_time, guard;
} law;

static const law elastic = {.restitution = 1.0};

static dem_model *compile(double spacing, law l)
{
    static const double points[] = {-1.0, 0.0, 1.0, 0.0};
    const dem_obstacle floor = {.struct_size = sizeof(dem_obstacle),
                                .n_points = 2,
                                .points = points,
                                .restitution = l.restitution,
                                .friction = l.friction};
    dem_lattice body = plate_make_falling(spacing);
    dem_model *model;
    if (l.damping_time > 0.0) plate_damp(&body, l.damping_time);
    if (l.guard > 0.0) plate_guard(&body, l.guard);
    ask(dem_model_create(&model, &body, &floor, 1));
    dem_lattice_free(&body);
    return model;
}

static dem_options read_options(char **argv, const dem_model *model)
{
    dem_options options = dem_options_default();
    ask(dem_method_find(&options.method, argv[0]));
    options.contact = strcmp(argv[1], "exact") == 0 ? DEM_CONTACT_EXACT : DEM_CONTACT_LOCAL;
    must(options.contact == DEM_CONTACT_EXACT || strcmp(argv[1], "local") == 0, "CONTACT is exact or local");
    options.rtol = atof(argv[2]);
    options.max_step = atof(argv[3]) / dem_model_omega_max(model);
    if (options.method == DEM_METHOD_VERLET) options.fixed_step = options.max_step;
    options.penetration_tolerance = atof(argv[4]) * dem_model_spacing(model);
    options.window = 0.0;
    return options;
}

static law read_law(char **argv, int n)
{
    if (n < 3) return elastic;
    return (law){atof(argv[0]), atof(argv[1]), atof(argv[2]), n > 3 ? atof(argv[3]) : 0.0};
}

/* ---- what local contact does, timed where simulation.c calls it ---- */

typedef struct times {
    double all, find, take; /* s */
} times;

static times spent;
static bool looks_inside; /* whether the clocks inside are read */

void __real_event_queue_start(event_queue *q, dense_output *step, double *y1, double *f1, double *state);
dem_status __real_event_queue_show(event_queue *q, double t);
void __wrap_event_queue_start(event_queue *q, dense_output *step, double *y1, double *f1, double *state);
dem_status __wrap_event_queue_show(event_queue *q, double t);

static double inner_clock(void)
{
    return looks_inside ? seconds(CLOCK_PROCESS_CPUTIME_ID) : 0.0;
}

void __wrap_event_queue_start(event_queue *q, dense_output *step, double *y1, double *f1, double *state)
{
    const double start = inner_clock();
    __real_event_queue_start(q, step, y1, f1, state);
    spent.find += inner_clock() - start;
}

dem_status __wrap_event_queue_show(event_queue *q, double t)
{
    const double start = inner_clock();
    const dem_status status = __real_event_queue_show(q, t);
    spent.take += inner_clock() - start;
    return status;
}

/* ---- runs ---- */

static times take(dem_simulation **simulation, const dem_model *model, const dem_options *options, double t_end)
{
    ask(dem_simulation_create(simulation, model, options));
    spent = (times){0};
    const double start = seconds(CLOCK_PROCESS_CPUTIME_ID);
    ask(dem_simulation_advance(*simulation, t_end));
    spent.all = seconds(CLOCK_PROCESS_CPUTIME_ID) - start;
    return spent;
}

static void print(const dem_simulation *simulation, times t)
{
    const dem_counts counts = ask_counts(simulation);
    const dem_model_size sizes = ask_sizes(dem_simulation_model(simulation));
    (void)printf("nodes %lld\nsprings %lld\nevaluations %lld\nsteps %lld\nevents %lld\nimpacts %lld\nlate %lld\n"
                 "cpu %.6f\nfind %.6f\ntake %.6f\n",
                 (long long)sizes.n_nodes, (long long)sizes.n_springs, (long long)counts.evaluations,
                 (long long)counts.steps, (long long)counts.events, (long long)counts.impacts, (long long)counts.late,
                 t.all, t.find, t.take);
}

int main(int argc, char **argv)
{
    must(argc == 4 || argc == 9 || argc == 10 || argc == 13 || argc == 14,
         "SPACING TIME TURNS METHOD CONTACT RTOL STEP TOLERANCE [FILE [ETA FRICTION DAMPING [GUARD]]] or SPACING "
         "lammps FILE");
    const double spacing = atof(argv[1]), t_end = atof(argv[2]);
    if (argc == 4) {
        dem_lattice body = plate_make_falling(spacing);
        plate_write_lammps(&body, spacing, 0.05, argv[3]);
        dem_lattice_free(&body);
        return 0;
    }
    dem_model *model = compile(spacing, read_law(argv + 10, argc - 10));
    const dem_options options = read_options(argv + 4, model);
    const int turns = atoi(argv[3]);
    dem_simulation *simulation = NULL;
    times least = {INFINITY, INFINITY, INFINITY};
    double sum = 0.0;
    for (int turn = 0; turns > 0 ? turn < turns : sum < least_time || turn < 2; turn++) {
        dem_simulation_destroy(simulation);
        looks_inside = turns > 0 || turn % 2 == 0;
        const times now = take(&simulation, model, &options, t_end);
        sum += now.all;
        if (turns > 0 || !looks_inside) least.all = fmin(least.all, now.all);
        if (looks_inside) least.find = fmin(least.find, now.find), least.take = fmin(least.take, now.take);
    }
    print(simulation, least);
    if (argc > 9) plate_write_state(simulation, argv[9]);
    dem_simulation_destroy(simulation);
    dem_model_destroy(model);
    return 0;
}
