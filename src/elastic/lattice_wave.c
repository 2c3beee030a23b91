/* SPDX-License-Identifier: BSD-3-Clause */
/* Lattice row r takes step s when the next one has taken step s - 1: so in turn t row t takes the first step, row t - 1
 * the second one, and so on, each in place. A lattice row is taken from the arrays at the start when the one below it
 * takes its first step, and put into those at the end after its last one; between, it stands in one of a few slots.
 *
 * Shares take the same number of lattice rows each, and as many more above as there are steps, and one more than that
 * below, so that they need nothing of each other. The lowest one of these is not drifted, as nothing is below it: it is
 * wrong from the first step on, the next one after that, and so on. Of those above one less takes each step. What is
 * known at the ends of steps is of its own rows alone. */
#include "elastic/lattice_wave.h"

#include <math.h>
#include <stdlib.h>

#include "base/aligned.h"
#include "base/sorted.h"
#include "base/status.h"
#include "elastic/lattice_reach.h"
#include "elastic/sweep.h"

enum {
    PLANES = 8,                         /* of lattice_planes */
    PAD = LAYOUT_LANES,                 /* places behind those of a lattice row */
    CACHE = 1200000,                    /* bytes of slots; what the second cache does not hold the third one has */
    FEWEST_STEPS = 4,                   /* even if they take more, */
    LEAST_SHARE = 3 * LATTICE_WAVE_MOST /* lattice rows of a share */
};

/* What a share has found. */
typedef struct lattice_result {
    bool holds; /* all is finite, and the guard acts nowhere */
    double square[LATTICE_WAVE_MOST], sum[LATTICE_WAVE_MOST];
} lattice_result;

struct lattice_wave {
    lattice_rows rows;
    lattice_reach reach;
    lattice_step_function *step;
    team *team;
    int most, n_slots, n_shares;
    size_t width;            /* numbers of an array of a slot */
    double *numbers;         /* [threads][n_slots][PLANES][width] */
    lattice_planes *slots;   /* [threads][n_slots] lattice rows on their way */
    lattice_result *results; /* [n_shares] */
};

/* The pass over the lattice rows of a share. */
typedef struct lattice_pass {
    const lattice_wave *wave;
    const lattice_wave_steps *steps;
    lattice_planes *slots; /* of the thread */
    dem_index first, end;  /* its own lattice rows */
    dem_index from, to;    /* those that it takes */
    lattice_result *result;
} lattice_pass;

static lattice_planes *slot_of(const lattice_pass *p, dem_index row)
{
    return &p->slots[row % p->wave->n_slots];
}

/* ---- between arrays of nodes and slots ---- */

/* Places without nodes, from `first` to `end` - 1, are where no node is, each elsewhere, and do not move. */
static void clear(const lattice_planes *p, dem_index row, dem_index first, dem_index end)
{
    static const double far = 1e9; /* m */
    for (dem_index k = first; k < end; k++) {
        p->x[0][k] = far + (double)k;
        p->x[1][k] = far + (double)row;
        p->v[0][k] = p->v[1][k] = p->a[0][k] = p->a[1][k] = 0.0;
    }
}

static void split(double *const planes[2], dem_index place, const double *pairs, dem_index n)
{
    double *x = planes[0] + place, *y = planes[1] + place;
    for (dem_index k = 0; k < n; k++) {
        x[k] = pairs[2 * k];
        y[k] = pairs[2 * k + 1];
    }
}

static void merge(double *pairs, double *const planes[2], dem_index place, dem_index n)
{
    const double *x = planes[0] + place, *y = planes[1] + place;
    for (dem_index k = 0; k < n; k++) {
        pairs[2 * k] = x[k];
        pairs[2 * k + 1] = y[k];
    }
}

static void take_in(const lattice_pass *p, dem_index row)
{
    const lattice_rows *r = &p->wave->rows;
    const lattice_row *of = &r->row[row];
    const lattice_wave_steps *s = p->steps;
    const lattice_planes *to = slot_of(p, row);
    dem_index empty = 0;
    for (int32_t k = 0; k < of->n_segments; k++) {
        const lattice_segment *g = &r->segment[of->segment + k];
        const dem_index at = vec2_row(g->node);
        clear(to, row, empty, g->place);
        split(to->x, g->place, s->x0 + at, g->n);
        split(to->v, g->place, s->v0 + at, g->n);
        split(to->a, g->place, s->a0 + at, g->n);
        empty = g->place + g->n;
    }
    clear(to, row, empty, LAYOUT_LANES * (dem_index)of->n_stored + PAD);
}

