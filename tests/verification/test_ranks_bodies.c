/* SPDX-License-Identifier: BSD-3-Clause */
/* Ranks that share bodies which touch each other and themselves, also rigid ones, as threads: the motion, what is seen
 * of contact, and checkpoints have the bits of the whole model in one process, whoever owns which node.
 * `test_ranks_bodies [long]`. */
#include <stdio.h>
#include <string.h>

#include "ask.h"
#include "scattered.h"
#include "support.h"

#include "base/checkpoint_entries.h"
#include "base/random.h"
#include "domain/partition.h"
#include "harness/rank_threads.h"
#include "model/domain_model.h"
#include "simulation/led_run.h"
#include "simulation/private.h"

enum { MOST_RANKS = 7, N_STOPS = 4, TEXT = 256 };

static const double spacing = 5e-3;
static bool is_long = false;
static const dem_method methods[] = {DEM_METHOD_FEHLBERG45, DEM_METHOD_VERLET, DEM_METHOD_DOPRI45, DEM_METHOD_RK4};
static const double floor_points[4] = {-1.0, 0.0, 1.0, 0.0};

/* ---- scenes ---- */

typedef enum kind {
    FREE,     /* two squares in free space, one of which hits the other */
    FOLDING,  /* a body that touches itself */
    FALLING,  /* two squares, one above the other, that fall on a floor */
    HAMMERED, /* a rigid hammer on a guide hits a block on a floor */
    TOPPLING, /* a rigid block on its edge, beside a soft one */
    N_KINDS
} kind;

typedef struct scene {
    dem_model *model;
    dem_options options;
    double t_end; /* s */
} scene;

static dem_material rubber(double damping_time)
{
    return (dem_material)SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 1050.0,
                               .thickness = 1.0, .guard = 0.02, .damping_time = damping_time);
}

static dem_lattice make_block(double width, double height, const dem_material *material)
{
    dem_lattice l = support_rectangle(width, height, spacing, material);
    dem_lattice_move(&l, 0.0, (const double[2]){0.0, -support_bottom(&l)});
    return l;
}

static void add(dem_lattice *to, dem_lattice body)
{
    assert_ok(dem_lattice_append(to, &body));
    dem_lattice_free(&body);
}

/* Two legs on a foot, which come together. */
static dem_lattice make_fork(const dem_material *material)
{
    dem_lattice l = make_block(0.06, 0.07, material);
    CLEANUP(free_memory) bool *keep = malloc((size_t)l.n_nodes * sizeof *keep);
    for (dem_index i = 0; i < l.n_nodes; i++) keep[i] = l.x[2 * i + 1] < 0.021 || fabs(l.x[2 * i]) > 0.006;
    assert_ok(dem_lattice_select(&l, keep));
    l.velocity = calloc(2 * (size_t)l.n_nodes, sizeof *l.velocity);
    for (dem_index i = 0; i < l.n_nodes; i++)
        l.velocity[2 * i] = l.x[2 * i + 1] < 0.03 ? 0.0 : (l.x[2 * i] > 0.0 ? -8.0 : 8.0);
    return l;
}

