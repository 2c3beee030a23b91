/* SPDX-License-Identifier: BSD-3-Clause */
/* Each turn takes every stage one band further. Stage s is a band behind stage s - 1, whose derivative it needs, and
 * the derivative of a band needs the state of the bands beside it. With R stages band b comes
 *   in turn b + s       into the state of stage s, s = 0 to R - 1,
 *   in turn b + s + 1   into its derivative,
 *   in turn b + R       into the end of the step and the squares of its error.
 * Velocities of a stage are the first half of its derivative too, so they are kept with its accelerations until the
 * end: in slots, one for each band that is on its way. Positions are read by the neighbouring bands only and lie side
 * by side in a window, which goes on with the bands.
 *
 * Shares of the pass are consecutive bands. Each share takes its stages from R - s bands further below and up to R - s
 * bands further above by itself, to the same bits, so that shares have nothing to wait for. */
#include "time/stage_wave.h"

#include <math.h>
#include <stdlib.h>

#include "base/aligned.h"

enum {
    CACHED = 8000,    /* nodes, of which a core has all arrays of a step in its second cache */
    LEAST_BANDS = 24, /* of a share: it takes some 4 in addition */
    MANY_BANDS = 60,  /* from which on there are more shares than threads */
    WINDOW_BANDS = 6, /* of which three are in use */
    PIECE = 1024,     /* numbers of the error at a time */
    LINE = ALIGNED_TO / sizeof(double)
};

/* What a thread has of a stage. */
typedef struct stage_room {
    double *x, *v, *a;
    double *scratch;    /* of the evaluation */
    dem_index x_begins; /* the component of a state with which x begins */
} stage_room;

struct stage_wave {
    const ode_problem *problem;
    int n_stages, n_shares, n_threads;
    dem_index n_bands, band; /* components of a band but the last */
    dem_index slot, window;  /* numbers that there is room for */
    stage_room *rooms;       /* [n_threads][n_stages] */
    array_ops_sum *squares;  /* [n_shares] */
    double *sums;            /* [n_shares] of accelerations */
};

/* The pass of one share. */
typedef struct wave_pass {
    const stage_wave *wave;
    const stage_program *program;
    stage_room *rooms;     /* of the thread */
    dem_index first, last; /* bands; `last` is behind */
    array_ops_sum squares;
    double sum;
} wave_pass;

/* ---- bands ---- */

static dem_index band_begin(const stage_wave *w, dem_index b)
{
    return b * w->band;
}

/* What stands behind the nodes belongs to the last band. */
static dem_index band_end(const stage_wave *w, dem_index b)
{
    return b + 1 < w->n_bands ? (b + 1) * w->band : state_velocities(&w->problem->layout);
}

/* Bands that a share needs of a stage: its own and `further` more on either side. */
static dem_index first_band(const wave_pass *p, int further)
{
    return p->first > further ? p->first - further : 0;
}

static bool has_band(const wave_pass *p, dem_index b, int further)
{
    return b >= first_band(p, further) && b < p->last + further && b < p->wave->n_bands;
}

/* Where a band of the velocities and accelerations of a stage is: there are n_stages - stage + 1 slots. */
static dem_index slot_of(const stage_wave *w, int stage, dem_index b)
{
    return b % (w->n_stages - stage + 1) * w->slot;
}

/* ---- sums ---- */

/* The operands of a sum in a band: of positions, or of velocities. */
static void find_operands(const wave_pass *p, const stage_sum *s, dem_index b, bool of_velocities, const double **in)
{
    const stage_wave *w = p->wave;
    const dem_index at = band_begin(w, b) + (of_velocities ? state_velocities(&w->problem->layout) : 0);
    for (int k = 0; k < s->n; k++) {
        const int stage = s->operand[k] - STAGE_WAVE_GIVEN;
        if (stage < 0)
            in[k] = p->program->given[s->operand[k]] + at;
        else
            in[k] = (of_velocities ? p->rooms[stage].a : p->rooms[stage].v) + slot_of(w, stage, b);
    }
}

