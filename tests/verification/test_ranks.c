/* SPDX-License-Identifier: BSD-3-Clause */
/* Ranks that share a model, as threads: positions, velocities, energies integrated along, times, lengths of steps and
 * their counts, and all that is measured on a state, have the bits of the whole model in one process, whatever the
 * shares. Bodies are free, damped, driven, folded nearly flat, two and far apart; triangles single and coupled, and
 * squares. */
#include <stdio.h>
#include <string.h>

#include "rank_runs.h"
#include "scattered.h"
#include "support.h"

#include "domain/partition.h"
#include "simulation/led_run.h"
#include "simulation/private.h"
#include "simulation/right_hand_side.h"

enum { N_BODIES = 4, STRIP = N_BODIES, COUPLED_STRIP, N_METHODS = 4, SEEN_STEP = 4, STEP_RINGS = 3 };

static const double spacing = 5e-3;
static const dem_method methods[N_METHODS] = {DEM_METHOD_FEHLBERG45, DEM_METHOD_DOPRI45, DEM_METHOD_RK4,
                                              DEM_METHOD_VERLET};

/* ---- bodies ---- */

typedef struct scene {
    rank_runs_scene run;
    dem_boundary boundaries[3];
    dem_index *held, *pushed; /* nodes */
} scene;

/* A second body beside the first. */
static void add_copy(dem_lattice *l)
{
    CLEANUP(dem_lattice_free) dem_lattice other = dem_lattice_empty();
    assert_ok(dem_lattice_append(&other, l));
    dem_lattice_move(&other, 0.3, (const double[]){0.1, 0.02});
    assert_ok(dem_lattice_append(l, &other));
}

static dem_lattice make_lattice(int body)
{
    dem_material solid = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 0.3, .density = 1050.0,
                               .thickness = 1.0, .guard = 0.02);
    dem_lattice l = dem_lattice_empty();
    if (body == 1) solid.damping_time = 2e-5;
    if (body == 2 || body == COUPLED_STRIP) solid.springs = DEM_SPRINGS_COUPLED;
    if (body == 3) {
        assert_ok(dem_lattice_squares(&l, 0.09, 0.06, spacing));
        assert_ok(dem_lattice_assemble_squares(&l, &solid, 0.45));
    } else if (body >= STRIP) {
        /* Rows are so long that a sweep takes the nodes in another order. */
        assert_ok(dem_lattice_rectangle(&l, 1100 * spacing, 3 * spacing, spacing));
        assert_ok(dem_lattice_jitter(&l, 0.2 * spacing, 7));
        assert_ok(dem_lattice_assemble(&l, &solid));
    } else {
        assert_ok(dem_lattice_disc(&l, 0.04, spacing));
        assert_ok(dem_lattice_jitter(&l, 0.2 * spacing, 7));
        assert_ok(dem_lattice_assemble(&l, &solid));
    }
    if (body == 1) add_copy(&l);
    rank_runs_set_off(&l, body == 0 ? 60.0 : 2.0, 40.0);
    return l;
}

static dem_index *list_where(const dem_lattice *l, int coordinate, double sign, dem_index *n)
{
    dem_index *list = malloc((size_t)l->n_nodes * sizeof *list);
    *n = 0;
    for (dem_index i = 0; i < l->n_nodes; i++)
        if (sign * l->x[2 * i + coordinate] > 0.032) list[(*n)++] = i;
    return list;
}

