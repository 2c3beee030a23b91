/* SPDX-License-Identifier: BSD-3-Clause */
/* all_rows.c: every rank gets the rows of all, in the order of ranks. */
#include "harness/test.h"

#include <stdlib.h>

#include "base/all_rows.h"
#include "harness/rank_threads.h"

enum { MOST = 5, WIDTH = 3 };

/* Some ranks have none. */
static dem_index count(int rank)
{
    return rank % 2 == 0 ? 0 : 7 * rank;
}

static double number(int rank, dem_index row, int column)
{
    return rank + 1.0 / (double)(WIDTH * row + column + 3);
}

static bool is_right(const all_rows *a, const double *rows)
{
    bool right = true;
    dem_index n = 0;
    for (int k = 0; k < a->ranks->size; k++)
        for (dem_index q = 0; q < count(k); q++, n++)
            for (int c = 0; c < WIDTH; c++) right = right && rows[WIDTH * n + c] == number(k, q, c);
    return right && n == a->n;
}

/* Twice, as rows change. */
static void share(const ranks *r, void *context)
{
    bool *right = context;
    all_rows a;
    right[r->rank] = all_rows_create(&a, r, count(r->rank)) == DEM_OK;
    double *rows = calloc((size_t)(WIDTH * a.n) + 1, sizeof *rows);
    right[r->rank] = right[r->rank] && rows != NULL;
    for (int turn = 0; turn < 2 && right[r->rank]; turn++) {
        for (dem_index k = 0; k < WIDTH * a.n; k++) rows[k] = -1.0;
        for (dem_index q = 0; q < count(r->rank); q++)
            for (int c = 0; c < WIDTH; c++) rows[WIDTH * (all_rows_own(&a) + q) + c] = number(r->rank, q, c);
        all_rows_share(&a, WIDTH * sizeof *rows, rows);
        right[r->rank] = is_right(&a, rows);
    }
    free(rows);
    all_rows_free(&a);
}

TEST(every_rank_gets_the_rows_of_all)
{
    for (int n = 1; n <= MOST; n++) {
        bool right[MOST] = {0};
        rank_threads_run(n, share, right);
        for (int k = 0; k < n; k++) assert_true(right[k]);
    }
}
