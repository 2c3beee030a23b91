/* SPDX-License-Identifier: BSD-3-Clause */
/* Steps of Fehlberg's pair by ranks that are threads, each of which has so many nodes that its stages are evaluated
 * together, band by band: one sweep over all nodes of a rank for each attempt, at the end of the step. Motions have the
 * bits of one process where steps are accepted and rejected, where bodies hit obstacles and each other, so that some
 * stages are evaluated one by one after all, and where a force is not finite. And steps of Verlet's method, of which
 * ranks take as many at once as they have rings of ghosts, where one process takes each by itself. */
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

#include "rank_runs.h"
#include "scattered.h"
#include "support.h"

#include "domain/partition.h"
#include "harness/kernel_of_rows.h"
#include "simulation/private.h"

enum { MOST_RANKS = 3, MANY_RANKS = 7, STEP_RINGS = 3, TEXT = 256 };

static const double spacing = 2e-3;

/* ---- sweeps ---- */

/* Of all ranks together; a band is a part of a rank's blocks. */
static sweep_function *sweep_of_kernel;
static atomic_int whole_sweeps, bands;

static double count_sweep(const sweep *s, dem_index first, dem_index last, double *ring)
{
    (void)atomic_fetch_add(first == 0 && last == s->layout->n_blocks ? &whole_sweeps : &bands, 1);
    return sweep_of_kernel(s, first, last, ring);
}

/* ---- scenes ---- */

typedef struct scene {
    dem_model *model;
    dem_options options;
    double t_end;          /* s */
    dem_observer watch[2]; /* by the first and the last rank, if they have functions */
} scene;

/* Where springs and guards alone act, which Poisson's ratio says, Verlet's method goes by lattice rows. */
static dem_lattice make_plate_of(double width, double height, double poissons_ratio)
{
    const dem_material solid = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = poissons_ratio,
                                     .density = 1050.0, .thickness = 1.0, .guard = 0.02);
    dem_lattice l = dem_lattice_empty();
    assert_ok(dem_lattice_rectangle(&l, width, height, spacing));
    assert_ok(dem_lattice_jitter(&l, 0.1 * spacing, 7));
    assert_ok(dem_lattice_assemble(&l, &solid));
    return l;
}

static dem_lattice make_plate(double width, double height)
{
    return make_plate_of(width, height, 0.3);
}

static scene scene_of(const dem_lattice *l, const dem_obstacle *obstacles, int n, double t_end)
{
    scene s = {.model = support_model(l, obstacles, n), .options = dem_options_default(), .t_end = t_end};
    s.options.checkpoint_steps = 0;
    return s;
}

/* ---- runs ---- */

typedef struct outcome {
    dem_counts counts;
    double t, step;            /* s */
    double *x, *v;             /* [n_nodes][2] of the whole */
    rank_threads_counts calls; /* of one rank */
    dem_status status;
    char failure[TEXT]; /* empty: none */
} outcome;

static outcome make_outcome(dem_index n)
{
    return (outcome){.x = calloc(2 * (size_t)n, sizeof(double)), .v = calloc(2 * (size_t)n, sizeof(double))};
}

static void free_outcome(outcome *o)
{
    free(o->x);
    free(o->v);
}

/* Ranks write the rows of their own nodes. */
static void look(const dem_simulation *s, outcome *o)
{
    dem_state seen = {.struct_size = sizeof seen};
    if (dem_simulation_state(s, &seen) != DEM_OK || dem_simulation_counts(s, &o->counts) != DEM_OK) return;
    o->t = seen.t;
    o->step = seen.step;
    rank_runs_copy(s->model, 2, seen.x, o->x);
    rank_runs_copy(s->model, 2, seen.v, o->v);
}

static void run(const dem_model *model, const scene *c, const dem_observer *watch, outcome *o)
{
    dem_simulation *s = NULL;
    o->counts.struct_size = sizeof o->counts;
    o->status = dem_simulation_create(&s, model, &c->options);
    if (o->status == DEM_OK) {
        s->kernel.sweep = count_sweep;
        if (watch != NULL) o->status = dem_simulation_observe(s, watch);
        if (o->status == DEM_OK) o->status = dem_simulation_advance(s, c->t_end);
    }
    if (o->status != DEM_OK) (void)snprintf(o->failure, TEXT, "%s", dem_status_message());
    if (s != NULL) look(s, o);
    dem_simulation_destroy(s);
}

