/* SPDX-License-Identifier: BSD-3-Clause */
/* row_blocks.c: each rank gets the rows of its slices, whoever owns them, and all together have every row once. */
#include "harness/test.h"

#include <stdlib.h>
#include <string.h>

#include "domain/row_blocks.h"
#include "harness/cleanup.h"
#include "harness/rank_threads.h"

enum { MANY = 4 * ROWS_CHUNK + 1237, SIZE = 5, MOST_RANKS = 6 };

typedef int owner_of_row(dem_index k, int n_ranks);

static int owner_at_random(dem_index k, int n_ranks)
{
    return (int)(((uint64_t)k * 2654435761u >> 7) % (uint64_t)n_ranks);
}

/* As the rows of slabs are owned. */
static int owner_by_range(dem_index k, int n_ranks)
{
    return (int)(k * n_ranks / MANY);
}

/* Rank 0 has all. */
static int owner_is_first(dem_index k, int n_ranks)
{
    (void)k;
    (void)n_ranks;
    return 0;
}

typedef struct dealing {
    owner_of_row *owner;
    dem_index n; /* rows of the whole */
    int n_stripes;
    bool has_numbers;    /* and flags, on rank 0 */
    unsigned char *seen; /* [n] how often a row has come to a rank */
    bool is_good[MOST_RANKS];
    rank_threads_counts counts[MOST_RANKS];
    dem_index n_rounds;
} dealing;

static unsigned char byte_of(dem_index k, dem_index q)
{
    return (unsigned char)(k >> 4 * q);
}

/* Of each stripe the rows come in their order on each rank. */
static bool check_slice(const dealing *d, row_slice s, const unsigned char *slice)
{
    const dem_index end = d->n * (s.stripe + 1) / d->n_stripes;
    bool good = s.n <= ROWS_CHUNK && s.first % ROWS_CHUNK == 0 && s.begin + s.first + s.n <= end;
    for (dem_index k = 0; k < s.n; k++) {
        for (dem_index q = 0; q < SIZE; q++) good = good && slice[SIZE * k + q] == byte_of(s.begin + s.first + k, q);
        d->seen[s.begin + s.first + k]++;
    }
    return good;
}

/* What is said of rows that are not own is not to be believed. */
static void deal(const ranks *r, void *context)
{
    dealing *d = context;
    unsigned char *is_own = malloc((size_t)d->n + 1), *rows = malloc((size_t)d->n * SIZE + 1);
    unsigned char *slice = malloc(ROWS_CHUNK * SIZE);
    dem_index *number = malloc(((size_t)d->n + 1) * sizeof *number);
    gather_items items = {.n_whole = d->n, .number = number, .is_own = is_own};
    for (dem_index k = 0; k < d->n; k++) {
        const bool owns = d->owner(k, r->size) == r->rank;
        if (!owns && (k % 3 != r->rank || !d->has_numbers)) continue;
        for (dem_index q = 0; q < SIZE; q++) rows[SIZE * items.n + q] = owns ? byte_of(k, q) : 0xee;
        is_own[items.n] = owns;
        number[items.n++] = k;
    }
    if (!d->has_numbers) items.number = NULL, items.is_own = NULL;
    row_blocks b;
    d->is_good[r->rank] = row_blocks_create(&b, r, &(row_blocks_source){&items, SIZE, rows}, d->n_stripes) == DEM_OK;
    while (b.round < b.n_rounds) {
        const row_slice s = row_blocks_slice(&b, r->rank, b.round);
        row_blocks_next(&b, slice);
        d->is_good[r->rank] = check_slice(d, s, slice) && d->is_good[r->rank];
    }
    d->counts[r->rank] = rank_threads_count(r);
    if (r->rank == 0) d->n_rounds = b.n_rounds;
    row_blocks_free(&b);
    free(is_own);
    free(rows);
    free(slice);
    free(number);
}

static void check(dealing d)
{
    CLEANUP(free_memory) unsigned char *seen = calloc((size_t)d.n + 1, 1);
    for (int n_ranks = 1; n_ranks <= MOST_RANKS; n_ranks++) {
        d.seen = seen;
        memset(seen, 0, (size_t)d.n);
        rank_threads_run(n_ranks, deal, &d);
        for (int k = 0; k < n_ranks; k++) {
            assert_true(d.is_good[k]);
            assert_int_equal(d.counts[k].reductions, 2);
            assert_int_equal(d.counts[k].exchanges, 1 + d.n_rounds);
        }
        for (dem_index k = 0; k < d.n; k++)
            if (seen[k] != 1) fail_msg("%d ranks: row %d has come %d times", n_ranks, (int)k, seen[k]);
    }
}

TEST(each_row_comes_to_one_rank_whoever_owns_it)
{
    static owner_of_row *const owners[] = {owner_at_random, owner_by_range, owner_is_first};
    for (int k = 0; k < 3; k++) check((dealing){owners[k], MANY, 1, .has_numbers = true});
}

TEST(slices_end_with_stripes)
{
    for (int n_stripes = 2; n_stripes <= 5; n_stripes++)
        check((dealing){owner_at_random, MANY, n_stripes, .has_numbers = true});
}

/* Some stripes and ranks have none. */
TEST(few_rows_are_dealt_out_too)
{
    for (dem_index n = 0; n <= 3; n++) check((dealing){owner_at_random, n, 2, .has_numbers = true});
}

TEST(rank_0_needs_no_numbers_where_it_has_all)
{
    check((dealing){.owner = owner_is_first, .n = MANY, .n_stripes = 2});
}