/* The driven body, 2, is held on its left and pulled down there, and pushed on top; nodes feel two forces. */
static void drive(scene *s)
{
    const dem_lattice *l = dem_model_lattice(s->run.model);
    dem_index n_held, n_pushed;
    s->held = list_where(l, 0, -1.0, &n_held);
    s->pushed = list_where(l, 1, 1.0, &n_pushed);
    s->boundaries[0] = (dem_boundary)SIZED(dem_boundary, .kind = DEM_BOUNDARY_DISPLACEMENT,
                                           .components = DEM_COMPONENT_X | DEM_COMPONENT_Y, .n_nodes = n_held,
                                           .nodes = s->held, .value = {1e-3, -2e-3, 0.0}, .ramp = 1e-3);
    s->boundaries[1] = (dem_boundary)SIZED(dem_boundary, .kind = DEM_BOUNDARY_FORCE, .n_nodes = n_pushed,
                                           .nodes = s->pushed, .value = {3e3, -2e3, 0.0}, .ramp = 1e-3);
    s->boundaries[2] = s->boundaries[1];
    s->boundaries[2].value[0] = -700.0;
    s->boundaries[2].ramp = 0.0;
    s->run.options.boundaries = s->boundaries;
    s->run.options.n_boundaries = 3;
}

static void open_scene(scene *s, int body, dem_method method)
{
    CLEANUP(dem_lattice_free) dem_lattice l = make_lattice(body);
    *s = (scene){
        .run = {
            .model = support_model(&l, NULL, 0), .options = dem_options_default(), .t_end = 3e-4, .step = SEEN_STEP}};
    s->run.options.method = method;
    s->run.options.checkpoint_steps = 0;
    if (body == 0) s->run.options.rtol = 1e-9;
    if (body == 1) s->run.options.mass_damping = 300.0;
    if (body == 2) drive(s);
}

static void close_scene(scene *s)
{
    dem_model_destroy(s->run.model);
    free(s->held);
    free(s->pushed);
}

/* ---- runs ---- */

/* Whether ranks integrate rings of ghosts through a step, so that one exchange does for it. */
static bool is_once_a_step(const scene *s, int n_rings)
{
    return n_rings == STEP_RINGS && s->run.options.method == DEM_METHOD_FEHLBERG45 &&
           s->run.options.n_boundaries == 0 && dem_model_lattice(s->run.model)->viscosity == NULL;
}

/* One exchange for each evaluation, or for each attempt and the first state, and those of looks for overlaps; a team of
 * one steps as a process alone does, without any. That at the end of a step of Fehlberg's is made even if the step is
 * rejected; the first fixed step of ARKODE's asks the guard for its length before there is one. */
static dem_index exchanges_of(const dem_options *options, bool once_a_step, int n_ranks, const dem_counts *counts)
{
    const dem_index ahead = options->method == DEM_METHOD_FEHLBERG45 ? counts->rejected : 0;
    const dem_index looks = RANK_RUNS_START_EXCHANGES + RANK_RUNS_LOOK_EXCHANGES * rank_runs_looks(counts->steps - 1);
    if (n_ranks == 1) return 0;
    if (once_a_step) return looks + counts->steps + counts->rejected + 1;
    return looks + counts->evaluations + ahead + (options->method == DEM_METHOD_RK4);
}

static void share_rings(const scene *s, int n_rings, int n_ranks, const int32_t *owner, const rank_runs_outcome *from,
                        const rank_runs_outcome *whole)
{
    const dem_counts *counts = &whole->views[RANK_RUNS_STOPS - 1].counts;
    const rank_threads_counts calls = rank_runs_assert_shared(
        &s->run, n_ranks, &(domain_model_shares){.owner = owner, .n_rings = n_rings}, from, whole);
    if (s->run.options.checkpoint_steps == 0)
        assert_int_equal(calls.exchanges, exchanges_of(&s->run.options, is_once_a_step(s, n_rings), n_ranks, counts));
}

static void share(const scene *s, int n_ranks, const int32_t *owner, const rank_runs_outcome *from,
                  const rank_runs_outcome *whole)
{
    share_rings(s, 1, n_ranks, owner, from, whole);
    if (n_ranks > 1 && s->run.options.method == DEM_METHOD_FEHLBERG45)
        share_rings(s, STEP_RINGS, n_ranks, owner, from, whole);
}

