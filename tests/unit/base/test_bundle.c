/* SPDX-License-Identifier: BSD-3-Clause */
/* bundle.c: what each rank has for each other one comes there. */
#include "harness/test.h"

#include <stdlib.h>

#include "base/bundle.h"
#include "harness/rank_threads.h"

enum { MOST = 5 };

/* So many numbers, each another one, from one rank to another; none from a rank to the next. */
static int count(int from, int to)
{
    return to == from + 1 ? 0 : 100 * from + to;
}

static double number(int from, int to, int k)
{
    return from + to / 10.0 + 1.0 / (k + 3.0);
}

static bool is_right(const bundle *b, int from, int to)
{
    dem_index at = 0;
    bool right = b->n == (dem_index)sizeof(double) * count(from, to);
    for (int k = 0; right && k < count(from, to); k++) {
        double value;
        bundle_take(b, &at, &value, sizeof value);
        right = value == number(from, to, k);
    }
    return right;
}

static void deal(const ranks *r, void *context)
{
    bundle sent[MOST] = {{0}}, received[MOST];
    bool *right = context;
    for (int to = 0; to < r->size; to++)
        for (int k = 0; k < count(r->rank, to); k++) {
            const double value = number(r->rank, to, k);
            (void)bundle_add(&sent[to], &value, sizeof value);
        }
    right[r->rank] = bundles_exchange(r, sent, received) == DEM_OK;
    for (int from = 0; from < r->size; from++)
        right[r->rank] =
            right[r->rank] && (from == r->rank ? received[from].n == 0 : is_right(&received[from], from, r->rank));
    bundles_free(sent, r->size);
    bundles_free(received, r->size);
}

TEST(what_each_rank_has_for_another_comes_there)
{
    for (int n = 1; n <= MOST; n++) {
        bool right[MOST] = {0};
        rank_threads_run(n, deal, right);
        for (int k = 0; k < n; k++) assert_true(right[k]);
    }
}

TEST(what_is_freed_is_empty)
{
    bundle b = {0};
    assert_true(bundle_add(&b, "text", 5));
    bundles_free(&b, 1);
    assert_int_equal(b.n, 0);
    assert_null(b.bytes);
    bundles_free(NULL, 1);
}
