/* SPDX-License-Identifier: BSD-3-Clause */
/* Ranks that share bodies which break, beside others which do not, as threads: the motion, every break with its stress,
 * energy and fragment, what is broken, and checkpoints have the bits of the whole model in one process, whoever owns
 * which node. `test_ranks_fracture [long]`. */
#include <stdio.h>
#include <string.h>

#include "ask.h"
#include "scattered.h"
#include "support.h"

#include "base/checkpoint_entries.h"
#include "domain/partition.h"
#include "harness/rank_threads.h"
#include "model/domain_model.h"
#include "simulation/led_run.h"
#include "simulation/private.h"

enum { MOST_RANKS = 7, N_STOPS = 4, TEXT = 256, MOST_BREAKS = 600 };

static const double spacing = 8e-3;
static bool is_long = false;
static const double floor_points[4] = {-1.0, 0.0, 1.0, 0.0};

/* ---- scenes ---- */

typedef enum kind {
    SHATTERED, /* by stress: a block that falls on a floor, and one that does not break on it; all touch */
    STRETCHED, /* by strain: a block that flies apart in free space, and one that it hits, which does not break */
    SOFTENED,  /* a damped block with a fracture energy that falls on a floor; nothing touches but that */
    CRUSHED,   /* by pressure, too: a block that falls on a floor, and touches itself */
    N_KINDS
} kind;

typedef struct scene {
    dem_model *model;
    dem_options options;
    double t_end; /* s */
} scene;

static const double speeds[N_KINDS] = {-8.0, 0.0, -8.0, -9.0}; /* m/s, upwards */

static dem_material material_of(kind k)
{
    dem_material m = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 1050.0,
                           .thickness = 1.0, .guard = 0.02);
    if (k == STRETCHED) m.critical_stretch = 0.02;
    if (k != STRETCHED) m.strength = k == SHATTERED ? 1.2e5 : k == SOFTENED ? 9e4 : 3e5;
    if (k == CRUSHED) m.compressive_strength = 9e5;
    if (k == SOFTENED) {
        m.fracture_energy = 22.5;
        m.damping_time = 4e-6;
    }
    return m;
}

static void add(dem_lattice *to, dem_lattice body)
{
    assert_ok(dem_lattice_append(to, &body));
    dem_lattice_free(&body);
}

/* Strengths of triangles differ, so that not all of a row break at once. */
static dem_lattice make_brittle(kind k)
{
    const dem_material solid = material_of(k);
    dem_lattice l = support_rectangle(0.09, 0.06, spacing, &solid);
    dem_lattice_move(&l, 0.0, (const double[2]){0.0, 3e-4 - support_bottom(&l)});
    for (dem_index t = 0; t < l.n_triangles && k != STRETCHED && k != SOFTENED; t++)
        l.strength[t] *= 1.0 + 0.1 * sin(3.0 * (double)t);
    l.velocity = calloc(2 * (size_t)l.n_nodes, sizeof *l.velocity);
    for (dem_index i = 0; i < l.n_nodes; i++) {
        l.velocity[2 * i] = k == STRETCHED ? 60.0 * l.x[2 * i] + 900.0 * l.x[2 * i] * l.x[2 * i] : 0.3;
        l.velocity[2 * i + 1] = speeds[k];
    }
    return l;
}

/* So fine that not all of it is common. It comes first: what breaks has other numbers on ranks than in the whole. */
static void add_tough(dem_lattice *l, kind k)
{
    const dem_material rubber = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0,
                                      .density = 1050.0, .thickness = 1.0, .guard = 0.02);
    const bool beside = k == STRETCHED;
    dem_lattice other = support_rectangle(0.08, 0.07, 0.5 * spacing, &rubber);
    dem_lattice_move(&other, 0.1, (const double[2]){beside ? 0.092 : 0.0, 0.0});
    dem_lattice_move(&other, 0.0,
                     (const double[2]){0.0, beside ? 0.0 : support_top(l) + 1.2e-3 - support_bottom(&other)});
    assert_ok(dem_lattice_launch(&other, beside ? (const double[2]){-4.0, 0.0} : (const double[2]){0.0, -9.0}));
    add(&other, *l);
    *l = other;
}