/* Both ways to share a body out among ranks. */
static void check_numbers(int body, dem_method method, const int *numbers, size_t n_numbers)
{
    scene s;
    open_scene(&s, body, method);
    const dem_lattice *l = dem_model_lattice(s.run.model);
    CLEANUP(free_memory) int32_t *owner = malloc((size_t)l->n_nodes * sizeof *owner);
    rank_runs_outcome whole = rank_runs_alone(&s.run);
    const rank_runs_view *end = &whole.views[RANK_RUNS_STOPS - 1];
    assert_string_equal(whole.message, "");
    assert_true((end->totals[STATE_DAMPING] != 0.0) == (body == 1) && (end->totals[STATE_WORK] != 0.0) == (body == 2));
    if (body == 0 && method == DEM_METHOD_FEHLBERG45) assert_true(end->counts.rejected > 0);
    for (size_t k = 0; k < n_numbers; k++) {
        assert_ok(partition_bisect(l, numbers[k], owner));
        share(&s, numbers[k], owner, NULL, &whole);
        scatter(l, 4.1 * spacing, numbers[k], owner);
        share(&s, numbers[k], owner, NULL, &whole);
    }
    rank_runs_free_outcome(&whole);
    close_scene(&s);
}

static void check(int body, dem_method method)
{
    static const int numbers[] = {1, 2, 3, 4, 7};
    check_numbers(body, method, numbers, sizeof numbers / sizeof numbers[0]);
}

/* ---- checkpoints ---- */

/* Those of three ranks are those of one process, and so is what comes of one on any number of ranks. */
static void check_checkpoints(int body, dem_method method)
{
    static const int numbers[] = {1, 2, 3, 7};
    scene s;
    open_scene(&s, body, method);
    const dem_lattice *l = dem_model_lattice(s.run.model);
    CLEANUP(free_memory) int32_t *owner = malloc((size_t)l->n_nodes * sizeof *owner);
    s.run.options.checkpoint_steps = 4;
    rank_runs_outcome whole = rank_runs_alone(&s.run);
    assert_non_null(whole.kept);
    scatter(l, 4.1 * spacing, 3, owner);
    share(&s, 3, owner, NULL, &whole);
    for (size_t k = 0; k < sizeof numbers / sizeof numbers[0]; k++) {
        assert_ok(partition_bisect(l, numbers[k], owner));
        share(&s, numbers[k], owner, &whole, &whole);
    }
    rank_runs_free_outcome(&whole);
    close_scene(&s);
}

/* ---- a run that rank 0 leads ---- */

static void check_led(int body, dem_method method)
{
    static const int numbers[] = {1, 2, 5};
    scene s;
    open_scene(&s, body, method);
    s.run.options.checkpoint_steps = 4;
    rank_runs_outcome whole = rank_runs_alone(&s.run);
    assert_non_null(whole.kept);
    for (size_t k = 0; k < sizeof numbers / sizeof numbers[0]; k++) {
        rank_runs_assert_led(&s.run, numbers[k], NULL, &whole);
        rank_runs_assert_led(&s.run, numbers[k], &whole, &whole);
    }
    rank_runs_free_outcome(&whole);
    close_scene(&s);
}

/* ---- how often ranks talk ---- */

/* A run that rank 0 leads, and which it watches. */
typedef struct watched {
    const scene *scene;
    dem_status (*ask)(const dem_simulation *s); /* after each step */
    dem_status status;
    double v[2]; /* m/s, the largest |v_x| + |v_y| at the end: as it is reported, and of all nodes */
    int exchanges;
} watched;

static dem_status ask_nothing(const dem_simulation *s)
{
    return s != NULL ? DEM_OK : DEM_ERROR_ARGUMENT;
}

/* What the log looks at. */
static dem_status ask_how_far(const dem_simulation *s)
{
    dem_progress now = {.struct_size = sizeof now};
    return dem_simulation_fastest(s) > 0.0 ? dem_simulation_progress(s, &now) : DEM_ERROR_ARGUMENT;
}

static dem_status ask_step(void *context, const dem_simulation *s)
{
    return ((const watched *)context)->ask(s);
}

