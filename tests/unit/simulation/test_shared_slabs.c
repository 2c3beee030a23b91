/* SPDX-License-Identifier: BSD-3-Clause */
/* shared_slabs.c, whole_of_parts.c, led_run.c, led_parts.c, slab_migration.c: rank 0 leads a run of a lattice that
 * nobody has, and its files are those of a process that has it, whether or not nodes are shared out anew. */
#include "base/checkpoint_entries.h"
#include "base/slab_recipe.h"
#include "harness/rank_threads.h"
#include "simulation/led_run.h"
#include "unit/same_frames.h"
#include "unit/scratch.h"
#include "unit/simulation/runs.h"
#include "verification/rank_runs.h"

#include "shape/shape_slab.h"

#include <dem/trajectory.h>

#include <stdatomic.h>

enum { N_RANKS = 3, TEXT = 256, MOST_STRESSED = 5 };

static const dem_obstacle slope = {
    .struct_size = sizeof(dem_obstacle), .n_points = 3, .points = slope_points, .restitution = 0.5};
static const double down[2] = {0.5, -4.0};

/* So large, in m, that no rank has all nodes, though what may touch, with rings about it, is common. */
static const double width = 0.2, height = 0.3;

static const dem_probe probes[] = {{.name = "node", .kind = DEM_PROBE_NODE, .number = {4, 0}, .every = 1},
                                   {.name = "spring", .kind = DEM_PROBE_SPRING, .number = {20, 0}, .every = 2},
                                   {.name = "gauge", .kind = DEM_PROBE_GAUGE, .number = {1, 12}, .every = 1}};

/* ---- the same lattice as a whole and in slabs ---- */

static dem_status assemble(dem_lattice *lattice)
{
    const dem_material rubber = {.struct_size = sizeof rubber,
                                 .youngs_modulus = 1e7,
                                 .poissons_ratio = 1.0 / 3.0,
                                 .density = 1050.0,
                                 .thickness = 1.0,
                                 .guard = 0.02};
    const double up[2] = {0.01, 0.02};
    TRY(dem_lattice_assemble(lattice, &rubber));
    dem_lattice_move(lattice, 0.0, up);
    return dem_lattice_launch(lattice, down);
}

static dem_outline outline_of(double given)
{
    return (dem_outline)SIZED(dem_outline, .centre = {0.5 * width, 0.5 * given}, .size = {width, given});
}

static dem_model *make_whole(void)
{
    const dem_outline outline = outline_of(height);
    const dem_shape shape = SIZED(dem_shape, .outline = &outline, .spacing = spacing);
    dem_lattice lattice = dem_lattice_empty();
    assert_ok(dem_shape_lattice(&lattice, &shape, NULL));
    assert_ok(assemble(&lattice));
    dem_model *model = support_model(&lattice, &slope, 1);
    dem_lattice_free(&lattice);
    return model;
}

static dem_status cut_slab(const dem_shape *shape, const slab_share *which, dem_slab *out)
{
    dem_private_rows rows = {0};
    dem_index *counts = NULL;
    if (which->first == NULL) return dem_slab_shape(out, shape, which->part, which->n_parts);
    const dem_index begin = which->first[which->part], end = which->first[which->part + 1];
    const dem_status status = dem_private_slab_between(out, shape, &rows, &counts, begin, end);
    free(counts);
    if (status == DEM_OK && out->n_own == 0) return status_fail(DEM_ERROR_MODEL, "no rows");
    return status;
}

/* How often slabs are made, and what is to go wrong. */
typedef struct making {
    atomic_int n[N_RANKS + 1];
    int fails_at;    /* which of them fails, on the last rank, */
    dem_status with; /* or makes nodes elsewhere: DEM_OK */
} making;