static void open_scene(scene *s, kind k, dem_method method, dem_contact_method contact)
{
    const dem_obstacle floor =
        SIZED(dem_obstacle, .n_points = 2, .points = floor_points, .restitution = 0.2, .friction = 0.4);
    CLEANUP(dem_lattice_free) dem_lattice l = make_brittle(k);
    if (k <= STRETCHED) add_tough(&l, k);
    *s = (scene){.model = support_model(&l, &floor, k != STRETCHED), .options = dem_options_default(), .t_end = 0.9e-3};
    s->options.method = method;
    s->options.contact = contact;
    s->options.bodies = k == SOFTENED ? DEM_BODIES_NONE : DEM_BODIES_ALL;
    s->options.contact_friction = k == SHATTERED ? 0.3 : 0.0;
    s->options.checkpoint_steps = 6;
    s->options.gravity[1] = k == STRETCHED ? 0.0 : -9.81;
}

/* ---- runs ---- */

/* All that is seen at a stop, but for the nodes and elements. */
typedef struct view {
    double t, step;
    dem_counts counts;
    dem_energy energy;
    dem_surfaces surfaces;
    dem_strain strain;
} view;

typedef struct outcome {
    view stops[N_STOPS];
    dem_index n_nodes, n_triangles, n_springs;
    double *x, *v;         /* [N_STOPS][n_nodes][2] of the whole */
    unsigned char *broken; /* [N_STOPS][n_triangles] then [N_STOPS][n_springs], likewise */
    dem_index n_breaks;    /* [MOST_BREAKS] */
    dem_break *breaks;     /* and */
    double *at_breaks;     /* [MOST_BREAKS] J, the kinetic energy then */
    bool asks;             /* a run that keeps the first checkpoint in which something is broken: */
    dem_checkpoint *kept;
    double kept_t; /* s */
    dem_index kept_breaks;
    char failure[TEXT]; /* empty: none */
} outcome;

static void make_outcome(outcome *o, const dem_lattice *l)
{
    const size_t n = N_STOPS * (size_t)l->n_nodes;
    *o = (outcome){.n_nodes = l->n_nodes, .n_triangles = l->n_triangles, .n_springs = l->n_springs};
    o->x = calloc(2 * n, sizeof *o->x);
    o->v = calloc(2 * n, sizeof *o->v);
    o->broken = calloc(N_STOPS * (size_t)(l->n_triangles + l->n_springs), 1);
    o->breaks = calloc(MOST_BREAKS, sizeof *o->breaks);
    o->at_breaks = calloc(MOST_BREAKS, sizeof *o->at_breaks);
}

/* The arrays of nodes and elements are those of another one. */
static outcome beside(const outcome *all)
{
    outcome o = *all;
    o.breaks = calloc(MOST_BREAKS, sizeof *o.breaks);
    o.at_breaks = calloc(MOST_BREAKS, sizeof *o.at_breaks);
    return o;
}

static void free_breaks(outcome *o)
{
    free(o->breaks);
    free(o->at_breaks);
}

static void free_outcome(outcome *o)
{
    free(o->x);
    free(o->v);
    free(o->broken);
    free_breaks(o);
    dem_checkpoint_destroy(o->kept);
}

static void look_at_numbers(const dem_simulation *s, view *to)
{
    const dem_state state = ask_state(s);
    to->t = state.t;
    to->step = state.step;
    to->counts = ask_counts(s);
    to->energy = ask_energy(s);
    to->surfaces = ask_surfaces(s);
    to->strain = ask_strain(s);
}

/* Ranks write what they own, and of elements what all of them have where it is broken. */
static void look(const dem_simulation *s, outcome *o, int stop)
{
    const domain *d = s->model->domain;
    const dem_lattice *l = &s->model->lattice;
    CLEANUP(free_memory) unsigned char *triangle = malloc((size_t)l->n_triangles + 1);
    CLEANUP(free_memory) unsigned char *spring = malloc((size_t)l->n_springs + 1);
    look_at_numbers(s, &o->stops[stop]);
    const dem_state seen = ask_state(s);
    for (dem_index i = 0; i < l->n_nodes; i++) {
        const dem_index at = stop * o->n_nodes + domain_number(d, i);
        if (!domain_owns(d, i)) continue;
        memcpy(o->x + 2 * at, seen.x + 2 * i, 2 * sizeof *seen.x);
        memcpy(o->v + 2 * at, seen.v + 2 * i, 2 * sizeof *seen.v);
    }
    (void)dem_simulation_broken(s, triangle, spring);
    unsigned char *of_triangles = o->broken + stop * o->n_triangles,
                  *of_springs = o->broken + N_STOPS * o->n_triangles + stop * o->n_springs;
    for (dem_index t = 0; t < l->n_triangles; t++)
        if (triangle[t]) of_triangles[domain_triangle(d, t)] = 1;
    for (dem_index k = 0; k < l->n_springs; k++)
        if (spring[k]) of_springs[domain_spring(d, k)] = 1;
}

