/* SPDX-License-Identifier: BSD-3-Clause */
/* What contact detection costs per accepted step without event, in units of one evaluation of the forces by the plain
 * loop over CSR: a body of COLUMNS x ROWS nodes is pressed on a ground of SEGMENTS segments, flat or with bumps of
 * ROUGHNESS times the spacing, and every step without event counts in which its lower face is in contact. The functions
 * are timed where simulation.c calls them; what ARKODE does to find roots of 'exact' is not counted.
 * `bench_contact COLUMNS ROWS SEGMENTS SECONDS ROUGHNESS METHOD` */
#include <string.h>

#include "bench.h"
#include "contact/automaton_step.h"
#include "harness/motion.h"
#include "events/event_queue.h"

enum { most = 100000 };

static const double spacing = 1e-3;

/* Bumps of `roughness` times the spacing, by a fixed generator. */
static double *make_ground(long segments, double width, double roughness)
{
    double *points = malloc(2 * ((size_t)segments + 1) * sizeof *points);
    unsigned long long random = 1;
    for (long k = 0; points != NULL && k <= segments; k++) {
        random = random * 6364136223846793005ULL + 1442695040888963407ULL;
        points[2 * k] = width * ((double)k / (double)segments - 0.5);
        points[2 * k + 1] = roughness * spacing * (double)(random >> 33) / 2147483648.0;
    }
    return points;
}

static dem_model *make_model(long columns, long rows, long segments, double roughness)
{
    const dem_material rubber = {.struct_size = sizeof(dem_material),
                                 .youngs_modulus = 1e7,
                                 .poissons_ratio = 1.0 / 3.0,
                                 .density = 1050.0,
                                 .thickness = 1.0,
                                 .guard = 0.02};
    const double width = (double)(columns - 1) * spacing, speed[2] = {0.0, -0.1},
                 lift[2] = {0.0, (roughness + 1e-3) * spacing};
    double *points = make_ground(segments, 1.2 * width, roughness);
    const dem_obstacle ground = {
        .struct_size = sizeof(dem_obstacle), .n_points = segments + 1, .points = points, .friction = 0.3};
    dem_lattice lattice = dem_lattice_empty();
    dem_model *model;
    ask(dem_lattice_rectangle(&lattice, width, 0.866025403784 * (double)(rows - 1) * spacing, spacing));
    ask(dem_lattice_assemble(&lattice, &rubber));
    dem_lattice_move(&lattice, 0.0, lift);
    ask(dem_lattice_launch(&lattice, speed));
    ask(dem_model_create(&model, &lattice, &ground, 1));
    dem_lattice_free(&lattice);
    free(points);
    return model;
}

/* ---- the functions of contact detection, timed ---- */

enum { PARTS = 5 };

static double spent[PARTS]; /* s, in this step */

void __real_automaton_begin_roots(automaton *c, double t, const double *y);
double __real_automaton_root_function(automaton *c, const dense_output *p, double *state);
bool __real_automaton_check_step(automaton *c, dense_output *p, bool rooted, double *state);
void __real_automaton_end_step(automaton *c, const dense_output *p, const double *y);
void __real_event_queue_start(event_queue *q, dense_output *step, double *y1, double *f1, double *state);
dem_status __real_event_queue_show(event_queue *q, double t);
void __wrap_automaton_begin_roots(automaton *c, double t, const double *y);
double __wrap_automaton_root_function(automaton *c, const dense_output *p, double *state);
bool __wrap_automaton_check_step(automaton *c, dense_output *p, bool rooted, double *state);
void __wrap_automaton_end_step(automaton *c, const dense_output *p, const double *y);
void __wrap_event_queue_start(event_queue *q, dense_output *step, double *y1, double *f1, double *state);
dem_status __wrap_event_queue_show(event_queue *q, double t);

void __wrap_automaton_begin_roots(automaton *c, double t, const double *y)
{
    const double start = seconds(CLOCK_MONOTONIC);
    __real_automaton_begin_roots(c, t, y);
    spent[0] += seconds(CLOCK_MONOTONIC) - start;
}

double __wrap_automaton_root_function(automaton *c, const dense_output *p, double *state)
{
    const double start = seconds(CLOCK_MONOTONIC);
    const double value = __real_automaton_root_function(c, p, state);
    spent[0] += seconds(CLOCK_MONOTONIC) - start;
    return value;
}