static void put_out(const lattice_pass *p, dem_index row)
{
    const lattice_rows *r = &p->wave->rows;
    const lattice_row *of = &r->row[row];
    const lattice_wave_steps *s = p->steps;
    const lattice_planes *from = slot_of(p, row);
    for (int32_t k = 0; k < of->n_segments; k++) {
        const lattice_segment *g = &r->segment[of->segment + k];
        const dem_index at = vec2_row(g->node);
        merge(s->x1 + at, from->x, g->place, g->n);
        merge(s->v1 + at, from->v, g->place, g->n);
        merge(s->a1 + at, from->a, g->place, g->n);
    }
}

/* ---- steps ---- */

static double highest_square(const lattice_pass *p, dem_index row, double square)
{
    const lattice_rows *r = &p->wave->rows;
    const lattice_row *of = &r->row[row];
    const lattice_wave_steps *s = p->steps;
    const lattice_planes *planes = slot_of(p, row);
    for (int32_t k = 0; k < of->n_segments && s->n_watched > 0; k++) {
        const lattice_segment *g = &r->segment[of->segment + k];
        for (dem_index w = sorted_first(s->watched, s->n_watched, g->node);
             w < s->n_watched && s->watched[w] < g->node + g->n; w++) {
            const dem_index at = g->place + s->watched[w] - g->node;
            square = fmax(square, planes->v[0][at] * planes->v[0][at] + planes->v[1][at] * planes->v[1][at]);
        }
    }
    return square;
}

/* A lattice row with nothing to evaluate takes the next one through the step if that has. */
static void take_step(lattice_pass *p, dem_index row, int step)
{
    const lattice_reach *reach = &p->wave->reach;
    const int n_follow = p->steps->n - 1 - step;
    const lattice_span blocks = lattice_reach_span(reach, row, n_follow);
    if (blocks.n_blocks == 0 && lattice_reach_span(reach, row + 1, n_follow).n_blocks == 0) return;
    lattice_result *result = p->result;
    lattice_step s = {.rows = &p->wave->rows,
                      .row = row,
                      .blocks = blocks,
                      .h = p->steps->h,
                      .gravity = p->steps->gravity,
                      .here = *slot_of(p, row),
                      .next = *slot_of(p, row + 1)};
    p->wave->step(&s);
    if (row < p->first || row >= p->end) return;
    result->holds = result->holds && isfinite(s.sum) && !s.guarded;
    result->sum[step] += s.sum;
    result->square[step] = highest_square(p, row, result->square[step]);
}

/* Behind the last lattice row of all there is none to take any more, so that all others take each step. */
static dem_index last_of(const lattice_pass *p, int step)
{
    return p->to == p->wave->rows.n_rows ? p->to - 2 : p->to - 2 - step;
}

static void take_steps(lattice_pass *p)
{
    const int n = p->steps->n;
    *p->result = (lattice_result){.holds = true};
    take_in(p, p->from);
    for (dem_index turn = p->from; turn < p->end + n - 1 && p->result->holds; turn++) {
        if (turn + 1 < p->to) take_in(p, turn + 1);
        for (int step = 0; step < n; step++) {
            const dem_index row = turn - step;
            if (row >= p->from && row <= last_of(p, step)) take_step(p, row, step);
        }
        const dem_index done = turn - (n - 1);
        if (done >= p->first && done < p->end) put_out(p, done);
    }
}

/* The common context of all shares. */
typedef struct lattice_run {
    const lattice_wave *wave;
    const lattice_wave_steps *steps;
} lattice_run;