static void add_up(const wave_pass *p, const stage_sum *s, dem_index b, bool of_velocities, double *out)
{
    const double *in[STAGE_WAVE_TERMS];
    find_operands(p, s, b, of_velocities, in);
    p->wave->problem->ops->combine(out, s->n, s->factor, in, band_end(p->wave, b) - band_begin(p->wave, b));
}

/* Where the window has a band. If there is no room behind those that it has, it goes on with the last two of them. */
static double *enter_window(const wave_pass *p, int stage, dem_index b)
{
    const stage_wave *w = p->wave;
    stage_room *r = &p->rooms[stage];
    const dem_index begin = band_begin(w, b), first = first_band(p, w->n_stages - stage);
    if (b == first) r->x_begins = begin;
    if (band_end(w, b) - r->x_begins > w->window) {
        const dem_index kept = band_begin(w, b - 2);
        memmove(r->x, r->x + (kept - r->x_begins), (size_t)(begin - kept) * sizeof *r->x);
        r->x_begins = kept;
    }
    return r->x + (begin - r->x_begins);
}

static void enter_stage(const wave_pass *p, int stage, dem_index b)
{
    const stage_sum *s = &p->program->sums[stage];
    add_up(p, s, b, false, enter_window(p, stage, b));
    add_up(p, s, b, true, p->rooms[stage].v + slot_of(p->wave, stage, b));
}

/* The squares of half of the error, in pieces, of which none is kept. */
static void add_squares(wave_pass *p, dem_index b, bool of_velocities)
{
    const stage_wave *w = p->wave;
    const stage_sum *s = &p->program->sums[w->n_stages + 1];
    const dem_index size = band_end(w, b) - band_begin(w, b);
    const dem_index begin = band_begin(w, b) + (of_velocities ? state_velocities(&w->problem->layout) : 0);
    const double *in[STAGE_WAVE_TERMS];
    double error[PIECE];
    find_operands(p, s, b, of_velocities, in);
    for (dem_index k = 0; k < size; k += PIECE) {
        const dem_index n = k + PIECE < size ? PIECE : size - k;
        w->problem->ops->combine(error, s->n, s->factor, in, n);
        error_weights_square(p->program->weights, &p->squares, error, p->program->scale, begin + k, n);
        for (int q = 0; q < s->n; q++) in[q] += n;
    }
}

static void end_band(wave_pass *p, dem_index b)
{
    const stage_wave *w = p->wave;
    double *x = p->program->end + band_begin(w, b);
    add_up(p, &p->program->sums[w->n_stages], b, false, x);
    add_up(p, &p->program->sums[w->n_stages], b, true, x + state_velocities(&w->problem->layout));
    add_squares(p, b, false);
    add_squares(p, b, true);
}

/* ---- derivatives ---- */

static void evaluate(wave_pass *p, int stage, dem_index b)
{
    const stage_wave *w = p->wave;
    const stage_room *r = &p->rooms[stage];
    const dem_index begin = band_begin(w, b), slot = slot_of(w, stage, b), dim = w->problem->layout.dim;
    const bool is_own = has_band(p, b, 0), goes_on = first_band(p, w->n_stages - 1 - stage) < b;
    const ode_band band = {.t = p->program->t[stage],
                           .first = begin / dim,
                           .end = band_end(w, b) / dim,
                           .stage = stage,
                           .is_own = is_own,
                           .goes_on = goes_on,
                           .x = r->x - r->x_begins,
                           .v = r->v + slot - begin,
                           .a = r->a + slot - begin,
                           .scratch = r->scratch};
    p->sum += w->problem->band_derivative(&band, w->problem->context);
}

/* ---- the pass ---- */

static void take_turn(wave_pass *p, dem_index turn)
{
    const int n = p->wave->n_stages;
    for (int s = 0; s < n; s++) {
        const dem_index b = turn - s;
        if (has_band(p, b, n - s)) enter_stage(p, s, b);
        if (has_band(p, b - 1, n - 1 - s)) evaluate(p, s, b - 1);
    }
    if (has_band(p, turn - n, 0)) end_band(p, turn - n);
}

/* The common context of all shares. */
typedef struct wave_run {
    const stage_wave *wave;
    const stage_program *program;
} wave_run;

