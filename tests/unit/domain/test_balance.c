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
}

TEST(rank_0_learns_how_long_each_has_worked)
{
    const double expected[4] = {1.5, 2.5, 3.5, 4.5};
    balance all[4] = {{0}};
    assert_ok(balance_create(&all[0], 4));
    rank_threads_run(4, collect, all);
    assert_memory_equal(all[0].busy, expected, sizeof expected);
    balance_free(&all[0]);
}

int main(void)
{
    return test_run();
}
