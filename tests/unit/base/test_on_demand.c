/* SPDX-License-Identifier: BSD-3-Clause */
/* on_demand.c: what is made once stays, whoever asks; what could not be made is tried again. */
#include "base/on_demand.h"

#include "base/status.h"
#include "harness/test.h"
#include "unit/free_team.h"

/* Plain numbers, so that a race among those who ask is one. */
typedef struct thing {
    on_demand made;
    int n_calls, n_failures, value;
} thing;

static dem_status make(void *self)
{
    thing *t = self;
    if (t->n_calls++ < t->n_failures) return status_fail(DEM_ERROR_MEMORY, "out of memory");
    t->value += 7;
    return DEM_OK;
}

TEST(it_is_made_at_the_first_call_that_succeeds)
{
    thing t = {.n_failures = 2};
    assert_int_equal(on_demand_create(&t.made), DEM_OK);
    for (int k = 0; k < 2; k++) assert_int_equal(on_demand_make(&t.made, make, &t), DEM_ERROR_MEMORY);
    for (int k = 0; k < 3; k++) assert_int_equal(on_demand_make(&t.made, make, &t), DEM_OK);
    assert_int_equal(t.n_calls, 3);
    assert_int_equal(t.value, 7);
    on_demand_destroy(&t.made);
}

enum { N_SHARES = 64 };

typedef struct asking {
    thing *wanted;
    int *seen; /* [N_SHARES] the value that a share has seen */
} asking;

static void ask(const void *context, int share, int thread)
{
    const asking *a = context;
    (void)thread;
    if (on_demand_make(&a->wanted->made, make, a->wanted) == DEM_OK) a->seen[share] = a->wanted->value;
}

TEST(several_threads_may_ask_at_once)
{
    CLEANUP(free_team) team *threads = team_create(4, 1);
    for (int turn = 0; turn < 200; turn++) {
        thing t = {0};
        int seen[N_SHARES] = {0};
        assert_int_equal(on_demand_create(&t.made), DEM_OK);
        team_run(threads, N_SHARES, ask, &(asking){&t, seen});
        for (int k = 0; k < N_SHARES; k++) assert_int_equal(seen[k], 7);
        assert_int_equal(t.n_calls, 1);
        on_demand_destroy(&t.made);
    }
}
