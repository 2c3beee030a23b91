/* SPDX-License-Identifier: BSD-3-Clause */
/* A step of a block needs the step before of the `ahead` blocks behind it, and of as many before it, and nothing else:
 * positions follow from that state of the node itself. So each turn takes every step a stretch further, and a step is
 * `ahead` blocks behind the one before. Each step has a ring of its own. Ends of steps lie in two sets of arrays in
 * turn: what a step overwrites, the end of the last but one, nothing reads any more.
 *
 * Shares of a pass are divided by borders, and no share waits for another. First each takes of step s the blocks that
 * are s times `ahead` away from its borders or further; all that they need is in the share. Then the blocks about each
 * border take what is left, step by step from the border on. At a border of the first kind positions are drifted for
 * `ahead` blocks more than steps are taken of; at one of the second kind they are there.
 *
 *   step 3      /-----\       /-----\               \           /
 *   step 2     /-------\     /-------\       then    \---------/
 *   step 1    /---------\   /---------\               \-------/
 *            |  a share  | |  a share  |               \-----/ about the border */
#include "forces/step_wave.h"

#include <stdlib.h>

#include "base/aligned.h"
#include "base/sorted.h"
#include "base/status.h"
#include "elastic/lattice_wave.h"
#include "forces/kernel_functions.h"

enum {
    TURN = 4,             /* times `ahead`: blocks of the first step in a turn */
    LEAST_NODES = 250000, /* of fewer the third cache has all arrays of a step */
    LEAST_SHARE =
        4 * STEP_WAVE_MOST /* times `ahead`: each share evaluates springs of `ahead` blocks thrice in a step */
};

/* What a share has found. */
typedef struct wave_result {
    bool holds; /* all is finite, and the guard acts nowhere */
    double square[STEP_WAVE_MOST], sum[STEP_WAVE_MOST];
} wave_result;

struct step_wave {
    const kernel *kernel;
    lattice_wave *rows; /* NULL: blocks of the layout are taken, as follows */
    int n_shares;
    uint8_t *judged; /* [n_blocks + 1] a bit for each node of a block, and of those behind the last one, whose guard is
                        judged; NULL: of all */
    double *rings;   /* [threads][STEP_WAVE_MOST][ring_size] */
    wave_result *results; /* [2 n_shares] */
};

/* The pass over the blocks of a share, or about a border. */
typedef struct wave_pass {
    const step_wave *wave;
    const forces *forces;
    const step_wave_steps *steps;
    double *rings;                  /* of the thread */
    dem_index first, last;          /* blocks before the first step; */
    dem_index rise, fall;           /* by so many more or less, at either end, in each step */
    dem_index done[STEP_WAVE_MOST]; /* the block up to which a step has been taken */
    dem_index seen[STEP_WAVE_MOST]; /* watched nodes of which its end is known */
    wave_result *result;
} wave_pass;

/* ---- blocks of a step ---- */

static const layout *layout_of(const wave_pass *p)
{
    return kernel_layout(p->wave->kernel, p->forces->elements);
}

static dem_index smaller(dem_index a, dem_index b)
{
    return a < b ? a : b;
}

static dem_index first_of(const wave_pass *p, int step)
{
    return p->first + (step + 1) * p->rise;
}

static dem_index last_of(const wave_pass *p, int step)
{
    return p->last + (step + 1) * p->fall;
}

/* Where the drift of a step ends: it goes as far as a share, and about a border as far as the step. */
static dem_index drift_end(const wave_pass *p, int step)
{
    const layout *l = layout_of(p);
    return smaller(last_of(p, step) + (p->fall < 0 ? l->ahead : 0), l->n_blocks);
}

/* How far a step may go now. */
static dem_index limit(const wave_pass *p, int step)
{
    const layout *l = layout_of(p);
    const dem_index last = last_of(p, step);
    if (step == 0) return smaller(p->done[0] + TURN * l->ahead + 1, last);
    if (p->done[step - 1] == last_of(p, step - 1)) return last;
    return smaller(p->done[step - 1] - l->ahead, last);
}

