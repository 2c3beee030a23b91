/* SPDX-License-Identifier: BSD-3-Clause */
/* parcel.c: what rank 0 lists comes to one other rank. */
#include "harness/test.h"

#include <stdlib.h>
#include <string.h>

#include "base/parcel.h"
#include "harness/rank_threads.h"

enum { N_RANKS = 3, N = 1000 };

/* What each rank has. */
typedef struct box {
    double *numbers;
    char *text, *nothing;
    char *empty; /* an array without items */
    dem_status status;
} box;

static double number(int to, int k)
{
    return to + 1.0 / (k + 1.0);
}

static void list(parcel *p, box *b)
{
    parcel_add(p, &b->numbers, N * sizeof *b->numbers);
    parcel_add(p, &b->text, 5);
    parcel_add(p, &b->nothing, 7);
    parcel_add(p, &b->empty, 0);
}

static void fill(box *b, int to)
{
    b->numbers = malloc(N * sizeof *b->numbers);
    for (int k = 0; k < N; k++) b->numbers[k] = number(to, k);
    b->text = strdup("text");
    b->empty = malloc(1);
}

static void empty(box *b)
{
    free(b->numbers);
    free(b->text);
    free(b->nothing);
    free(b->empty);
}

static void deal(const ranks *r, void *context)
{
    box *all = context;
    for (int to = 1; to < N_RANKS; to++) {
        box of_root = {.nothing = NULL}, *own = r->rank == 0 ? &of_root : &all[r->rank];
        parcel p = {0};
        if (r->rank == 0) fill(own, to);
        if (r->rank == 0 || r->rank == to) list(&p, own);
        all[r->rank].status = parcel_send(r, to, &p);
        empty(&of_root);
    }
}

TEST(what_is_listed_comes_to_one_rank)
{
    static char elsewhere;
    box all[N_RANKS];
    for (int k = 0; k < N_RANKS; k++) all[k] = (box){.nothing = &elsewhere, .status = DEM_STOPPED};
    all[0].nothing = NULL;
    rank_threads_run(N_RANKS, deal, all);
    for (int to = 0; to < N_RANKS; to++) {
        assert_int_equal(all[to].status, DEM_OK);
        assert_null(all[to].nothing);
        if (to == 0) continue;
        for (int k = 0; k < N; k++) assert_true(all[to].numbers[k] == number(to, k));
        assert_string_equal(all[to].text, "text");
        assert_non_null(all[to].empty);
        empty(&all[to]);
    }
}
