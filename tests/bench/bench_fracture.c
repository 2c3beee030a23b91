/* SPDX-License-Identifier: BSD-3-Clause */
/* What fracture costs, of rectangles of equilateral triangles with the folding guard.
 *
 *      bench_fracture memory NODES                      bytes a node of a simulation that may break, more than of one
 *                                                       that may not: at the start, and with a triangle broken
 *      bench_fracture whole NODES METHOD STEPS TURNS    a step of a run in which nothing breaks, over one that may not:
 *                                                       medians of turns, strengths far above stresses and
 *                                                       1.5 times as high
 *      bench_fracture damaged NODES TURNS               an evaluation of all forces with triangles dead, over that of
 *                                                       the whole body: medians of turns
 *      bench_fracture softened NODES TURNS              the same with triangles softened, of nodes moved at random, of
 *                                                       which springs are coupled
 *      bench_fracture deaths NODES METHOD [stretch]     a body that breaks where waves meet, by stress or by stretch:
 *                                                       time per broken triangle
 *
 * CPU time. Rows of dead or softened triangles lie side by side across the body, as cracks do; those at random are each
 * of them chosen by itself. The time of a death is in parts: finding what breaks in a step, resolving it (with its
 * local correction and the looks around it, in the steps in which something breaks), and what follows at the end of the
 * step (surfaces, layout); and all of a run, less as many steps of the same impact on a stronger body. What is made
 * ready once, at the first break, is reported apart. */
#include <math.h>
#include <string.h>

#include "base/aligned.h"
#include "events/event_queue.h"
#include "forces/kernel.h"
#include "fracture/break_search.h"
#include "simulation/breaking.h"
#include "ask.h"
#include "bench.h"
#include "memory.h"

static const double spacing = 1e-3, youngs_modulus = 1e9, density = 2500.0, speed = 2.0;

enum { MOST = 400 };

/* ---- bodies ---- */

/* How bodies break: triangles by their strength, brittle or softening, or springs by their critical stretch. */
typedef enum law { BRITTLE, SOFTENING, STRETCH } law;

/* Strength in units of E v/c, and critical stretch in units of v/c, with v = `speed` and c the speed of waves; 0: it
 * does not break. Bodies that soften have nodes moved at random. */
static dem_lattice make_body(double nodes, double strength, law breaks)
{
    const double c = sqrt(youngs_modulus / density), columns = sqrt(nodes * sqrt(3.0) / 2.0);
    const double stretch = strength * speed / c, stress = stretch * youngs_modulus;
    const bool softens = breaks == SOFTENING;
    const dem_material stone = {.struct_size = sizeof(dem_material),
                                .youngs_modulus = youngs_modulus,
                                .poissons_ratio = softens ? 0.22 : 1.0 / 3.0,
                                .density = density,
                                .thickness = 1.0,
                                .guard = 0.02,
                                .springs = softens ? DEM_SPRINGS_COUPLED : DEM_SPRINGS_INDEPENDENT,
                                .strength = breaks == STRETCH ? 0.0 : stress,
                                .critical_stretch = breaks == STRETCH ? stretch : 0.0,
                                .fracture_energy = softens ? 8.0 * stress * stress * spacing / youngs_modulus : 0.0};
    dem_lattice l = dem_lattice_empty();
    ask(dem_lattice_rectangle(&l, columns * spacing, columns * spacing, spacing));
    if (softens) ask(dem_lattice_jitter(&l, 0.25 * spacing, 1));
    ask(dem_lattice_assemble(&l, &stone));
    return l;
}

static dem_model *compile(dem_lattice l, const dem_obstacle *obstacles, dem_index n)
{
    dem_model *model;
    ask(dem_model_create(&model, &l, obstacles, n));
    dem_lattice_free(&l);
    return model;
}

/* A standing wave of twelve spacings. */
static dem_model *make_waves(double nodes, double strength, law breaks)
{
    dem_lattice l = make_body(nodes, strength, breaks);
    l.velocity = calloc(2 * (size_t)l.n_nodes, sizeof *l.velocity);
    must(l.velocity != NULL, "out of memory");
    for (dem_index i = 0; i < l.n_nodes; i++) {
        const double w = acos(-1.0) / (6.0 * spacing), x = w * l.x[2 * i], y = w * l.x[2 * i + 1];
        l.velocity[2 * i] = speed * cos(x) * cos(0.5 * y);
        l.velocity[2 * i + 1] = speed * cos(y) * cos(0.5 * x);
    }
    return compile(l, NULL, 0);
}

