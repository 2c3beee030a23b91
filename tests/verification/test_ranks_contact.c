/* SPDX-License-Identifier: BSD-3-Clause */
/* Ranks that share bodies which fall on obstacles, as threads: motion, quadratures, ledger, contacts and events have
 * the bits of the whole model in one process, whatever the shares. The body is large enough to have nodes that are not
 * common ones. `test_ranks_contact [long]`. */
#include <stdio.h>
#include <string.h>

#include "scattered.h"
#include "support.h"

#include "base/checkpoint_entries.h"
#include "domain/partition.h"
#include "harness/rank_threads.h"
#include "model/domain_model.h"
#include "simulation/led_run.h"
#include "simulation/private.h"
#include "simulation/rank_shares.h"

enum { MOST_RANKS = 7, N_STOPS = 3, STEP_RINGS = 3, TEXT = 256, FLOOR_POINTS = 61 };

static const double spacing = 2.5e-3;
static bool is_long = false;
static const dem_method methods[] = {DEM_METHOD_FEHLBERG45, DEM_METHOD_DOPRI45, DEM_METHOD_RK4, DEM_METHOD_VERLET};

/* ---- scenes ---- */

/* What falls on what. */
typedef enum ground { PLANE, BUMPS, TEETH, SHAKEN } ground;

typedef struct kind {
    ground ground;
    dem_contact_method contact;
    double restitution, friction;
    double damping_time; /* s, of springs */
    double mass_damping; /* 1/s */
    bool is_dropped;     /* from rest, and soon as fast as others */
} kind;

typedef struct scene {
    dem_model *model;
    dem_options options;
    double t_end;      /* s */
    dem_index *driven; /* nodes */
    dem_boundary drive;
} scene;

/* Teeth are finer than the spacing: vertices hold edges in groups. */
static void make_floor(ground g, double *points)
{
    for (int k = 0; k < FLOOR_POINTS; k++) {
        const double x = 0.004 * (k - FLOOR_POINTS / 2);
        points[2 * k] = g == TEETH ? 0.5 * x : x;
        points[2 * k + 1] = 0.0;
        if (g == BUMPS) points[2 * k + 1] = 3e-4 * sin(2.0 * k);
        if (g == TEETH) points[2 * k + 1] = 2e-4 * (k % 2);
    }
}

/* A turned block of rubber that comes down and along. */
static dem_lattice make_block(const kind *k)
{
    static const double down[2] = {1.5, -4.0};
    const dem_material rubber =
        SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 1050.0, .thickness = 1.0,
              .guard = 0.02, .damping_time = k->damping_time);
    dem_lattice l = support_rectangle(0.07, 0.045, spacing, &rubber);
    dem_lattice_move(&l, 0.02, (double[]){0.0, 0.0});
    dem_lattice_move(&l, 0.0, (double[]){0.0, 2e-4 - support_bottom(&l) + (k->ground == PLANE ? 0.0 : 3e-4)});
    if (!k->is_dropped) assert_ok(dem_lattice_launch(&l, down));
    return l;
}

/* A force on nodes that touch and on others; or some that are near what touches, and do not themselves, keep their
 * speed. */
static void drive(scene *s, const dem_lattice *l, bool by_force)
{
    dem_index n = 0;
    s->driven = malloc((size_t)l->n_nodes * sizeof *s->driven);
    for (dem_index i = 0; i < l->n_nodes; i++) {
        const bool touches = dem_model_lattice(s->model)->flags[i] & DEM_NODE_CONTACT;
        if (by_force ? l->x[2 * i] < -0.02 : !touches && l->x[2 * i + 1] < 0.012 && fabs(l->x[2 * i]) < 0.01)
            s->driven[n++] = i;
    }
    s->drive = (dem_boundary)SIZED(dem_boundary, .kind = by_force ? DEM_BOUNDARY_FORCE : DEM_BOUNDARY_VELOCITY,
                                   .components = DEM_COMPONENT_X | DEM_COMPONENT_Y, .n_nodes = n, .nodes = s->driven,
                                   .value = {1.5, -4.0, 0.0});
    if (by_force) vec2_put(s->drive.value, 0, (vec2){900.0, -3000.0});
    if (by_force) s->drive.ramp = 1e-4;
    s->options.boundaries = &s->drive;
    s->options.n_boundaries = 1;
}

