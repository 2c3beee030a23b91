/* SPDX-License-Identifier: BSD-3-Clause */
/* Blocks are whole slices, and numbers of ranks and of their blocks ascend alike. So where ranks own ranges of rows, as
 * those of slabs do, most rows stay where they are. In each round a rank sends every other one the numbers of what it
 * owns of that one's slice, and behind them the rows; how many there will be all have sent each other before. */
#include "domain/row_blocks.h"

#include <stdlib.h>
#include <string.h>

#include "base/reduce.h"
#include "base/sorted.h"
#include "base/status.h"
#include "base/team.h"

/* ---- slices ---- */

static dem_index begin_of(const row_blocks *b, int stripe)
{
    return team_share(b->from.items->n_whole, b->n_stripes, stripe);
}

static void number_slices(const row_blocks *b)
{
    for (int k = 0; k < b->n_stripes; k++) {
        const dem_index n = begin_of(b, k + 1) - begin_of(b, k);
        b->first_slice[k + 1] = b->first_slice[k] + (n + ROWS_CHUNK - 1) / ROWS_CHUNK;
    }
}

row_slice row_blocks_slice(const row_blocks *b, int rank, dem_index round)
{
    const dem_index all = b->first_slice[b->n_stripes], slice = team_share(all, b->ranks->size, rank) + round;
    if (slice >= team_share(all, b->ranks->size, rank + 1)) return (row_slice){0};
    const int stripe = (int)sorted_first(b->first_slice + 1, b->n_stripes, slice + 1);
    const dem_index begin = begin_of(b, stripe), first = (slice - b->first_slice[stripe]) * ROWS_CHUNK;
    const dem_index left = begin_of(b, stripe + 1) - begin - first;
    return (row_slice){stripe, begin, first, left < ROWS_CHUNK ? left : ROWS_CHUNK};
}

/* ---- what will come ---- */

/* Behind the last row of a slice; 0 where there is none. */
static dem_index end_of(row_slice s)
{
    return s.begin + s.first + s.n;
}

/* One pass over the items, which ascend as slices do. */
static void count_sent(const row_blocks *b)
{
    const gather_items *items = b->from.items;
    dem_index i = 0;
    for (int k = 0; k < b->ranks->size; k++)
        for (dem_index round = 0; round < b->n_rounds; round++) {
            const row_slice s = row_blocks_slice(b, k, round);
            if (round == 0) b->next[k] = i;
            for (; i < items->n && gather_number(items, i) < end_of(s); i++)
                b->sends[k * b->n_rounds + round] += gather_owns(items, i);
        }
}

/* An array of each rank to each other one. */
static void exchange(const row_blocks *b)
{
    b->ranks->exchange(b->ranks->self, b->ranks->size - 1, b->sent, b->received);
}

/* The others are numbered without this rank. */
static int other_of(const row_blocks *b, int k)
{
    return k < b->ranks->rank ? k : k + 1;
}

static void tell(const row_blocks *b)
{
    const size_t bytes = (size_t)b->n_rounds * sizeof *b->sends;
    for (int k = 0; k < b->ranks->size - 1; k++) {
        const int other = other_of(b, k);
        b->sent[k] = (ranks_message){other, bytes, &b->sends[other * b->n_rounds]};
        b->received[k] = (ranks_message){other, bytes, &b->gets[other * b->n_rounds]};
    }
    exchange(b);
}

/* Bytes of the largest round. */
static size_t most_of(const row_blocks *b, const dem_index *counts)
{
    size_t most = 0;
    for (dem_index round = 0; round < b->n_rounds; round++) {
        size_t bytes = 0;
        for (int k = 0; k < b->ranks->size - 1; k++)
            bytes += gather_message(counts[other_of(b, k) * b->n_rounds + round], b->from.size);
        most = bytes > most ? bytes : most;
    }
    return most;
}