static dem_options options_of(const char *method)
{
    dem_options options = dem_options_default();
    options.gravity[1] = 0.0;
    ask(dem_method_find(&options.method, method));
    return options;
}

/* ---- memory ---- */

/* Bytes that a simulation has, or has when a triangle has broken. That of the second of two is measured, so that what
 * is allocated once for all is not counted. */
static double bytes_of(const dem_model *model, bool breaks)
{
    const dem_options options = options_of("verlet");
    const dem_index first = 0;
    dem_simulation *simulation;
    double before = 0.0, taken = 0.0;
    for (int turn = 0; turn < 2; turn++) {
        before = memory_in_use();
        ask(dem_simulation_create(&simulation, model, &options));
        if (breaks) ask(dem_simulation_break(simulation, &first, 1, NULL, 0));
        taken = memory_in_use() - before;
        dem_simulation_destroy(simulation);
    }
    return taken;
}

static void measure_memory(double nodes)
{
    dem_model *whole = make_waves(nodes, 0.0, BRITTLE), *brittle = make_waves(nodes, 100.0, BRITTLE);
    const double n = (double)whole->lattice.n_nodes, least = bytes_of(whole, false);
    (void)printf("%.0f nodes: may break %.1f bytes a node more, with a broken triangle %.1f, without strength %.1f\n",
                 n, (bytes_of(brittle, false) - least) / n, (bytes_of(brittle, true) - least) / n,
                 (bytes_of(whole, true) - least) / n);
    dem_model_destroy(whole);
    dem_model_destroy(brittle);
}

/* ---- may break, but does not ---- */

/* CPU time of a step, s. */
static double time_step(const dem_model *model, const dem_options *options, int steps)
{
    enum { FIRST = 20 };
    dem_simulation *simulation;
    ask(dem_simulation_create(&simulation, model, options));
    const double h = ask_options(simulation).max_step;
    ask(dem_simulation_advance(simulation, FIRST * h));
    const double start = seconds(CLOCK_PROCESS_CPUTIME_ID);
    ask(dem_simulation_advance(simulation, (FIRST + steps) * h));
    const double spent = seconds(CLOCK_PROCESS_CPUTIME_ID) - start;
    must(ask_energy(simulation).fracture == 0.0, "something has broken");
    dem_simulation_destroy(simulation);
    return spent / steps;
}

static void measure_whole(double nodes, const char *method, int steps, int turns)
{
    enum { NONE, FAR, NEAR, KINDS };
    static const double strength[KINDS] = {0.0, 100.0, 2.0};
    static double times[KINDS][MOST];
    dem_model *models[KINDS];
    const dem_options options = options_of(method);
    for (int k = 0; k < KINDS; k++) models[k] = make_waves(nodes, strength[k], BRITTLE);
    for (int turn = 0; turn < turns; turn++)
        for (int k = 0; k < KINDS; k++)
            times[(turn + k) % KINDS][turn] = time_step(models[(turn + k) % KINDS], &options, steps);
    for (int turn = 0; turn < turns; turn++)
        for (int k = FAR; k < KINDS; k++) times[k][turn] /= times[NONE][turn];
    const size_t n = (size_t)turns;
    (void)printf("%lld nodes, %s: %.2f us a step, %.4f with a strength far above stresses, %.4f near them\n",
                 (long long)models[0]->lattice.n_nodes, method, 1e6 * median(times[NONE], n), median(times[FAR], n),
                 median(times[NEAR], n));
    for (int k = 0; k < KINDS; k++) dem_model_destroy(models[k]);
}

/* ---- with dead or softened triangles ---- */

typedef struct damage {
    const char *name;
    bool by_rows;
    double share;
} damage;

/* All of it as well where triangles soften, whose forces remain. */
static const damage kinds[] = {{"whole", false, 0.0},        {"rows, 1 %", true, 0.01},    {"rows, 10 %", true, 0.1},
                               {"rows, 30 %", true, 0.3},    {"random, 1 %", false, 0.01}, {"random, 10 %", false, 0.1},
                               {"random, 30 %", false, 0.3}, {"all", false, 1.0}};
enum { N_KINDS = sizeof kinds / sizeof *kinds };

