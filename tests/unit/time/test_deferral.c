/* SPDX-License-Identifier: BSD-3-Clause */
/* deferral.c: operations that are recorded come out as those at once, whoever asks for what, and when. Each test does
 * the same with a space that defers and with one that does not; numbers are to be equal. Runs of whole steps are in
 * test_stage_wave.c. */
#include "unit/close.h"

#include <stdlib.h>
#include <string.h>
#include <sundials/sundials_context.h>

#include "time/deferral.h"

enum { n_nodes = 8003, band = 40, n_vectors = 6 };
enum { Y, F0, F1, F2, STATE, ERROR }; /* a method of two stages behind F0 */

typedef struct bench {
    SUNContext sundials;
    ode_problem problem;
    error_weights *weights;
    nvector_space *space;
    deferral *deferral; /* NULL: operations are carried out at once */
    N_Vector v[n_vectors];
    int evaluated, failures_left;
    int by_waves; /* derivatives */
} bench;

static void accelerate(const double *x, double *a, dem_index i)
{
    for (int d = 0; d < 2; d++) a[2 * i + d] = -sin(x[2 * i + d]) + 0.1 * (i >= band ? x[2 * (i - band) + d] : 0.0);
}

/* All rows are alike, also those behind the nodes. */
static int swing(double t, N_Vector y, N_Vector f, void *context)
{
    bench *b = context;
    const double *x = nvector_values(y);
    double *u = nvector_fresh(f);
    const dem_index v = state_velocities(&b->problem.layout);
    (void)t;
    b->evaluated++;
    memcpy(u, x + v, (size_t)v * sizeof *u);
    for (dem_index i = 0; i < b->problem.layout.n_rows; i++) accelerate(x, u + v, i);
    return b->failures_left-- > 0 ? -1 : 0;
}

static double swing_band(const ode_band *p, void *context)
{
    const bench *b = context;
    for (dem_index i = p->first; i < p->end; i++) accelerate(p->x, p->a, i);
    return b->failures_left > 0 ? (double)INFINITY : 0.0;
}

static bool has_bands(int n_stages, void *context)
{
    (void)context;
    return n_stages == 2;
}

static void count(int n, void *context)
{
    bench *b = context;
    b->by_waves += n;
}

/* In place, as the owner keeps its address.  \param tolerance  what counts as an error of 1 */
static void begin(bench *b, bool defers, double tolerance)
{
#ifdef SUN_COMM_NULL
    assert_int_equal(SUNContext_Create(SUN_COMM_NULL, &b->sundials), 0);
#else
    assert_int_equal(SUNContext_Create(NULL, &b->sundials), 0);
#endif
    b->problem = (ode_problem){.layout = state_layout_of(2, n_nodes, 0, false),
                               .band_rows = band,
                               .has_bands = has_bands,
                               .bands_hold = has_bands,
                               .band_derivative = swing_band,
                               .context = b,
                               .position_error = tolerance,
                               .velocity_error = 2.0 * tolerance,
                               .ops = array_ops_fastest()};
    const dem_index length = state_size(&b->problem.layout);
    b->weights = error_weights_create(&b->problem);
    assert_non_null(b->weights);
    b->space = nvector_space_create(
        &(nvector_shape){
            .ranks = &ranks_alone, .length = length, .n_whole = length, .weights = b->weights, .ops = b->problem.ops},
        n_vectors);
    assert_non_null(b->space);
    for (int k = 0; k < n_vectors; k++) {
        b->v[k] = nvector_create(b->space, b->sundials);
        double *to = nvector_fresh(b->v[k]);
        for (dem_index c = 0; c < state_size(&b->problem.layout); c++) to[c] = cos(1.0 + k + 0.1 * (double)c);
    }
    if (!defers) return;
    b->deferral = deferral_create(&(deferral_owner){&b->problem, b->space, b->weights, swing, count, b}, 2);
    assert_non_null(b->deferral);
}

static void end(bench *b)
{
    for (int k = 0; k < n_vectors; k++) N_VDestroy(b->v[k]);
    deferral_free(b->deferral);
    nvector_space_free(b->space);
    error_weights_free(b->weights);
    (void)SUNContext_Free(&b->sundials);
}

static int sum(bench *b, int to, int n, double factor[], const int of[])
{
    N_Vector x[4];
    for (int k = 0; k < n; k++) x[k] = b->v[of[k]];
    return N_VLinearCombination(n, factor, x, b->v[to]);
}

static int derive(bench *b, int f)
{
    return deferral_take_derivative(b->deferral, 0.0, b->v[STATE], b->v[f]) ? 0 : swing(0.0, b->v[STATE], b->v[f], b);
}

static void first_stage(bench *b)
{
    (void)sum(b, STATE, 2, (double[]){0.1, 1.0}, (int[]){F0, Y});
    (void)derive(b, F1);
}

static void second_stage(bench *b)
{
    (void)sum(b, STATE, 3, (double[]){0.05, 0.2, 1.0}, (int[]){F0, F1, Y});
    (void)derive(b, F2);
}

/* \return the status of the last sum */
static int end_of_step(bench *b)
{
    (void)sum(b, STATE, 4, (double[]){0.05, 0.1, 0.15, 1.0}, (int[]){F0, F1, F2, Y});
    return sum(b, ERROR, 3, (double[]){0.01, -0.02, 0.01}, (int[]){F0, F1, F2});
}

static int take_step(bench *b)
{
    first_stage(b);
    second_stage(b);
    return end_of_step(b);
}

static void assert_same(const bench *a, const bench *b, int which)
{
    assert_memory_equal(nvector_values(a->v[which]), nvector_values(b->v[which]),
                        (size_t)state_size(&a->problem.layout) * sizeof(double));
}