/* ---- what is known at the end of a step ---- */

/* Takes what some accelerations add to the sum over all. */
static void add_up(wave_pass *p, int step, double sum)
{
    p->result->holds = p->result->holds && isfinite(sum);
    p->result->sum[step] += sum;
}

/* The highest speed of watched nodes up to `end`, which is behind. */
static void watch(wave_pass *p, int step, dem_index end)
{
    const step_wave_steps *s = p->steps;
    double *square = &p->result->square[step];
    for (; p->seen[step] < s->n_watched && s->watched[p->seen[step]] < end; p->seen[step]++) {
        const double *v = s->step[step].v1 + 2 * s->watched[p->seen[step]];
        *square = fmax(*square, v[0] * v[0] + v[1] * v[1]);
    }
}

static unsigned judged_of(const step_wave *w, dem_index block)
{
    return w->judged != NULL ? w->judged[block] : (1u << LAYOUT_LANES) - 1;
}

static bool guard_acts(const step_wave *w, dem_index first, dem_index last)
{
    const uint8_t *guarded = w->kernel->guarded;
    for (dem_index block = first; block < last; block++)
        if (guarded[block] != 0 && (guarded[block] & judged_of(w, block)) != 0) return true;
    return false;
}

/* ---- a step ---- */

/* The positions that a step reads first. */
static void begin_step(wave_pass *p, int step)
{
    const layout *l = layout_of(p);
    const dem_index from = first_of(p, step), low = p->rise > 0 ? from - l->ahead : from;
    const dem_index high = smaller(from + l->ahead, drift_end(p, step));
    kernel_drift(p->wave->kernel, &p->steps->step[step], LAYOUT_LANES * low, LAYOUT_LANES * high);
    p->seen[step] = sorted_first(p->steps->watched, p->steps->n_watched, LAYOUT_LANES * from);
}

/* Nodes behind the last block are drifted when they have taken the step before. */
static void drift_rest(const wave_pass *p, int step)
{
    const layout *l = layout_of(p);
    kernel_drift(p->wave->kernel, &p->steps->step[step], LAYOUT_LANES * l->n_blocks, l->n_nodes);
}

static void end_rest(wave_pass *p, int step)
{
    const kernel *k = p->wave->kernel;
    const layout *l = layout_of(p);
    const sweep_fused_step *s = &p->steps->step[step];
    const kernel_state y = {.x = s->x1, .v = s->v1, .a = p->steps->a[step], .fused_step = s};
    const dem_index first = LAYOUT_LANES * l->n_blocks;
    for (dem_index i = first; i < l->n_nodes; i++) {
        const bool is_judged = judged_of(p->wave, l->n_blocks) >> (i - first) & 1;
        add_up(p, step, kernel_accelerate_row(k, p->forces, &y, i));
        p->result->holds = p->result->holds && (!is_judged || kernel_guard_bound(k, p->forces, s->x1, i) == 0.0);
    }
    watch(p, step, l->n_nodes);
    if (step + 1 < p->steps->n) drift_rest(p, step + 1);
}

static void take_blocks(wave_pass *p, int step, dem_index to)
{
    const kernel *k = p->wave->kernel;
    const layout *l = layout_of(p);
    const dem_index from = p->done[step];
    const sweep_fused_step *s = &p->steps->step[step];
    const sweep blocks = {.layout = l,
                          .goes_on = from > first_of(p, step),
                          .inverse_mass = k->model->inverse_mass,
                          .gravity = {p->forces->gravity[0], p->forces->gravity[1]},
                          .x = s->x1,
                          .v = s->v1,
                          .a = p->steps->a[step],
                          .guarded = k->guarded,
                          .looks_at_lowest = !l->stiff,
                          .fused_step = s,
                          .drift_end = drift_end(p, step)};
    if (!blocks.goes_on) begin_step(p, step);
    add_up(p, step, k->sweep(&blocks, from, to, p->rings + (size_t)step * k->ring_size));
    p->result->holds = p->result->holds && !guard_acts(p->wave, from, to);
    p->done[step] = to;
    watch(p, step, LAYOUT_LANES * to);
    if (to == l->n_blocks) end_rest(p, step);
}

