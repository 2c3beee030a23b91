/* SPDX-License-Identifier: BSD-3-Clause */
/* shared_attempt.c, attempt.c: ranks whose derivatives fail somewhere in a step, or at its end, reject and retry it as
 * a process alone does, with its counts and messages. */
#include "verification/support.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/reduce.h"
#include "base/status.h"
#include "harness/rank_threads.h"
#include "time/integrator.h"

enum { N = 5, N_STEPS = 40, MOST_RANKS = 3, TEXT = 200 };

/* Oscillators, node i with the frequency 1 + 0.4 i in x. Derivatives fail where one of them is farther out than the
 * limit, which is that only in steps that are too long; and by chance, so that any evaluation of a step may. */
typedef struct world {
    const ranks *ranks;
    int n, number[N]; /* nodes here */
    double limit;
    int cases; /* 0: never by chance */
    int culprit;
} world;

/* Of a place, in one of so many cases. */
static bool is_unlucky(double x, int cases)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    const uint64_t mixed = bits * 0x9e3779b97f4a7c15 * (uint64_t)(2 * cases + 1);
    return cases > 0 && (mixed >> 40) * (uint64_t)cases < (uint64_t)1 << 24;
}

static int swing(double t, const double *y, double *u, double *a, void *context)
{
    world *w = context;
    for (int i = 0; i < w->n; i++) {
        const double omega = 1.0 + 0.4 * w->number[i];
        for (int c = 0; c < 2 && u != NULL; c++) u[2 * i + c] = y[2 * w->n + 2 * i + c];
        a[2 * i] = -omega * omega * y[2 * i];
        a[2 * i + 1] = 0.0;
    }
    for (int i = 0; i < w->n; i++)
        if (fabs(y[2 * i]) > w->limit || is_unlucky(y[2 * i], w->cases)) {
            w->culprit = w->number[i];
            (void)status_fail(DEM_ERROR_INTEGRATOR, "node %d fails at t = %.17g s", w->culprit, t);
            return 1;
        }
    return 0;
}

static void fill_ghosts(double *y, void *context)
{
    (void)y;
    (void)context;
}

static void name_failure(bool is_first, void *context)
{
    const world *w = context;
    (void)reduce_status(w->ranks, is_first ? DEM_ERROR_INTEGRATOR : DEM_OK, w->culprit);
}

static bool wants_stop(void *context)
{
    (void)context;
    return false;
}

static void stop(void *context)
{
    (void)context;
}

/* After each step. */
typedef struct outcome {
    double t[N_STEPS], x[N_STEPS][N], v[N_STEPS][N], next[N_STEPS];
    dem_counts counts[N_STEPS];
    dem_status status[N_STEPS];
    char message[N_STEPS][TEXT];
} outcome;

typedef struct run {
    dem_method method;
    double limit, tolerance;
    int cases;
    outcome outcomes[MOST_RANKS];
} run;

static void begin(const world *w, double *y)
{
    for (int i = 0; i < w->n; i++) {
        y[2 * i] = 1.0 - 0.1 * w->number[i];
        y[2 * i + 1] = y[2 * w->n + 2 * i] = y[2 * w->n + 2 * i + 1] = 0.0;
    }
}

static void note(outcome *o, int k, const integrator *e, const world *w)
{
    const double *y = integrator_state(e);
    o->counts[k] = integrator_counts(e);
    o->next[k] = integrator_next_step(e);
    (void)snprintf(o->message[k], TEXT, "%s", o->status[k] != DEM_OK ? dem_status_message() : "");
    for (int i = 0; i < w->n; i++) {
        o->x[k][w->number[i]] = y[2 * i];
        o->v[k][w->number[i]] = y[2 * w->n + 2 * i];
    }
}