/* The recipe is the height of the rectangle. */
static dem_status make_slab(void *program, const void *recipe, size_t size, const slab_share *which, dem_slab *out)
{
    making *m = program;
    double given;
    if (size != sizeof given) return DEM_ERROR_ARGUMENT;
    memcpy(&given, recipe, sizeof given);
    const bool fails = atomic_fetch_add(&m->n[which->part], 1) + 1 == m->fails_at && which->part == which->n_parts - 1;
    if (fails && m->with != DEM_OK) return status_fail(m->with, "it is gone");
    const dem_outline outline = outline_of(given);
    const dem_shape shape = SIZED(dem_shape, .outline = &outline, .spacing = spacing);
    TRY(cut_slab(&shape, which, out));
    if (fails) out->lattice.x[2 * out->first_own] += 1e-3 * spacing;
    return assemble(&out->lattice);
}

/* ---- runs ---- */

typedef struct written {
    const dem_model *whole; /* NULL: rank 0 leads a run of slabs */
    slab_maker maker;
    double height; /* m, of what is made in slabs */
    dem_options options;
    const char *path;
    dem_index n_own;    /* nodes of rank 0 now, */
    int n_shared;       /* and how often it has had other ones */
    char failure[TEXT]; /* empty: none */
} written;

static dem_status count_step(void *context, const dem_simulation *s)
{
    written *w = context;
    if (s->leads == NULL) return DEM_OK;
    const domain *d = led_run_part(s->leads)->model->domain;
    dem_index n = 0;
    for (dem_index i = 0; i < d->n_nodes; i++) n += d->is_own[i];
    w->n_shared += n != w->n_own;
    w->n_own = n;
    return DEM_OK;
}

static dem_trajectory_options options_with(const dem_peaks *peaks)
{
    dem_trajectory_options o = dem_trajectory_options_default();
    o.frame_interval = 2e-4;
    o.fields = DEM_FIELD_ALL & ~(uint32_t)DEM_FIELD_FRAGMENT;
    o.n_probes = sizeof probes / sizeof *probes;
    o.probes = probes;
    o.peaks = peaks;
    o.most_stressed = MOST_STRESSED;
    return o;
}

static dem_status advance(written *w, dem_simulation *s, dem_trajectory *t, dem_peaks *peaks)
{
    dem_observer all[3] = {{.struct_size = sizeof *all},
                           {.struct_size = sizeof *all},
                           {.struct_size = sizeof *all, .step = count_step, .context = w}};
    TRY(dem_trajectory_observer(t, &all[0]));
    TRY(dem_peaks_observer(peaks, &all[1]));
    for (int k = 0; k < 3; k++) TRY(dem_simulation_observe(s, &all[k]));
    TRY(dem_simulation_advance(s, t_whole));
    return dem_trajectory_finish(t);
}

static dem_status run(written *w, const dem_model *model, const ranks *leads)
{
    dem_simulation *s = NULL;
    dem_trajectory *t = NULL;
    dem_peaks *peaks = NULL;
    dem_status status = dem_peaks_create(&peaks, model, 3);
    const dem_trajectory_options o = options_with(peaks);
    if (status == DEM_OK) status = dem_simulation_create(&s, model, &w->options);
    if (status == DEM_OK && leads != NULL) status = dem_private_lead(s, leads, &w->options, NULL);
    if (status == DEM_OK) status = dem_trajectory_create(&t, w->path, s, &o);
    if (status == DEM_OK) status = advance(w, s, t, peaks);
    dem_trajectory_destroy(t);
    dem_simulation_destroy(s);
    dem_peaks_destroy(peaks);
    return status;
}

static dem_status run_slabs(written *w, const ranks *r)
{
    dem_model *model = NULL;
    const slab_recipe recipe = {
        .bytes = &w->height, .size = sizeof w->height, .obstacles = &slope, .n_obstacles = 1, .options = &w->options};
    TRY(dem_private_lead_slabs(&model, r, &w->maker, &recipe));
    const dem_status status = run(w, model, r);
    dem_model_destroy(model);
    return status;
}