typedef struct shared_run {
    const scene *scene;
    domain_model_shares shares;
    outcome *outcomes; /* [ranks] whose x and v are one */
} shared_run;

/* Observers need not be the same on all ranks. */
static const dem_observer *watch_of(const scene *s, const ranks *r)
{
    const dem_observer *o = &s->watch[r->rank > 0];
    return (r->rank == 0 || r->rank == r->size - 1) && o->struct_size > 0 ? o : NULL;
}

static void run_rank(const ranks *r, void *context)
{
    shared_run *c = context;
    outcome *o = &c->outcomes[r->rank];
    dem_model *model = NULL;
    o->status = domain_model_create(&model, r, c->scene->model, &c->shares);
    if (o->status == DEM_OK)
        run(model, c->scene, watch_of(c->scene, r), o);
    else
        (void)snprintf(o->failure, TEXT, "%s", dem_status_message());
    o->calls = rank_threads_count(r);
    dem_model_destroy(model);
}

static void assert_same(const outcome *one, const outcome *whole, dem_index n)
{
    assert_string_equal(one->failure, whole->failure);
    assert_int_equal(one->status, whole->status);
    assert_memory_equal(&one->counts, &whole->counts, sizeof one->counts);
    assert_true(one->t == whole->t && one->step == whole->step);
    assert_memory_equal(one->x, whole->x, 2 * (size_t)n * sizeof(double));
    assert_memory_equal(one->v, whole->v, 2 * (size_t)n * sizeof(double));
}

/* \return the calls of a rank */
static rank_threads_counts share(const scene *s, int n_ranks, domain_model_shares shares, const outcome *whole)
{
    const dem_index n = dem_model_lattice(s->model)->n_nodes;
    outcome all[MANY_RANKS];
    all[0] = make_outcome(n);
    for (int k = 1; k < n_ranks; k++) all[k] = all[0];
    atomic_store(&whole_sweeps, 0);
    atomic_store(&bands, 0);
    rank_threads_run(n_ranks, run_rank, &(shared_run){s, shares, all});
    for (int k = 0; k < n_ranks; k++) assert_same(&all[k], whole, n);
    free_outcome(&all[0]);
    return all[0].calls;
}

static outcome run_alone(const scene *s)
{
    outcome whole = make_outcome(dem_model_lattice(s->model)->n_nodes);
    dem_simulation *first = NULL;
    assert_ok(dem_simulation_create(&first, s->model, &s->options));
    sweep_of_kernel = first->kernel.sweep;
    dem_simulation_destroy(first);
    run(s->model, s, NULL, &whole);
    return whole;
}

/* For overlaps. Where bodies touch each other all of the boundary is common. */
static int exchanges_of_looks(const scene *s, const outcome *whole)
{
    const int n_looks = (int)rank_runs_looks(whole->counts.steps - 1);
    if (s->options.bodies != DEM_BODIES_NONE) return 1 + n_looks;
    return RANK_RUNS_START_EXCHANGES + RANK_RUNS_LOOK_EXCHANGES * n_looks;
}

/* By compact domains, and by large tiles. Only the first state and the ends of steps are swept as a whole, and, where
 * this is said, the stages of steps that were rejected or for which bands did not hold.
 * \param n_stages  those that are swept as a whole, at most, by each rank */
static void check(const scene *s, int n_ranks, const outcome *whole, int n_stages)
{
    const dem_lattice *l = dem_model_lattice(s->model);
    CLEANUP(free_memory) int32_t *owner = malloc((size_t)l->n_nodes * sizeof *owner);
    const int attempts = (int)(whole->counts.steps + whole->counts.rejected);
    for (int tiles = 0; tiles < 2; tiles++) {
        assert_ok(partition_bisect(l, n_ranks, owner));
        if (tiles) scatter(l, 50.3 * spacing, n_ranks, owner);
        const int exchanges =
            share(s, n_ranks,
                  (domain_model_shares){
                      .owner = owner, .touching = s->options.bodies != DEM_BODIES_NONE, .n_rings = STEP_RINGS},
                  whole)
                .exchanges;
        const int looks = exchanges_of_looks(s, whole);
        if (whole->counts.events == 0)
            assert_in_range(exchanges - looks, attempts + 1, attempts + 1 + (int)whole->counts.rejected);
        const int swept = atomic_load(&whole_sweeps);
        assert_in_range(swept, n_ranks * (attempts + 1) + (n_stages > 0), n_ranks * (attempts + 1 + n_stages));
        assert_true(atomic_load(&bands) > n_ranks * 24);
    }
}

