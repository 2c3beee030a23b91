/* SPDX-License-Identifier: BSD-3-Clause */
/* Functions of the program on ranks that are threads: external forces, and motions of obstacles. Motion, ledger, loads,
 * events and failures have the bits of the whole model in one process, whatever the shares; functions that answer
 * otherwise on one rank are found out. */
#include <stdio.h>
#include <string.h>

#include "rank_runs.h"
#include "scattered.h"
#include "support.h"

#include "domain/partition.h"

enum { FLOOR_POINTS = 31, MOST_HELD = 64 };

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
    rank_runs_scene run;
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
    s->run.options.boundaries = &s->hold;
    s->run.options.n_boundaries = 1;
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
    *s = (scene){.run = {.options = dem_options_default(), .t_end = t_end}};
    s->field = (field){.mass = l.mass[l.n_nodes / 2], .fails_at = (double)INFINITY, .bad = -1};
    if (what == SHAKEN) {
        floor.motion = shake;
        floor.motion_context = &s->field;
        floor.most_speed = 3.0;
        floor.most_acceleration = 3e4;
    }
    s->run.model = support_model(&l, &floor, what >= LANDING);
    s->run.options.method = method;
    s->run.options.contact = contact;
    s->run.options.checkpoint_steps = 20;
    if (method == DEM_METHOD_DOPRI45) { /* a team of threads on each rank, too */
        s->run.options.threads = 2;
        s->run.options.thread_nodes = 20;
    }
    if (what == DAMPED) s->run.options.mass_damping = 300.0;
    if (what != SHAKEN || contact == DEM_CONTACT_EXACT) s->run.options.force = push;
    s->run.options.force_context = &s->field;
    if (what == HELD) hold_left(s, &l);
}

static void close_scene(scene *s)
{
    dem_model_destroy(s->run.model);
}

/* ---- runs ---- */

/* The force fails no more. */
static bool mend(const rank_runs_outcome *so_far)
{
    field *f = so_far->scene->options.force_context;
    f->fails_at = (double)INFINITY;
    return true;
}

/* With functions that have the context of a field of this rank. */
static void run(const dem_model *model, const scene *s, field *f, const ranks *leads, const rank_runs_outcome *from,
                rank_runs_outcome *o)
{
    rank_runs_scene own = s->run;
    const rank_runs_scene *const common = o->scene;
    own.options.force_context = f;
    own.mends = f->fails_at < (double)INFINITY ? mend : NULL;
    f->domain = model->domain;
    o->scene = &own;
    rank_runs_go(model, leads, from, o);
    o->scene = common;
}

static rank_runs_outcome run_alone(const scene *s)
{
    rank_runs_outcome whole = rank_runs_make_outcome(&s->run);
    field f = s->field;
    run(s->run.model, s, &f, NULL, NULL, &whole);
    return whole;
}

/* Of all ranks. */
typedef struct shared_run {
    const scene *scene;
    const int32_t *owner;
    const rank_runs_outcome *from;
    rank_runs_outcome *outcomes; /* [ranks] */
    int other;                   /* rank whose functions answer otherwise; -1: none */
    dem_index ghosts[RANK_RUNS_MOST];
} shared_run;

/* The model has obstacles with a context of this rank. */
static void run_rank(const ranks *r, void *context)
{
    shared_run *c = context;
    const dem_model *all = c->scene->run.model;
    rank_runs_outcome *o = &c->outcomes[r->rank];
    dem_model *whole = NULL, *part = NULL;
    field f = c->scene->field;
    dem_obstacle floor = {0};
    if (all->obstacles.n > 0) floor = all->obstacles.list[0];
    if (floor.motion != NULL) floor.motion_context = &f;
    if (r->rank == c->other) f.shift = 1e-6;
    dem_status status = dem_model_create(&whole, &all->lattice, &floor, all->obstacles.n);
    if (status == DEM_OK) status = domain_model_create(&part, r, whole, &(domain_model_shares){.owner = c->owner});
    if (status == DEM_OK) run(part, c->scene, &f, NULL, c->from, o);
    if (status != DEM_OK) (void)snprintf(o->message, RANK_RUNS_TEXT, "%s", dem_status_message());
    c->ghosts[r->rank] = f.ghosts;
    dem_model_destroy(part);
    dem_model_destroy(whole);
}

/* ---- comparison ---- */

static void share(const scene *s, int n_ranks, const int32_t *owner, const rank_runs_outcome *from,
                  const rank_runs_outcome *whole)
{
    rank_runs_outcome all[RANK_RUNS_MOST];
    shared_run c = {.scene = s, .owner = owner, .from = from, .outcomes = all, .other = -1};
    rank_runs_make_outcomes(&s->run, n_ranks, all);
    rank_threads_run(n_ranks, run_rank, &c);
    for (int k = 0; k < n_ranks; k++) {
        const char *what = rank_runs_difference(&all[k], whole, from);
        if (what != NULL) fail_msg("rank %d of %d has another %s: '%s'", k, n_ranks, what, all[k].message);
        if (from == NULL) assert_int_equal(c.ghosts[k], 0);
    }
    rank_runs_free_outcomes(all, n_ranks);
}

