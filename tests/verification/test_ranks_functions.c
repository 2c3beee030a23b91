/* SPDX-License-Identifier: BSD-3-Clause */
/* Functions of the program on ranks that are threads: external forces, and motions of obstacles. Motion, ledger, loads,
 * events and failures have the bits of the whole model in one process, whatever the shares; functions that answer
 * otherwise on one rank are found out. */
#include <stdio.h>
#include <string.h>

#include "scattered.h"
#include "support.h"

#include "base/checkpoint_entries.h"
#include "domain/partition.h"
#include "harness/rank_threads.h"
#include "model/domain_model.h"
#include "simulation/led_run.h"

enum { MOST_RANKS = 7, N_STOPS = 2, TEXT = 256, FLOOR_POINTS = 31, MOST_HELD = 64 };

static const double spacing = 4e-3, t_end = 4e-4;
static const dem_method methods[] = {DEM_METHOD_FEHLBERG45, DEM_METHOD_DOPRI45, DEM_METHOD_RK4, DEM_METHOD_VERLET};

/* ---- functions ---- */

/* What they return, and how they fail. One rank has another object than the others. */
typedef struct field {
    double mass;          /* kg, of a node */
    double fails_at;      /* s; infinity: never */
    dem_index bad;        /* node whose force is not finite from then on; -1: the status is returned then */
    double shift;         /* s, by which an obstacle is ahead */
    dem_index ghosts;     /* nodes asked about that another rank integrates alone */
    const domain *domain; /* NULL: all are here */
} field;

/* A node that is not integrated here is asked about once, before the run. */
static void count_ghosts(field *f, const dem_force_query *q)
{
    for (dem_index k = 0; k < q->n && f->domain != NULL; k++) f->ghosts += domain_node(f->domain, q->nodes[k]) < 0;
}

/* It depends on number, place, velocity and time. */
static dem_status push(void *context, const dem_force_query *q, double *force)
{
    field *f = context;
    if (q->t > 0.0) count_ghosts(f, q);
    for (dem_index k = 0; k < q->n; k++) {
        const double phase = 3e4 * q->t + 0.1 * (double)q->nodes[k];
        force[2 * k] = f->mass * (4e3 * sin(phase) + 2e5 * q->x[2 * k + 1] - 700.0 * q->v[2 * k]);
        force[2 * k + 1] = f->mass * (-2e3 - 2e5 * q->x[2 * k] + 300.0 * q->v[2 * k] + f->shift);
        if (q->t >= f->fails_at && q->nodes[k] == f->bad) force[2 * k] = (double)NAN;
    }
    return q->t >= f->fails_at && f->bad < 0 ? DEM_STOPPED : DEM_OK;
}

/* Up and down, turning to and fro. */
static dem_status shake(void *context, double t, dem_pose *to)
{
    const field *f = context;
    const double w = 1.2e4, s = sin(w * (t + f->shift)), c = cos(w * (t + f->shift));
    to->place[1] = 1e-4 * s;
    to->velocity[1] = 1e-4 * w * c;
    to->acceleration[1] = -1e-4 * w * w * s;
    to->angle = 1e-3 * s;
    to->spin = 1e-3 * w * c;
    to->spin_rate = -1e-3 * w * w * s;
    return DEM_OK;
}

/* ---- scenes ---- */

typedef enum kind { FREE, HELD, DAMPED, LANDING, SHAKEN } kind;

typedef struct scene {
    dem_model *model;
    dem_options options;
    field field;
    dem_index held[MOST_HELD];
    dem_boundary hold;
} scene;

static void hold_left(scene *s, const dem_lattice *l)
{
    dem_index n = 0;
    for (dem_index i = 0; i < l->n_nodes; i++)
        if (l->x[2 * i] < -0.026) s->held[n++] = i;
    assert_true(n > 3 && n <= MOST_HELD);
    s->hold = (dem_boundary)SIZED(dem_boundary, .kind = DEM_BOUNDARY_VELOCITY, .components = DEM_COMPONENT_X,
                                  .n_nodes = n, .nodes = s->held, .value = {0.5, 0.0, 0.0}, .ramp = 1e-4);
    s->options.boundaries = &s->hold;
    s->options.n_boundaries = 1;
}

static void make_floor(double *points)
{
    for (int k = 0; k < FLOOR_POINTS; k++) {
        points[2 * k] = 4e-3 * (k - FLOOR_POINTS / 2);
        points[2 * k + 1] = 3e-4 * sin(2.0 * k);
    }
}