static dem_status watch(watched *w, const ranks *r)
{
    dem_simulation *s = NULL;
    dem_state state = {.struct_size = sizeof state};
    const dem_observer observer = SIZED(dem_observer, .context = w, .step = ask_step);
    dem_status status = dem_simulation_create(&s, w->scene->run.model, &w->scene->run.options);
    if (status == DEM_OK) status = dem_private_lead(s, r, &w->scene->run.options, NULL);
    if (status == DEM_OK) status = dem_simulation_observe(s, &observer);
    if (status == DEM_OK) status = dem_simulation_advance(s, 1e-4);
    w->exchanges = rank_threads_count(r).exchanges;
    w->v[0] = dem_simulation_fastest(s);
    if (status == DEM_OK) status = dem_simulation_state(s, &state);
    for (dem_index i = 0; status == DEM_OK && i < dem_model_lattice(w->scene->run.model)->n_nodes; i++)
        w->v[1] = fmax(w->v[1], fabs(state.v[2 * i]) + fabs(state.v[2 * i + 1]));
    dem_simulation_destroy(s);
    return status;
}

static void watch_as_leader(const ranks *r, void *context)
{
    watched *w = context;
    w->status = watch(w, r);
}

/* Rows of all nodes would take exchanges. */
TEST(a_leader_that_asks_how_far_the_run_is_gathers_nothing)
{
    scene s;
    open_scene(&s, 0, DEM_METHOD_VERLET);
    watched silent = {.scene = &s, .ask = ask_nothing}, curious = {.scene = &s, .ask = ask_how_far};
    rank_runs_lead(3, NULL, watch_as_leader, &silent);
    rank_runs_lead(3, NULL, watch_as_leader, &curious);
    assert_ok(silent.status);
    assert_ok(curious.status);
    assert_int_equal(curious.exchanges, silent.exchanges);
    assert_close(curious.v[0], curious.v[1], 0.0);
    close_scene(&s);
}

/* Three ranks.  \param[out] all  [3] */
static void listen(scene *s, int n_rings, double t_end, rank_runs_outcome *all)
{
    const dem_lattice *l = dem_model_lattice(s->run.model);
    CLEANUP(free_memory) int32_t *owner = malloc((size_t)l->n_nodes * sizeof *owner);
    assert_ok(partition_bisect(l, 3, owner));
    s->run.counts_calls = true;
    s->run.t_end = t_end;
    rank_runs_make_outcomes(&s->run, 3, all);
    rank_runs_together(&s->run, 3, &(domain_model_shares){.owner = owner, .n_rings = n_rings}, NULL, all);
    assert_string_equal(all[0].message, "");
    assert_true(all[0].n_steps > 10);
}

static dem_index count_rejected(const rank_runs_outcome *o)
{
    return o->views[RANK_RUNS_STOPS - 1].counts.rejected;
}

/* From its second step on, as the first evaluates where it begins. */
static void check_calls(int body, dem_method method, int n_rings, int n_exchanges)
{
    scene s;
    rank_runs_outcome all[3];
    open_scene(&s, body, method);
    listen(&s, n_rings, 1e-4, all);
    assert_int_equal(count_rejected(all), 0);
    for (dem_index k = 2; k < all->n_steps; k++) {
        const rank_runs_step *step = &all->steps[k];
        const int n_looks = (int)(rank_runs_looks(k) - rank_runs_looks(k - 1));
        assert_int_equal(step->calls.exchanges - step[-1].calls.exchanges,
                         n_exchanges + n_looks * RANK_RUNS_LOOK_EXCHANGES);
        assert_int_equal(step->calls.reductions - step[-1].calls.reductions, 1 + n_looks);
    }
    rank_runs_free_outcomes(all, 3);
    close_scene(&s);
}