static dem_status note(void *context, const dem_simulation *s, const dem_break *what)
{
    outcome *o = context;
    if (o->n_breaks == MOST_BREAKS) return DEM_STOPPED;
    o->breaks[o->n_breaks] = *what;
    o->at_breaks[o->n_breaks++] = ask_energy(s).kinetic;
    return DEM_OK;
}

static dem_status keep_checkpoint(void *context, const dem_simulation *s, dem_checkpoint *checkpoint)
{
    outcome *o = context;
    if (o->kept != NULL || o->n_breaks == 0) return DEM_OK;
    o->kept_t = ask_state(s).t;
    o->kept_breaks = o->n_breaks;
    assert_ok(dem_checkpoint_create(&o->kept));
    return checkpoint_entries_copy(o->kept, checkpoint);
}

/* \param leads  ranks that make the run of rank 0, which has the whole; NULL: it makes its own
 * \param from   of a checkpoint; NULL: the run begins */
static dem_status run_led(const dem_model *model, const scene *sc, const ranks *leads, const outcome *from, outcome *o)
{
    dem_simulation *s = NULL;
    const dem_checkpoint *checkpoint = from != NULL ? from->kept : NULL;
    const dem_observer observer =
        SIZED(dem_observer, .context = o, .broken = note, .checkpoint = o->asks ? keep_checkpoint : NULL);
    dem_status status = from != NULL ? dem_simulation_resume(&s, model, &sc->options, checkpoint)
                                     : dem_simulation_create(&s, model, &sc->options);
    if (status == DEM_OK && leads != NULL) status = dem_private_lead(s, leads, &sc->options, checkpoint);
    if (status == DEM_OK) status = dem_simulation_observe(s, &observer);
    for (int k = 0; k < N_STOPS && status == DEM_OK; k++) {
        const double t = sc->t_end * k / (N_STOPS - 1);
        if (from != NULL && t < from->kept_t) continue;
        status = dem_simulation_advance(s, t);
        if (status == DEM_OK) look(s, o, k);
    }
    dem_simulation_destroy(s);
    return status;
}

/* Of all ranks. */
typedef struct shared_run {
    const scene *scene;
    domain_model_shares shares;
    outcome *outcomes; /* [ranks] */
} shared_run;

static void run_rank(const ranks *r, void *context)
{
    shared_run *c = context;
    dem_model *model = NULL;
    outcome *o = &c->outcomes[r->rank];
    dem_status status = domain_model_create(&model, r, c->scene->model, &c->shares);
    if (status == DEM_OK) status = run_led(model, c->scene, NULL, NULL, o);
    if (status != DEM_OK) (void)snprintf(o->failure, TEXT, "%s", dem_status_message());
    dem_model_destroy(model);
}

/* The last breaks of the whole are those of a run from a checkpoint, too. */
static void assert_same_breaks(const outcome *one, const outcome *whole)
{
    const dem_index first = whole->n_breaks - one->n_breaks;
    assert_true(first >= 0);
    assert_memory_equal(one->breaks, whole->breaks + first, (size_t)one->n_breaks * sizeof *one->breaks);
    assert_memory_equal(one->at_breaks, whole->at_breaks + first, (size_t)one->n_breaks * sizeof *one->at_breaks);
}

/* From a stop on. */
static void assert_same(const outcome *one, const outcome *whole, int from)
{
    const size_t first = (size_t)from * (size_t)whole->n_nodes, n = N_STOPS * (size_t)whole->n_nodes - first;
    assert_string_equal(one->failure, "");
    for (int k = from; k < N_STOPS; k++) {
        const size_t t = (size_t)(k * whole->n_triangles), of_springs = (size_t)(N_STOPS * whole->n_triangles);
        const size_t p = of_springs + (size_t)(k * whole->n_springs);
        assert_memory_equal(&one->stops[k], &whole->stops[k], sizeof one->stops[k]);
        assert_memory_equal(one->broken + t, whole->broken + t, (size_t)whole->n_triangles);
        assert_memory_equal(one->broken + p, whole->broken + p, (size_t)whole->n_springs);
    }
    assert_memory_equal(one->x + 2 * first, whole->x + 2 * first, 2 * n * sizeof *one->x);
    assert_memory_equal(one->v + 2 * first, whole->v + 2 * first, 2 * n * sizeof *one->v);
    assert_same_breaks(one, whole);
}