static void open_scene(scene *s, kind what, dem_method method, dem_contact_method contact)
{
    static const double down[2] = {1.5, -4.0};
    double points[2 * FLOOR_POINTS];
    const dem_material rubber =
        SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 1050.0, .thickness = 1.0,
              .guard = 0.02, .damping_time = what == DAMPED ? 2e-5 : 0.0);
    dem_obstacle floor =
        SIZED(dem_obstacle, .n_points = FLOOR_POINTS, .points = points, .restitution = 0.5, .friction = 0.3);
    CLEANUP(dem_lattice_free) dem_lattice l = support_rectangle(0.06, 0.04, spacing, &rubber);
    make_floor(points);
    dem_lattice_move(&l, 0.02, (double[]){0.0, 0.0});
    dem_lattice_move(&l, 0.0, (double[]){0.0, 7e-4 - support_bottom(&l)});
    assert_ok(dem_lattice_launch(&l, down));
    *s = (scene){.options = dem_options_default()};
    s->field = (field){.mass = l.mass[l.n_nodes / 2], .fails_at = (double)INFINITY, .bad = -1};
    if (what == SHAKEN) {
        floor.motion = shake;
        floor.motion_context = &s->field;
        floor.most_speed = 3.0;
        floor.most_acceleration = 3e4;
    }
    s->model = support_model(&l, &floor, what >= LANDING);
    s->options.method = method;
    s->options.contact = contact;
    s->options.checkpoint_steps = 20;
    if (method == DEM_METHOD_DOPRI45) { /* a team of threads on each rank, too */
        s->options.threads = 2;
        s->options.thread_nodes = 20;
    }
    if (what == DAMPED) s->options.mass_damping = 300.0;
    if (what != SHAKEN || contact == DEM_CONTACT_EXACT) s->options.force = push;
    s->options.force_context = &s->field;
    if (what == HELD) hold_left(s, &l);
}

static void close_scene(scene *s)
{
    dem_model_destroy(s->model);
}

/* ---- runs ---- */

typedef struct view {
    double t, step;
    dem_counts counts;
    dem_energy energy;
    dem_obstacle_load obstacle;
    dem_boundary_load boundary;
} view;

typedef struct outcome {
    view stops[N_STOPS];
    double *x, *v; /* [n_nodes][2] at the end, of the whole */
    dem_index n_events;
    uint64_t events;      /* a hash of all that is said of them */
    dem_index ghosts;     /* that the force was asked for */
    dem_status status;    /* of the first advance that has failed; then the run goes on with functions that do not */
    double failed_t;      /* s, of the state after it */
    char message[TEXT];   /* of the same */
    char failure[TEXT];   /* that is none of the functions; empty: none */
    dem_checkpoint *kept; /* the third one; NULL: elsewhere than on rank 0 */
    int n_checkpoints;
} outcome;

static void make_outcome(outcome *o, dem_index n)
{
    *o = (outcome){.x = calloc(2 * (size_t)n, sizeof *o->x), .v = calloc(2 * (size_t)n, sizeof *o->v)};
}

static void free_outcome(outcome *o)
{
    dem_checkpoint_destroy(o->kept);
    free(o->x);
    free(o->v);
}

/* By Fowler, Noll and Vo. */
static dem_status note_event(void *context, const dem_simulation *s, const dem_event *event)
{
    outcome *o = context;
    const unsigned char *bytes = (const unsigned char *)event;
    (void)s;
    for (size_t k = 0; k < sizeof *event; k++) o->events = (o->events ^ bytes[k]) * 1099511628211u;
    o->n_events++;
    return DEM_OK;
}

static dem_status keep_checkpoint(void *context, const dem_simulation *s, dem_checkpoint *checkpoint)
{
    outcome *o = context;
    if (++o->n_checkpoints != 3 || dem_simulation_model(s)->ranks->rank > 0) return DEM_OK;
    assert_ok(dem_checkpoint_create(&o->kept));
    return checkpoint_entries_copy(o->kept, checkpoint);
}

