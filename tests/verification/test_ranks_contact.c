/* SPDX-License-Identifier: BSD-3-Clause */
/* Ranks that share bodies which fall on obstacles, as threads: motion, quadratures, ledger, contacts and events have
 * the bits of the whole model in one process, whatever the shares. The body is large enough to have nodes that are not
 * common ones. `test_ranks_contact [long]`. */
#include <string.h>

#include "ask.h"
#include "rank_runs.h"
#include "scattered.h"
#include "support.h"

#include "domain/partition.h"
#include "simulation/private.h"

enum { STEP_RINGS = 3, FLOOR_POINTS = 61 };

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
    rank_runs_scene run;
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
        const bool touches = dem_model_lattice(s->run.model)->flags[i] & DEM_NODE_CONTACT;
        if (by_force ? l->x[2 * i] < -0.02 : !touches && l->x[2 * i + 1] < 0.012 && fabs(l->x[2 * i]) < 0.01)
            s->driven[n++] = i;
    }
    s->drive = (dem_boundary)SIZED(dem_boundary, .kind = by_force ? DEM_BOUNDARY_FORCE : DEM_BOUNDARY_VELOCITY,
                                   .components = DEM_COMPONENT_X | DEM_COMPONENT_Y, .n_nodes = n, .nodes = s->driven,
                                   .value = {1.5, -4.0, 0.0});
    if (by_force) vec2_put(s->drive.value, 0, (vec2){900.0, -3000.0});
    if (by_force) s->drive.ramp = 1e-4;
    s->run.options.boundaries = &s->drive;
    s->run.options.n_boundaries = 1;
}

static bool has_contacts(const dem_simulation *s, const rank_runs_outcome *so_far)
{
    (void)so_far;
    return ask_state(s).n_contacts > 0;
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
    *s = (scene){.run = {.model = support_model(&l, &floor, 1),
                         .options = dem_options_default(),
                         .t_end = 4e-4,
                         .keeps = has_contacts}};
    s->run.options.method = method;
    s->run.options.contact = k->contact;
    s->run.options.mass_damping = k->mass_damping;
    s->run.options.checkpoint_steps = 40;
    s->run.options.gravity[1] = k->is_dropped ? -1.6e4 : -9.81;
    if (k->ground == BUMPS || k->ground == SHAKEN) drive(s, &l, k->ground == BUMPS);
}

static void close_scene(scene *s)
{
    dem_model_destroy(s->run.model);
    free(s->driven);
}

/* ---- the same bits ---- */

static void share(const scene *s, int n_rings, int n_ranks, const int32_t *owner, const rank_runs_outcome *whole)
{
    rank_runs_assert_shared(&s->run, n_ranks, &(domain_model_shares){.owner = owner, .n_rings = n_rings}, NULL, whole);
}