static void run_share(const void *context, int share, int thread)
{
    const wave_run *run = context;
    const stage_wave *w = run->wave;
    wave_pass p = {.wave = w,
                   .program = run->program,
                   .rooms = w->rooms + (size_t)thread * (size_t)w->n_stages,
                   .first = team_share(w->n_bands, w->n_shares, share),
                   .last = team_share(w->n_bands, w->n_shares, share + 1)};
    for (dem_index turn = first_band(&p, w->n_stages); turn < p.last + w->n_stages; turn++) take_turn(&p, turn);
    w->squares[share] = p.squares;
    w->sums[share] = p.sum;
}

bool stage_wave_run(stage_wave *w, const stage_program *program, array_ops_sum *squares)
{
    double sum = 0.0;
    if (program->n_stages != w->n_stages) return false;
    team_run(w->problem->team, w->n_shares, run_share, &(wave_run){w, program});
    *squares = (array_ops_sum){0};
    for (int k = 0; k < w->n_shares; k++) {
        array_ops_add(squares, &w->squares[k]);
        sum += w->sums[k];
    }
    return isfinite(sum) && isfinite(squares->largest) && w->problem->bands_hold(w->n_stages, w->problem->context);
}

/* ---- set-up ---- */

static bool allocate_rooms(stage_wave *w)
{
    bool complete = true;
    for (int k = 0; k < w->n_threads * w->n_stages && complete; k++) {
        stage_room *r = &w->rooms[k];
        const size_t kept = (size_t)((w->n_stages - k % w->n_stages + 1) * w->slot);
        r->x = aligned_reals((size_t)w->window);
        r->v = aligned_reals(kept);
        r->a = aligned_reals(kept);
        r->scratch = aligned_zeros(w->problem->band_scratch);
        complete = r->x != NULL && r->v != NULL && r->a != NULL && r->scratch != NULL;
    }
    return complete;
}

/* As many shares as the loops over nodes have if they are long enough, else one for each thread. */
static int count_shares(const team *t, dem_index nodes, dem_index n_bands)
{
    const int n = team_shares(t, nodes), threads = team_threads(t);
    return n <= threads || n_bands >= MANY_BANDS * n ? n : threads;
}

stage_wave *stage_wave_create(const ode_problem *problem, int n_stages)
{
    const state_layout *l = &problem->layout;
    const dem_index rows = problem->band_rows;
    if (rows == 0 || l->n_nodes < (dem_index)CACHED * team_threads(problem->team)) return NULL;
    const dem_index n_bands = (l->n_nodes + rows - 1) / rows;
    const int n_shares = count_shares(problem->team, l->n_nodes, n_bands);
    if (n_bands < LEAST_BANDS * n_shares) return NULL;
    stage_wave *w = calloc(1, sizeof *w);
    if (w == NULL) return NULL;
    *w = (stage_wave){.problem = problem,
                      .n_stages = n_stages,
                      .n_shares = n_shares,
                      .n_threads = team_threads(problem->team),
                      .n_bands = n_bands,
                      .band = state_row(l, rows)};
    w->slot = (w->band + state_row(l, l->n_rows - l->n_nodes) + LINE - 1) / LINE * LINE;
    w->window = (WINDOW_BANDS - 1) * w->band + w->slot;
    w->rooms = calloc((size_t)w->n_threads * (size_t)n_stages, sizeof *w->rooms);
    w->squares = calloc((size_t)n_shares, sizeof *w->squares);
    w->sums = calloc((size_t)n_shares, sizeof *w->sums);
    if (w->rooms != NULL && w->squares != NULL && w->sums != NULL && allocate_rooms(w)) return w;
    stage_wave_free(w);
    return NULL;
}

void stage_wave_free(stage_wave *w)
{
    if (w == NULL) return;
    for (int k = 0; k < w->n_threads * w->n_stages && w->rooms != NULL; k++) {
        free(w->rooms[k].x);
        free(w->rooms[k].v);
        free(w->rooms[k].a);
        free(w->rooms[k].scratch);
    }
    free(w->rooms);
    free(w->squares);
    free(w->sums);
    free(w);
}
