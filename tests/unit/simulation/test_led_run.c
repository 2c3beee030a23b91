/* SPDX-License-Identifier: BSD-3-Clause */
/* led_run.c, shared_field.c, shared_peaks.c: nodes that are shared out anew, as ranks say that they work for different
 * times, change no bit of what is seen, fields of nodes and springs and their peaks too, and frames, steps and
 * checkpoints come as in a run of one process. */
#include "harness/rank_threads.h"
#include "simulation/led_run.h"
#include "unit/simulation/runs.h"
#include "verification/rank_runs.h"

#include <stdio.h>

enum { N_RANKS = 3, MOST_FRAMES = 64, TEXT = 256 };

typedef struct watched {
    const dem_model *model;
    dem_options options;
    dem_index n_nodes, n_springs; /* of the whole, and how many numbers a frame has */
    size_t n_seen;
    int n_frames, n_checkpoints, n_steps;
    double *frames;                /* [MOST_FRAMES][n_seen] positions, stresses, strains and forces */
    dem_node_peak *node_peaks;     /* [2][n_nodes] half-way and at the end, as the next ones are */
    dem_spring_peak *spring_peaks; /* [2][n_springs] */
    dem_index n_own;               /* of the part of rank 0 now, and */
    int n_shared;                  /* how often it has had other nodes */
    char failure[TEXT];            /* empty: none */
} watched;

static dem_status note_frame(void *context, const dem_simulation *s)
{
    watched *w = context;
    dem_state state = {.struct_size = sizeof state};
    TRY(dem_simulation_state(s, &state));
    if (w->n_frames == MOST_FRAMES) return DEM_ERROR_ARGUMENT;
    double *frame = w->frames + w->n_seen * (size_t)w->n_frames++, *strain = frame + 5 * w->n_nodes;
    memcpy(frame, state.x, 2 * (size_t)w->n_nodes * sizeof *state.x);
    TRY(dem_simulation_stress(s, frame + 2 * w->n_nodes));
    TRY(dem_simulation_strains(s, strain));
    return dem_simulation_forces(s, strain + w->n_springs);
}

static dem_index count_own(const dem_simulation *part)
{
    const domain *d = part->model->domain;
    dem_index n = 0;
    for (dem_index i = 0; i < d->n_nodes; i++) n += d->is_own[i];
    return n;
}

static dem_status count_step(void *context, const dem_simulation *s)
{
    watched *w = context;
    w->n_steps++;
    if (s->leads == NULL) return DEM_OK;
    const dem_index n = count_own(led_run_part(s->leads));
    w->n_shared += n != w->n_own;
    w->n_own = n;
    return DEM_OK;
}

static dem_status count_checkpoint(void *context, const dem_simulation *s, dem_checkpoint *checkpoint)
{
    (void)s;
    (void)checkpoint;
    ((watched *)context)->n_checkpoints++;
    return DEM_OK;
}

static void note_peaks(watched *w, const dem_peaks *peaks, int k)
{
    memcpy(w->node_peaks + k * w->n_nodes, dem_peaks_nodes(peaks), (size_t)w->n_nodes * sizeof *w->node_peaks);
    memcpy(w->spring_peaks + k * w->n_springs, dem_peaks_springs(peaks),
           (size_t)w->n_springs * sizeof *w->spring_peaks);
}

/* They are read while there is a simulation, and when it is gone.
 * \param leads  ranks that make the run; NULL: this process alone does */
static dem_status watch_with(watched *w, dem_peaks *peaks, const ranks *leads)
{
    dem_simulation *s = NULL;
    dem_observer looks = {.struct_size = sizeof looks};
    const dem_observer observer = SIZED(dem_observer, .context = w, .interval = 2.5e-4, .frame = note_frame,
                                        .step = count_step, .checkpoint = count_checkpoint);
    dem_status status = dem_simulation_create(&s, w->model, &w->options);
    if (status == DEM_OK && leads != NULL) status = dem_private_lead(s, leads, &w->options, NULL);
    if (status == DEM_OK) status = dem_simulation_observe(s, &observer);
    if (status == DEM_OK) status = dem_peaks_observer(peaks, &looks);
    if (status == DEM_OK) status = dem_simulation_observe(s, &looks);
    if (status == DEM_OK) status = dem_simulation_advance(s, 0.5 * t_whole);
    if (status == DEM_OK) note_peaks(w, peaks, 0);
    if (status == DEM_OK) status = dem_simulation_advance(s, t_whole);
    if (status == DEM_OK) status = note_frame(w, s);
    dem_simulation_destroy(s);
    if (status == DEM_OK) note_peaks(w, peaks, 1);
    return status;
}