static void lead(const ranks *r, void *context)
{
    written *w = context;
    const dem_status status = w->whole != NULL ? run(w, w->whole, r) : run_slabs(w, r);
    if (status != DEM_OK) (void)snprintf(w->failure, TEXT, "%s", dem_status_message());
}

static written prepare(const char *path, making *slabs)
{
    written w = {.maker = {make_slab, slabs}, .height = height, .options = dem_options_default(), .path = path};
    w.options.checkpoint_steps = 8;
    w.options.bodies = DEM_BODIES_NONE;
    return w;
}

/* Runs slabs on ranks that say they work for such times, and compares with a process that has the whole.
 * \param seconds  as rank_threads_pretend() has it */
static void check_frames(const double *seconds, making *slabs, int *n_shared, dem_index *n_own)
{
    scratch_folder folder;
    folder_open(&folder);
    const char *one = folder_file(&folder, "one.vtkhdf"), *led = folder_file(&folder, "led.vtkhdf");
    for (const char *const *n = (const char *const[]){"one.body.vtkhdf", "led.body.vtkhdf", "one.obstacle.vtkhdf",
                                                      "led.obstacle.vtkhdf", NULL};
         *n != NULL; n++)
        (void)folder_file(&folder, *n);
    dem_model *model = make_whole();
    written alone = prepare(one, NULL), ranks_have = prepare(led, slabs);
    assert_ok(run(&alone, model, NULL));
    rank_threads_pretend(seconds);
    rank_runs_lead(N_RANKS, &ranks_have.maker, lead, &ranks_have);
    rank_threads_pretend(NULL);
    assert_string_equal(ranks_have.failure, "");
    same_frames_check(one, led);
    *n_shared = ranks_have.n_shared;
    *n_own = ranks_have.n_own;
    dem_model_destroy(model);
    folder_close(&folder);
}

TEST(a_run_of_slabs_has_the_frames_of_a_process_that_has_the_whole)
{
    making slabs = {0};
    int n_shared;
    dem_index n_own;
    check_frames(NULL, &slabs, &n_shared, &n_own);
    assert_int_equal(n_shared, 1);
    assert_int_equal(slabs.n[0], 1);
}

/* ---- shared out anew ---- */

TEST(slabs_that_are_made_anew_change_no_bit)
{
    static const double slow_0[N_RANKS] = {3.0, 1.0, 1.0}, slow_2[N_RANKS] = {1.0, 1.0, 1.5},
                        alike[N_RANKS] = {1.0, 1.0, 1.0};
    making slabs = {0}, of_0 = {0}, of_2 = {0};
    int n_shared;
    dem_index n, n_own;
    check_frames(alike, &slabs, &n_shared, &n);
    assert_int_equal(n_shared, 1);
    check_frames(slow_0, &of_0, &n_shared, &n_own);
    assert_true(n_own < n && n_shared > 1);
    check_frames(slow_2, &of_2, &n_shared, &n_own);
    assert_true(n_own > n && n_own < 2 * n);
    assert_true(of_2.n[0] > 2); /* not once only */
}

TEST(where_a_rank_would_have_no_rows_nodes_stay_where_they_are)
{
    static const double slow_0[N_RANKS] = {3.0, 1.0, 1.0};
    making slabs = {.fails_at = 2, .with = DEM_ERROR_MODEL};
    int n_shared;
    dem_index n_own;
    check_frames(slow_0, &slabs, &n_shared, &n_own);
    assert_true(slabs.n[0] > 2 && slabs.n[0] > n_shared);
}

