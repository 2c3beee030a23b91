/* SPDX-License-Identifier: BSD-3-Clause */
/* balance.c: when it pays to share nodes out anew, and what they weigh then. */
#include "domain/balance.h"
#include "domain/partition.h"
#include "harness/rank_threads.h"
#include "unit/domain/shared_lattice.h"

TEST(it_pays_where_the_others_have_waited_for_longer_than_sharing_takes)
{
    double busy[3] = {1.0, 4.0, 1.0}; /* two wait for 4 - 2 = 2 s in the mean */
    balance cheap = {.n_ranks = 3, .busy = busy}, dear = cheap;
    balance_begin(&cheap, 1.9);
    assert_true(balance_pays(&cheap));
    balance_begin(&dear, 2.1);
    assert_false(balance_pays(&dear));
}

TEST(after_each_sharing_it_pays_for_twice_as_much)
{
    double busy[2] = {0.0, 10.0}; /* 5 s are lost */
    balance b = {.n_ranks = 2, .busy = busy};
    for (int k = 0; k < 3; k++) {
        balance_begin(&b, 1.1);
        assert_true(balance_pays(&b));
    }
    balance_begin(&b, 1.1);
    assert_false(balance_pays(&b)); /* 8.8 s */
}

TEST(small_differences_do_not_pay_however_long_they_last)
{
    double busy[2] = {0.91e6, 1e6};
    balance b = {.n_ranks = 2, .busy = busy};
    balance_begin(&b, 1.0);
    assert_false(balance_pays(&b));
    busy[0] = 0.89e6;
    assert_true(balance_pays(&b));
}

/* A row of twelve nodes, of which rank 0 takes three times as long for its half: it gets a quarter of them. Then both
 * work alike, and the weights share them out as they are. */
TEST(nodes_weigh_what_they_cost_the_rank_that_has_them)
{
    double x[24] = {0.0};
    for (int i = 0; i < 12; i++) x[2 * i] = i;
    const dem_lattice row = SIZED(dem_lattice, .dim = 2, .n_nodes = 12, .x = x);
    const double busy[2] = {18.0, 6.0}, alike[2] = {12.0, 12.0};
    int32_t owner[12];
    balance b;
    assert_ok(balance_create(&b, 2));
    balance_begin(&b, 0.0);
    for (int turn = 0; turn < 2; turn++) {
        memcpy(b.busy, turn == 0 ? busy : alike, sizeof busy);
        assert_ok(balance_weigh(&b, &row));
        for (int i = 0; i < 12; i++)
            assert_true(b.weights[i] == (turn == 0 ? (i < 6 ? 3.0 : 1.0) : (i < 4 ? 3.0 : 1.5)));
        assert_ok(partition_bisect_weighted(&row, b.weights, 2, owner));
        for (int i = 0; i < 12; i++) assert_int_equal(owner[i], i >= 4);
    }
    balance_free(&b);
}

static void collect(const ranks *r, void *context)
{
    balance_collect((balance *)context + r->rank, r, 1.5 + r->rank);
    for (int turn = 0; turn < 2; turn++) balance_count((balance *)context + r->rank, r, 10 * (r->rank + 1) + turn);
}

TEST(rank_0_learns_how_long_each_has_worked)
{
    const double expected[4] = {1.5, 2.5, 3.5, 4.5};
    balance all[4] = {{0}};
    assert_ok(balance_create(&all[0], 4));
    rank_threads_run(4, collect, all);
    assert_memory_equal(all[0].busy, expected, sizeof expected);
    for (int k = 0; k < 4; k++) {
        assert_int_equal(all[0].n_start[k], 10 * (k + 1));
        assert_int_equal(all[0].n_own[k], 10 * (k + 1) + 1);
    }
    balance_free(&all[0]);
}

/* ---- ranges ---- */

static void check_cut(const double *busy, const dem_index *own, const dem_index *start, const dem_index *expected)
{
    dem_index first[4];
    balance b;
    assert_ok(balance_create(&b, 3));
    memcpy(b.busy, busy, 3 * sizeof *busy);
    memcpy(b.n_own, own, 3 * sizeof *own);
    memcpy(b.n_start, start, 3 * sizeof *start);
    balance_cut(&b, first);
    assert_memory_equal(first, expected, sizeof first);
    balance_ranges(&b, first);
    for (int k = 0; k < 3; k++) assert_int_equal(first[k + 1] - first[k], own[k]);
    balance_free(&b);
}

TEST(ranges_have_equal_parts_of_the_work)
{
    const dem_index own[3] = {100, 100, 100}, even[4] = {0, 100, 200, 300};
    check_cut((double[]){2.0, 2.0, 2.0}, own, own, even);
    /* 4 s for each: 80 of the nodes that take 0.05 s, then 20 of these and 100 of 0.03 s. */
    check_cut((double[]){5.0, 3.0, 4.0}, own, own, (dem_index[]){0, 80, 200, 300});
    /* Where the work is unknown, bounds alone count. */
    check_cut((double[]){0.0, 0.0, 0.0}, own, own, (dem_index[]){0, 50, 175, 300});
}

TEST(no_range_has_much_more_nodes_than_at_first_or_next_to_none)
{
    const dem_index own[3] = {100, 100, 100};
    check_cut((double[]){1.0, 1.0, 10.0}, own, own, (dem_index[]){0, 125, 250, 300});
    check_cut((double[]){10.0, 1.0, 1.0}, own, own, (dem_index[]){0, 50, 175, 300});
    check_cut((double[]){1e9, 1.0, 1e9}, own, own, (dem_index[]){0, 66, 191, 300}); /* 66 2/3 of 100 */
    /* Of nodes at first, whatever they are now. */
    check_cut((double[]){1.0, 1.0, 10.0}, own, (dem_index[]){40, 130, 130}, (dem_index[]){0, 50, 213, 300});
}

int main(void)
{
    return test_run();
}