/* Ranks write the rows of their own nodes. */
static dem_status look(const dem_simulation *s, outcome *o, int stop)
{
    view *to = &o->stops[stop];
    const dem_model *model = dem_simulation_model(s);
    dem_state state = {.struct_size = sizeof state};
    to->counts.struct_size = sizeof to->counts;
    to->energy.struct_size = sizeof to->energy;
    to->obstacle.struct_size = sizeof to->obstacle;
    to->boundary.struct_size = sizeof to->boundary;
    dem_status status = dem_simulation_state(s, &state);
    if (status == DEM_OK) status = dem_simulation_counts(s, &to->counts);
    if (status == DEM_OK) status = dem_simulation_energy(s, &to->energy);
    if (status == DEM_OK && model->obstacles.n > 0) status = dem_simulation_obstacle(s, 0, &to->obstacle);
    if (status == DEM_OK && s->options.n_boundaries > 0) status = dem_simulation_boundary(s, 0, &to->boundary);
    to->t = state.t;
    to->step = state.step;
    for (dem_index i = 0; i < model->lattice.n_nodes && status == DEM_OK; i++) {
        if (!domain_owns(model->domain, i)) continue;
        memcpy(o->x + 2 * domain_number(model->domain, i), state.x + 2 * i, 2 * sizeof *state.x);
        memcpy(o->v + 2 * domain_number(model->domain, i), state.v + 2 * i, 2 * sizeof *state.v);
    }
    return status;
}

/* To a stop; after a failure of a function from where that has left the run. */
static dem_status advance(dem_simulation *s, field *f, double t, outcome *o)
{
    dem_state state = {.struct_size = sizeof state};
    dem_status status = dem_simulation_advance(s, t);
    if (status == DEM_OK || f->fails_at == (double)INFINITY) return status;
    o->status = status;
    (void)snprintf(o->message, TEXT, "%s", dem_status_message());
    f->fails_at = (double)INFINITY;
    status = dem_simulation_state(s, &state);
    o->failed_t = state.t;
    return status == DEM_OK ? dem_simulation_advance(s, t) : status;
}

/* With functions that have the context of a field of this rank.
   \param from   a checkpoint, of rank 0; NULL: the run begins
   \param leads  ranks that make the run of rank 0, which has the whole; NULL: it makes its own */
static void run(const dem_model *model, const scene *sc, field *f, const dem_checkpoint *from, const ranks *leads,
                outcome *o)
{
    dem_simulation *s = NULL;
    dem_options options = sc->options;
    const dem_observer observer = SIZED(dem_observer, .context = o, .event = note_event, .checkpoint = keep_checkpoint);
    options.force_context = f;
    f->domain = model->domain;
    dem_status status =
        from != NULL ? dem_simulation_resume(&s, model, &options, from) : dem_simulation_create(&s, model, &options);
    if (status == DEM_OK && leads != NULL) status = dem_private_lead(s, leads, &options, NULL);
    if (status == DEM_OK) status = dem_simulation_observe(s, &observer);
    for (int k = from != NULL ? N_STOPS - 1 : 0; k < N_STOPS && status == DEM_OK; k++) {
        status = advance(s, f, t_end * (k + 1) / N_STOPS, o);
        if (status == DEM_OK) status = look(s, o, k);
    }
    if (status != DEM_OK) (void)snprintf(o->failure, TEXT, "%s", dem_status_message());
    o->ghosts = f->ghosts;
    dem_simulation_destroy(s);
}

/* Of all ranks. */
typedef struct shared_run {
    const scene *scene;
    const int32_t *owner;
    const dem_checkpoint *from;
    outcome *outcomes; /* [ranks] whose x and v are one */
    int other;         /* rank whose functions answer otherwise; -1: none */
} shared_run;

/* The model has obstacles with a context of this rank. */
static void run_rank(const ranks *r, void *context)
{
    shared_run *c = context;
    const dem_model *all = c->scene->model;
    outcome *o = &c->outcomes[r->rank];
    dem_model *whole = NULL, *part = NULL;
    field f = c->scene->field;
    dem_obstacle floor = {0};
    if (all->obstacles.n > 0) floor = all->obstacles.list[0];
    if (floor.motion != NULL) floor.motion_context = &f;
    if (r->rank == c->other) f.shift = 1e-6;
    dem_status status = dem_model_create(&whole, &all->lattice, &floor, all->obstacles.n);
    if (status == DEM_OK) status = domain_model_create(&part, r, whole, &(domain_model_shares){.owner = c->owner});
    if (status == DEM_OK) run(part, c->scene, &f, c->from, NULL, o);
    if (status != DEM_OK) (void)snprintf(o->failure, TEXT, "%s", dem_status_message());
    dem_model_destroy(part);
    dem_model_destroy(whole);
}

/* ---- comparison ---- */