static dem_lattice make_bodies(kind k)
{
    static const double along[2] = {6.0, 0.5}, down[2] = {0.3, -4.0}, back[2] = {-4.0, -4.0};
    const dem_material soft = rubber(k == FALLING ? 5e-6 : 0.0), hard = rubber(0.0);
    if (k == FOLDING) return make_fork(&soft);
    dem_lattice l = make_block(0.06, 0.05, &soft);
    dem_lattice above = make_block(k == HAMMERED ? 0.03 : 0.045, 0.03, &hard);
    if (k == FREE) {
        assert_ok(dem_lattice_launch(&l, along));
        dem_lattice_move(&above, 0.3, (const double[2]){0.065, 0.01});
        add(&l, above);
        return l;
    }
    dem_lattice_move(&l, 0.0, (const double[2]){0.0, 3e-4});
    if (k != HAMMERED) assert_ok(dem_lattice_launch(&l, k == TOPPLING ? back : down));
    if (k != FALLING) assert_ok(dem_lattice_stiffen(&above, k == HAMMERED ? DEM_GUIDE_Y : DEM_GUIDE_NONE));
    dem_lattice_move(&above, k == HAMMERED ? 0.0 : 0.2, (const double[2]){0.0, 0.0});
    dem_lattice_move(&above, 0.0, (const double[2]){k == TOPPLING ? -0.0575 : 0.0, 0.0});
    const double bottom = k == TOPPLING ? 1.5e-3 : support_top(&l) + 1.5e-3;
    dem_lattice_move(&above, 0.0, (const double[2]){0.0, bottom - support_bottom(&above)});
    assert_ok(dem_lattice_launch(&above, k == TOPPLING ? (const double[2]){6.0, -3.0} : (const double[2]){0.0, -6.0}));
    add(&l, above);
    return l;
}

static void open_scene(scene *s, kind k, dem_method method, dem_contact_method contact)
{
    const dem_obstacle floor =
        SIZED(dem_obstacle, .n_points = 2, .points = floor_points, .restitution = 0.3, .friction = 0.4);
    CLEANUP(dem_lattice_free) dem_lattice l = make_bodies(k);
    *s = (scene){.model = support_model(&l, &floor, k >= FALLING), .options = dem_options_default(), .t_end = 1.2e-3};
    s->options.method = method;
    s->options.contact = contact;
    s->options.bodies = k == FREE ? DEM_BODIES_OTHERS : DEM_BODIES_ALL;
    s->options.contact_friction = k == FOLDING ? 0.0 : 0.5;
    s->options.checkpoint_steps = 25;
    s->options.gravity[1] = k >= FALLING ? -9.81 : 0.0;
}

/* ---- runs ---- */

enum { MOST_BODIES = 2 };

/* All that is seen at a stop, but for the nodes. */
typedef struct view {
    double t, step;
    dem_counts counts;
    dem_energy energy;
    dem_surfaces surfaces;
    dem_pair first, last;
    dem_body_motion bodies[MOST_BODIES];
    dem_obstacle_load load;
} view;

typedef struct outcome {
    view stops[N_STOPS];
    dem_index n_nodes;
    double *x, *v, *force, *pressure; /* [N_STOPS][n_nodes][2], and without the [2], of the whole */
    bool asks;                        /* a run that keeps the first checkpoint in which surfaces push each other: */
    dem_checkpoint *kept;
    double kept_t;      /* s */
    bool touched;       /* whether they did at a stop */
    char failure[TEXT]; /* empty: none */
} outcome;

static void make_outcome(outcome *o, dem_index n)
{
    const size_t all = N_STOPS * (size_t)n;
    *o = (outcome){.n_nodes = n,
                   .x = calloc(2 * all, sizeof *o->x),
                   .v = calloc(2 * all, sizeof *o->v),
                   .force = calloc(2 * all, sizeof *o->force),
                   .pressure = calloc(all, sizeof *o->pressure)};
}

static void free_outcome(outcome *o)
{
    free(o->x);
    free(o->v);
    free(o->force);
    free(o->pressure);
    dem_checkpoint_destroy(o->kept);
}

static void look_at_numbers(const dem_simulation *s, view *to)
{
    const dem_model_size size = ask_sizes(s->model);
    const dem_state state = ask_state(s);
    to->t = state.t;
    to->step = state.step;
    to->counts = ask_counts(s);
    to->energy = ask_energy(s);
    to->surfaces = ask_surfaces(s);
    if (to->surfaces.pushing > 0) to->first = ask_pair(s, 0);
    if (to->surfaces.pushing > 0) to->last = ask_pair(s, to->surfaces.pushing - 1);
    for (dem_index b = 0; b < size.n_bodies; b++) to->bodies[b] = ask_body(s, b);
    if (size.n_obstacles > 0) to->load = ask_obstacle(s, 0);
}