/* A space that defers, and one that does not. */
typedef struct pair {
    bench a, b;
} pair;

static void begin_within(pair *p, double tolerance)
{
    memset(p, 0, sizeof *p);
    begin(&p->a, true, tolerance);
    begin(&p->b, false, tolerance);
}

static void begin_pair(pair *p)
{
    begin_within(p, 1.0);
}

static double norm_of_error(const bench *b)
{
    return N_VWrmsNorm(b->v[ERROR], b->v[Y]); /* which weights are given does not matter */
}

static void end_pair(pair *p)
{
    end(&p->a);
    end(&p->b);
}

TEST(a_step_is_a_wave_with_the_norm_and_the_end_of_one_by_one)
{
    CLEANUP(end_pair) pair p;
    begin_pair(&p);
    assert_int_equal(take_step(&p.a), 0);
    assert_int_equal(take_step(&p.b), 0);
    const double norm = norm_of_error(&p.b);
    assert_true(norm > 1e-3 && norm < 1.0);
    assert_close(norm_of_error(&p.a), norm, 0.0);
    assert_same(&p.a, &p.b, STATE);
    assert_int_equal(p.a.by_waves, 2);
    assert_int_equal(p.a.evaluated, 0);
    assert_int_equal(p.b.evaluated, 2);
}

/* What a wave has left out: a stage, and the error. */
TEST(what_is_left_out_may_be_read)
{
    static const int read[] = {F1, F2, ERROR};
    for (size_t k = 0; k < sizeof read / sizeof *read; k++) {
        CLEANUP(end_pair) pair p;
        begin_pair(&p);
        (void)take_step(&p.a);
        (void)take_step(&p.b);
        assert_same(&p.a, &p.b, read[k]);
        assert_same(&p.a, &p.b, STATE);
        assert_int_equal(p.a.evaluated, 2);
    }
}

/* Read or written half-way: what has been recorded is carried out, and the step goes on. */
TEST(a_step_may_be_interrupted)
{
    for (int what = 0; what < 5; what++) {
        CLEANUP(end_pair) pair p;
        begin_pair(&p);
        for (int k = 0; k < 2; k++) {
            bench *b = k == 0 ? &p.a : &p.b;
            first_stage(b);
            if (what == 0) (void)nvector_values(b->v[F1]);
            if (what == 1) N_VConst(0.5, b->v[Y]);
            if (what == 2) nvector_shared(b->v[F0])[17] = 3.0;
            if (what == 3) N_VScale(1.0, b->v[STATE], b->v[F2]);
            if (what == 4) nvector_share(b->v[F0], b->v[F1]);
            second_stage(b);
            assert_int_equal(end_of_step(b), 0);
        }
        for (int k = 0; k < n_vectors; k++) assert_same(&p.a, &p.b, k);
        assert_close(norm_of_error(&p.a), norm_of_error(&p.b), 0.0);
    }
}

/* Its error is larger than 1, so that it will be read: there is no wave then. */
TEST(a_rejected_step_leaves_all_vectors)
{
    CLEANUP(end_pair) pair p;
    begin_within(&p, 1e-3);
    for (int k = 0; k < 2; k++) {
        bench *b = k == 0 ? &p.a : &p.b;
        (void)take_step(b);
        N_VConst(7.0, b->v[Y]); /* the start is gone */
    }
    assert_true(norm_of_error(&p.a) > 1.0);
    for (int k = 0; k < n_vectors; k++) assert_same(&p.a, &p.b, k);
    assert_int_equal(p.a.by_waves, 0);
}

/* Two sums in a row complete a step; these are other things. */
TEST(other_orders_of_calls_are_no_wave)
{
    CLEANUP(end_pair) pair p;
    begin_pair(&p);
    for (int k = 0; k < 2; k++) {
        bench *b = k == 0 ? &p.a : &p.b;
        (void)sum(b, STATE, 2, (double[]){0.1, 1.0}, (int[]){F0, Y}); /* without a derivative */
        (void)sum(b, ERROR, 2, (double[]){0.2, 1.0}, (int[]){STATE, Y});
        (void)sum(b, STATE, 2, (double[]){0.1, 1.0}, (int[]){F0, Y});
        (void)sum(b, STATE, 2, (double[]){0.3, 1.0}, (int[]){STATE, Y});
        first_stage(b); /* a stage is missing */
        (void)end_of_step(b);
        for (int stage = 0; stage < 20; stage++) first_stage(b); /* too many */
        (void)sum(b, Y, 2, (double[]){0.1, 1.0}, (int[]){F1, STATE});
        first_stage(b); /* the end is a vector that is read */
        second_stage(b);
        (void)sum(b, Y, 3, (double[]){0.05, 0.1, 1.0}, (int[]){F0, F1, Y});
        (void)sum(b, ERROR, 2, (double[]){0.01, -0.02}, (int[]){F1, F2});
    }
    for (int k = 0; k < n_vectors; k++) assert_same(&p.a, &p.b, k);
    assert_int_equal(p.a.by_waves, 0);
    assert_int_equal(p.a.evaluated, p.b.evaluated);
}

TEST(a_failure_is_the_failure_of_the_last_sum)
{
    CLEANUP(end_pair) pair p;
    begin_pair(&p);
    p.a.failures_left = 1;
    assert_int_equal(take_step(&p.a), -1);
    assert_int_equal(p.a.evaluated, 1);
    assert_int_equal(take_step(&p.a), 0);
    (void)take_step(&p.b);
    assert_same(&p.a, &p.b, STATE);
    assert_int_equal(p.a.by_waves, 2);
}