/* ---- the pass ---- */

static void run(wave_pass *p)
{
    const int n = p->steps->n;
    *p->result = (wave_result){.holds = true};
    for (int step = 0; step < n; step++) p->done[step] = first_of(p, step);
    if (p->last == layout_of(p)->n_blocks) drift_rest(p, 0);
    while (p->result->holds && p->done[n - 1] < last_of(p, n - 1))
        for (int step = 0; step < n; step++) {
            const dem_index to = limit(p, step);
            if (to > p->done[step]) take_blocks(p, step, to);
        }
}

/* The common context of all shares. */
typedef struct wave_run {
    const step_wave *wave;
    const forces *forces;
    const step_wave_steps *steps;
} wave_run;

static wave_pass begin(const wave_run *run, int thread, wave_result *result)
{
    const kernel *k = run->wave->kernel;
    return (wave_pass){.wave = run->wave,
                       .forces = run->forces,
                       .steps = run->steps,
                       .rings = run->wave->rings + (size_t)thread * STEP_WAVE_MOST * k->ring_size,
                       .result = result};
}

static dem_index border_of(const step_wave *w, int share)
{
    return team_share(w->kernel->model->layout.n_blocks, w->n_shares, share);
}

static void run_share(const void *context, int share, int thread)
{
    const wave_run *of = context;
    const step_wave *w = of->wave;
    wave_pass p = begin(of, thread, &w->results[share]);
    p.first = border_of(w, share);
    p.last = border_of(w, share + 1);
    p.rise = share > 0 ? layout_of(&p)->ahead : 0;
    p.fall = share + 1 < w->n_shares ? -layout_of(&p)->ahead : 0;
    run(&p);
}

static void run_border(const void *context, int share, int thread)
{
    const wave_run *of = context;
    const step_wave *w = of->wave;
    wave_pass p = begin(of, thread, &w->results[w->n_shares + share]);
    p.first = p.last = border_of(w, share + 1);
    p.fall = layout_of(&p)->ahead;
    p.rise = -p.fall;
    run(&p);
}

/* By lattice rows, of which the states between are nowhere. */
static bool run_rows(lattice_wave *rows, const forces *f, step_wave_steps *steps)
{
    const int last = steps->n - 1;
    const sweep_fused_step *from = &steps->step[0], *to = &steps->step[last];
    lattice_wave_steps s = {.n = steps->n,
                            .h = from->h,
                            .gravity = {f->gravity[0], f->gravity[1]},
                            .x0 = from->x0,
                            .v0 = from->v0,
                            .a0 = from->a0,
                            .x1 = to->x1,
                            .v1 = to->v1,
                            .a1 = steps->a[last],
                            .watched = steps->watched,
                            .n_watched = steps->n_watched};
    const bool holds = lattice_wave_run(rows, &s);
    for (int step = 0; step < steps->n; step++) {
        steps->square[step] = s.square[step];
        steps->sum[step] = s.sum[step];
    }
    return holds;
}

bool step_wave_run(step_wave *w, const forces *f, step_wave_steps *steps)
{
    if (w->rows != NULL) return run_rows(w->rows, f, steps);
    const wave_run context = {w, f, steps};
    bool holds = true;
    for (int k = 0; k < 2 * w->n_shares; k++) w->results[k] = (wave_result){.holds = true};
    team_run(w->kernel->team, w->n_shares, run_share, &context);
    for (int k = 0; k < w->n_shares; k++) holds = holds && w->results[k].holds;
    if (holds && w->n_shares > 1) team_run(w->kernel->team, w->n_shares - 1, run_border, &context);
    for (int step = 0; step < steps->n; step++) steps->square[step] = steps->sum[step] = 0.0;
    for (int k = 0; k < 2 * w->n_shares; k++) {
        const wave_result *r = &w->results[k];
        holds = holds && r->holds;
        for (int step = 0; step < steps->n; step++) {
            steps->square[step] = fmax(steps->square[step], r->square[step]);
            steps->sum[step] += r->sum[step];
        }
    }
    return holds;
}