/* Ranks write the rows of their own nodes. */
static void look(const dem_simulation *s, outcome *o, int stop)
{
    const domain *d = s->model->domain;
    const size_t n = (size_t)s->layout.n_nodes;
    CLEANUP(free_memory) double *force = malloc(2 * n * sizeof *force);
    CLEANUP(free_memory) double *pressure = malloc(n * sizeof *pressure);
    look_at_numbers(s, &o->stops[stop]);
    o->touched = o->touched || o->stops[stop].surfaces.pushing > 0;
    const dem_state seen = ask_state(s);
    (void)dem_simulation_contact_forces(s, force);
    (void)dem_simulation_contact_pressures(s, pressure);
    for (dem_index i = 0; i < (dem_index)n; i++) {
        if (!domain_owns(d, i)) continue;
        const dem_index at = stop * o->n_nodes + domain_number(d, i);
        memcpy(o->x + 2 * at, seen.x + 2 * i, 2 * sizeof *seen.x);
        memcpy(o->v + 2 * at, seen.v + 2 * i, 2 * sizeof *seen.v);
        memcpy(o->force + 2 * at, force + 2 * i, 2 * sizeof *force);
        o->pressure[at] = pressure[i];
    }
}

static dem_status keep_checkpoint(void *context, const dem_simulation *s, dem_checkpoint *checkpoint)
{
    outcome *o = context;
    if (o->kept != NULL || ask_surfaces(s).pushing == 0) return DEM_OK;
    o->kept_t = ask_state(s).t;
    assert_ok(dem_checkpoint_create(&o->kept));
    return checkpoint_entries_copy(o->kept, checkpoint);
}

/* \param leads  ranks that make the run of rank 0, which has the whole; NULL: it makes its own
 * \param from   of a checkpoint; NULL: the run begins */