static void assert_same_outcome(const outcome *one, const outcome *whole, dem_index n)
{
    const size_t size = 2 * (size_t)n * sizeof *whole->x;
    assert_string_equal(one->failure, "");
    assert_string_equal(one->message, whole->message);
    assert_int_equal(one->status, whole->status);
    assert_true(one->failed_t == whole->failed_t);
    assert_memory_equal(one->stops, whole->stops, sizeof one->stops);
    assert_memory_equal(one->x, whole->x, size);
    assert_memory_equal(one->v, whole->v, size);
    assert_int_equal(one->n_events, whole->n_events);
    assert_true(one->events == whole->events);
    assert_int_equal(one->ghosts, 0);
}

static void share(const scene *s, int n_ranks, const int32_t *owner, const outcome *whole)
{
    const dem_index n = dem_model_lattice(s->model)->n_nodes;
    outcome all[MOST_RANKS];
    make_outcome(&all[0], n);
    for (int k = 1; k < n_ranks; k++) all[k] = all[0];
    shared_run c = {.scene = s, .owner = owner, .outcomes = all, .other = -1};
    rank_threads_run(n_ranks, run_rank, &c);
    for (int k = 0; k < n_ranks; k++) assert_same_outcome(&all[k], whole, n);
    free_outcome(&all[0]);
}

/* In scattered tiles, and in compact domains where there is more than one number of ranks.
 * \return that of a process alone */
static outcome check_scene(scene *s, int n_numbers, const int *numbers)
{
    outcome whole;
    const dem_lattice *l = dem_model_lattice(s->model);
    CLEANUP(free_memory) int32_t *owner = malloc((size_t)l->n_nodes * sizeof *owner);
    make_outcome(&whole, l->n_nodes);
    field f = s->field;
    run(s->model, s, &f, NULL, NULL, &whole);
    assert_string_equal(whole.failure, "");
    for (int p = 0; p < n_numbers; p++) {
        scatter(l, 4.1 * spacing, numbers[p], owner);
        share(s, numbers[p], owner, &whole);
        if (n_numbers == 1) continue;
        assert_ok(partition_bisect(l, numbers[p], owner));
        share(s, numbers[p], owner, &whole);
    }
    free_outcome(&whole);
    return whole;
}

static const int some[] = {3, 1, 7};

static void check(kind what)
{
    for (int m = 0; m < 4; m++)
        for (int exact = 0; exact < (what >= LANDING ? 2 : 1); exact++) {
            scene s;
            open_scene(&s, what, methods[m], exact ? DEM_CONTACT_EXACT : DEM_CONTACT_LOCAL);
            const outcome whole = check_scene(&s, m + exact == 0 && what != DAMPED ? 3 : 1, some);
            assert_true(what < LANDING || whole.n_events > 30);
            close_scene(&s);
        }
}

TEST(a_force_on_a_free_body_has_the_same_bits)
{
    check(FREE);
}

TEST(a_force_on_a_body_that_is_held_has_the_same_bits)
{
    check(HELD);
}

TEST(a_force_on_a_damped_body_has_the_same_bits)
{
    check(DAMPED);
}

TEST(a_force_on_a_body_that_lands_has_the_same_bits)
{
    check(LANDING);
}

TEST(an_obstacle_that_a_function_moves_has_the_same_bits)
{
    check(SHAKEN);
}

/* From a checkpoint of one process, with a body that is held and with an obstacle that moves. */
TEST(ranks_go_on_with_functions_of_the_program)
{
    enum { N_RANKS = 3 };
    static const kind kinds[] = {HELD, SHAKEN};
    for (int k = 0; k < 2; k++) {
        scene s;
        outcome whole, all[N_RANKS];
        open_scene(&s, kinds[k], DEM_METHOD_FEHLBERG45, DEM_CONTACT_EXACT);
        const dem_lattice *l = dem_model_lattice(s.model);
        const size_t size = 2 * (size_t)l->n_nodes * sizeof *whole.x;
        CLEANUP(free_memory) int32_t *owner = malloc((size_t)l->n_nodes * sizeof *owner);
        make_outcome(&whole, l->n_nodes);
        make_outcome(&all[0], l->n_nodes);
        for (int q = 1; q < N_RANKS; q++) all[q] = all[0];
        run(s.model, &s, &s.field, NULL, NULL, &whole);
        assert_non_null(whole.kept);
        scatter(l, 4.1 * spacing, N_RANKS, owner);
        shared_run c = {.scene = &s, .owner = owner, .from = whole.kept, .outcomes = all, .other = -1};
        rank_threads_run(N_RANKS, run_rank, &c);
        for (int q = 0; q < N_RANKS; q++) {
            assert_string_equal(all[q].failure, "");
            assert_memory_equal(&all[q].stops[N_STOPS - 1], &whole.stops[N_STOPS - 1], sizeof whole.stops[0]);
        }
        assert_memory_equal(all[0].x, whole.x, size);
        assert_memory_equal(all[0].v, whole.v, size);
        free_outcome(&whole);
        free_outcome(&all[0]);
        close_scene(&s);
    }
}

