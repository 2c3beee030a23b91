/* SPDX-License-Identifier: BSD-3-Clause */
/* ARKODE's norm is the mean over all N = 2 dim n_rows numbers of the whole state, sqrt(sum of (w_k e_k)^2/N). The
 * quadratures, the padding and the ghosts have no part in the error, so the weights of the nodes are
 *   share/position_error and share/velocity_error, with share^2 = n_rows/n_nodes,
 * which makes the norm the mean over the 2 dim n_nodes numbers of all nodes. Sums are taken piece by piece. For a piece
 * of a run there is an array of its weight, which stays in the cache. Short runs, such as the padding, are put together
 * with what comes behind them: where ranks share the nodes a run may be as short as a node. */
#include "time/error_weights.h"

#include <math.h>
#include <stdlib.h>

#include "base/aligned.h"
#include "base/grow.h"

enum {
    PIECE = 1024, /* numbers at a time, at most */
    SHORT = 128   /* the same of several runs */
};

/* The weight of quadratures and padding, in place of 1/tolerance. */
static const double no_weight = 1e-100;

typedef enum weight_kind { OF_POSITIONS, OF_VELOCITIES, OF_NOTHING, KINDS } weight_kind;

/* From the end of the run before. */
typedef struct weight_run {
    dem_index end;
    const double *weights; /* [PIECE] all the same */
} weight_run;

struct error_weights {
    const array_ops *ops;
    weight_run *runs; /* [n_runs] up to the end of the state */
    dem_index n_runs, capacity;
    double *weights; /* [KINDS][PIECE] */
};

/* The run of number k. */
static const weight_run *run_of(const error_weights *w, dem_index k)
{
    dem_index low = 0, high = w->n_runs - 1;
    while (low < high) {
        const dem_index middle = low + (high - low) / 2;
        if (w->runs[middle].end <= k)
            low = middle + 1;
        else
            high = middle;
    }
    return &w->runs[low];
}

double error_weights_at(const error_weights *w, dem_index k)
{
    return run_of(w, k)->weights[0];
}

/* Puts together the weights of n numbers from `first` on, of which the first one is in this run. */
static void mix(double *weights, const weight_run *run, dem_index first, dem_index n)
{
    for (dem_index k = 0; k < n; run++) {
        const dem_index end = run->end - first < n ? run->end - first : n;
        const double weight = run->weights[0];
        for (; k < end; k++) weights[k] = weight;
    }
}

static dem_index lesser(dem_index a, dem_index b)
{
    return a < b ? a : b;
}

void error_weights_square(const error_weights *w, array_ops_sum *sum, const double *x, double scale, dem_index first,
                          dem_index n)
{
    double mixed[SHORT];
    for (dem_index k = 0, here; k < n; k += here) {
        const weight_run *run = run_of(w, first + k);
        const dem_index left = n - k, in_run = lesser(run->end - first - k, left);
        const bool is_mixed = in_run < SHORT && in_run < left;
        here = lesser(is_mixed ? left : in_run, is_mixed ? SHORT : PIECE);
        if (is_mixed) mix(mixed, run, first + k, here);
        w->ops->square(sum, x + k, is_mixed ? mixed : run->weights, scale, here);
    }
}

/* The sum of |x| of n numbers. */
static double sum_magnitudes(const array_ops *ops, const double *x, dem_index n)
{
    const dem_index whole = n - n % ARRAY_OPS_LANES;
    double sum[2];
    ops->magnitude(sum, x, (int)whole);
    for (dem_index k = whole; k < n; k++) sum[0] += fabs(x[k]);
    return sum[0] + sum[1];
}

/* A run in pieces, as `magnitude` counts in `int`. */
double error_weights_bound(const error_weights *w, const double *x, dem_index first, dem_index n)
{
    const double rounding = 1.0 + 1e-9;
    double bound = 0.0;
    for (dem_index k = 0, here; k < n; k += here) {
        const weight_run *run = run_of(w, first + k);
        here = lesser(lesser(run->end - first - k, n - k), PIECE);
        bound += rounding * run->weights[0] * sum_magnitudes(w->ops, x + k, here);
    }
    return bound;
}

/* ---- making and freeing ---- */

/* Takes the last run on to `end`, or begins another one behind it. */
static bool add_run(error_weights *w, dem_index end, weight_kind kind)
{
    const double *weights = w->weights + kind * PIECE;
    if (w->n_runs > 0 && w->runs[w->n_runs - 1].weights == weights) {
        w->runs[w->n_runs - 1].end = end;
        return true;
    }
    void *runs = w->runs;
    const bool has_room = grow_array(&runs, &w->capacity, w->n_runs + 1, sizeof *w->runs);
    w->runs = runs;
    if (has_room) w->runs[w->n_runs++] = (weight_run){end, weights};
    return has_room;
}

/* Positions or velocities of all rows.  \param begin  of the first one */
static bool add_half(error_weights *w, const ode_problem *p, dem_index begin, weight_kind of_nodes)
{
    const state_layout *l = &p->layout;
    bool complete = true;
    for (dem_index i = 0; i < l->n_nodes && complete; i++)
        complete = add_run(w, begin + state_row(l, i + 1), ode_problem_is_own(p, i) ? of_nodes : OF_NOTHING);
    return complete && (l->n_rows == l->n_nodes || add_run(w, begin + state_velocities(l), OF_NOTHING));
}

static bool fill(error_weights *w, const ode_problem *p)
{
    const state_layout *whole = ode_problem_whole(p);
    const double share = sqrt((double)whole->n_rows / (double)whole->n_nodes);
    const double weights[KINDS] = {share / p->position_error, share / p->velocity_error, no_weight};
    w->weights = aligned_reals((size_t)KINDS * PIECE);
    if (w->weights == NULL) return false;
    for (int k = 0; k < KINDS * PIECE; k++) w->weights[k] = weights[k / PIECE];
    return add_half(w, p, 0, OF_POSITIONS) && add_half(w, p, state_velocities(&p->layout), OF_VELOCITIES);
}

error_weights *error_weights_create(const ode_problem *problem)
{
    error_weights *w = calloc(1, sizeof *w);
    if (w == NULL) return NULL;
    w->ops = problem->ops;
    if (fill(w, problem)) return w;
    error_weights_free(w);
    return NULL;
}

void error_weights_free(error_weights *w)
{
    if (w == NULL) return;
    free(w->runs);
    free(w->weights);
    free(w);
}