/* \param height  m, by how much it is lifted */
static void open_scene(scene *s, const kind *k, dem_method method, double height)
{
    double points[2 * FLOOR_POINTS];
    dem_obstacle floor = SIZED(dem_obstacle, .n_points = FLOOR_POINTS, .points = points, .restitution = k->restitution,
                               .friction = k->friction);
    if (k->ground == SHAKEN) {
        floor.amplitude[1] = 1e-4;
        floor.frequency = 2000.0;
    }
    CLEANUP(dem_lattice_free) dem_lattice l = make_block(k);
    make_floor(k->ground == SHAKEN ? BUMPS : k->ground, points);
    dem_lattice_move(&l, 0.0, (double[]){0.0, height});
    *s = (scene){.model = support_model(&l, &floor, 1), .options = dem_options_default(), .t_end = 4e-4};
    s->options.method = method;
    s->options.contact = k->contact;
    s->options.mass_damping = k->mass_damping;
    s->options.checkpoint_steps = 40;
    s->options.gravity[1] = k->is_dropped ? -1.6e4 : -9.81;
    if (k->ground == BUMPS || k->ground == SHAKEN) drive(s, &l, k->ground == BUMPS);
}

static void close_scene(scene *s)
{
    dem_model_destroy(s->model);
    free(s->driven);
}

/* ---- runs ---- */

/* All that is seen at a stop, but for the nodes. */
typedef struct view {
    double t, step;
    dem_counts counts;
    double totals[STATE_TOTALS], sums[3]; /* J */
    dem_energy energy;
    dem_obstacle_load load;
    dem_index n_contacts;
    dem_contact first, last;
} view;

typedef struct outcome {
    view stops[N_STOPS];
    double *x, *v; /* [N_STOPS][n_nodes][2] of the whole */
    dem_index n_nodes, n_events, capacity;
    dem_event *events;
    bool asks;            /* at every event what is seen then, */
    view *at_events;      /* [n_events] which is here; NULL: it does not */
    dem_checkpoint *kept; /* the first one with a closed contact; NULL: there was none, or it is not looked for */
    double kept_t;        /* s */
    dem_index n_steps, n_frames; /* that observers have seen */
    double n_common[2];          /* nodes of others that a rank integrates, at most, at the start and at the end */
    char failure[TEXT];          /* empty: none */
} outcome;

static void make_outcome(outcome *o, dem_index n)
{
    *o = (outcome){.n_nodes = n};
    o->x = calloc(2 * N_STOPS * (size_t)n, sizeof *o->x);
    o->v = calloc(2 * N_STOPS * (size_t)n, sizeof *o->v);
}

static void free_outcome(outcome *o)
{
    free(o->x);
    free(o->v);
    free(o->events);
    free(o->at_events);
    dem_checkpoint_destroy(o->kept);
}

static dem_status look_at_contacts(const dem_simulation *s, view *to)
{
    to->load.struct_size = sizeof to->load;
    to->first.struct_size = to->last.struct_size = sizeof to->first;
    dem_status status = dem_simulation_obstacle(s, 0, &to->load);
    if (status == DEM_OK && to->n_contacts > 0) status = dem_simulation_contact(s, 0, &to->first);
    if (status == DEM_OK && to->n_contacts > 0) status = dem_simulation_contact(s, to->n_contacts - 1, &to->last);
    return status;
}

