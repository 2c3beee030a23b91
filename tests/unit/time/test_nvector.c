/* SPDX-License-Identifier: BSD-3-Clause */
/* nvector.c: copies that share numbers, combinations, norms; with 1, 2 and 3 threads. */
#include "unit/close.h"

#include <stdlib.h>
#include <sundials/sundials_context.h>

#include "time/nvector.h"

enum { n_nodes = 251, n = 4 * n_nodes, n_vectors = 5 };

typedef struct bench {
    SUNContext sundials;
    team *team;
    error_weights *weights;
    nvector_space *space;
    N_Vector v[n_vectors];
} bench;

static double number(int which, dem_index k)
{
    return sin(1.0 + which + 0.37 * (double)k);
}

static double weight(dem_index k)
{
    return k < n / 2 ? 0.75 : 0.25;
}

static bench make_bench(int n_threads)
{
    bench b;
#ifdef SUN_COMM_NULL
    assert_int_equal(SUNContext_Create(SUN_COMM_NULL, &b.sundials), 0);
#else
    assert_int_equal(SUNContext_Create(NULL, &b.sundials), 0);
#endif
    b.team = team_create(n_threads, 1);
    b.weights = error_weights_create(&(ode_problem){.layout = {.dim = 2, .n_nodes = n_nodes, .n_rows = n_nodes},
                                                    .position_error = 1.0 / weight(0),
                                                    .velocity_error = 1.0 / weight(n - 1),
                                                    .ops = &array_ops_portable});
    assert_non_null(b.weights);
    b.space = nvector_space_create(&(nvector_shape){.ranks = &ranks_alone,
                                                    .length = n,
                                                    .n_whole = n,
                                                    .weights = b.weights,
                                                    .ops = &array_ops_portable,
                                                    .team = b.team},
                                   n_vectors - 1);
    assert_non_null(b.space);
    for (int p = 0; p < n_vectors; p++) {
        b.v[p] = p == 0 ? nvector_create(b.space, b.sundials) : N_VClone(b.v[0]);
        assert_non_null(b.v[p]);
        double *to = nvector_fresh(b.v[p]);
        for (dem_index k = 0; k < n; k++) to[k] = number(p, k);
    }
    return b;
}

static void free_bench(bench *b)
{
    for (int p = 0; p < n_vectors; p++) N_VDestroy(b->v[p]);
    nvector_space_free(b->space);
    error_weights_free(b->weights);
    team_destroy(b->team);
    (void)SUNContext_Free(&b->sundials);
}

static void assert_is(N_Vector v, int which)
{
    for (dem_index k = 0; k < n; k++) assert_close(nvector_values(v)[k], number(which, k), 0.0);
}

TEST(a_copy_shares_numbers_until_one_is_given_others)
{
    CLEANUP(free_bench) bench b = make_bench(1);
    N_VScale(1.0, b.v[0], b.v[1]);
    nvector_share(b.v[0], b.v[2]);
    assert_ptr_equal(nvector_values(b.v[0]), nvector_values(b.v[1]));
    assert_ptr_equal(nvector_values(b.v[0]), nvector_values(b.v[2]));
    double *fresh = nvector_fresh(b.v[0]);
    for (dem_index k = 0; k < n; k++) fresh[k] = 5.0;
    assert_is(b.v[1], 0);
    assert_is(b.v[2], 0);
    assert_close(nvector_values(b.v[0])[n - 1], 5.0, 0.0);
    N_VScale(1.0, b.v[1], b.v[1]); /* onto itself */
    assert_is(b.v[1], 0);
    N_VScale(-2.0, b.v[1], b.v[1]);
    for (dem_index k = 0; k < n; k++) assert_close(nvector_values(b.v[1])[k], -2.0 * number(0, k), 0.0);
    assert_is(b.v[2], 0);
    N_VConst(0.25, b.v[2]);
    assert_close(nvector_values(b.v[2])[0], 0.25, 0.0);
}

/* Every vector shared and parted again, many times: no buffer is lost, none has two owners. */
TEST(buffers_go_round)
{
    CLEANUP(free_bench) bench b = make_bench(1);
    for (int round = 0; round < 1000; round++) {
        const int from = (7 * round) % n_vectors, to = (3 * round + round / n_vectors) % n_vectors;
        nvector_share(b.v[from], b.v[to]);
        double *fresh = nvector_fresh(b.v[(to + 1) % n_vectors]);
        for (dem_index k = 0; k < n; k++) fresh[k] = round;
        for (int p = 0; p < n_vectors; p++)
            if (p != (to + 1) % n_vectors) assert_ptr_not_equal(nvector_values(b.v[p]), fresh);
    }
}