/* ---- set-up ---- */

/* As many shares as the kernel has if they are long enough, else one for each thread; 0: neither. */
static int count_shares(const kernel *k)
{
    const layout *l = &k->model->layout;
    const dem_index most = l->n_blocks / (LEAST_SHARE * (l->ahead + 1));
    const int threads = team_threads(k->team), fewest = k->n_shares < threads ? k->n_shares : threads;
    if (k->n_shares <= most) return k->n_shares;
    return fewest <= most ? fewest : 0;
}

/* Lattice rows have springs and guards alone. Without memory for them blocks of the layout are taken. */
static lattice_wave *create_rows(const kernel *k)
{
    const dem_model *m = k->model;
    const lattice_rows_input from = {.springs = &m->springs,
                                     .triangles = &m->triangles,
                                     .x = m->lattice.x,
                                     .inverse_mass = m->inverse_mass,
                                     .is_ghost = m->domain != NULL ? m->domain->is_ghost : NULL};
    lattice_step_function *step = kernel_functions_of(k->kind)->lattice_step;
    lattice_wave *rows = NULL;
    if (step == NULL || m->layout.stiff || m->layout.coupled || m->layout.damped) return NULL;
    return lattice_wave_create(&rows, &from, step, k->team) == DEM_OK ? rows : NULL;
}

/* Ghosts on the outside go on without forces, and may fold there. A triangle is judged by the ranks of which some
 * corner is no ghost: they have all of it right at the end of each step. The sweep finds it at its lowest corner, or at
 * all three of them where area terms act. */
static dem_status find_judged(step_wave *w)
{
    const dem_model *m = w->kernel->model;
    const triangles *all = &m->triangles;
    if (m->domain == NULL) return DEM_OK;
    w->judged = calloc((size_t)m->layout.n_blocks + 1, sizeof *w->judged);
    CHECK_MEMORY(w->judged);
    for (dem_index i = 0; i < m->lattice.n_nodes; i++)
        for (dem_index p = all->row[i]; p < all->row[i + 1] && !m->domain->is_ghost[i]; p++) {
            const dem_index lowest = smaller(i, smaller(all->next[p], all->last[p])), at = m->layout.stiff ? i : lowest;
            w->judged[at / LAYOUT_LANES] |= (uint8_t)(1u << at % LAYOUT_LANES);
        }
    return DEM_OK;
}

bool step_wave_pays(const step_wave *w)
{
    const bool is_large = w->kernel->model->layout.n_nodes >= LEAST_NODES;
    return is_large || (w->rows != NULL && lattice_wave_pays(w->rows));
}

int step_wave_most(const step_wave *w)
{
    return w->rows != NULL ? lattice_wave_most(w->rows) : STEP_WAVE_MOST;
}

step_wave *step_wave_create(const kernel *k)
{
    const int n_shares = count_shares(k), threads = team_threads(k->team);
    if (k->packed != NULL) return NULL;
    lattice_wave *rows = create_rows(k);
    step_wave *w = rows != NULL || n_shares > 0 ? calloc(1, sizeof *w) : NULL;
    if (w == NULL) {
        lattice_wave_free(rows);
        return NULL;
    }
    *w = (step_wave){.kernel = k, .rows = rows, .n_shares = n_shares};
    if (rows != NULL) return w;
    w->rings = aligned_zeros((size_t)threads * STEP_WAVE_MOST * k->ring_size);
    w->results = calloc(2 * (size_t)w->n_shares, sizeof *w->results);
    if (w->rings != NULL && w->results != NULL && find_judged(w) == DEM_OK) return w;
    step_wave_free(w);
    return NULL;
}

void step_wave_free(step_wave *w)
{
    if (w == NULL) return;
    lattice_wave_free(w->rows);
    free(w->judged);
    free(w->rings);
    free(w->results);
    free(w);
}