/* \param[out] x, v  as they are seen */
static dem_status look_at_all(const dem_simulation *s, view *to, const double **x, const double **v)
{
    dem_state state = {.struct_size = sizeof state};
    to->counts.struct_size = sizeof to->counts;
    dem_status status = dem_simulation_state(s, &state);
    if (status == DEM_OK) status = dem_simulation_counts(s, &to->counts);
    to->energy.struct_size = sizeof to->energy;
    if (status == DEM_OK) status = dem_simulation_energy(s, &to->energy);
    if (status != DEM_OK) return status;
    const contact_ledger *ledger = &(s->leads != NULL ? led_run_part(s->leads) : s)->automaton.set.ledger;
    const exact_sum *sums[] = {&ledger->impact, &ledger->projection, &ledger->work};
    to->t = state.t;
    to->step = state.step;
    to->n_contacts = state.n_contacts;
    for (int k = 0; k < 3; k++) to->sums[k] = exact_sum_value(sums[k]);
    for (int k = 0; k < STATE_TOTALS; k++)
        if (k != STATE_OBSTACLE || state_has_total(&s->layout, STATE_OBSTACLE))
            to->totals[k] = state_total_of(&s->layout, s->seen, (state_total)k);
    *x = state.x;
    *v = state.v;
    return look_at_contacts(s, to);
}

/* Ranks write the rows of their own nodes. */
static dem_status look(const dem_simulation *s, const domain *d, outcome *o, int stop)
{
    const dem_index first = 2 * stop * o->n_nodes;
    const double *x, *v;
    const dem_status status = look_at_all(s, &o->stops[stop], &x, &v);
    for (dem_index i = 0; i < s->layout.n_nodes && status == DEM_OK; i++) {
        if (d != NULL && !d->is_own[i]) continue;
        memcpy(o->x + first + 2 * domain_number(d, i), x + 2 * i, 2 * sizeof *x);
        memcpy(o->v + first + 2 * domain_number(d, i), v + 2 * i, 2 * sizeof *v);
    }
    return status;
}

static dem_status note_event(void *context, const dem_simulation *s, const dem_event *event)
{
    outcome *o = context;
    const double *x, *v;
    if (o->n_events == o->capacity) {
        o->capacity = 2 * o->capacity + 64;
        o->events = realloc(o->events, (size_t)o->capacity * sizeof *o->events);
        if (o->asks) o->at_events = realloc(o->at_events, (size_t)o->capacity * sizeof *o->at_events);
    }
    o->events[o->n_events++] = *event;
    if (!o->asks) return DEM_OK;
    view *to = memset(&o->at_events[o->n_events - 1], 0, sizeof *to);
    return look_at_all(s, to, &x, &v);
}

static dem_status count_step(void *context, const dem_simulation *s)
{
    (void)s;
    ((outcome *)context)->n_steps++;
    return DEM_OK;
}

static dem_status count_frame(void *context, const dem_simulation *s)
{
    (void)s;
    ((outcome *)context)->n_frames++;
    return DEM_OK;
}

static double count_common(const dem_simulation *s, bool is_led)
{
    double least[RANK_SHARES_ALL], most[RANK_SHARES_ALL] = {0.0};
    if (is_led) dem_private_shares(s, least, most);
    return most[RANK_SHARES_COMMON];
}

static dem_status keep_checkpoint(void *context, const dem_simulation *s, dem_checkpoint *checkpoint)
{
    outcome *o = context;
    dem_state state = {.struct_size = sizeof state};
    const dem_status status = dem_simulation_state(s, &state);
    if (status != DEM_OK || o->kept != NULL || state.n_contacts == 0) return status;
    o->kept_t = state.t;
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
        SIZED(dem_observer, .context = o, .interval = sc->t_end / 29.0, .frame = count_frame, .step = count_step,
              .event = note_event, .checkpoint = o->asks ? keep_checkpoint : NULL);
    dem_status status = from != NULL ? dem_simulation_resume(&s, model, &sc->options, checkpoint)
                                     : dem_simulation_create(&s, model, &sc->options);
    if (status == DEM_OK && leads != NULL) status = dem_private_lead(s, leads, &sc->options, checkpoint);
    if (status == DEM_OK) status = dem_simulation_observe(s, &observer);
    if (status == DEM_OK) o->n_common[0] = count_common(s, leads != NULL);
    for (int k = 0; k < N_STOPS && status == DEM_OK; k++) {
        const double t = sc->t_end * (k + 1) / N_STOPS;
        if (from != NULL && t < from->kept_t) continue;
        status = dem_simulation_advance(s, t);
        if (status == DEM_OK) status = look(s, model->domain, o, k);
    }
    if (status == DEM_OK) o->n_common[1] = count_common(s, leads != NULL);
    dem_simulation_destroy(s);
    return status;
}