static dem_status allocate_lists(row_blocks *b)
{
    const size_t size = (size_t)b->ranks->size;
    b->first_slice = calloc((size_t)b->n_stripes + 1, sizeof *b->first_slice);
    b->next = calloc(size, sizeof *b->next);
    b->sent = calloc(size, sizeof *b->sent);
    b->received = calloc(size, sizeof *b->received);
    CHECK(b->first_slice && b->next && b->sent && b->received, DEM_ERROR_MEMORY, "out of memory for blocks of %d ranks",
          b->ranks->size);
    number_slices(b);
    b->n_rounds = (b->first_slice[b->n_stripes] + b->ranks->size - 1) / b->ranks->size;
    b->sends = calloc(size * (size_t)b->n_rounds + 1, sizeof *b->sends);
    b->gets = calloc(size * (size_t)b->n_rounds + 1, sizeof *b->gets);
    CHECK(b->sends && b->gets, DEM_ERROR_MEMORY, "out of memory for blocks of %d ranks", b->ranks->size);
    return DEM_OK;
}

static dem_status allocate_messages(row_blocks *b)
{
    b->out = malloc(most_of(b, b->sends) + 1);
    b->in = malloc(most_of(b, b->gets) + 1);
    CHECK(b->out && b->in, DEM_ERROR_MEMORY, "out of memory for rows of %d ranks", b->ranks->size);
    return DEM_OK;
}

dem_status row_blocks_create(row_blocks *out, const ranks *r, const row_blocks_source *from, int n_stripes)
{
    *out = (row_blocks){.ranks = r, .from = *from, .n_stripes = n_stripes};
    TRY(reduce_status(r, allocate_lists(out), 0.0));
    count_sent(out);
    tell(out);
    return reduce_status(r, allocate_messages(out), 0.0);
}

void row_blocks_free(row_blocks *b)
{
    free(b->first_slice);
    free(b->sends);
    free(b->gets);
    free(b->next);
    free(b->out);
    free(b->in);
    free(b->sent);
    free(b->received);
    *b = (row_blocks){0};
}

/* ---- a round ---- */

/* Rows of a slice, from where the slice before has ended.
 * \param numbers  NULL: rows go to their places in the slice; otherwise they come one behind the other */
static void take(row_blocks *b, int rank, dem_index *numbers, unsigned char *rows)
{
    const gather_items *items = b->from.items;
    const size_t size = b->from.size;
    const unsigned char *from = b->from.rows;
    const row_slice s = row_blocks_slice(b, rank, b->round);
    dem_index n = 0;
    for (dem_index *i = &b->next[rank]; *i < items->n && gather_number(items, *i) < end_of(s); (*i)++) {
        const dem_index number = gather_number(items, *i);
        if (!gather_owns(items, *i)) continue;
        const dem_index at = numbers != NULL ? n : number - s.begin - s.first;
        memcpy(rows + (size_t)at * size, from + (size_t)*i * size, size);
        if (numbers != NULL) numbers[n++] = number;
    }
}

static void pack(row_blocks *b)
{
    unsigned char *out = b->out, *in = b->in;
    for (int k = 0; k < b->ranks->size - 1; k++) {
        const int other = other_of(b, k);
        const dem_index sends = b->sends[other * b->n_rounds + b->round];
        dem_index *numbers = (dem_index *)(void *)out;
        b->sent[k] = (ranks_message){other, gather_message(sends, b->from.size), out};
        b->received[k] =
            (ranks_message){other, gather_message(b->gets[other * b->n_rounds + b->round], b->from.size), in};
        take(b, other, numbers, (unsigned char *)(numbers + sends));
        out += b->sent[k].size;
        in += b->received[k].size;
    }
}

static void unpack(const row_blocks *b, unsigned char *slice)
{
    const row_slice s = row_blocks_slice(b, b->ranks->rank, b->round);
    const dem_index first = s.begin + s.first;
    for (int k = 0; k < b->ranks->size - 1; k++) {
        const dem_index *number = b->received[k].bytes, n = b->gets[other_of(b, k) * b->n_rounds + b->round];
        const unsigned char *from = (const unsigned char *)(number + n);
        for (dem_index q = 0; q < n; q++)
            memcpy(slice + (size_t)(number[q] - first) * b->from.size, from + (size_t)q * b->from.size, b->from.size);
    }
}

void row_blocks_next(row_blocks *b, void *slice)
{
    pack(b);
    take(b, b->ranks->rank, NULL, slice);
    exchange(b);
    unpack(b, slice);
    b->round++;
}