/* \param message  what the run ends with, when slabs are made for the second time */
static void check_end(dem_status with, const char *message)
{
    static const double slow_0[N_RANKS] = {3.0, 1.0, 1.0};
    making slabs = {.fails_at = 2, .with = with};
    scratch_folder folder;
    folder_open(&folder);
    written w = prepare(folder_file(&folder, "led.vtkhdf"), &slabs);
    rank_threads_pretend(slow_0);
    rank_runs_lead(N_RANKS, &w.maker, lead, &w);
    rank_threads_pretend(NULL);
    assert_non_null(strstr(w.failure, message));
    for (const char *const *n =
             (const char *const[]){"led.part.vtkhdf", "led.body.vtkhdf", "led.obstacle.vtkhdf", NULL};
         *n != NULL; n++)
        (void)folder_file(&folder, *n);
    folder_close(&folder);
}

TEST(slabs_that_cannot_be_made_again_end_the_run)
{
    check_end(DEM_ERROR_IO, "it is gone");
}

TEST(slabs_that_are_others_end_the_run)
{
    check_end(DEM_OK, "become others");
}

/* ---- going on ---- */

typedef struct resumed {
    written of;
    dem_checkpoint *from;
    double *state; /* [2][nodes][2] at the end */
} resumed;

static dem_status go_on(resumed *w, const dem_model *model, const ranks *leads)
{
    const dem_index n = 2 * ask_sizes(model).n_nodes;
    dem_simulation *s = NULL;
    w->state = calloc(2 * (size_t)n, sizeof *w->state);
    dem_status status = dem_simulation_resume(&s, model, &w->of.options, w->from);
    if (status == DEM_OK && leads != NULL) status = dem_private_lead(s, leads, &w->of.options, w->from);
    if (status == DEM_OK) status = dem_simulation_advance(s, t_whole);
    if (status == DEM_OK) status = dem_simulation_gather(s, w->state, w->state + n);
    dem_simulation_destroy(s);
    return status;
}

static void lead_on(const ranks *r, void *context)
{
    resumed *w = context;
    dem_model *model = NULL;
    const slab_recipe recipe = {.bytes = &w->of.height,
                                .size = sizeof w->of.height,
                                .obstacles = &slope,
                                .n_obstacles = 1,
                                .options = &w->of.options};
    dem_status status = dem_private_lead_slabs(&model, r, &w->of.maker, &recipe);
    if (status == DEM_OK) status = go_on(w, model, r);
    if (status != DEM_OK) (void)snprintf(w->of.failure, TEXT, "%s", dem_status_message());
    dem_model_destroy(model);
}

static dem_checkpoint *checkpoint_half_way(const dem_model *model, const dem_options *options)
{
    dem_checkpoint *copy;
    dem_simulation *s = simulate(model, options);
    assert_ok(dem_simulation_advance(s, 0.5 * t_whole));
    assert_ok(dem_checkpoint_create(&copy));
    assert_ok(checkpoint_entries_copy(copy, dem_simulation_checkpoint(s)));
    dem_simulation_destroy(s);
    return copy;
}

TEST(a_run_of_slabs_goes_on_from_the_checkpoint_of_one_process)
{
    dem_model *model = make_whole();
    making made = {0};
    resumed alone = {.of = prepare("none.vtkhdf", &made)}, slabs = alone;
    const size_t size = 4 * (size_t)ask_sizes(model).n_nodes * sizeof(double);
    alone.from = slabs.from = checkpoint_half_way(model, &alone.of.options);
    assert_ok(go_on(&alone, model, NULL));
    rank_runs_lead(N_RANKS, &slabs.of.maker, lead_on, &slabs);
    assert_string_equal(slabs.of.failure, "");
    assert_memory_equal(alone.state, slabs.state, size);
    free(alone.state);
    free(slabs.state);
    dem_checkpoint_destroy(alone.from);
    dem_model_destroy(model);
}

TEST(a_recipe_that_one_rank_cannot_follow_is_refused_on_all)
{
    making made = {0};
    written w = prepare("none.vtkhdf", &made);
    w.height = spacing; /* too few rows for a slab of each */
    rank_runs_lead(N_RANKS + 1, &w.maker, lead, &w);
    assert_non_null(strstr(w.failure, "rows"));
}

int main(void)
{
    return test_run();
}