static dem_status run(const dem_model *model, const scene *sc, outcome *o)
{
    return run_led(model, sc, NULL, NULL, o);
}

/* Of all ranks. */
typedef struct shared_run {
    const scene *scene;
    const int32_t *owner;
    int n_rings;       /* of ghosts */
    outcome *outcomes; /* [ranks] whose x and v are one */
} shared_run;

static void run_rank(const ranks *r, void *context)
{
    shared_run *c = context;
    dem_model *model = NULL;
    outcome *o = &c->outcomes[r->rank];
    dem_status status = domain_model_create(&model, r, c->scene->model,
                                            &(domain_model_shares){.owner = c->owner, .n_rings = c->n_rings});
    if (status == DEM_OK) status = run(model, c->scene, o);
    if (status != DEM_OK) (void)snprintf(o->failure, TEXT, "%s", dem_status_message());
    dem_model_destroy(model);
}

static void assert_same_outcome(const outcome *one, const outcome *whole)
{
    const size_t size = 2 * N_STOPS * (size_t)whole->n_nodes * sizeof *whole->x;
    assert_string_equal(one->failure, "");
    for (int k = 0; k < N_STOPS; k++) assert_memory_equal(&one->stops[k], &whole->stops[k], sizeof one->stops[k]);
    assert_memory_equal(one->x, whole->x, size);
    assert_memory_equal(one->v, whole->v, size);
    assert_int_equal(one->n_events, whole->n_events);
    for (dem_index k = 0; k < whole->n_events; k++)
        assert_memory_equal(&one->events[k], &whole->events[k], sizeof *whole->events);
}

static void share(const scene *s, int n_rings, int n_ranks, const int32_t *owner, const outcome *whole)
{
    outcome all[MOST_RANKS];
    make_outcome(&all[0], whole->n_nodes);
    for (int k = 1; k < n_ranks; k++) all[k] = all[0];
    shared_run c = {s, owner, n_rings, all};
    rank_threads_run(n_ranks, run_rank, &c);
    for (int k = 0; k < n_ranks; k++) assert_same_outcome(&all[k], whole);
    for (int k = 1; k < n_ranks; k++) free(all[k].events);
    free_outcome(&all[0]);
}

/* In scattered tiles, and in compact domains where there is more than one number of ranks. */
static void check(const kind *k, dem_method method, int n, const int *numbers)
{
    scene s;
    outcome whole;
    open_scene(&s, k, method, 0.0);
    const dem_lattice *l = dem_model_lattice(s.model);
    CLEANUP(free_memory) int32_t *owner = malloc((size_t)l->n_nodes * sizeof *owner);
    make_outcome(&whole, l->n_nodes);
    assert_ok(run(s.model, &s, &whole));
    assert_true(whole.n_events > 30);
    for (int p = 0; p < n; p++) {
        scatter(l, 4.1 * spacing, numbers[p], owner);
        share(&s, STEP_RINGS, numbers[p], owner, &whole);
        if (n == 1) continue;
        assert_ok(partition_bisect(l, numbers[p], owner));
        share(&s, numbers[p] % 2 == 0 ? STEP_RINGS : 1, numbers[p], owner, &whole);
    }
    free_outcome(&whole);
    close_scene(&s);
}

