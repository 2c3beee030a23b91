/* SPDX-License-Identifier: BSD-3-Clause */
/* gather.c, migration.c: rank 0 has all rows, each from the rank that owns it; rows go from rank to rank. */
#include "unit/domain/shared_lattice.h"

#include "domain/migration.h"
#include "harness/rank_threads.h"

enum { MOST_RANKS = 6, DIM = 3 };

typedef struct gathering {
    const dem_lattice *lattice;
    const int32_t *owner;
    double *whole; /* [n_nodes][DIM] of rank 0 */
    dem_status status[MOST_RANKS];
} gathering;

static double value(dem_index k)
{
    return sin(1.0 + (double)k);
}

/* What is said of ghosts is not to be believed. */
static void gather(const ranks *r, void *context)
{
    gathering *g = context;
    domain d;
    g->status[r->rank] =
        domain_create(&d, g->lattice, &(domain_shares){.n_ranks = r->size, .owner = g->owner}, r->rank);
    if (g->status[r->rank] != DEM_OK) return;
    double *rows = calloc(DIM * (size_t)d.n_nodes, sizeof *rows);
    for (dem_index k = 0; k < DIM * d.n_nodes; k++)
        rows[k] = d.is_own[k / DIM] ? value(DIM * d.number[k / DIM] + k % DIM) : (double)NAN;
    const gather_items nodes = gather_nodes(&d);
    g->status[r->rank] = gather_rows(r, &nodes, DIM * sizeof *rows, rows, r->rank == 0 ? g->whole : NULL);
    free(rows);
    domain_free(&d);
}

TEST(rank_0_gets_the_rows_of_all_nodes)
{
    for (int n_ranks = 1; n_ranks <= MOST_RANKS; n_ranks++) {
        CLEANUP(dem_lattice_free) dem_lattice l = shared_disc();
        CLEANUP(free_memory) int32_t *owner = shared_owners(&l, n_ranks);
        CLEANUP(free_memory) double *whole = calloc(DIM * (size_t)l.n_nodes, sizeof *whole);
        gathering g = {.lattice = &l, .owner = owner, .whole = whole};
        rank_threads_run(n_ranks, gather, &g);
        for (int k = 0; k < n_ranks; k++) assert_int_equal(g.status[k], DEM_OK);
        for (dem_index k = 0; k < DIM * l.n_nodes; k++) assert_true(whole[k] == value(k));
    }
}

/* Rows of an odd number of bytes, of more items than go into two messages; not all ranks have all of them. */
enum { MANY = 150001, SIZE = 5 };

static int owner_of(dem_index k, int n_ranks)
{
    return (int)(((uint64_t)k * 2654435761u >> 7) % (uint64_t)n_ranks);
}

typedef struct many {
    unsigned char *whole; /* [MANY][SIZE] of rank 0 */
    bool is_good[MOST_RANKS];
    dem_index n_taken; /* rows of chunks so far, on rank 0, */
    bool comes_apart;  /* whether one was not the next */
    int n_calls;
} many;

static unsigned char byte_of(dem_index k, dem_index q)
{
    return (unsigned char)(k >> 4 * q);
}

static dem_status take_chunk(void *context, dem_index first, dem_index n, const void *rows)
{
    many *m = context;
    const unsigned char *byte = rows;
    bool is_next = first == m->n_taken && n <= ROWS_CHUNK;
    for (dem_index k = 0; k < SIZE * n; k++) is_next = is_next && byte[k] == byte_of(first + k / SIZE, k % SIZE);
    m->n_taken += n;
    m->comes_apart = m->comes_apart || !is_next;
    return DEM_OK;
}

static dem_status take_one_chunk(void *context, dem_index first, dem_index n, const void *rows)
{
    many *m = context;
    (void)n;
    (void)rows;
    m->n_calls++;
    return first > 0 ? DEM_ERROR_IO : DEM_OK;
}

/* What fails on rank 0 fails on all. */
static bool pass_chunks(const ranks *r, const gather_items *items, const unsigned char *rows, many *m)
{
    rows_taker *first = r->rank == 0 ? take_chunk : NULL, *second = r->rank == 0 ? take_one_chunk : NULL;
    return gather_chunks(r, items, SIZE, rows, first, m) == DEM_OK &&
           gather_chunks(r, items, SIZE, rows, second, m) == DEM_ERROR_IO;
}