/* In scattered tiles, and in compact domains where there is more than one number of ranks.
 * \return that of a process alone, to be freed */
static rank_runs_outcome check_scene(const scene *s, int n_numbers, const int *numbers)
{
    const dem_lattice *l = dem_model_lattice(s->run.model);
    CLEANUP(free_memory) int32_t *owner = malloc((size_t)l->n_nodes * sizeof *owner);
    const rank_runs_outcome whole = run_alone(s);
    for (int p = 0; p < n_numbers; p++) {
        scatter(l, 4.1 * spacing, numbers[p], owner);
        share(s, numbers[p], owner, NULL, &whole);
        if (n_numbers == 1) continue;
        assert_ok(partition_bisect(l, numbers[p], owner));
        share(s, numbers[p], owner, NULL, &whole);
    }
    return whole;
}

static const int some[] = {3, 1, 7};

static void check(kind what)
{
    for (int m = 0; m < 4; m++)
        for (int exact = 0; exact < (what >= LANDING ? 2 : 1); exact++) {
            scene s;
            open_scene(&s, what, methods[m], exact ? DEM_CONTACT_EXACT : DEM_CONTACT_LOCAL);
            rank_runs_outcome whole = check_scene(&s, m + exact == 0 && what != DAMPED ? 3 : 1, some);
            assert_string_equal(whole.message, "");
            assert_true(what < LANDING || whole.n_notes > 30);
            rank_runs_free_outcome(&whole);
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
    static const kind kinds[] = {HELD, SHAKEN};
    for (int k = 0; k < 2; k++) {
        scene s;
        open_scene(&s, kinds[k], DEM_METHOD_FEHLBERG45, DEM_CONTACT_EXACT);
        const dem_lattice *l = dem_model_lattice(s.run.model);
        CLEANUP(free_memory) int32_t *owner = malloc((size_t)l->n_nodes * sizeof *owner);
        rank_runs_outcome whole = run_alone(&s);
        assert_non_null(whole.kept);
        scatter(l, 4.1 * spacing, 3, owner);
        share(&s, 3, owner, &whole, &whole);
        rank_runs_free_outcome(&whole);
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
    rank_runs_outcome whole = check_scene(&s, 1, some);
    assert_int_equal(whole.status, bad < 0 ? DEM_STOPPED : DEM_ERROR_INTEGRATOR);
    assert_non_null(strstr(whole.message, message));
    const double failed_t = whole.views[RANK_RUNS_STOPS].t;
    assert_true(failed_t > 0.0 && failed_t < s.field.fails_at);
    rank_runs_free_outcome(&whole);
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
    rank_runs_outcome all[N_RANKS];
    open_scene(&s, what, DEM_METHOD_FEHLBERG45, DEM_CONTACT_LOCAL);
    const dem_lattice *l = dem_model_lattice(s.run.model);
    CLEANUP(free_memory) int32_t *owner = malloc((size_t)l->n_nodes * sizeof *owner);
    assert_ok(partition_bisect(l, N_RANKS, owner));
    rank_runs_make_outcomes(&s.run, N_RANKS, all);
    rank_threads_run(N_RANKS, run_rank, &(shared_run){.scene = &s, .owner = owner, .outcomes = all, .other = other});
    for (int k = 1; k < N_RANKS; k++) assert_string_equal(all[k].message, all[0].message);
    (void)snprintf(message, RANK_RUNS_TEXT, "%s", all[0].message);
    rank_runs_free_outcomes(all, N_RANKS);
    close_scene(&s);
}

TEST(a_force_of_another_context_is_found_out)
{
    char message[RANK_RUNS_TEXT];
    find_out(FREE, 1, message);
    assert_non_null(strstr(message, "the external force on node "));
    assert_non_null(strstr(message, "is another one on rank "));
}

TEST(an_obstacle_that_is_elsewhere_on_one_rank_is_found_out)
{
    char message[RANK_RUNS_TEXT];
    find_out(SHAKEN, 2, message);
    assert_non_null(strstr(message, "moves obstacle 0 says otherwise on rank 2 than on rank 0 at t = 0 s"));
}

/* ---- runs that rank 0 leads ---- */

TEST(a_run_with_an_external_force_is_not_led)
{
    scene s;
    open_scene(&s, FREE, DEM_METHOD_VERLET, DEM_CONTACT_LOCAL);
    rank_runs_outcome led = rank_runs_make_outcome(&s.run);
    rank_runs_led(&s.run, 2, NULL, &led);
    assert_string_equal(led.message, "rank 0 cannot lead a run with an external force");
    rank_runs_free_outcome(&led);
    close_scene(&s);
}

int main(void)
{
    return test_run();
}