/* By both methods of contact. */
static void check_both(kind k)
{
    static const int all[] = {1, 2, 3, 4, 7}, three = 3;
    for (int exact = 0; exact < 2; exact++) {
        k.contact = exact ? DEM_CONTACT_EXACT : DEM_CONTACT_LOCAL;
        for (int m = 0; m < 4; m++) {
            const bool is_short = !is_long && exact + m > 0;
            check(&k, methods[m], is_short ? 1 : 5, is_short ? &three : all);
        }
    }
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
        assert_int_equal(dem_private_follow(r), 75);
        return;
    }
    if (run_led(c->scene->model, c->scene, r, c->from, c->led) != DEM_OK)
        (void)snprintf(c->led->failure, TEXT, "%s", dem_status_message());
    dem_private_dismiss(r, 75);
}

/* What is seen at events, too. A run that goes on has the last events and stops of one that does not. */
static void assert_same_led(const outcome *led, const outcome *whole, bool is_resumed)
{
    const dem_index before = whole->n_events - led->n_events;
    assert_string_equal(led->failure, "");
    assert_true(is_resumed ? before > 0 && led->n_events > 0 : before == 0);
    if (!is_resumed) assert_true(led->n_steps == whole->n_steps && led->n_frames == whole->n_frames);
    for (dem_index k = 0; k < led->n_events; k++) {
        assert_memory_equal(&led->events[k], &whole->events[before + k], sizeof *whole->events);
        assert_memory_equal(&led->at_events[k], &whole->at_events[before + k], sizeof *whole->at_events);
    }
    for (int k = 0; k < N_STOPS; k++) {
        const size_t first = 2 * (size_t)k * (size_t)whole->n_nodes, size = 2 * (size_t)whole->n_nodes * sizeof(double);
        if (is_resumed && whole->stops[k].t < whole->kept_t) continue;
        assert_memory_equal(&led->stops[k], &whole->stops[k], sizeof led->stops[k]);
        assert_memory_equal(led->x + first, whole->x + first, size);
        assert_memory_equal(led->v + first, whole->v + first, size);
    }
}

/* \return by how much more nodes a rank has as common ones at the end */
static double lead(const scene *s, int n_ranks, const outcome *from, const outcome *whole)
{
    outcome led;
    make_outcome(&led, whole->n_nodes);
    led.asks = true;
    led_scene c = {s, from, &led};
    rank_threads_run(n_ranks, lead_as_rank, &c);
    assert_same_led(&led, whole, from != NULL);
    free_outcome(&led);
    return led.n_common[1] - led.n_common[0];
}

static void check_led(kind k)
{
    static const int numbers[] = {3, 1, 7};
    for (int exact = 0; exact < 2; exact++) {
        scene s;
        outcome whole;
        k.contact = exact ? DEM_CONTACT_EXACT : DEM_CONTACT_LOCAL;
        open_scene(&s, &k, DEM_METHOD_FEHLBERG45, 0.0);
        s.options.checkpoint_steps = 10;
        make_outcome(&whole, dem_model_lattice(s.model)->n_nodes);
        whole.asks = true;
        assert_ok(run(s.model, &s, &whole));
        assert_true(whole.n_events > 30 && whole.kept != NULL);
        for (int q = 0; q < (is_long ? 3 : 1); q++) {
            (void)lead(&s, numbers[q], NULL, &whole);
            (void)lead(&s, numbers[q], &whole, &whole);
        }
        free_outcome(&whole);
        close_scene(&s);
    }
}

/* Nothing is near where the body is let go, and there is no other checkpoint: at the first impact all go back there.
 * Where there are many, some are foreseen. */