/* In [0, 1), of its own for each number. */
static double share_of(dem_index number)
{
    uint64_t hash = ((uint64_t)number + 1) * 0x9e3779b97f4a7c15u;
    hash = (hash ^ hash >> 30) * 0xbf58476d1ce4e5b9u;
    hash = (hash ^ hash >> 27) * 0x94d049bb133111ebu;
    return ldexp((double)(hash >> 12), -52);
}

/* The row of triangles in which one lies. */
static double row_of(const dem_lattice *l, dem_index triangle)
{
    double y = 0.0;
    for (int c = 0; c < 3; c++) y += l->x[2 * l->triangles[3 * triangle + c] + 1] / 3.0;
    return floor(y / (spacing * sqrt(3.0) / 2.0));
}

static bool is_chosen(const dem_lattice *l, damage d, dem_index triangle)
{
    const double period = 1.0 / d.share;
    return d.by_rows ? fmod(row_of(l, triangle), period) < 1.0 : share_of(triangle) < d.share;
}

/* Each between one and 32 times. */
static void soften(dem_simulation *s, const dem_index *triangle, dem_index n)
{
    ask(element_state_prepare(&s->elements));
    for (dem_index k = 0; k < n; k++)
        for (dem_index t = 0; t <= triangle[k] % SOFTENING_LEVELS; t++) element_state_soften(&s->elements, triangle[k]);
    kernel_follow(&s->kernel, &s->elements, NULL, 0);
}

/* A simulation of which the kernel is asked, with the elements and the layout that the run would have. */
static dem_simulation *open_damaged(const dem_model *model, damage d)
{
    const dem_lattice *l = &model->lattice;
    dem_options options = options_of("verlet");
    dem_index *dead = malloc((size_t)l->n_triangles * sizeof *dead), n = 0;
    dem_simulation *simulation;
    options.bodies = DEM_BODIES_NONE;
    must(dead != NULL, "out of memory");
    for (dem_index t = 0; t < l->n_triangles && d.share > 0.0; t++)
        if (is_chosen(l, d, t)) dead[n++] = t;
    ask(dem_simulation_create(&simulation, model, &options));
    if (n > 0 && l->softening != NULL) soften(simulation, dead, n);
    if (n > 0 && l->softening == NULL) ask(dem_simulation_break(simulation, dead, n, NULL, 0));
    free(dead);
    return simulation;
}

/* CPU time of an evaluation, s. */
static double time_forces(dem_simulation *s, double *a, int rounds)
{
    const double *x = s->model->lattice.position;
    const kernel_state y = {.x = x, .v = x, .a = a};
    const double start = seconds(CLOCK_PROCESS_CPUTIME_ID);
    for (int r = 0; r < rounds; r++) must(isfinite(kernel_accelerate(&s->kernel, &s->forces, &y)), "not finite");
    return (seconds(CLOCK_PROCESS_CPUTIME_ID) - start) / rounds;
}

static void measure_damaged(double nodes, int turns, bool softens)
{
    static double times[N_KINDS][MOST];
    dem_model *model = softens ? compile(make_body(nodes, 1.0, SOFTENING), NULL, 0) : make_waves(nodes, 0.0, BRITTLE);
    const int n_kinds = softens ? N_KINDS : N_KINDS - 1, rounds = (int)(2e6 / nodes) + 1;
    double *a = aligned_zeros(2 * (size_t)model->lattice.n_nodes);
    dem_simulation *simulations[N_KINDS];
    must(a != NULL, "out of memory");
    for (int k = 0; k < n_kinds; k++) simulations[k] = open_damaged(model, kinds[k]);
    for (int turn = 0; turn < turns; turn++)
        for (int k = 0; k < n_kinds; k++)
            times[(turn + k) % n_kinds][turn] = time_forces(simulations[(turn + k) % n_kinds], a, rounds);
    for (int turn = 0; turn < turns; turn++)
        for (int k = 1; k < n_kinds; k++) times[k][turn] /= times[0][turn];
    (void)printf("%lld nodes: %.2f ns a node", (long long)model->lattice.n_nodes,
                 1e9 * median(times[0], (size_t)turns) / (double)model->lattice.n_nodes);
    for (int k = 1; k < n_kinds; k++) (void)printf("; %s %.3f", kinds[k].name, median(times[k], (size_t)turns));
    (void)printf("\n");
    for (int k = 0; k < n_kinds; k++) dem_simulation_destroy(simulations[k]);
    dem_model_destroy(model);
    free(a);
}

/* ---- deaths ---- */