bool __wrap_automaton_check_step(automaton *c, dense_output *p, bool rooted, double *state)
{
    const double start = seconds(CLOCK_MONOTONIC);
    const bool late = __real_automaton_check_step(c, p, rooted, state);
    spent[1] += seconds(CLOCK_MONOTONIC) - start;
    return late;
}

void __wrap_event_queue_start(event_queue *q, dense_output *step, double *y1, double *f1, double *state)
{
    const double start = seconds(CLOCK_MONOTONIC);
    __real_event_queue_start(q, step, y1, f1, state);
    spent[2] += seconds(CLOCK_MONOTONIC) - start;
}

dem_status __wrap_event_queue_show(event_queue *q, double t)
{
    const double start = seconds(CLOCK_MONOTONIC);
    const dem_status status = __real_event_queue_show(q, t);
    spent[3] += seconds(CLOCK_MONOTONIC) - start;
    return status;
}

void __wrap_automaton_end_step(automaton *c, const dense_output *p, const double *y)
{
    const double start = seconds(CLOCK_MONOTONIC);
    __real_automaton_end_step(c, p, y);
    spent[4] += seconds(CLOCK_MONOTONIC) - start;
}

/* ---- the run ---- */

typedef struct tally {
    const dem_model *model;
    dem_index columns, events, contacts;
    double part[PARTS][most], contact[most], force[most], sum;
    size_t n;
} tally;

static dem_status after_step(void *context, const dem_simulation *simulation)
{
    tally *t = context;
    motion state;
    const dem_counts counts = ask_counts(simulation);
    motion_see(simulation, &state);
    const bool quiet = counts.events == t->events;
    if (quiet && 10 * state.n_contacts >= 8 * t->columns && t->n < most) {
        const double start = seconds(CLOCK_MONOTONIC);
        for (dem_index i = 0; i < t->model->lattice.n_nodes; i++)
            t->sum += springs_force(&t->model->springs, SPRINGS_WHOLE, i, state.x).x;
        t->force[t->n] = seconds(CLOCK_MONOTONIC) - start;
        t->contact[t->n] = 0.0;
        for (int k = 0; k < PARTS; k++) t->contact[t->n] += t->part[k][t->n] = spent[k];
        t->n++;
        t->contacts = state.n_contacts;
    }
    t->events = counts.events;
    for (int k = 0; k < PARTS; k++) spent[k] = 0.0;
    return DEM_OK;
}

int main(int argc, char **argv)
{
    if (argc != 7) return 1;
    const long columns = atol(argv[1]), rows = atol(argv[2]), segments = atol(argv[3]);
    static tally t;
    dem_model *model = make_model(columns, rows, segments, atof(argv[5]));
    const dem_observer observer = {.struct_size = sizeof(dem_observer), .step = after_step, .context = &t};
    dem_options options = dem_options_default();
    dem_simulation *simulation;
    options.contact = strcmp(argv[6], "exact") == 0 ? DEM_CONTACT_EXACT : DEM_CONTACT_LOCAL;
    options.gravity[1] = -1e4; /* presses it down */
    options.mass_damping = 1e5;
    t.model = model;
    t.columns = columns;
    ask(dem_simulation_create(&simulation, model, &options));
    ask(dem_simulation_observe(simulation, &observer));
    ask(dem_simulation_advance(simulation, atof(argv[4])));
    const dem_counts counts = ask_counts(simulation);
    const double force = median(t.force, t.n), contact_time = median(t.contact, t.n);
    (void)printf("%lld nodes, %ld segments, %lld contacts on %ld columns, %lld steps, %lld events, %zu steps counted\n",
                 (long long)model->lattice.n_nodes, segments, (long long)t.contacts, columns, (long long)counts.steps,
                 (long long)counts.events, t.n);
    (void)printf(
        "forces %.3f ms, contact %.3f ms (root functions %.3f, check %.3f, look %.3f, show %.3f, follow %.3f), ",
        1e3 * force, 1e3 * contact_time, 1e3 * median(t.part[0], t.n), 1e3 * median(t.part[1], t.n),
        1e3 * median(t.part[2], t.n), 1e3 * median(t.part[3], t.n), 1e3 * median(t.part[4], t.n));
    (void)printf("ratio %.4f (sum %g)\n", contact_time / force, t.sum);
    dem_simulation_destroy(simulation);
    dem_model_destroy(model);
    return 0;
}