TEST(a_led_run_that_goes_back_shows_nothing_twice)
{
    for (int has_many = 0; has_many < 2; has_many++) {
        scene s;
        outcome whole;
        const kind k = {.ground = BUMPS, .restitution = 0.5, .friction = 0.3, .is_dropped = true};
        open_scene(&s, &k, DEM_METHOD_FEHLBERG45, 8e-3);
        s.t_end = 1.4e-3;
        s.options.checkpoint_steps = has_many ? 25 : 100000;
        make_outcome(&whole, dem_model_lattice(s.model)->n_nodes);
        whole.asks = true;
        assert_ok(run(s.model, &s, &whole));
        assert_true(whole.n_events > 30 && whole.n_frames == 30 && whole.n_steps > 200);
        assert_true(lead(&s, 3, NULL, &whole) > 50.0);
        free_outcome(&whole);
        close_scene(&s);
    }
}

static dem_status stay(void *context, double t, dem_pose *to)
{
    (void)context;
    (void)t;
    (void)to;
    return DEM_OK;
}

TEST(a_run_with_a_motion_by_a_function_is_not_led)
{
    scene s;
    const kind k = {.ground = PLANE};
    const double points[] = {-0.5, 0.0, 0.5, 0.0};
    const dem_obstacle floor = SIZED(dem_obstacle, .n_points = 2, .points = points, .motion = stay, .most_speed = 1.0,
                                     .most_acceleration = 1.0);
    open_scene(&s, &k, DEM_METHOD_FEHLBERG45, 0.0);
    CLEANUP(dem_lattice_free) dem_lattice l = dem_lattice_empty();
    assert_ok(dem_lattice_append(&l, dem_model_lattice(s.model)));
    dem_model_destroy(s.model);
    s.model = support_model(&l, &floor, 1);
    outcome led;
    make_outcome(&led, l.n_nodes);
    led_scene c = {.scene = &s, .led = &led};
    rank_threads_run(2, lead_as_rank, &c);
    assert_string_equal(led.failure, "rank 0 cannot lead a run with obstacles whose motion a function computes");
    free_outcome(&led);
    close_scene(&s);
}

/* ---- how often ranks talk ---- */

enum { MOST_STEPS = 2000, N_TALKING = 3 };

/* One rank's run: its calls and events up to the end of each step. */
typedef struct talk {
    const scene *scene;
    const int32_t *owner;
    int n_rings; /* of ghosts */
    const ranks *ranks;
    rank_threads_counts calls[MOST_STEPS];
    dem_index n_events[MOST_STEPS];
    int n_steps;
    char failure[TEXT]; /* empty: none */
} talk;

static dem_status note_calls(void *context, const dem_simulation *s)
{
    talk *t = context;
    if (t->n_steps == MOST_STEPS) return DEM_OK;
    t->n_events[t->n_steps] = s->events;
    t->calls[t->n_steps++] = rank_threads_count(t->ranks);
    return DEM_OK;
}

static void talk_as_rank(const ranks *r, void *context)
{
    talk *t = (talk *)context + r->rank;
    dem_model *model = NULL;
    dem_simulation *s = NULL;
    const dem_observer observer = SIZED(dem_observer, .context = t, .step = note_calls);
    t->ranks = r;
    dem_status status = domain_model_create(&model, r, t->scene->model,
                                            &(domain_model_shares){.owner = t->owner, .n_rings = t->n_rings});
    if (status == DEM_OK) status = dem_simulation_create(&s, model, &t->scene->options);
    if (status == DEM_OK) status = dem_simulation_observe(s, &observer);
    if (status == DEM_OK) status = dem_simulation_advance(s, t->scene->t_end);
    if (status != DEM_OK) (void)snprintf(t->failure, TEXT, "%s", dem_status_message());
    dem_simulation_destroy(s);
    dem_model_destroy(model);
}

/* One for each of three ranks.  \param[out] t  [N_TALKING]
 * \param height  m, above the place where it touches at once */