static void run_share(const void *context, int share, int thread)
{
    const lattice_run *of = context;
    const lattice_wave *w = of->wave;
    const dem_index n_rows = w->rows.n_rows, n = of->steps->n;
    lattice_pass p = {.wave = w,
                      .steps = of->steps,
                      .slots = w->slots + (size_t)thread * (size_t)w->n_slots,
                      .first = team_share(n_rows, w->n_shares, share),
                      .end = team_share(n_rows, w->n_shares, share + 1),
                      .result = &w->results[share]};
    p.from = p.first > n + 1 ? p.first - n - 1 : 0;
    p.to = p.end + n < n_rows ? p.end + n : n_rows;
    take_steps(&p);
}

bool lattice_wave_run(lattice_wave *w, lattice_wave_steps *steps)
{
    bool holds = true;
    team_run(w->team, w->n_shares, run_share, &(lattice_run){w, steps});
    for (int step = 0; step < steps->n; step++) steps->square[step] = steps->sum[step] = 0.0;
    for (int k = 0; k < w->n_shares; k++) {
        const lattice_result *r = &w->results[k];
        holds = holds && r->holds;
        for (int step = 0; step < steps->n; step++) {
            steps->square[step] = fmax(steps->square[step], r->square[step]);
            steps->sum[step] += r->sum[step];
        }
    }
    return holds;
}

/* Threads that each take their part of a single step wait for each other in each step. */
bool lattice_wave_pays(const lattice_wave *w)
{
    return 2 * w->n_shares >= team_threads(w->team);
}

int lattice_wave_most(const lattice_wave *w)
{
    return w->most;
}

/* ---- set-up ---- */

/* Arrays of a slot do not begin at the same place of a page. */
static size_t width_of(const lattice_rows *r)
{
    const size_t width = LAYOUT_LANES * (size_t)r->most_stored + PAD;
    return width % 64 == 0 ? width + PAD : width;
}

static void lay_out(lattice_wave *w, int n)
{
    for (int k = 0; k < n; k++) {
        double *at = w->numbers + (size_t)k * PLANES * w->width;
        double **const planes[] = {w->slots[k].x, w->slots[k].v, w->slots[k].a, w->slots[k].below};
        for (int c = 0; c < PLANES; c++) planes[c / 2][c % 2] = at + (size_t)c * w->width;
    }
}

static dem_status allocate(lattice_wave *w)
{
    const size_t row = PLANES * w->width * sizeof(double);
    const int fit = (int)(CACHE / row) - 2, threads = team_threads(w->team);
    const dem_index most_shares = w->rows.n_rows / LEAST_SHARE;
    w->most = fit < FEWEST_STEPS ? FEWEST_STEPS : fit < LATTICE_WAVE_MOST ? fit : LATTICE_WAVE_MOST;
    w->n_slots = w->most + 2;
    w->n_shares = most_shares < 1 ? 1 : most_shares < threads ? (int)most_shares : threads;
    const int n = threads * w->n_slots;
    w->numbers = aligned_zeros((size_t)n * PLANES * w->width);
    w->slots = calloc((size_t)n, sizeof *w->slots);
    w->results = calloc((size_t)w->n_shares, sizeof *w->results);
    CHECK(w->numbers && w->slots && w->results, DEM_ERROR_MEMORY, "out of memory for %d lattice rows", n);
    lay_out(w, n);
    return DEM_OK;
}

dem_status lattice_wave_create(lattice_wave **out, const lattice_rows_input *from, lattice_step_function *step, team *t)
{
    *out = NULL;
    lattice_wave *w = calloc(1, sizeof *w);
    CHECK_MEMORY(w);
    *w = (lattice_wave){.step = step, .team = t};
    dem_status status = lattice_rows_create(&w->rows, from);
    if (status == DEM_OK && w->rows.n_rows > 0) {
        w->width = width_of(&w->rows);
        status = allocate(w);
        if (status == DEM_OK) status = lattice_reach_create(&w->reach, &w->rows, from->is_ghost, w->most);
        if (status == DEM_OK) {
            *out = w;
            return DEM_OK;
        }
    }
    lattice_wave_free(w);
    return status;
}

void lattice_wave_free(lattice_wave *w)
{
    if (w == NULL) return;
    lattice_rows_destroy(&w->rows);
    lattice_reach_destroy(&w->reach);
    free(w->numbers);
    free(w->slots);
    free(w->results);
    free(w);
}