/* Steps after one that has failed are tried from the same state. */
static dem_status go(const run *c, world *w, const ode_domain *d, outcome *o)
{
    const bool is_fixed = c->method == DEM_METHOD_RK4 || c->method == DEM_METHOD_VERLET;
    const ode_problem problem = {.layout = {.dim = 2, .n_nodes = w->n, .n_rows = w->n},
                                 .domain = d,
                                 .ops = &array_ops_portable,
                                 .derivative = swing,
                                 .context = w,
                                 .method = c->method,
                                 .position_error = c->tolerance,
                                 .velocity_error = c->tolerance,
                                 .max_step = 400.0,
                                 .fixed_step = is_fixed ? 1.2 : 0.0};
    double y[4 * N];
    integrator e;
    dense_output p = {0};
    bool rooted;
    begin(w, y);
    TRY(integrator_create(&e, &problem, 0.0, y));
    for (int k = 0; k < N_STEPS; k++) {
        o->status[k] = integrator_step(&e, &p, &rooted);
        if (o->status[k] == DEM_OK) {
            o->t[k] = p.t1;
            integrator_settle(&e, &p);
        }
        note(o, k, &e, w);
    }
    integrator_destroy(&e);
    return DEM_OK;
}

static void take_part(void *context)
{
    (void)context;
}

static void go_as_rank(const ranks *r, void *context)
{
    run *c = context;
    world w = {.ranks = r, .limit = c->limit, .cases = c->cases};
    for (int i = r->rank; i < N; i += r->size) w.number[w.n++] = i;
    const unsigned char own[N] = {1, 1, 1, 1, 1};
    const ode_domain d = {.ranks = r,
                          .whole = {.dim = 2, .n_nodes = N, .n_rows = N},
                          .is_own = own,
                          .fill_ghosts = fill_ghosts,
                          .take_part = take_part,
                          .name_failure = name_failure,
                          .wants_stop = wants_stop,
                          .stop = stop};
    if (go(c, &w, &d, &c->outcomes[r->rank]) != DEM_OK) abort();
}

static void compare(const outcome *one, const outcome *whole, int rank, int n_ranks)
{
    assert_memory_equal(one->t, whole->t, sizeof one->t);
    assert_memory_equal(one->next, whole->next, sizeof one->next);
    assert_memory_equal(one->counts, whole->counts, sizeof one->counts);
    assert_memory_equal(one->status, whole->status, sizeof one->status);
    for (int k = 0; k < N_STEPS; k++) {
        assert_string_equal(one->message[k], whole->message[k]);
        for (int i = rank; i < N; i += n_ranks) {
            assert_memory_equal(&one->x[k][i], &whole->x[k][i], sizeof(double));
            assert_memory_equal(&one->v[k][i], &whole->v[k][i], sizeof(double));
        }
    }
}

TEST(ranks_reject_and_retry_as_a_process_alone)
{
    static const dem_method methods[] = {DEM_METHOD_FEHLBERG45, DEM_METHOD_DOPRI45, DEM_METHOD_BS23,
                                         DEM_METHOD_HEUN12,     DEM_METHOD_RK4,     DEM_METHOD_VERLET};
    for (size_t m = 0; m < sizeof methods / sizeof methods[0]; m++) {
        dem_index retries = 0, rejected = 0, failures = 0;
        for (int k = 0; k < 40; k++) {
            world w = {.ranks = &ranks_alone, .n = N, .number = {0, 1, 2, 3, 4}, .limit = 1.001 + 0.02 * pow(2.0, k)};
            w.cases = k % 2 == 0 ? 100 + k : 0;
            run c = {.method = methods[m], .limit = w.limit, .tolerance = k % 3 == 0 ? 1e3 : 1e-7, .cases = w.cases};
            outcome whole = {0};
            assert_ok(go(&c, &w, NULL, &whole));
            retries += whole.counts[N_STEPS - 1].retries;
            rejected += whole.counts[N_STEPS - 1].rejected;
            for (int step = 0; step < N_STEPS; step++) failures += whole.status[step] != DEM_OK;
            for (int n_ranks = 1; n_ranks <= MOST_RANKS; n_ranks++) {
                memset(c.outcomes, 0, sizeof c.outcomes);
                rank_threads_run(n_ranks, go_as_rank, &c);
                for (int r = 0; r < n_ranks; r++) compare(&c.outcomes[r], &whole, r, n_ranks);
            }
        }
        const bool is_fixed = methods[m] == DEM_METHOD_RK4 || methods[m] == DEM_METHOD_VERLET;
        assert_true(is_fixed ? failures > 0 : retries > 0 && rejected > 0);
    }
}