typedef struct times {
    double all, find, root, take, follow;  /* s; to find what breaks is to look and to search */
    double ready_to_take, ready_to_follow; /* of these, once */
    dem_index steps, n_broken, with_breaks;
} times;

static times spent;

void __real_event_queue_start(event_queue *q, dense_output *step, double *y1, double *f1, double *state);
dem_status __real_event_queue_show(event_queue *q, double t);
void __real_break_search_find(break_search *s, double from);
dem_status __real_breaking_end_step(dem_simulation *s);
dem_status __real_trimmed_layout_create(trimmed_layout *out, const layout *whole, const springs *s, const triangles *t,
                                        const couplings *c, bool softens);
dem_status __real_element_state_prepare(element_state *s);
dem_status __real_mesh_boundary_create(mesh_boundary *out, const dem_lattice *lattice, const unsigned char *broken);
void __wrap_event_queue_start(event_queue *q, dense_output *step, double *y1, double *f1, double *state);
dem_status __wrap_event_queue_show(event_queue *q, double t);
void __wrap_break_search_find(break_search *s, double from);
dem_status __wrap_breaking_end_step(dem_simulation *s);
dem_status __wrap_trimmed_layout_create(trimmed_layout *out, const layout *whole, const springs *s, const triangles *t,
                                        const couplings *c, bool softens);
dem_status __wrap_element_state_prepare(element_state *s);
dem_status __wrap_mesh_boundary_create(mesh_boundary *out, const dem_lattice *lattice, const unsigned char *broken);

void __wrap_event_queue_start(event_queue *q, dense_output *step, double *y1, double *f1, double *state)
{
    const double start = seconds(CLOCK_PROCESS_CPUTIME_ID);
    __real_event_queue_start(q, step, y1, f1, state);
    spent.find += seconds(CLOCK_PROCESS_CPUTIME_ID) - start;
}

dem_status __wrap_event_queue_show(event_queue *q, double t)
{
    const double start = seconds(CLOCK_PROCESS_CPUTIME_ID);
    const dem_status status = __real_event_queue_show(q, t);
    if (q->n_taken > 0) spent.take += seconds(CLOCK_PROCESS_CPUTIME_ID) - start;
    return status;
}

/* From the start of a step nothing has broken in it. To ask for the time takes longer than to search for nothing. */
void __wrap_break_search_find(break_search *s, double from)
{
    if (from != s->step->t0 || s->n == 0) {
        __real_break_search_find(s, from);
        return;
    }
    const double start = seconds(CLOCK_PROCESS_CPUTIME_ID);
    __real_break_search_find(s, from);
    spent.root += seconds(CLOCK_PROCESS_CPUTIME_ID) - start;
}

/* It is part of taking the first break. */
dem_status __wrap_element_state_prepare(element_state *s)
{
    if (s->integrity != NULL) return DEM_OK;
    const double start = seconds(CLOCK_PROCESS_CPUTIME_ID);
    const dem_status status = __real_element_state_prepare(s);
    spent.ready_to_take += seconds(CLOCK_PROCESS_CPUTIME_ID) - start;
    return status;
}

/* The outline of what is whole is made when the first triangle has broken, and then follows. */
dem_status __wrap_mesh_boundary_create(mesh_boundary *out, const dem_lattice *lattice, const unsigned char *broken)
{
    const double start = seconds(CLOCK_PROCESS_CPUTIME_ID);
    const dem_status status = __real_mesh_boundary_create(out, lattice, broken);
    spent.ready_to_follow += seconds(CLOCK_PROCESS_CPUTIME_ID) - start;
    return status;
}

/* So is the layout, of the whole body first. */
dem_status __wrap_trimmed_layout_create(trimmed_layout *out, const layout *whole, const springs *s, const triangles *t,
                                        const couplings *c, bool softens)
{
    const double start = seconds(CLOCK_PROCESS_CPUTIME_ID);
    const dem_status status = __real_trimmed_layout_create(out, whole, s, t, c, softens);
    spent.ready_to_follow += seconds(CLOCK_PROCESS_CPUTIME_ID) - start;
    return status;
}

dem_status __wrap_breaking_end_step(dem_simulation *s)
{
    if (!fracture_source_has_broken(&s->breaks)) return __real_breaking_end_step(s);
    const double start = seconds(CLOCK_PROCESS_CPUTIME_ID);
    spent.with_breaks++;
    const dem_status status = __real_breaking_end_step(s);
    spent.follow += seconds(CLOCK_PROCESS_CPUTIME_ID) - start;
    return status;
}

