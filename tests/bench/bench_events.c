/* SPDX-License-Identifier: BSD-3-Clause */
/* What an event of each kind takes: an impact, a closing, a release, what else happens to a lasting contact; of nodes
 * on a floor or of edges on the tips of a saw. The body of W2 falls on either:
 *
 *      bench_events floor|saw SPACING TIME METHOD ETA FRICTION [TURNS]
 *
 * The tips of the saw are three spacings apart, so that each has an edge of its own, and lines between them so deep
 * that no node comes there. Elements have a guard, as in decks; every check is on, there is no window. An event takes
 * from when its correction is opened to when that of the next one is, or to the end of the step, whose settling is
 * counted by itself. Prints the nodes; of each kind how many there were, the median and the mean in us; of steps with
 * events how many, the median and the mean of the settling in us, and the mean number of lasting contacts. */
#include <string.h>

#include "contact/automaton.h"
#include "events/event_queue.h"
#include "ask.h"
#include "plate.h"

static const double half_width = 0.3; /* m, of what the body falls on */

/* ---- what is timed ---- */

enum { IMPACT, CLOSING, RELEASE, OTHER, NODE_KINDS, KINDS = 2 * NODE_KINDS, STEP = KINDS, SERIES, MOST = 1000000 };

static const char *const names[SERIES] = {"impact",       "closing",      "release",    "other",   "edge_impact",
                                          "edge_closing", "edge_release", "edge_other", "settling"};

typedef struct series {
    double *us;
    size_t n;
} series;

static series of[SERIES];
static double began, n_contacts; /* s, of the event under way; 0: there is none */
static const event_queue *queue;
static dem_index n_seen;

static void note(int which, double since)
{
    must(of[which].n < MOST, "too many events");
    of[which].us[of[which].n++] = 1e6 * (seconds(CLOCK_MONOTONIC) - since);
}

/* By the first that has been noted of it. Nothing has been where nothing had to change. */
static int kind_of(const dem_event *e)
{
    const int edge = e->other >= 0 ? NODE_KINDS : 0;
    if (e->kind == DEM_EVENT_RELEASE) return edge + RELEASE;
    if (e->kind == DEM_EVENT_CLOSE) return edge + CLOSING;
    if (e->kind == DEM_EVENT_IMPACT) return edge + (e->state != DEM_CONTACT_FREE ? CLOSING : IMPACT);
    return edge + OTHER;
}

static void end_event(void)
{
    if (began > 0.0) note(n_seen < queue->n_events ? kind_of(&queue->events[n_seen]) : OTHER, began);
    n_seen = queue->n_events;
    began = 0.0;
}

dem_status __real_event_queue_show(event_queue *q, double t);
dem_status __real_local_correction_open(local_correction *p, const dense_output *step, neighbourhood_seeds seeds,
                                        double t, double *state);
void __real_changed_motion_end_rows(changed_motion *tr);
dem_status __wrap_event_queue_show(event_queue *q, double t);
dem_status __wrap_local_correction_open(local_correction *p, const dense_output *step, neighbourhood_seeds seeds,
                                        double t, double *state);
void __wrap_changed_motion_end_rows(changed_motion *tr);

dem_status __wrap_local_correction_open(local_correction *p, const dense_output *step, neighbourhood_seeds seeds,
                                        double t, double *state)
{
    end_event();
    began = seconds(CLOCK_MONOTONIC);
    return __real_local_correction_open(p, step, seeds, t, state);
}

static double settles; /* s, when the settling began; 0: it has not */

void __wrap_changed_motion_end_rows(changed_motion *tr)
{
    end_event();
    settles = seconds(CLOCK_MONOTONIC);
    __real_changed_motion_end_rows(tr);
}

dem_status __wrap_event_queue_show(event_queue *q, double t)
{
    queue = q;
    n_seen = q->n_events;
    settles = began = 0.0;
    const dem_status status = __real_event_queue_show(q, t);
    if (settles > 0.0) {
        const automaton *c = q->constraints->self;
        note(STEP, settles);
        n_contacts += (double)c->set.forces.n_groups;
    }
    return status;
}

/* ---- runs ---- */

static double *make_points(const char *scene, double spacing, long *n)
{
    const long n_teeth = strcmp(scene, "saw") == 0 ? lround(2.0 * half_width / (3.0 * spacing)) : 0;
    *n = n_teeth > 0 ? 2 * n_teeth + 1 : 2;
    double *points = calloc(2 * (size_t)*n, sizeof *points);
    must(points != NULL, "out of memory");
    for (long k = 0; k < *n; k++) {
        points[2 * k] = half_width * (2.0 * (double)k / (double)(*n - 1) - 1.0);
        points[2 * k + 1] = n_teeth > 0 && k % 2 == 0 ? -3.0 * spacing : 0.0;
    }
    return points;
}

static dem_model *compile(char **argv)
{
    const double spacing = atof(argv[2]);
    long n_points;
    double *points = make_points(argv[1], spacing, &n_points);
    const dem_obstacle ground = {.struct_size = sizeof(dem_obstacle),
                                 .n_points = n_points,
                                 .points = points,
                                 .restitution = atof(argv[5]),
                                 .friction = atof(argv[6])};
    dem_lattice body = plate_make_falling(spacing);
    dem_model *model;
    plate_guard(&body, 0.02);
    ask(dem_model_create(&model, &body, &ground, 1));
    dem_lattice_free(&body);
    free(points);
    return model;
}

static void run(const dem_model *model, const char *method, double t_end)
{
    dem_simulation *simulation;
    dem_options options = dem_options_default();
    ask(dem_method_find(&options.method, method));
    options.max_step = 0.5 / dem_model_omega_max(model);
    if (options.method == DEM_METHOD_VERLET) options.fixed_step = options.max_step;
    options.window = 0.0;
    ask(dem_simulation_create(&simulation, model, &options));
    ask(dem_simulation_advance(simulation, t_end));
    dem_simulation_destroy(simulation);
}

static double mean(const series *s)
{
    double sum = 0.0;
    for (size_t k = 0; k < s->n; k++) sum += s->us[k];
    return sum / (double)s->n;
}

int main(int argc, char **argv)
{
    must(argc == 7 || argc == 8, "floor|saw SPACING TIME METHOD ETA FRICTION [TURNS]");
    const int turns = argc > 7 ? atoi(argv[7]) : 5;
    dem_model *model = compile(argv);
    for (int which = 0; which < SERIES; which++) {
        of[which].us = malloc(MOST * sizeof(double));
        must(of[which].us != NULL, "out of memory");
    }
    for (int turn = 0; turn < turns; turn++) run(model, argv[4], atof(argv[3]));
    (void)printf("nodes %lld\n", (long long)ask_sizes(model).n_nodes);
    for (int which = 0; which < SERIES; which++) {
        const size_t n = of[which].n;
        if (n == 0) continue;
        const double mean_us = mean(&of[which]);
        (void)printf("%s %zu %.2f %.2f\n", names[which], n / (size_t)turns, median(of[which].us, n), mean_us);
        free(of[which].us);
    }
    if (of[STEP].n > 0) (void)printf("contacts %.1f\n", n_contacts / (double)of[STEP].n);
    dem_model_destroy(model);
    return 0;
}