/* ---- failures ---- */

static void fail_once(kind what, dem_method method, dem_index bad, const char *message)
{
    scene s;
    open_scene(&s, what, method, DEM_CONTACT_LOCAL);
    s.field.fails_at = 2.5e-4;
    s.field.bad = bad;
    const outcome whole = check_scene(&s, 1, some);
    assert_int_equal(whole.status, bad < 0 ? DEM_STOPPED : DEM_ERROR_INTEGRATOR);
    assert_non_null(strstr(whole.message, message));
    assert_true(whole.failed_t > 0.0 && whole.failed_t < s.field.fails_at);
    close_scene(&s);
}

/* On one rank, or on those that have the node in common. */
TEST(a_force_that_is_not_finite_on_one_rank_leaves_the_state_of_one_process)
{
    for (kind what = FREE; what <= SHAKEN - 1; what++)
        for (int m = 0; m < 4; m += 3) fail_once(what, methods[m], 101, "node 101 is not finite");
}

TEST(a_status_of_the_force_ends_the_advance_of_all_ranks)
{
    fail_once(HELD, DEM_METHOD_FEHLBERG45, -1, "the external force was refused");
    fail_once(LANDING, DEM_METHOD_VERLET, -1, "the external force was refused");
}

/* ---- functions that answer otherwise on one rank ---- */

/* \return the message, the same on all */
static void find_out(kind what, int other, char *message)
{
    enum { N_RANKS = 3 };
    scene s;
    outcome all[N_RANKS];
    open_scene(&s, what, DEM_METHOD_FEHLBERG45, DEM_CONTACT_LOCAL);
    const dem_lattice *l = dem_model_lattice(s.model);
    CLEANUP(free_memory) int32_t *owner = malloc((size_t)l->n_nodes * sizeof *owner);
    assert_ok(partition_bisect(l, N_RANKS, owner));
    make_outcome(&all[0], l->n_nodes);
    for (int k = 1; k < N_RANKS; k++) all[k] = all[0];
    rank_threads_run(N_RANKS, run_rank, &(shared_run){.scene = &s, .owner = owner, .outcomes = all, .other = other});
    for (int k = 1; k < N_RANKS; k++) assert_string_equal(all[k].failure, all[0].failure);
    (void)snprintf(message, TEXT, "%s", all[0].failure);
    free_outcome(&all[0]);
    close_scene(&s);
}

TEST(a_force_of_another_context_is_found_out)
{
    char message[TEXT];
    find_out(FREE, 1, message);
    assert_non_null(strstr(message, "the external force on node "));
    assert_non_null(strstr(message, "is another one on rank "));
}

TEST(an_obstacle_that_is_elsewhere_on_one_rank_is_found_out)
{
    char message[TEXT];
    find_out(SHAKEN, 2, message);
    assert_non_null(strstr(message, "moves obstacle 0 says otherwise on rank 2 than on rank 0 at t = 0 s"));
}

/* ---- runs that rank 0 leads ---- */

static void lead_as_rank(const ranks *r, void *context)
{
    shared_run *c = context;
    field f = c->scene->field;
    if (r->rank > 0) {
        (void)dem_private_follow(r);
        return;
    }
    run(c->scene->model, c->scene, &f, NULL, r, c->outcomes);
    dem_private_dismiss(r, 0);
}

TEST(a_run_with_an_external_force_is_not_led)
{
    scene s;
    outcome led;
    open_scene(&s, FREE, DEM_METHOD_VERLET, DEM_CONTACT_LOCAL);
    make_outcome(&led, dem_model_lattice(s.model)->n_nodes);
    rank_threads_run(2, lead_as_rank, &(shared_run){.scene = &s, .outcomes = &led});
    assert_string_equal(led.failure, "rank 0 cannot lead a run with an external force");
    free_outcome(&led);
    close_scene(&s);
}

int main(void)
{
    return test_run();
}