static dem_index count_broken(const dem_simulation *simulation)
{
    const dem_index n = simulation->model->lattice.n_triangles;
    unsigned char *triangle = malloc((size_t)n);
    dem_index n_broken = 0;
    must(triangle != NULL, "out of memory");
    ask(dem_simulation_broken(simulation, triangle, NULL));
    for (dem_index t = 0; t < n; t++) n_broken += triangle[t];
    free(triangle);
    return n_broken;
}

static times take(const dem_model *model, const char *method, double t_end)
{
    const dem_options options = options_of(method);
    dem_simulation *simulation;
    ask(dem_simulation_create(&simulation, model, &options));
    spent = (times){0};
    const double start = seconds(CLOCK_PROCESS_CPUTIME_ID);
    ask(dem_simulation_advance(simulation, t_end));
    spent.all = seconds(CLOCK_PROCESS_CPUTIME_ID) - start;
    spent.steps = ask_counts(simulation).steps;
    spent.n_broken = count_broken(simulation);
    dem_simulation_destroy(simulation);
    return spent;
}

enum { LOOK, ROOT, TAKE, FOLLOW, ALL, READY, PARTS };

/* us of a run, by parts. */
static void put_parts(const times *t, double by[PARTS][MOST], int turn)
{
    by[LOOK][turn] = 1e6 * (t->find - t->root);
    by[ROOT][turn] = 1e6 * t->root;
    by[TAKE][turn] = 1e6 * (t->take - t->ready_to_take);
    by[FOLLOW][turn] = 1e6 * (t->follow - t->ready_to_follow);
    by[ALL][turn] = 1e6 * t->all;
    by[READY][turn] = 1e6 * (t->ready_to_take + t->ready_to_follow);
}

/* The waves go once through the body. Runs do the same, so that medians of each part are what it takes. */
static void measure_deaths(double nodes, const char *method, law breaks)
{
    enum { TURNS = 9 };
    static double by[PARTS][MOST], step[MOST];
    const double t_end = sqrt(nodes) * spacing / sqrt(youngs_modulus / density);
    dem_model *brittle = make_waves(nodes, 1.0, breaks), *strong = make_waves(nodes, 100.0, breaks);
    times last, whole;
    for (int turn = 0; turn < TURNS; turn++) {
        last = take(brittle, method, t_end);
        put_parts(&last, by, turn);
        whole = take(strong, method, t_end);
        step[turn] = 1e6 * whole.all / (double)whole.steps;
    }
    must(last.n_broken > 0, "nothing has broken");
    double part[PARTS];
    for (int k = 0; k < PARTS; k++) part[k] = median(by[k], TURNS);
    const double n = (double)last.n_broken, without = median(step, TURNS) * (double)last.steps;
    (void)printf(
        "%lld nodes, %s: %lld deaths in %lld of %lld steps; us a death: look %.1f, root %.1f, take %.1f, follow"
        " %.1f, all %.1f, once %.0f us to be ready (of %.3f s; a step of the strong body takes %.1f us)\n",
        (long long)brittle->lattice.n_nodes, method, (long long)last.n_broken, (long long)last.with_breaks,
        (long long)last.steps, part[LOOK] / n, part[ROOT] / n, part[TAKE] / n, part[FOLLOW] / n,
        (part[ALL] - without) / n, part[READY], 1e-6 * part[ALL], without / (double)last.steps);
    dem_model_destroy(brittle);
    dem_model_destroy(strong);
}

int main(int argc, char **argv)
{
    must(argc > 2, "memory | whole | damaged | softened | deaths, NODES ...");
    const double nodes = atof(argv[2]);
    if (strcmp(argv[1], "memory") == 0) measure_memory(nodes);
    if (strcmp(argv[1], "whole") == 0 && argc == 6)
        measure_whole(nodes, argv[3], atoi(argv[4]), (int)fmin(MOST, atof(argv[5])));
    const bool softens = strcmp(argv[1], "softened") == 0;
    if ((softens || strcmp(argv[1], "damaged") == 0) && argc == 4)
        measure_damaged(nodes, (int)fmin(MOST, atof(argv[3])), softens);
    const bool by_stretch = argc == 5 && strcmp(argv[4], "stretch") == 0;
    if (strcmp(argv[1], "deaths") == 0 && (argc == 4 || by_stretch))
        measure_deaths(nodes, argv[3], by_stretch ? STRETCH : BRITTLE);
    return 0;
}