static dem_status watch(watched *w, const ranks *leads)
{
    dem_peaks *peaks = NULL;
    dem_status status = dem_peaks_create(&peaks, w->model, 3);
    if (status == DEM_OK) status = watch_with(w, peaks, leads);
    dem_peaks_destroy(peaks);
    return status;
}

static void watch_as_leader(const ranks *r, void *context)
{
    watched *w = context;
    if (watch(w, r) != DEM_OK) (void)snprintf(w->failure, TEXT, "%s", dem_status_message());
}

static watched begin_watch(const dem_model *model)
{
    const dem_lattice *l = dem_model_lattice(model);
    watched w = {.model = model, .options = dem_options_default(), .n_nodes = l->n_nodes, .n_springs = l->n_springs};
    w.n_seen = (size_t)(5 * l->n_nodes + 2 * l->n_springs);
    w.options.checkpoint_steps = 8;
    w.node_peaks = calloc((size_t)(2 * w.n_nodes), sizeof *w.node_peaks);
    w.spring_peaks = calloc((size_t)(2 * w.n_springs), sizeof *w.spring_peaks);
    w.frames = calloc(MOST_FRAMES * w.n_seen, sizeof *w.frames);
    return w;
}

static void end_watch(watched *w)
{
    free(w->frames);
    free(w->node_peaks);
    free(w->spring_peaks);
}

/* \param seconds  of work for each call, of each rank; NULL: nobody knows
 * \return how many nodes rank 0 has at the end; \param[out] n_shared  and how often it has had other ones */
static dem_index lead(const watched *whole, const double *seconds, int *n_shared)
{
    watched led = begin_watch(whole->model);
    rank_threads_pretend(seconds);
    rank_runs_lead(N_RANKS, NULL, watch_as_leader, &led);
    rank_threads_pretend(NULL);
    assert_string_equal(led.failure, "");
    assert_int_equal(led.n_steps, whole->n_steps);
    assert_int_equal(led.n_frames, whole->n_frames);
    assert_int_equal(led.n_checkpoints, whole->n_checkpoints);
    assert_memory_equal(led.frames, whole->frames, led.n_seen * (size_t)led.n_frames * sizeof *led.frames);
    assert_memory_equal(led.node_peaks, whole->node_peaks, (size_t)(2 * led.n_nodes) * sizeof *led.node_peaks);
    assert_memory_equal(led.spring_peaks, whole->spring_peaks, (size_t)(2 * led.n_springs) * sizeof *led.spring_peaks);
    end_watch(&led);
    *n_shared = led.n_shared;
    return led.n_own;
}

TEST(nodes_that_are_shared_out_anew_change_no_bit)
{
    static const double slow_0[N_RANKS] = {3.0, 1.0, 1.0}, slow_2[N_RANKS] = {1.0, 1.0, 1.5},
                        alike[N_RANKS] = {1.0, 1.0, 1.0};
    int n_shared;
    dem_index n_later = 0;
    dem_model *model = make_falling(0.5);
    watched whole = begin_watch(model);
    assert_ok(watch(&whole, NULL));
    assert_true(whole.n_checkpoints > 3 && whole.n_frames > 10 && whole.n_frames < MOST_FRAMES);
    for (dem_index i = 0; i < whole.n_nodes; i++) /* which the second half has changed */
        n_later += whole.node_peaks[whole.n_nodes + i].t > 0.5 * t_whole;
    assert_true(n_later > 0 && n_later < whole.n_nodes);
    const dem_index n = lead(&whole, NULL, &n_shared);
    assert_int_equal(n, whole.n_nodes / N_RANKS);
    assert_int_equal(lead(&whole, alike, &n_shared), n);
    assert_int_equal(n_shared, 1);
    assert_true(lead(&whole, slow_0, &n_shared) < n);
    assert_true(lead(&whole, slow_2, &n_shared) > n);
    assert_true(n_shared > 2); /* not once only */
    end_watch(&whole);
    dem_model_destroy(model);
}

int main(void)
{
    return test_run();
}