/* ---- free bodies ---- */

TEST(each_step_of_a_rank_is_one_wave)
{
    CLEANUP(dem_lattice_free) dem_lattice l = make_plate(0.38, 0.28);
    rank_runs_set_off(&l, 2.0, 20.0);
    scene s = scene_of(&l, NULL, 0, 2e-4);
    outcome whole = run_alone(&s);
    assert_string_equal(whole.failure, "");
    assert_true(whole.counts.steps > 10 && whole.counts.rejected == 0);
    for (int n_ranks = 2; n_ranks <= MOST_RANKS; n_ranks++) check(&s, n_ranks, &whole, 0);
    free_outcome(&whole);
    dem_model_destroy(s.model);
}

/* The stages of a step that is rejected are evaluated again, as ARKODE may ask for the error; so are those of some
 * steps whose largest error is far from that of the step before, which take a second exchange, too. */
TEST(steps_are_rejected_alike)
{
    CLEANUP(dem_lattice_free) dem_lattice l = make_plate(0.22, 0.28);
    rank_runs_set_off(&l, 60.0, 20.0);
    scene s = scene_of(&l, NULL, 0, 4e-5);
    s.options.rtol = 1e-10;
    outcome whole = run_alone(&s);
    assert_string_equal(whole.failure, "");
    assert_true(whole.counts.rejected > 0);
    check(&s, 2, &whole, 10 * (int)whole.counts.rejected);
    free_outcome(&whole);
    dem_model_destroy(s.model);
}

/* Of one node, whose rank alone fails; the stages before are swept. */
TEST(a_stage_that_is_not_finite_fails_alike)
{
    CLEANUP(dem_lattice_free) dem_lattice l = make_plate(0.3, 0.28);
    rank_runs_set_off(&l, 2.0, 20.0);
    for (int k = 0; k < 2; k++) {
        l.velocity[2 * 20] = k == 0 ? 1e200 : 1e161; /* at any length of the step; at the first */
        scene s = scene_of(&l, NULL, 0, 1e-5);
        outcome whole = run_alone(&s);
        assert_int_equal(whole.status, DEM_ERROR_INTEGRATOR);
        CLEANUP(free_memory) int32_t *owner = malloc((size_t)l.n_nodes * sizeof *owner);
        assert_ok(partition_bisect(&l, 2, owner));
        (void)share(&s, 2, (domain_model_shares){.owner = owner, .n_rings = STEP_RINGS}, &whole);
        free_outcome(&whole);
        dem_model_destroy(s.model);
    }
}

/* ---- contact ---- */

TEST(waves_and_events_follow_each_other_alike)
{
    static const double floor_points[] = {-2.0, 0.0, 2.0, 0.0};
    CLEANUP(dem_lattice_free) dem_lattice l = make_plate(0.3, 0.28);
    const dem_obstacle floor =
        SIZED(dem_obstacle, .n_points = 2, .points = floor_points, .restitution = 0.9, .friction = 0.1);
    dem_lattice_move(&l, 0.03, (double[]){0.0, 0.0});
    dem_lattice_move(&l, 0.0, (double[]){0.0, 1e-4 - support_bottom(&l)});
    assert_ok(dem_lattice_launch(&l, (double[]){0.5, -4.0}));
    scene s = scene_of(&l, &floor, 1, 2.5e-4);
    outcome whole = run_alone(&s);
    assert_string_equal(whole.failure, "");
    assert_true(whole.counts.impacts > 3);
    check(&s, 2, &whole, 6 * (int)(whole.counts.steps + whole.counts.rejected));
    free_outcome(&whole);
    dem_model_destroy(s.model);
}

/* Surfaces that come near each other end waves: it is seen when one has been taken. */
TEST(bodies_that_run_into_each_other_do_so_alike)
{
    CLEANUP(dem_lattice_free) dem_lattice l = make_plate(0.16, 0.28), other = dem_lattice_empty();
    assert_ok(dem_lattice_append(&other, &l));
    dem_lattice_move(&other, 0.0, (double[]){0.1628, 0.01});
    assert_ok(dem_lattice_launch(&l, (double[]){8.0, 1.0}));
    assert_ok(dem_lattice_launch(&other, (double[]){-2.0, 1.0}));
    assert_ok(dem_lattice_append(&l, &other));
    scene s = scene_of(&l, NULL, 0, 2.5e-4);
    s.options.bodies = DEM_BODIES_OTHERS;
    outcome whole = run_alone(&s);
    assert_string_equal(whole.failure, "");
    check(&s, 2, &whole, 5 * (int)(whole.counts.steps + whole.counts.rejected) - 10);
    free_outcome(&whole);
    dem_model_destroy(s.model);
}