static void share(const scene *s, int n_ranks, const int32_t *owner, const outcome *whole)
{
    outcome all[MOST_RANKS];
    make_outcome(&all[0], dem_model_lattice(s->model));
    for (int k = 1; k < n_ranks; k++) all[k] = beside(&all[0]);
    shared_run c = {s, {.owner = owner, .touching = s->options.bodies != DEM_BODIES_NONE}, all};
    rank_threads_run(n_ranks, run_rank, &c);
    for (int k = 0; k < n_ranks; k++) {
        assert_int_equal(all[k].n_breaks, whole->n_breaks);
        assert_same(&all[k], whole, 0);
    }
    for (int k = 1; k < n_ranks; k++) free_breaks(&all[k]);
    free_outcome(&all[0]);
}

/* In compact domains, and in scattered tiles. */
static void check(kind k, dem_method method, dem_contact_method contact)
{
    static const int numbers[] = {3, 1, 2, 7};
    scene s;
    outcome whole;
    open_scene(&s, k, method, contact);
    const dem_lattice *l = dem_model_lattice(s.model);
    CLEANUP(free_memory) int32_t *owner = malloc((size_t)l->n_nodes * sizeof *owner);
    make_outcome(&whole, l);
    assert_ok(run_led(s.model, &s, NULL, NULL, &whole));
    assert_true(k != SOFTENED || whole.stops[N_STOPS - 1].energy.fracture > 0.0);
    assert_true(k == SOFTENED || whole.n_breaks > 0);
    assert_true(k > STRETCHED || whole.stops[N_STOPS - 1].surfaces.pushing > 0 || contact == DEM_CONTACT_EXACT);
    for (int q = 0; q < (is_long ? 4 : 1); q++) {
        assert_ok(partition_bisect(l, numbers[q], owner));
        share(&s, numbers[q], owner, &whole);
        scatter(l, 4.1 * spacing, numbers[q], owner);
        share(&s, numbers[q], owner, &whole);
    }
    free_outcome(&whole);
    dem_model_destroy(s.model);
}

static void check_all(kind k)
{
    check(k, DEM_METHOD_FEHLBERG45, DEM_CONTACT_LOCAL);
    if (k == SOFTENED && !is_long) return; /* it has thousands of events */
    check(k, DEM_METHOD_VERLET, DEM_CONTACT_LOCAL);
    check(k, DEM_METHOD_FEHLBERG45, DEM_CONTACT_EXACT);
    if (is_long) check(k, DEM_METHOD_RK4, DEM_CONTACT_LOCAL);
}

TEST(blocks_that_break_by_stress_have_the_bits_of_one_process)
{
    check_all(SHATTERED);
}

TEST(springs_that_break_by_strain_have_the_bits_of_one_process)
{
    check_all(STRETCHED);
}

TEST(blocks_that_soften_have_the_bits_of_one_process)
{
    check_all(SOFTENED);
}

TEST(blocks_that_are_crushed_have_the_bits_of_one_process)
{
    check_all(CRUSHED);
}

/* ---- runs that rank 0 leads ---- */

typedef struct led_scene {
    const scene *scene;
    const outcome *from; /* of a checkpoint; NULL: the run begins */
    outcome *led;
} led_scene;

static void lead_as_rank(const ranks *r, void *context)
{
    const led_scene *c = context;
    if (r->rank > 0) {
        (void)dem_private_follow(r);
        return;
    }
    if (run_led(c->scene->model, c->scene, r, c->from, c->led) != DEM_OK)
        (void)snprintf(c->led->failure, TEXT, "%s", dem_status_message());
    dem_private_dismiss(r, 0);
}

static void assert_same_checkpoint(const dem_checkpoint *a, const dem_checkpoint *b)
{
    static const char *const names[] = {"sizes",  "broken triangles", "broken springs", "softened triangles",
                                        "state",  "fracture",         "fillings",       "nodes buried",
                                        "counts", "friction"};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        size_t size, other;
        const void *here = dem_checkpoint_find(a, names[k], &size), *there = dem_checkpoint_find(b, names[k], &other);
        assert_int_equal(here != NULL, there != NULL);
        if (here == NULL) continue;
        assert_int_equal(size, other);
        assert_memory_equal(here, there, size);
    }
}

/* The first stop that a run from a checkpoint comes to. */
static int first_stop(const scene *s, double t)
{
    int k = 0;
    while (s->t_end * k / (N_STOPS - 1) < t) k++;
    return k;
}