TEST(a_step_needs_one_reduction_and_an_exchange_for_each_evaluation)
{
    static const int n_exchanges[N_METHODS] = {6, 6, 4, 1};
    for (int body = 0; body < N_BODIES; body += 3)
        for (int m = 0; m < N_METHODS; m++) check_calls(body, methods[m], 1, n_exchanges[m]);
}

TEST(a_step_of_fehlbergs_pair_needs_one_exchange_where_rings_of_ghosts_are_integrated)
{
    for (int body = 0; body < N_BODIES; body += 3) {
        check_calls(body, DEM_METHOD_FEHLBERG45, STEP_RINGS - 1, 6);
        check_calls(body, DEM_METHOD_FEHLBERG45, STEP_RINGS, 1);
        check_calls(body, DEM_METHOD_DOPRI45, STEP_RINGS, 6);
    }
}

/* Where the error is more than 32 times what is allowed, its sum is taken anew. The first step evaluates where it
 * begins, and asks for the norm of that state. */
TEST(an_attempt_that_is_rejected_needs_two_reductions_at_most)
{
    for (int n_rings = 1; n_rings <= STEP_RINGS; n_rings += STEP_RINGS - 1) {
        scene s;
        rank_runs_outcome all[3];
        open_scene(&s, 0, DEM_METHOD_FEHLBERG45);
        listen(&s, n_rings, 3e-4, all);
        const dem_index n_rejected = count_rejected(all), n = all->n_steps - 1, least = n + n_rejected;
        const int n_looks = (int)rank_runs_looks(n);
        const rank_threads_counts *first = &all->steps[0].calls, *last = &all->steps[n].calls;
        assert_true(n_rejected > 0);
        assert_in_range(last->reductions - first->reductions - n_looks, least, least + n_rejected + 3);
        assert_int_equal(last->exchanges - first->exchanges - n_looks * RANK_RUNS_LOOK_EXCHANGES,
                         (n_rings == 1 ? 6 : 1) * least + 1);
        rank_runs_free_outcomes(all, 3);
        close_scene(&s);
    }
}

/* ---- by which way steps are taken ---- */

/* Of a run by some ranks. */
typedef struct way {
    const scene *scene;
    const int32_t *owner;
    bool is_shared, has_bands, may_fuse, fuses; /* of rank 0's problem; whether it has taken a step in one sweep */
    dem_status status;
} way;

/* A step from the state at which the simulation is, whose accelerations, as of an integrator, are 0. */
static bool take_fused_step(const ode_problem *p, double *y)
{
    const size_t n = (size_t)state_size(&p->layout);
    CLEANUP(free_memory) double *f0 = calloc(n, sizeof *f0), *y1 = calloc(n, sizeof *y1), *f1 = calloc(n, sizeof *f1);
    const ode_fused_step step = {.t1 = p->max_step, .h = p->max_step, .y0 = y, .f0 = f0, .y1 = y1, .f1 = f1};
    return f0 != NULL && y1 != NULL && f1 != NULL && p->fused_step(&step, p->context) == 0;
}

static void find_way(const ranks *r, void *context)
{
    way other = *(way *)context, *w = r->rank == 0 ? context : &other;
    dem_model *model = NULL;
    dem_simulation *s = NULL;
    w->status = domain_model_create(&model, r, w->scene->run.model, &(domain_model_shares){.owner = w->owner});
    if (w->status == DEM_OK) w->status = dem_simulation_create(&s, model, &w->scene->run.options);
    if (w->status == DEM_OK) {
        const ode_problem p = right_hand_side_problem(s);
        w->is_shared = p.domain != NULL;
        w->has_bands = p.has_bands != NULL;
        w->may_fuse = p.fused_step != NULL;
        w->fuses = w->may_fuse && take_fused_step(&p, s->y);
    }
    dem_simulation_destroy(s);
    dem_model_destroy(model);
}