/* ---- Verlet's method ---- */

static scene verlet_of(const dem_lattice *l, const dem_obstacle *obstacles, int n, double steps)
{
    scene s = scene_of(l, obstacles, n, 0.0);
    dem_simulation *first = NULL;
    s.options.method = DEM_METHOD_VERLET;
    assert_ok(dem_simulation_create(&first, s.model, &s.options));
    s.t_end = steps * first->options.fixed_step;
    dem_simulation_destroy(first);
    return s;
}

/* \param most_calls  exchanges of compact domains, each with a reduction before and one behind it, or one behind it and
 *  none before, without those of looks for overlaps; further reductions are those of a simulation's creation, and the
 *  last step's */
static void check_verlet(const scene *s, int n_ranks, int n_rings, const outcome *whole, int most_calls)
{
    const dem_lattice *l = dem_model_lattice(s->model);
    CLEANUP(free_memory) int32_t *owner = malloc((size_t)l->n_nodes * sizeof *owner);
    for (int tiles = 0; tiles < 2; tiles++) {
        assert_ok(partition_bisect(l, n_ranks, owner));
        if (tiles) scatter(l, 50.3 * spacing, n_ranks, owner);
        const rank_threads_counts calls = share(
            s, n_ranks,
            (domain_model_shares){.owner = owner, .touching = s->options.bodies != DEM_BODIES_NONE, .n_rings = n_rings},
            whole);
        const int looks = exchanges_of_looks(s, whole);
        if (!tiles) assert_in_range(calls.exchanges, 1, most_calls + looks);
        if (!tiles) assert_in_range(calls.reductions, 1, 2 * most_calls + 40 + looks);
    }
}

/* All but the last step, in which the end of the run is: as many at once as there are rings, up to the looks after
 * every 16th step; and an exchange for the first state. */
static void check_steps_at_once(double width, double height, double poissons_ratio, dem_kernel kind)
{
    CLEANUP(dem_lattice_free) dem_lattice l = make_plate_of(width, height, poissons_ratio);
    rank_runs_set_off(&l, 2.0, 20.0);
    scene s = verlet_of(&l, NULL, 0, 80.5);
    s.options.kernel = kind;
    outcome whole = run_alone(&s);
    assert_string_equal(whole.failure, "");
    assert_int_equal(whole.counts.steps, 81);
    check_verlet(&s, 2, 16, &whole, 1 + 5 + 1);
    check_verlet(&s, 3, 5, &whole, 1 + 5 * 4 + 1);
    check_verlet(&s, 4, 8, &whole, 1 + 5 * 2 + 1);
    check_verlet(&s, 7, 5, &whole, 1 + 5 * 4 + 1);
    check_verlet(&s, 2, STEP_RINGS, &whole, 1 + 81);
    s.options.threads = 2;
    s.options.thread_nodes = 1;
    check_verlet(&s, 2, 16, &whole, 1 + 5 + 1);
    free_outcome(&whole);
    dem_model_destroy(s.model);
}

/* By blocks a seventh of a plate has to be large enough for a wave, by lattice rows it need not be. */
TEST(ranks_take_steps_at_once)
{
    check_steps_at_once(0.46, 0.4, 0.3, DEM_KERNEL_AUTO);
    check_steps_at_once(0.3, 0.28, 1.0 / 3.0, kernel_of_rows());
}

/* Some 40 steps above a floor, and then on it, and past a checkpoint. */
TEST(steps_at_once_and_events_follow_each_other_alike)
{
    static const double floor_points[] = {-2.0, 0.0, 2.0, 0.0};
    CLEANUP(dem_lattice_free) dem_lattice l = make_plate(0.3, 0.28);
    const dem_obstacle floor = SIZED(dem_obstacle, .n_points = 2, .points = floor_points, .restitution = 0.9);
    rank_runs_set_off(&l, 0.5, 20.0);
    for (dem_index i = 0; i < l.n_nodes; i++) l.velocity[2 * i + 1] -= 4.0;
    dem_lattice_move(&l, 0.0, (double[]){0.0, 3e-4 - support_bottom(&l)});
    scene s = verlet_of(&l, &floor, 1, 100.5);
    s.options.checkpoint_steps = 23;
    outcome whole = run_alone(&s);
    assert_string_equal(whole.failure, "");
    assert_true(whole.counts.impacts > 3);
    for (int n_ranks = 2; n_ranks <= MOST_RANKS; n_ranks++) check_verlet(&s, n_ranks, 6, &whole, 300);
    free_outcome(&whole);
    dem_model_destroy(s.model);
}