static void lead(const scene *s, int n_ranks, const outcome *from, const outcome *whole)
{
    outcome led;
    make_outcome(&led, dem_model_lattice(s->model));
    led.asks = from == NULL;
    rank_threads_run(n_ranks, lead_as_rank, &(led_scene){s, from, &led});
    assert_same(&led, whole, from != NULL ? first_stop(s, from->kept_t) : 0);
    if (led.asks) assert_same_checkpoint(led.kept, whole->kept);
    assert_int_equal(led.n_breaks, whole->n_breaks - (from != NULL ? from->kept_breaks : 0));
    free_outcome(&led);
}

/* Another number of ranks goes on with what is broken. */
TEST(led_runs_show_breaks_and_go_on_with_them)
{
    for (kind k = SHATTERED; k < N_KINDS; k++) {
        scene s;
        outcome whole;
        open_scene(&s, k, DEM_METHOD_FEHLBERG45, DEM_CONTACT_LOCAL);
        make_outcome(&whole, dem_model_lattice(s.model));
        whole.asks = true;
        assert_ok(run_led(s.model, &s, NULL, NULL, &whole));
        assert_true(whole.kept != NULL && (k == SOFTENED || whole.n_breaks > whole.kept_breaks));
        lead(&s, 3, NULL, &whole);
        lead(&s, 2, &whole, &whole);
        if (is_long) lead(&s, 7, &whole, &whole);
        free_outcome(&whole);
        dem_model_destroy(s.model);
    }
}

/* ---- what is refused ---- */

/* Stretched at the start by more than springs stand: all ranks say so of the spring that a process alone names. */
TEST(messages_name_elements_of_the_whole)
{
    scene s;
    outcome all[3];
    char message[TEXT];
    open_scene(&s, STRETCHED, DEM_METHOD_FEHLBERG45, DEM_CONTACT_LOCAL);
    CLEANUP(dem_lattice_free) dem_lattice l = dem_lattice_empty();
    assert_ok(dem_lattice_append(&l, dem_model_lattice(s.model)));
    for (dem_index i = 0; i < l.n_nodes; i++)
        if (l.body[i] == 1) l.position[2 * i] *= 1.03;
    dem_model_destroy(s.model);
    s.model = support_model(&l, NULL, 0);
    CLEANUP(free_memory) int32_t *owner = malloc((size_t)l.n_nodes * sizeof *owner);
    assert_ok(partition_bisect(&l, 3, owner));
    make_outcome(&all[0], &l);
    assert_int_equal(run_led(s.model, &s, NULL, NULL, &all[0]), DEM_ERROR_MODEL);
    (void)snprintf(message, TEXT, "%s", dem_status_message());
    assert_non_null(strstr(message, "beyond its critical stretch"));
    for (int k = 1; k < 3; k++) all[k] = beside(&all[0]);
    rank_threads_run(3, run_rank, &(shared_run){&s, {.owner = owner, .touching = true}, all});
    for (int k = 0; k < 3; k++) assert_string_equal(all[k].failure, message);
    for (int k = 1; k < 3; k++) free_breaks(&all[k]);
    free_outcome(&all[0]);
    dem_model_destroy(s.model);
}

/* Not all ranks have what does not break by itself. */
TEST(what_a_program_has_broken_elsewhere_is_refused)
{
    static const dem_index first = 0;
    scene s;
    outcome from, led;
    dem_simulation *alone;
    open_scene(&s, SHATTERED, DEM_METHOD_FEHLBERG45, DEM_CONTACT_LOCAL);
    make_outcome(&from, dem_model_lattice(s.model));
    make_outcome(&led, dem_model_lattice(s.model));
    assert_ok(dem_simulation_create(&alone, s.model, &s.options));
    assert_ok(dem_simulation_break(alone, &first, 1, NULL, 0));
    assert_ok(dem_simulation_advance(alone, 1e-4));
    assert_ok(dem_checkpoint_create(&from.kept));
    assert_ok(checkpoint_entries_copy(from.kept, dem_simulation_checkpoint(alone)));
    rank_threads_run(2, lead_as_rank, &(led_scene){&s, &from, &led});
    assert_string_equal(led.failure,
                        "in the checkpoint 1 of the broken triangles are not of what may break by itself: ranks cannot "
                        "share what a program breaks yet");
    dem_simulation_destroy(alone);
    free_outcome(&from);
    free_outcome(&led);
    dem_model_destroy(s.model);
}

int main(int argc, char **argv)
{
    is_long = argc > 1 && strcmp(argv[1], "long") == 0;
    return test_run();
}