static void pass_many(const ranks *r, void *context)
{
    many *m = context;
    unsigned char *whole = r->rank == 0 ? m->whole : NULL, *is_own = malloc(MANY), *rows = malloc((size_t)MANY * SIZE);
    dem_index *number = malloc(MANY * sizeof *number), n = 0;
    for (dem_index k = 0; k < MANY; k++) {
        const bool owns = owner_of(k, r->size) == r->rank;
        if (!owns && k % 3 != r->rank) continue;
        for (dem_index q = 0; q < SIZE; q++) rows[SIZE * n + q] = owns ? byte_of(k, q) : 0xee;
        is_own[n] = owns;
        number[n++] = k;
    }
    const gather_items items = {.n = n, .n_whole = MANY, .number = number, .is_own = is_own};
    m->is_good[r->rank] = gather_rows(r, &items, SIZE, rows, whole) == DEM_OK && pass_chunks(r, &items, rows, m);
    memset(rows, 0xee, (size_t)MANY * SIZE);
    rows_here all = {SIZE, whole};
    if (gather_back(r, &items, SIZE, rows_reader_copy, &all, rows) != DEM_OK) m->is_good[r->rank] = false;
    for (dem_index k = 0; k < SIZE * n; k++)
        if (rows[k] != byte_of(number[k / SIZE], k % SIZE)) m->is_good[r->rank] = false;
    free(number);
    free(is_own);
    free(rows);
}

TEST(many_rows_come_chunk_by_chunk_and_go_back)
{
    for (int n_ranks = 1; n_ranks <= MOST_RANKS; n_ranks++) {
        CLEANUP(free_memory) unsigned char *whole = calloc(MANY, SIZE);
        many m = {.whole = whole};
        rank_threads_run(n_ranks, pass_many, &m);
        for (int k = 0; k < n_ranks; k++) assert_true(m.is_good[k]);
        for (dem_index k = 0; k < SIZE * MANY; k++)
            if (whole[k] != byte_of(k / SIZE, k % SIZE)) fail_msg("%d ranks: item %d", n_ranks, (int)(k / SIZE));
        assert_false(m.comes_apart);
        assert_int_equal(m.n_taken, MANY);
        assert_int_equal(m.n_calls, 2);
    }
}

/* ---- shared out anew ---- */

/* The first number of a rank's range, before or after. */
static dem_index first_of(int rank, int n_ranks, bool after)
{
    return after ? (dem_index)MANY * rank * rank / (n_ranks * n_ranks) : (dem_index)MANY * rank / n_ranks;
}

/* Owned nodes, and five of others on each side, of which nothing is to be believed. */
static dem_status keep_range(const ranks *r, migrating_rows *out, unsigned char *rows)
{
    const dem_index begin = first_of(r->rank, r->size, false), end = first_of(r->rank + 1, r->size, false);
    unsigned char *is_own = malloc(MANY);
    dem_index *number = malloc(MANY * sizeof *number), n = 0;
    for (dem_index k = begin - 5; k < end + 5; k++) {
        if (k < 0 || k >= MANY) continue;
        is_own[n] = k >= begin && k < end;
        for (dem_index q = 0; q < SIZE; q++) rows[SIZE * n + q] = is_own[n] ? byte_of(k, q) : 0xee;
        number[n++] = k;
    }
    const gather_items items = {.n = n, .n_whole = MANY, .number = number, .is_own = is_own};
    const dem_status status = migration_begin(out, &items, SIZE, rows);
    free(number);
    free(is_own);
    return status;
}

/* Afterwards a rank has all of its range, and every seventh beside it. */
static void move_many(const ranks *r, void *context)
{
    many *m = context;
    const dem_index begin = first_of(r->rank, r->size, true), end = first_of(r->rank + 1, r->size, true);
    unsigned char *rows = malloc((size_t)MANY * SIZE);
    dem_index *number = malloc(MANY * sizeof *number), n = 0;
    migrating_rows kept;
    m->is_good[r->rank] = keep_range(r, &kept, rows) == DEM_OK;
    memset(rows, 0xee, (size_t)MANY * SIZE);
    for (dem_index k = 0; k < MANY; k++)
        if ((k >= begin && k < end) || k % 7 == 0) number[n++] = k;
    const gather_items items = {.n = n, .n_whole = MANY, .number = number};
    if (migration_end(&kept, r, &items, rows) != DEM_OK || kept.rows != NULL) m->is_good[r->rank] = false;
    for (dem_index k = 0; k < SIZE * n; k++)
        if (rows[k] != byte_of(number[k / SIZE], k % SIZE)) m->is_good[r->rank] = false;
    free(number);
    free(rows);
}

TEST(rows_migrate_from_those_who_owned_them_to_all_who_have_them)
{
    for (int n_ranks = 1; n_ranks <= MOST_RANKS; n_ranks++) {
        many m = {.whole = NULL};
        rank_threads_run(n_ranks, move_many, &m);
        for (int k = 0; k < n_ranks; k++) assert_true(m.is_good[k]);
    }
}