static dem_status run_led(const dem_model *model, const scene *sc, const ranks *leads, const outcome *from, outcome *o)
{
    dem_simulation *s = NULL;
    const dem_checkpoint *checkpoint = from != NULL ? from->kept : NULL;
    const dem_observer observer = SIZED(dem_observer, .context = o, .checkpoint = o->asks ? keep_checkpoint : NULL);
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
    outcome *outcomes; /* [ranks] whose arrays of nodes are one */
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

/* From a stop on. */
static void assert_same(const outcome *one, const outcome *whole, int from)
{
    const size_t first = (size_t)from * (size_t)whole->n_nodes, n = N_STOPS * (size_t)whole->n_nodes - first;
    assert_string_equal(one->failure, "");
    for (int k = from; k < N_STOPS; k++) assert_memory_equal(&one->stops[k], &whole->stops[k], sizeof one->stops[k]);
    assert_memory_equal(one->x + 2 * first, whole->x + 2 * first, 2 * n * sizeof *one->x);
    assert_memory_equal(one->v + 2 * first, whole->v + 2 * first, 2 * n * sizeof *one->v);
    assert_memory_equal(one->force + 2 * first, whole->force + 2 * first, 2 * n * sizeof *one->force);
    assert_memory_equal(one->pressure + first, whole->pressure + first, n * sizeof *one->pressure);
}

static void share(const scene *s, int n_ranks, const int32_t *owner, const outcome *whole)
{
    outcome all[MOST_RANKS];
    make_outcome(&all[0], whole->n_nodes);
    for (int k = 1; k < n_ranks; k++) all[k] = all[0];
    shared_run c = {
        s, {.owner = owner, .touching = true, .n_rings = s->options.method == DEM_METHOD_FEHLBERG45 ? 3 : 0}, all};
    rank_threads_run(n_ranks, run_rank, &c);
    for (int k = 0; k < n_ranks; k++) assert_same(&all[k], whole, 0);
    free_outcome(&all[0]);
}

/* Each node to any rank. */
static void draw(dem_index n, int n_ranks, uint64_t seed, int32_t *owner)
{
    for (dem_index i = 0; i < n; i++) owner[i] = (int32_t)(random_mix(seed + (uint64_t)i) % (uint64_t)n_ranks);
}

/* In compact domains, in scattered tiles, and by lot. */
static void check(kind k, dem_method method, dem_contact_method contact)
{
    static const int numbers[] = {3, 1, 2, 4, 7};
    scene s;
    outcome whole;
    open_scene(&s, k, method, contact);
    const dem_lattice *l = dem_model_lattice(s.model);
    CLEANUP(free_memory) int32_t *owner = malloc((size_t)l->n_nodes * sizeof *owner);
    make_outcome(&whole, l->n_nodes);
    assert_ok(run_led(s.model, &s, NULL, NULL, &whole));
    assert_true(whole.touched && (k < FALLING || whole.stops[N_STOPS - 1].counts.events > 0));
    for (int q = 0; q < (is_long ? 5 : 1); q++) {
        assert_ok(partition_bisect(l, numbers[q], owner));
        share(&s, numbers[q], owner, &whole);
        if (numbers[q] == 1) continue;
        scatter(l, 4.1 * spacing, numbers[q], owner);
        share(&s, numbers[q], owner, &whole);
        draw(l->n_nodes, numbers[q], (uint64_t)k, owner);
        share(&s, numbers[q], owner, &whole);
    }
    free_outcome(&whole);
    dem_model_destroy(s.model);
}

static void check_all(kind k)
{
    check(k, DEM_METHOD_FEHLBERG45, DEM_CONTACT_LOCAL);
    check(k, DEM_METHOD_VERLET, DEM_CONTACT_LOCAL);
    if (k >= FALLING) check(k, DEM_METHOD_FEHLBERG45, DEM_CONTACT_EXACT);
    for (int m = 2; m < 4 && is_long; m++) check(k, methods[m], DEM_CONTACT_LOCAL);
}

TEST(bodies_that_hit_each_other_have_the_bits_of_one_process)
{
    check_all(FREE);
}

TEST(a_body_that_touches_itself_has_the_bits_of_one_process)
{
    check_all(FOLDING);
}

TEST(bodies_that_fall_on_each_other_and_a_floor_have_the_bits_of_one_process)
{
    check_all(FALLING);
}

TEST(a_rigid_body_on_a_guide_has_the_bits_of_one_process)
{
    check_all(HAMMERED);
}

TEST(a_rigid_body_on_a_floor_with_friction_has_the_bits_of_one_process)
{
    check_all(TOPPLING);
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

static void assert_same_entry(const dem_checkpoint *a, const dem_checkpoint *b, const char *name)
{
    size_t size, other;
    const void *here = dem_checkpoint_find(a, name, &size), *there = dem_checkpoint_find(b, name, &other);
    assert_int_equal(here != NULL, there != NULL);
    if (here == NULL) return;
    assert_int_equal(size, other);
    assert_memory_equal(here, there, size);
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
    make_outcome(&led, whole->n_nodes);
    led.asks = from == NULL;
    rank_threads_run(n_ranks, lead_as_rank, &(led_scene){s, from, &led});
    assert_same(&led, whole, from != NULL ? first_stop(s, from->kept_t) : 0);
    for (int k = 0; k < 3 && led.asks; k++)
        assert_same_entry(led.kept, whole->kept, (const char *[]){"state", "friction", "friction of rigid body 0"}[k]);
    free_outcome(&led);
}

/* Another number of ranks goes on with closed contacts and friction. */
TEST(led_runs_show_contact_and_go_on_from_it)
{
    for (kind k = FREE; k < N_KINDS; k++) {
        scene s;
        outcome whole;
        open_scene(&s, k, DEM_METHOD_FEHLBERG45, DEM_CONTACT_LOCAL);
        make_outcome(&whole, dem_model_lattice(s.model)->n_nodes);
        whole.asks = true;
        assert_ok(run_led(s.model, &s, NULL, NULL, &whole));
        assert_true(whole.kept != NULL && first_stop(&s, whole.kept_t) < N_STOPS);
        lead(&s, 3, NULL, &whole);
        lead(&s, 2, &whole, &whole);
        if (is_long) lead(&s, 7, &whole, &whole);
        free_outcome(&whole);
        dem_model_destroy(s.model);
    }
}

/* ---- what is refused ---- */

/* What each rank says; `ends` of a run that all begin. */
typedef struct said {
    const scene *scene;
    domain_model_shares shares;
    char messages[MOST_RANKS][TEXT];
} said;

static void say(const ranks *r, void *context)
{
    said *c = context;
    dem_model *model = NULL;
    outcome o;
    make_outcome(&o, c->scene->model->lattice.n_nodes);
    dem_status status = domain_model_create(&model, r, c->scene->model, &c->shares);
    if (status == DEM_OK) status = run_led(model, c->scene, NULL, NULL, &o);
    (void)snprintf(c->messages[r->rank], TEXT, "%s", status != DEM_OK ? dem_status_message() : "");
    dem_model_destroy(model);
    free_outcome(&o);
}

/* All ranks of three end with a message. */
static void assert_said(const scene *s, bool touching, const char *message)
{
    const dem_lattice *l = dem_model_lattice(s->model);
    CLEANUP(free_memory) int32_t *owner = malloc((size_t)l->n_nodes * sizeof *owner);
    draw(l->n_nodes, 3, 1, owner);
    said c = {.scene = s, .shares = {.owner = owner, .touching = touching}};
    rank_threads_run(3, say, &c);
    for (int k = 0; k < 3; k++) assert_string_equal(c.messages[k], message);
}

TEST(a_model_without_surfaces_refuses_bodies_that_touch)
{
    scene s;
    open_scene(&s, FREE, DEM_METHOD_FEHLBERG45, DEM_CONTACT_LOCAL);
    assert_said(
        &s, false,
        "bodies touch in a model of which ranks share no surfaces: a body alone without obstacles does not touch "
        "itself yet");
    dem_model_destroy(s.model);
}

/* With the message of a process alone, and its numbers of nodes: steps so long that surfaces cross; and bodies that
 * overlap at the start. */
TEST(messages_name_nodes_of_the_whole)
{
    for (int overlaps = 0; overlaps < 2; overlaps++) {
        scene s;
        outcome whole;
        char message[TEXT];
        open_scene(&s, FREE, DEM_METHOD_VERLET, DEM_CONTACT_LOCAL);
        s.options.fixed_step = 2e-5;
        CLEANUP(dem_lattice_free) dem_lattice l = dem_lattice_empty();
        assert_ok(dem_lattice_append(&l, dem_model_lattice(s.model)));
        for (dem_index i = 0; i < l.n_nodes; i++) {
            if (l.body[i] == 1 && overlaps) l.position[2 * i] -= 0.01;
            if (l.body[i] == 0) l.velocity[2 * i] = 600.0;
        }
        dem_model_destroy(s.model);
        s.model = support_model(&l, NULL, 0);
        make_outcome(&whole, l.n_nodes);
        assert_int_equal(run_led(s.model, &s, NULL, NULL, &whole), overlaps ? DEM_ERROR_MODEL : DEM_ERROR_CONTACT);
        (void)snprintf(message, TEXT, "%s", dem_status_message());
        assert_said(&s, true, message);
        free_outcome(&whole);
        dem_model_destroy(s.model);
    }
}

int main(int argc, char **argv)
{
    is_long = argc > 1 && strcmp(argv[1], "long") == 0;
    return test_run();
}
