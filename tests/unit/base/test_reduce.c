/* SPDX-License-Identifier: BSD-3-Clause */
/* Reductions over 1 to 7 ranks, which are threads: each packet is joined in another order on each of them. */
#include <string.h>

#include "base/reduce.h"
#include "base/status.h"
#include "harness/rank_threads.h"
#include "harness/test.h"

enum { MOST_RANKS = 7, N_TERMS = 700, N_COUNTS = 600, TEXT = 64 };

/* What each rank has found. */
typedef struct results {
    double least, largest, with_nan, sum, sums[2], reported[2];
    bool any, none, alike, alike_but_one;
    dem_index count, counts[N_COUNTS];
    array_ops_sum squares;
    dem_status fine, failed;
    char message[TEXT];
} results;

static double term(int k)
{
    return (k % 2 == 0 ? 1.0 : -1.0) * exp(0.07 * (double)(k % 600));
}

static void add_term(exact_sum *sum, array_ops_sum *squares, int k)
{
    const double x = term(k), w = 1e-18;
    exact_sum_add(sum, x);
    array_ops_portable.square(squares, &x, &w, 1.0, 1);
}

/* Each rank has the terms k with k mod size = rank. Ranks 1 and 2 fail, the latter at an earlier time. */
static void reduce_all(const ranks *r, void *context)
{
    results *of = (results *)context + r->rank;
    exact_sum sum = {0};
    array_ops_sum squares = {0};
    for (int k = r->rank; k < N_TERMS; k += r->size) add_term(&sum, &squares, k);
    of->least = reduce_min(r, -1.0 - r->rank);
    of->largest = reduce_max(r, 1.0 + r->rank);
    of->with_nan = reduce_max(r, r->rank == r->size / 2 ? (double)NAN : 1.0);
    of->any = reduce_any(r, r->rank == r->size - 1);
    of->none = reduce_any(r, false);
    of->alike = reduce_alike(r, 77);
    of->alike_but_one = reduce_alike(r, r->rank == r->size - 1 ? 78 : 77);
    of->count = reduce_count(r, r->rank + 1);
    for (int k = 0; k < N_COUNTS; k++) of->counts[k] = k * (r->rank + 1);
    reduce_counts(r, of->counts, N_COUNTS);
    of->sum = reduce_sum(r, &sum);
    const exact_sum ranks_there = exact_sum_of(1.0);
    reduce_sums(r, (const exact_sum *[]){&sum, &ranks_there}, 2, of->sums);
    of->reported[0] = of->reported[1] = (double)NAN;
    if (r->rank == r->size - 1) of->reported[0] = of->reported[1] = (double)r->size;
    reduce_report(r, r->rank == r->size - 1, of->reported, 2);
    of->squares = reduce_squares(r, squares);
    of->fine = reduce_status(r, DEM_OK, 0.0);
    const bool fails = r->rank == 1 || r->rank == 2;
    const dem_status own =
        fails ? status_fail(r->rank == 1 ? DEM_ERROR_MODEL : DEM_ERROR_CONTACT, "rank %d", r->rank) : DEM_OK;
    of->failed = reduce_status(r, own, r->rank == 2 ? 1.0 : 2.0);
    (void)strncpy(of->message, dem_status_message(), TEXT - 1);
}

TEST(every_rank_gets_the_same_whatever_the_shares)
{
    exact_sum sum = {0};
    array_ops_sum squares = {0};
    for (int k = 0; k < N_TERMS; k++) add_term(&sum, &squares, k);
    for (int n = 1; n <= MOST_RANKS; n++) {
        results all[MOST_RANKS] = {{0}};
        rank_threads_run(n, reduce_all, all);
        for (int k = 0; k < n; k++) {
            assert_true(all[k].least == -(double)n && all[k].largest == (double)n);
            assert_true(isnan(all[k].with_nan));
            assert_true(all[k].any && !all[k].none);
            assert_true(all[k].alike && all[k].alike_but_one == (n == 1));
            assert_int_equal(all[k].count, n * (n + 1) / 2);
            for (int q = 0; q < N_COUNTS; q++) assert_int_equal(all[k].counts[q], q * n * (n + 1) / 2);
            assert_true(all[k].sum == exact_sum_value(&sum));
            assert_true(all[k].sums[0] == exact_sum_value(&sum) && all[k].sums[1] == (double)n);
            assert_true(all[k].reported[0] == (double)n && all[k].reported[1] == (double)n);
            assert_memory_equal(&all[k].squares, &squares, sizeof squares);
            assert_int_equal(all[k].fine, DEM_OK);
        }
    }
}

TEST(the_first_failure_is_that_of_all)
{
    results all[MOST_RANKS] = {{0}};
    rank_threads_run(MOST_RANKS, reduce_all, all);
    for (int k = 0; k < MOST_RANKS; k++) {
        assert_int_equal(all[k].failed, DEM_ERROR_CONTACT);
        assert_string_equal(all[k].message, "rank 2");
    }
    rank_threads_run(2, reduce_all, all);
    assert_int_equal(all[0].failed, DEM_ERROR_MODEL);
    assert_string_equal(all[0].message, "rank 1");
}

TEST(a_process_alone_keeps_what_it_has)
{
    results one = {0};
    reduce_all(&ranks_alone, &one);
    assert_true(one.least == -1.0 && one.largest == 1.0 && one.count == 1);
    assert_int_equal(one.failed, DEM_OK);
}