static void listen(talk *t, dem_method method, int n_rings, double height)
{
    scene s;
    const kind k = {.ground = PLANE, .restitution = 0.5};
    open_scene(&s, &k, method, height);
    s.options.checkpoint_steps = 0;
    const dem_lattice *l = dem_model_lattice(s.model);
    CLEANUP(free_memory) int32_t *owner = malloc((size_t)l->n_nodes * sizeof *owner);
    assert_ok(partition_bisect(l, N_TALKING, owner));
    for (int q = 0; q < N_TALKING; q++) t[q] = (talk){.scene = &s, .owner = owner, .n_rings = n_rings};
    rank_threads_run(N_TALKING, talk_as_rank, t);
    for (int q = 0; q < N_TALKING; q++) {
        assert_string_equal(t[q].failure, "");
        t[q].scene = NULL;
        t[q].owner = NULL;
    }
    assert_in_range(t->n_steps, 10, MOST_STEPS - 1);
    close_scene(&s);
}

/* From its second step on, as the first evaluates where it begins. Where nothing happens it is what a free body needs.
 * A step with events needs the ghosts at its end, and whether observers have failed at one; the next step the norm of
 * the state that events have changed, and fixed steps how stiff it is, for which RK4 needs the ghosts again. */
TEST(events_cost_a_few_calls_a_step_however_many_there_are)
{
    static const int n_exchanges[] = {6, 6, 4, 1, 1}, after_events[] = {2, 2, 3, 1, 2};
    for (int m = 0; m < 5; m++)
        for (int is_high = 0; is_high < 2; is_high++) {
            static talk all[N_TALKING];
            const talk *t = &all[0];
            const bool has_rings = m == 4; /* Fehlberg's pair again */
            int n_busy = 0;
            listen(all, methods[has_rings ? 0 : m], has_rings ? STEP_RINGS : 1, is_high ? 0.1 : 0.0);
            for (int k = 2; k < t->n_steps; k++) {
                const bool busy = t->n_events[k] > t->n_events[k - 1],
                           was_busy = t->n_events[k - 1] > t->n_events[k - 2];
                n_busy += busy;
                assert_int_equal(t->calls[k].exchanges - t->calls[k - 1].exchanges,
                                 n_exchanges[m] + busy + (was_busy && m == 2));
                assert_int_equal(t->calls[k].reductions - t->calls[k - 1].reductions,
                                 1 + busy + (was_busy ? after_events[m] : 0));
            }
            assert_true(is_high ? n_busy == 0 : n_busy > 10);
        }
}

/* ---- what stops a run ---- */

/* What each rank has: one alone watches events, and may stop at one. */
typedef struct stopped_run {
    const scene *scene;
    const int32_t *owner;
    dem_status status[MOST_RANKS];
    dem_counts counts[MOST_RANKS];
    char messages[MOST_RANKS][TEXT];
    int n_seen, last; /* events, and the one at which the run is stopped */
} stopped_run;

static dem_status stop_at_last(void *context, const dem_simulation *s, const dem_event *event)
{
    stopped_run *c = context;
    (void)s;
    (void)event;
    return ++c->n_seen == c->last ? DEM_STOPPED : DEM_OK;
}

static dem_status run_until_stopped(const dem_model *model, stopped_run *c, int rank)
{
    dem_simulation *s = NULL;
    const dem_observer observer = SIZED(dem_observer, .context = c, .event = rank == 0 ? stop_at_last : NULL);
    dem_status status = dem_simulation_create(&s, model, &c->scene->options);
    if (status == DEM_OK) status = dem_simulation_observe(s, &observer);
    if (status == DEM_OK) status = dem_simulation_advance(s, c->scene->t_end);
    c->counts[rank].struct_size = sizeof c->counts[rank];
    if (s != NULL) (void)dem_simulation_counts(s, &c->counts[rank]);
    dem_simulation_destroy(s);
    return status;
}

static void stop_rank(const ranks *r, void *context)
{
    stopped_run *c = context;
    dem_model *model = NULL;
    dem_status status = domain_model_create(&model, r, c->scene->model, &(domain_model_shares){.owner = c->owner});
    if (status == DEM_OK) status = run_until_stopped(model, c, r->rank);
    c->status[r->rank] = status;
    (void)snprintf(c->messages[r->rank], TEXT, "%s", status != DEM_OK ? dem_status_message() : "");
    dem_model_destroy(model);
}

