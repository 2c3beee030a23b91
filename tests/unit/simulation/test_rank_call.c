/* SPDX-License-Identifier: BSD-3-Clause */
/* rank_call.c: what rank 0 calls all get, and what any of them is asked for rank 0 gets, once. */
#include "harness/rank_threads.h"
#include "harness/test.h"
#include "simulation/rank_call.h"

enum { N_RANKS = 4, N_CALLS = 3 };

/* Of one rank: what it is asked for, and what it has there after each call. */
typedef struct asked_rank {
    volatile sig_atomic_t end, checkpoint;
    int ends[N_CALLS], checkpoints[N_CALLS];
    dem_index numbers[N_CALLS];
} asked_rank;

static void call(const ranks *r, void *context)
{
    asked_rank *own = (asked_rank *)context + r->rank;
    ranks mine = *r;
    if (r->rank != 1) mine.requests[0] = &own->end; /* nobody asks rank 1 for an end */
    mine.requests[1] = &own->checkpoint;
    for (int k = 0; k < N_CALLS; k++) {
        const rank_call o = rank_call_send(&mine, (rank_call){.kind = RANK_CALL_ADVANCE, .number = 10 * r->rank + k});
        own->numbers[k] = o.kind == RANK_CALL_ADVANCE ? o.number : -1;
        own->ends[k] = own->end;
        own->checkpoints[k] = own->checkpoint;
        if (r->rank == 0) own->end = own->checkpoint = 0;
    }
}

TEST(rank_0_gets_what_any_rank_is_asked_for_with_the_next_call_and_once)
{
    asked_rank all[N_RANKS] = {[2] = {.end = 12}, [3] = {.end = 10, .checkpoint = 1}};
    rank_threads_run(N_RANKS, call, all);
    for (int r = 0; r < N_RANKS; r++)
        for (int k = 0; k < N_CALLS; k++) {
            assert_int_equal(all[r].numbers[k], k);
            assert_int_equal(all[r].ends[k], r == 0 && k == 0 ? 12 : 0);
            assert_int_equal(all[r].checkpoints[k], r == 0 && k == 0);
        }
}

static void call_once(const ranks *r, void *context)
{
    asked_rank *own = (asked_rank *)context + r->rank;
    ranks mine = *r;
    mine.requests[0] = &own->end;
    (void)rank_call_send(&mine, (rank_call){.kind = RANK_CALL_ADVANCE});
}

TEST(what_rank_0_is_asked_for_itself_stays)
{
    asked_rank all[2] = {{.end = 15}};
    rank_threads_run(2, call_once, all);
    assert_int_equal(all[0].end, 15);
    assert_int_equal(all[1].end, 0);
}

int main(void)
{
    return test_run();
}