/* One alone may go by the bands of a wave, too; several may where they integrate ghosts: not by Verlet's method. */
TEST(a_team_of_one_steps_as_a_process_alone_and_any_ranks_take_fused_steps)
{
    scene s;
    open_scene(&s, 3, DEM_METHOD_VERLET);
    const dem_lattice *l = dem_model_lattice(s.run.model);
    CLEANUP(free_memory) int32_t *owner = malloc((size_t)l->n_nodes * sizeof *owner);
    for (int n = 1; n <= 3; n += 2) {
        way w = {.scene = &s, .owner = owner};
        scatter(l, 4.1 * spacing, n, owner);
        rank_threads_run(n, find_way, &w);
        assert_ok(w.status);
        assert_int_equal(w.is_shared, n > 1);
        assert_int_equal(w.has_bands, n == 1);
        assert_true(w.may_fuse && w.fuses);
    }
    close_scene(&s);
}

/* ---- failures ---- */

/* On four ranks.  \param[out] all  [4] */
static void refuse(const scene *s, const rank_runs_outcome *from, rank_runs_outcome *all)
{
    const dem_lattice *l = dem_model_lattice(s->run.model);
    CLEANUP(free_memory) int32_t *owner = malloc((size_t)l->n_nodes * sizeof *owner);
    assert_ok(partition_bisect(l, 4, owner));
    rank_runs_make_outcomes(&s->run, 4, all);
    rank_runs_together(&s->run, 4, &(domain_model_shares){.owner = owner}, from, all);
}

/* Every rank gives up as one process does, after as many steps, and leaves the same state. */
static void check_failure(const dem_lattice *l, dem_method method)
{
    scene s = {.run = {.model = support_model(l, NULL, 0), .options = dem_options_default(), .t_end = 2e-4}};
    CLEANUP(free_memory) int32_t *owner = malloc((size_t)l->n_nodes * sizeof *owner);
    s.run.options.method = method;
    s.run.options.checkpoint_steps = 0;
    rank_runs_outcome whole = rank_runs_alone(&s.run);
    assert_int_equal(whole.status, DEM_ERROR_INTEGRATOR);
    assert_ok(partition_bisect(l, 4, owner));
    (void)rank_runs_assert_shared(&s.run, 4, &(domain_model_shares){.owner = owner}, NULL, &whole);
    rank_runs_free_outcome(&whole);
    close_scene(&s);
}

/* Two neighbours at one place have no direction of their force. */
TEST(a_force_that_is_not_finite_ends_the_run_of_all_ranks)
{
    CLEANUP(dem_lattice_free) dem_lattice l = make_lattice(0);
    support_start(&l, l.x, NULL);
    memcpy(l.position + 2 * l.ends[0], l.position + 2 * l.ends[1], 2 * sizeof *l.position);
    check_failure(&l, DEM_METHOD_FEHLBERG45);
    check_failure(&l, DEM_METHOD_VERLET);
}

/* The force is finite where the step begins; at its end one node is so far away that the square of a length is not.
 * Verlet's step is a single sweep, which fails. */
TEST(a_step_at_whose_end_a_force_is_not_finite_ends_the_run_of_all_ranks)
{
    CLEANUP(dem_lattice_free) dem_lattice l = make_lattice(3);
    l.velocity[77] = 1e200;
    check_failure(&l, DEM_METHOD_VERLET);
}

/* A boundary names a node of one rank twice. */
TEST(what_one_rank_refuses_is_refused_by_all)
{
    const dem_index twice[] = {0, 9, 0};
    scene s;
    open_scene(&s, 0, DEM_METHOD_VERLET);
    s.boundaries[0] = (dem_boundary)SIZED(dem_boundary, .kind = DEM_BOUNDARY_FORCE, .n_nodes = 3, .nodes = twice);
    s.run.options.boundaries = s.boundaries;
    s.run.options.n_boundaries = 1;
    rank_runs_outcome all[4];
    refuse(&s, NULL, all);
    for (int k = 0; k < 4; k++) {
        assert_int_equal(all[k].status, DEM_ERROR_ARGUMENT);
        assert_string_equal(all[k].message, "boundary 0: node 0 is named twice");
    }
    rank_runs_free_outcomes(all, 4);
    close_scene(&s);
}