/* In scattered tiles, and in compact domains where there is more than one number of ranks. */
static void check(const kind *k, dem_method method, int n, const int *numbers)
{
    scene s;
    open_scene(&s, k, method, 0.0);
    const dem_lattice *l = dem_model_lattice(s.run.model);
    CLEANUP(free_memory) int32_t *owner = malloc((size_t)l->n_nodes * sizeof *owner);
    rank_runs_outcome whole = rank_runs_alone(&s.run);
    assert_string_equal(whole.message, "");
    assert_true(whole.n_notes > 30);
    for (int p = 0; p < n; p++) {
        scatter(l, 4.1 * spacing, numbers[p], owner);
        share(&s, STEP_RINGS, numbers[p], owner, &whole);
        if (n == 1) continue;
        assert_ok(partition_bisect(l, numbers[p], owner));
        share(&s, numbers[p] % 2 == 0 ? STEP_RINGS : 1, numbers[p], owner, &whole);
    }
    rank_runs_free_outcome(&whole);
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

/* What is seen at events, too. */
static void check_led(kind k)
{
    static const int numbers[] = {3, 1, 7};
    for (int exact = 0; exact < 2; exact++) {
        scene s;
        k.contact = exact ? DEM_CONTACT_EXACT : DEM_CONTACT_LOCAL;
        open_scene(&s, &k, DEM_METHOD_FEHLBERG45, 0.0);
        s.run.options.checkpoint_steps = 10;
        s.run.is_seen_at_events = true;
        rank_runs_outcome whole = rank_runs_alone(&s.run);
        assert_true(whole.kept != NULL && whole.kept_notes > 0 && whole.n_notes > whole.kept_notes + 10);
        for (int q = 0; q < (is_long ? 3 : 1); q++) {
            rank_runs_assert_led(&s.run, numbers[q], NULL, &whole);
            rank_runs_assert_led(&s.run, numbers[q], &whole, &whole);
        }
        rank_runs_free_outcome(&whole);
        close_scene(&s);
    }
}

/* Nothing is near where the body is let go, and there is no other checkpoint: at the first impact all go back there.
 * Where there are many, some are foreseen. In the end a rank has more nodes of others than at the start. */
TEST(a_led_run_that_goes_back_shows_nothing_twice)
{
    for (int has_many = 0; has_many < 2; has_many++) {
        scene s;
        const kind k = {.ground = BUMPS, .restitution = 0.5, .friction = 0.3, .is_dropped = true};
        open_scene(&s, &k, DEM_METHOD_FEHLBERG45, 8e-3);
        s.run.t_end = 1.4e-3;
        s.run.options.checkpoint_steps = has_many ? 25 : 100000;
        s.run.is_seen_at_events = true;
        s.run.n_frames = 29;
        rank_runs_outcome whole = rank_runs_alone(&s.run), led = rank_runs_make_outcome(&s.run);
        assert_true(whole.n_notes > 30 && whole.n_frames == 30 && whole.n_steps > 200);
        rank_runs_led(&s.run, 3, NULL, &led);
        assert_null(rank_runs_difference(&led, &whole, NULL));
        assert_true(led.n_common[1] > led.n_common[0] + 50.0);
        rank_runs_free_outcome(&led);
        rank_runs_free_outcome(&whole);
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
    assert_ok(dem_lattice_append(&l, dem_model_lattice(s.run.model)));
    dem_model_destroy(s.run.model);
    s.run.model = support_model(&l, &floor, 1);
    rank_runs_outcome led = rank_runs_make_outcome(&s.run);
    rank_runs_led(&s.run, 2, NULL, &led);
    assert_string_equal(led.message, "rank 0 cannot lead a run with obstacles whose motion a function computes");
    rank_runs_free_outcome(&led);
    close_scene(&s);
}

/* ---- how often ranks talk ---- */

enum { N_TALKING = 3 };

/* \param height  m, above the place where it touches at once  \param[out] all  [N_TALKING] */
static void listen(dem_method method, int n_rings, double height, rank_runs_outcome *all)
{
    scene s;
    const kind k = {.ground = PLANE, .restitution = 0.5};
    open_scene(&s, &k, method, height);
    s.run.options.checkpoint_steps = 0;
    s.run.counts_calls = true;
    const dem_lattice *l = dem_model_lattice(s.run.model);
    CLEANUP(free_memory) int32_t *owner = malloc((size_t)l->n_nodes * sizeof *owner);
    assert_ok(partition_bisect(l, N_TALKING, owner));
    rank_runs_make_outcomes(&s.run, N_TALKING, all);
    rank_runs_together(&s.run, N_TALKING, &(domain_model_shares){.owner = owner, .n_rings = n_rings}, NULL, all);
    for (int q = 0; q < N_TALKING; q++) assert_string_equal(all[q].message, "");
    assert_true(all->n_steps >= 10);
    close_scene(&s);
}

/* From its second step on, as the first evaluates where it begins. Where nothing happens it is what a free body needs.
 * A step with events needs the ghosts at its end, and whether observers have failed at one, before each look in it,
 * too; the next step the norm of the state that events have changed, and fixed steps how stiff it is, for which RK4
 * needs the ghosts again. A look for overlaps takes one of both, as all nodes of the boundary are common. */
TEST(events_cost_a_few_calls_a_step_however_many_there_are)
{
    static const int n_exchanges[] = {6, 6, 4, 1, 1}, after_events[] = {2, 2, 3, 1, 2};
    for (int m = 0; m < 5; m++)
        for (int is_high = 0; is_high < 2; is_high++) {
            rank_runs_outcome all[N_TALKING];
            const bool has_rings = m == 4; /* Fehlberg's pair again */
            int n_busy = 0;
            listen(methods[has_rings ? 0 : m], has_rings ? STEP_RINGS : 1, is_high ? 0.1 : 0.0, all);
            for (dem_index k = 2; k < all->n_steps; k++) {
                const rank_runs_step *t = &all->steps[k];
                const bool busy = t->n_events > t[-1].n_events, was_busy = t[-1].n_events > t[-2].n_events;
                const int n_stops = busy ? t->n_stops - t[-1].n_stops : 0;
                const int n_looks = (int)(rank_runs_looks(k) - rank_runs_looks(k - 1));
                n_busy += busy;
                assert_int_equal(t->calls.exchanges - t[-1].calls.exchanges,
                                 n_exchanges[m] + busy + (was_busy && m == 2) + n_looks);
                assert_int_equal(t->calls.reductions - t[-1].calls.reductions,
                                 1 + busy + n_stops + (was_busy ? after_events[m] : 0) + n_looks);
            }
            assert_true(is_high ? n_busy == 0 : n_busy > 10);
            rank_runs_free_outcomes(all, N_TALKING);
        }
}

/* ---- what stops a run ---- */

/* What each rank has: one alone watches events, and may stop at one. */
typedef struct stopped_run {
    const scene *scene;
    const int32_t *owner;
    dem_status status[RANK_RUNS_MOST];
    dem_counts counts[RANK_RUNS_MOST];
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
    dem_status status = dem_simulation_create(&s, model, &c->scene->run.options);
    if (status == DEM_OK) status = dem_simulation_observe(s, &observer);
    if (status == DEM_OK) status = dem_simulation_advance(s, c->scene->run.t_end);
    c->counts[rank].struct_size = sizeof c->counts[rank];
    if (s != NULL) (void)dem_simulation_counts(s, &c->counts[rank]);
    dem_simulation_destroy(s);
    return status;
}

static void stop_rank(const ranks *r, void *context)
{
    stopped_run *c = context;
    dem_model *model = NULL;
    dem_status status = domain_model_create(&model, r, c->scene->run.model, &(domain_model_shares){.owner = c->owner});
    if (status == DEM_OK) status = run_until_stopped(model, c, r->rank);
    c->status[r->rank] = status;
    dem_model_destroy(model);
}

/* At the tenth event, as a process alone. */
TEST(an_event_that_one_rank_watches_stops_all)
{
    for (int exact = 0; exact < 2; exact++) {
        scene s;
        const kind k = {.ground = PLANE, .contact = exact ? DEM_CONTACT_EXACT : DEM_CONTACT_LOCAL, .restitution = 0.5};
        open_scene(&s, &k, DEM_METHOD_FEHLBERG45, 0.0);
        const dem_lattice *l = dem_model_lattice(s.run.model);
        CLEANUP(free_memory) int32_t *owner = malloc((size_t)l->n_nodes * sizeof *owner);
        stopped_run one = {.scene = &s, .last = 10}, all = {.scene = &s, .last = 10, .owner = owner};
        assert_int_equal(run_until_stopped(s.run.model, &one, 0), DEM_STOPPED);
        assert_ok(partition_bisect(l, 4, owner));
        rank_threads_run(4, stop_rank, &all);
        for (int q = 0; q < 4; q++) {
            assert_int_equal(all.status[q], DEM_STOPPED);
            assert_memory_equal(&all.counts[q], &one.counts[0], sizeof one.counts[0]);
        }
        assert_int_equal(all.n_seen, one.n_seen);
        close_scene(&s);
    }
}

/* All ranks of four end as a process alone does. */
static void assert_same_failure(const scene *s, dem_status expected)
{
    const dem_lattice *l = dem_model_lattice(s->run.model);
    CLEANUP(free_memory) int32_t *owner = malloc((size_t)l->n_nodes * sizeof *owner);
    rank_runs_outcome whole = rank_runs_alone(&s->run);
    assert_int_equal(whole.status, expected);
    assert_ok(partition_bisect(l, 4, owner));
    share(s, 0, 4, owner, &whole);
    rank_runs_free_outcome(&whole);
}

/* Messages have the numbers of nodes in the whole. */
TEST(what_starts_inside_an_obstacle_is_refused_by_all)
{
    scene s;
    const kind k = {.ground = PLANE, .restitution = 0.5};
    open_scene(&s, &k, DEM_METHOD_FEHLBERG45, -1e-3);
    assert_same_failure(&s, DEM_ERROR_MODEL);
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
        s.run.options.max_impacts = 1;
        s.run.options.window = 0.0;
        assert_same_failure(&s, DEM_ERROR_CONTACT);
        close_scene(&s);
    }
}

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