TEST(bodies_run_into_each_other_after_steps_at_once)
{
    CLEANUP(dem_lattice_free) dem_lattice l = make_plate(0.16, 0.28), other = dem_lattice_empty();
    assert_ok(dem_lattice_append(&other, &l));
    dem_lattice_move(&other, 0.0, (double[]){0.1635, 0.01});
    assert_ok(dem_lattice_launch(&l, (double[]){8.0, 1.0}));
    assert_ok(dem_lattice_launch(&other, (double[]){-2.0, 1.0}));
    assert_ok(dem_lattice_append(&l, &other));
    scene s = verlet_of(&l, NULL, 0, 80.5);
    s.options.bodies = DEM_BODIES_OTHERS;
    outcome whole = run_alone(&s);
    assert_string_equal(whole.failure, "");
    check_verlet(&s, 2, 6, &whole, 81);
    free_outcome(&whole);
    dem_model_destroy(s.model);
}

/* Steps are thrown away by all ranks where the guard acts on one, and taken one by one and shorter, and where something
 * is not finite. */
TEST(steps_that_one_rank_cannot_take_are_single_on_all)
{
    for (int k = 0; k < 4; k++) {
        CLEANUP(dem_lattice_free) dem_lattice l = make_plate_of(0.3, 0.28, k < 2 ? 0.3 : 1.0 / 3.0);
        rank_runs_set_off(&l, 2.0, 20.0);
        l.velocity[2 * 20] = k % 2 == 0 ? 400.0 : 1e200;
        scene s = verlet_of(&l, NULL, 0, 60.5);
        outcome whole = run_alone(&s);
        assert_int_equal(whole.status, k % 2 == 0 ? DEM_OK : DEM_ERROR_INTEGRATOR);
        check_verlet(&s, 2, 8, &whole, 1000);
        free_outcome(&whole);
        dem_model_destroy(s.model);
    }
}

/* Nodes tremble so fast that ghosts without forces fly through each other in the steps of a wave, and those with forces
 * do not come near the guard. */
TEST(ghosts_on_the_outside_may_fold)
{
    CLEANUP(dem_lattice_free) dem_lattice l = make_plate_of(0.3, 0.28, 1.0 / 3.0);
    rank_runs_set_off(&l, 2.0, 20.0);
    for (dem_index i = 0; i < l.n_nodes; i++) l.velocity[2 * i] += i * 7919 % 13 > 6 ? 24.0 : -24.0;
    scene s = verlet_of(&l, NULL, 0, 80.5);
    outcome whole = run_alone(&s);
    assert_string_equal(whole.failure, "");
    assert_int_equal(whole.counts.steps, 81);
    check_verlet(&s, 2, 16, &whole, 1 + 5 + 1);
    free_outcome(&whole);
    dem_model_destroy(s.model);
}

static dem_status count(void *context, const dem_simulation *simulation)
{
    (void)simulation;
    ++*(int *)context;
    return DEM_OK;
}

/* The ends that one rank sees are the ends of what all take at once. */
TEST(ranks_need_not_see_the_same_steps)
{
    CLEANUP(dem_lattice_free) dem_lattice l = make_plate(0.3, 0.28);
    rank_runs_set_off(&l, 2.0, 20.0);
    scene s = verlet_of(&l, NULL, 0, 80.5);
    outcome whole = run_alone(&s);
    int seen[2] = {0};
    for (int k = 0; k < 2; k++)
        s.watch[k] = (dem_observer){
            .struct_size = sizeof(dem_observer), .step = count, .step_every = k == 0 ? 9 : 25, .context = &seen[k]};
    check_verlet(&s, 2, 16, &whole, 40);
    assert_int_equal(seen[0], 2 * (80 / 9 + 1));
    assert_int_equal(seen[1], 2 * (80 / 25 + 1));
    free_outcome(&whole);
    dem_model_destroy(s.model);
}