TEST(combinations_leave_out_zeros_and_may_go_where_an_operand_is)
{
    for (int n_threads = 1; n_threads <= 3; n_threads++) {
        CLEANUP(free_bench) bench b = make_bench(n_threads);
        double c[4] = {2.0, 0.0, -3.0, 1.0};
        N_Vector x[4] = {b.v[0], b.v[1], b.v[2], b.v[3]};
        nvector_fresh(b.v[1])[5] = (double)NAN; /* of no weight */
        assert_int_equal(N_VLinearCombination(4, c, x, b.v[3]), 0);
        for (dem_index k = 0; k < n; k++)
            assert_close(nvector_values(b.v[3])[k], 2.0 * number(0, k) - 3.0 * number(2, k) + number(3, k), 0.0);
        N_VLinearSum(0.5, b.v[0], 0.5, b.v[0], b.v[0]);
        assert_is(b.v[0], 0);
        c[0] = c[2] = c[3] = 0.0;
        assert_int_equal(N_VLinearCombination(4, c, x, b.v[4]), 0);
        for (dem_index k = 0; k < n; k++) assert_close(nvector_values(b.v[4])[k], 0.0, 0.0);
        c[1] = 1.0;
        x[1] = b.v[2];
        assert_int_equal(N_VLinearCombination(4, c, x, b.v[4]), 0);
        assert_ptr_equal(nvector_values(b.v[2]), nvector_values(b.v[4]));
    }
}

/* sqrt(sum of (x w)^2/n), whatever the vector of weights says, within 1e-9: at the lower end of a range the largest
 * number is 3e-5, and its square is rounded to 2^-60; below 1e-3 that is 1e-6 of them. One number far above the others,
 * where a sample does not see it; and the same bits for any number of threads. */
TEST(norms_of_all_sizes_are_right)
{
    for (double size = 1e-6; size < 1e201; size *= 1e3)
        for (int peak = 0; peak < 2; peak++) {
            double first = 0.0;
            for (int n_threads = 1; n_threads <= 3; n_threads++) {
                CLEANUP(free_bench) bench b = make_bench(n_threads);
                double *x = nvector_fresh(b.v[0]), sum = 0.0, largest = 0.0;
                for (dem_index k = 0; k < n; k++) x[k] *= size;
                if (peak) x[501] = 1e7 * size;
                for (dem_index k = 0; k < n; k++) largest = fmax(largest, fabs(x[k] * weight(k)));
                for (dem_index k = 0; k < n; k++) {
                    const double e = x[k] * weight(k) / largest;
                    sum += e * e;
                }
                const double norm = N_VWrmsNorm(b.v[0], b.v[1]), expected = largest * sqrt(sum / n);
                assert_close(norm, expected, (size < 1e-3 ? 1e-6 : 1e-9) * expected);
                if (n_threads == 1) first = norm;
                assert_close(norm, first, 0.0);
            }
        }
}

/* Of the state from which a step goes a bound is enough, which is no more than sqrt(n) times the norm: both are by the
 * weights. Where it is too large to tell whether rounding counts, and of other vectors, it is the norm. */
TEST(the_norm_of_a_start_may_be_a_bound)
{
    for (int n_threads = 1; n_threads <= 3; n_threads++) {
        bench b = make_bench(n_threads);
        double *const start = nvector_fresh(b.v[0]), *const other = nvector_fresh(b.v[2]);
        for (double size = 1e-3; size < 1e19; size *= 1e4) {
            for (dem_index k = 0; k < n; k++) start[k] = other[k] = size * number(0, k);
            nvector_space_start(b.space, NULL);
            const double norm = N_VWrmsNorm(b.v[0], b.v[1]);
            nvector_space_start(b.space, b.v[0]);
            N_VScale(1.0, b.v[0], b.v[1]);
            const double bound = N_VWrmsNorm(b.v[1], b.v[0]);
            assert_true(bound >= norm && bound <= sqrt((double)n) * norm);
            assert_int_equal(bound != norm, size < 1e15);
            assert_close(N_VWrmsNorm(b.v[2], b.v[0]), norm, 0.0);
        }
        start[7] = (double)NAN;
        assert_true(isinf(N_VWrmsNorm(b.v[0], b.v[1])));
        free_bench(&b);
    }
}

TEST(the_norm_of_what_is_no_number_is_infinite)
{
    CLEANUP(free_bench) bench b = make_bench(2);
    nvector_fresh(b.v[0])[700] = (double)NAN;
    assert_true(N_VWrmsNorm(b.v[0], b.v[1]) > 1e300);
    nvector_fresh(b.v[0])[700] = -(double)INFINITY;
    assert_true(N_VWrmsNorm(b.v[0], b.v[1]) > 1e300);
    N_VConst(0.0, b.v[0]);
    assert_close(N_VWrmsNorm(b.v[0], b.v[1]), 0.0, 0.0);
}

/* What ARKODE asks a vector to have. */
TEST(the_rest_goes_number_by_number)
{
    CLEANUP(free_bench) bench b = make_bench(1);
    N_VDiv(b.v[0], b.v[1], b.v[2]);
    assert_close(nvector_values(b.v[2])[3], number(0, 3) / number(1, 3), 0.0);
    N_VAbs(b.v[0], b.v[2]);
    assert_close(nvector_values(b.v[2])[10], fabs(number(0, 10)), 0.0);
    N_VInv(b.v[0], b.v[2]);
    assert_close(nvector_values(b.v[2])[3], 1.0 / number(0, 3), 0.0);
    N_VAddConst(b.v[0], 2.0, b.v[0]);
    assert_close(nvector_values(b.v[0])[3], number(0, 3) + 2.0, 0.0);
    nvector_fresh(b.v[3])[99] = -7.0;
    assert_close(N_VMaxNorm(b.v[3]), 7.0, 0.0);
    assert_int_equal(N_VGetVectorID(b.v[0]), SUNDIALS_NVEC_CUSTOM);
}