/* Rank 0 has the checkpoint, of a body with more nodes. */
TEST(a_checkpoint_of_another_model_is_refused_by_all)
{
    scene s, other;
    open_scene(&other, 1, DEM_METHOD_VERLET);
    other.run.options.checkpoint_steps = 4;
    rank_runs_outcome whole = rank_runs_alone(&other.run);
    open_scene(&s, 0, DEM_METHOD_VERLET);
    rank_runs_outcome all[4];
    refuse(&s, &whole, all);
    for (int k = 0; k < 4; k++) {
        assert_int_equal(all[k].status, DEM_ERROR_IO);
        assert_string_equal(all[k].message, all[0].message);
        assert_non_null(strstr(all[k].message, "the checkpoint has "));
    }
    rank_runs_free_outcomes(all, 4);
    rank_runs_free_outcome(&whole);
    close_scene(&other);
    close_scene(&s);
}

static bool stop_third_step(const dem_simulation *s, const rank_runs_outcome *so_far)
{
    return s->model->ranks->rank == 2 && so_far->n_steps == 3;
}

TEST(an_observer_of_one_rank_stops_all)
{
    scene s;
    rank_runs_outcome all[4];
    open_scene(&s, 0, DEM_METHOD_DOPRI45);
    s.run.stops = stop_third_step;
    refuse(&s, NULL, all);
    for (int k = 0; k < 4; k++) {
        assert_int_equal(all[k].status, DEM_STOPPED);
        assert_int_equal(all[k].n_steps, 3);
    }
    rank_runs_free_outcomes(all, 4);
    close_scene(&s);
}

/* ---- the same bits ---- */

TEST(free_bodies_that_fold_have_the_bits_of_one_process)
{
    for (int m = 0; m < N_METHODS; m++) check(0, methods[m]);
}

TEST(damped_bodies_have_the_bits_of_one_process)
{
    for (int m = 0; m < N_METHODS; m++) check(1, methods[m]);
}

TEST(driven_bodies_have_the_bits_of_one_process)
{
    for (int m = 0; m < N_METHODS; m++) check(2, methods[m]);
}

TEST(squares_have_the_bits_of_one_process)
{
    for (int m = 0; m < N_METHODS; m++) check(3, methods[m]);
}

/* In one process the layout of this one has the nodes in another order. In short domains that of a rank has not; in
 * domains of rows it has one of its own, by which an element may have its lowest node on either rank. */
TEST(a_long_strip_has_the_bits_of_one_process)
{
    for (int body = STRIP; body <= COUPLED_STRIP; body++) {
        scene s;
        open_scene(&s, body, DEM_METHOD_VERLET);
        const dem_index n = dem_model_lattice(s.run.model)->n_nodes;
        CLEANUP(free_memory) int32_t *owner = malloc((size_t)n * sizeof *owner);
        assert_non_null(s.run.model->layout.order);
        for (dem_index i = 0; i < n; i++) owner[i] = (int32_t)(2 * i / n);
        rank_runs_outcome whole = rank_runs_alone(&s.run);
        share(&s, 2, owner, NULL, &whole);
        rank_runs_free_outcome(&whole);
        close_scene(&s);
        check_numbers(body, DEM_METHOD_VERLET, (const int[]){3}, 1);
    }
}

TEST(checkpoints_are_those_of_one_process_and_any_number_of_ranks_goes_on)
{
    for (int m = 0; m < N_METHODS; m++) check_checkpoints(m == 0 ? 0 : 2, methods[m]);
    check_checkpoints(1, DEM_METHOD_FEHLBERG45);
}

/* Rank 0 has a simulation of the whole, which shows what all ranks do. */
TEST(a_run_that_rank_0_leads_has_the_bits_of_one_process)
{
    check_led(1, DEM_METHOD_FEHLBERG45);
    check_led(2, DEM_METHOD_VERLET);
}