/* All ranks of four end as a process alone does. */
static void assert_same_end(const scene *s, int last, dem_status expected)
{
    const dem_lattice *l = dem_model_lattice(s->model);
    CLEANUP(free_memory) int32_t *owner = malloc((size_t)l->n_nodes * sizeof *owner);
    stopped_run one = {.scene = s, .last = last}, all = {.scene = s, .last = last, .owner = owner};
    assert_int_equal(run_until_stopped(s->model, &one, 0), expected);
    (void)snprintf(one.messages[0], TEXT, "%s", expected != DEM_STOPPED ? dem_status_message() : "");
    assert_ok(partition_bisect(l, 4, owner));
    rank_threads_run(4, stop_rank, &all);
    for (int k = 0; k < 4; k++) {
        assert_int_equal(all.status[k], expected);
        assert_memory_equal(&all.counts[k], &one.counts[0], sizeof one.counts[0]);
        if (expected != DEM_STOPPED) assert_string_equal(all.messages[k], one.messages[0]);
    }
    assert_int_equal(all.n_seen, one.n_seen);
}

TEST(an_event_that_one_rank_watches_stops_all)
{
    for (int exact = 0; exact < 2; exact++) {
        scene s;
        const kind k = {.ground = PLANE, .contact = exact ? DEM_CONTACT_EXACT : DEM_CONTACT_LOCAL, .restitution = 0.5};
        open_scene(&s, &k, DEM_METHOD_FEHLBERG45, 0.0);
        assert_same_end(&s, 10, DEM_STOPPED);
        close_scene(&s);
    }
}

/* Messages have the numbers of nodes in the whole. */
TEST(what_starts_inside_an_obstacle_is_refused_by_all)
{
    scene s;
    const kind k = {.ground = PLANE, .restitution = 0.5};
    open_scene(&s, &k, DEM_METHOD_FEHLBERG45, -1e-3);
    assert_same_end(&s, 0, DEM_ERROR_MODEL);
    close_scene(&s);
}

/* With `local` steps are tried again, shorter, before the run ends. */
TEST(too_many_impacts_end_the_run_of_all)
{
    for (int exact = 0; exact < 2; exact++) {
        scene s;
        const kind k = {.ground = BUMPS,
                        .contact = exact ? DEM_CONTACT_EXACT : DEM_CONTACT_LOCAL,
                        .restitution = 0.9,
                        .friction = 0.3};
        open_scene(&s, &k, DEM_METHOD_FEHLBERG45, 0.0);
        s.options.max_impacts = 1;
        s.options.window = 0.0;
        assert_same_end(&s, 0, DEM_ERROR_CONTACT);
        close_scene(&s);
    }
}

/* ---- the same bits ---- */

TEST(impacts_on_a_plane_have_the_bits_of_one_process)
{
    check_both((kind){.ground = PLANE, .restitution = 1.0});
}

TEST(rest_and_friction_on_bumps_have_the_bits_of_one_process)
{
    check_both((kind){.ground = BUMPS, .restitution = 0.5, .friction = 0.3});
}

TEST(groups_on_teeth_have_the_bits_of_one_process)
{
    check_both((kind){.ground = TEETH, .friction = 0.3});
}

TEST(damped_bodies_on_a_shaken_floor_have_the_bits_of_one_process)
{
    check_both(
        (kind){.ground = SHAKEN, .restitution = 0.3, .friction = 0.5, .damping_time = 5e-6, .mass_damping = 200.0});
}

TEST(a_led_run_shows_contacts_and_events_of_one_process)
{
    check_led((kind){.ground = BUMPS, .restitution = 0.5, .friction = 0.3});
}

TEST(a_led_run_shows_what_a_shaken_floor_does)
{
    check_led((kind){.ground = SHAKEN, .restitution = 0.3, .friction = 0.5});
}

int main(int argc, char **argv)
{
    is_long = argc > 1 && strcmp(argv[1], "long") == 0;
    return test_run();
}
