/* SPDX-License-Identifier: BSD-3-Clause */
/* Of an order each rank gets the rows of a block, slice by slice (domain/row_blocks.h), and makes portions of them.
 * These go to the ranks that write, from some ranks at a time, as a writer has memory for few portions. */
#include "simulation/shared_field.h"

#include <stdlib.h>
#include <string.h>

#include "base/reduce.h"
#include "base/status.h"
#include "domain/row_blocks.h"
#include "simulation/field_rows.h"
#include "simulation/private.h"

dem_status shared_field_gather(const dem_simulation *part, field_kind field, void *out)
{
    const gather_items items = field_rows_items(part, field);
    void *rows = NULL;
    dem_status status = field_rows_make(part, field, &rows);
    if (status == DEM_OK) status = gather_rows(part->model->ranks, &items, field_rows_size(field), rows, out);
    free(rows);
    return status;
}

/* ---- orders ---- */

enum { AT_ONCE = 8 /* ranks whose portions are on their way at the same time */ };

typedef struct carrying {
    const ranks *ranks;
    field_order order;
    void *what; /* as this rank has it */
    int stripe; /* which this rank writes; -1: none */
    gather_items items;
    row_blocks blocks;
    void *rows, *slice;
    field_portion own;
    size_t *sizes;                  /* [ranks] of portions: of the own one, and of those that come here */
    unsigned char *room[AT_ONCE];   /* for those of others, */
    size_t capacity[AT_ONCE];       /* in so many bytes */
    ranks_message *sent, *received; /* [ranks] */
} carrying;

static dem_status allocate(carrying *c)
{
    const size_t n = (size_t)c->ranks->size;
    c->what = malloc(c->order.size + 1);
    c->slice = malloc(ROWS_CHUNK * field_rows_size(c->order.field));
    c->sizes = calloc(n, sizeof *c->sizes);
    c->sent = calloc(n, sizeof *c->sent);
    c->received = calloc(n, sizeof *c->received);
    CHECK(c->what && c->slice && c->sizes && c->sent && c->received, DEM_ERROR_MEMORY,
          "out of memory for portions of %d ranks", c->ranks->size);
    return DEM_OK;
}

static void release(carrying *c)
{
    row_blocks_free(&c->blocks);
    for (int k = 0; k < AT_ONCE; k++) free(c->room[k]);
    free(c->what);
    free(c->rows);
    free(c->slice);
    free(c->sizes);
    free(c->sent);
    free(c->received);
}

/* ---- beginning ---- */

/* Rank 0 says what it is about. */
static void pass_order(const carrying *c)
{
    const ranks *r = c->ranks;
    const int n = r->rank == 0 ? r->size - 1 : 1;
    for (int k = 0; k < n; k++) {
        const int other = r->rank == 0 ? k + 1 : 0;
        const ranks_message full = {other, c->order.size, c->what}, empty = {other, 0, NULL};
        c->sent[k] = r->rank == 0 ? full : empty;
        c->received[k] = r->rank == 0 ? empty : full;
    }
    r->exchange(r->self, n, c->sent, c->received);
}

/* Every stripe has another writer. */
static void find_stripe(carrying *c)
{
    c->stripe = -1;
    for (int k = 0; k < c->order.n_stripes; k++)
        if (field_writer(c->ranks->size, c->order.n_stripes, k) == c->ranks->rank) c->stripe = k;
}

/* Where ranks do not have the rows of what they own, rank 0, which has the whole, has those of all. */
static dem_status make_rows(carrying *c, const dem_simulation *part)
{
    const field_kind field = c->order.field;
    const dem_simulation *whole = part->whole;
    c->items = field_rows_items(part, field);
    if (field_rows_are_shared(field)) return field_rows_make(part, field, &c->rows);
    c->items = (gather_items){.n = whole != NULL ? c->items.n_whole : 0, .n_whole = c->items.n_whole};
    return reduce_status(c->ranks, whole != NULL ? field_rows_make(whole, field, &c->rows) : DEM_OK, 0.0);
}

static dem_status begin(carrying *c, const dem_simulation *part)
{
    const ranks *r = c->ranks;
    TRY(reduce_status(r, allocate(c), 0.0));
    if (r->rank == 0) memcpy(c->what, c->order.what, c->order.size);
    pass_order(c);
    c->order.what = c->what;
    find_stripe(c);
    TRY(reduce_status(r, c->stripe >= 0 ? field_order_begin(&c->order, c->stripe, r->size) : DEM_OK, 0.0));
    TRY(make_rows(c, part));
    const row_blocks_source from = {&c->items, field_rows_size(c->order.field), c->rows};
    return row_blocks_create(&c->blocks, r, &from, c->order.n_stripes);
}

/* ---- rounds ---- */

/* What a rank makes in a round; n is 0 where it makes nothing any more. */
static field_portion portion_at(const carrying *c, int rank, dem_index round)
{
    const row_slice s = row_blocks_slice(&c->blocks, rank, round);
    return (field_portion){.stripe = s.stripe, .share = rank, .first = s.first, .n = s.n};
}

static dem_status make_portion(carrying *c)
{
    c->sizes[c->ranks->rank] = 0;
    if (c->own.n == 0) return DEM_OK;
    TRY(field_order_make(&c->order, c->slice, &c->own));
    c->sizes[c->ranks->rank] = c->own.size;
    return DEM_OK;
}

/* Whether a portion that is made in a round goes from one rank to another one. */
static bool goes(const carrying *c, dem_index round, int from, int to)
{
    const field_portion p = portion_at(c, from, round);
    return p.n > 0 && from != to && field_writer(c->ranks->size, c->order.n_stripes, p.stripe) == to;
}

static ranks_message size_of(const carrying *c, int rank)
{
    return (ranks_message){.size = sizeof *c->sizes, .bytes = &c->sizes[rank]};
}

/* Messages are not const, whoever sends them. */
static ranks_message bytes_of(const carrying *c, int rank)
{
    const bool is_own = rank == c->ranks->rank;
    return (ranks_message){.size = c->sizes[rank],
                           .bytes = is_own ? (void *)(uintptr_t)c->own.bytes : c->room[rank % AT_ONCE]};
}

/* Of the portions of ranks `first` to `end` - 1, from these to those that write. */
static void pass(const carrying *c, ranks_message (*of)(const carrying *, int), dem_index round, int first, int end)
{
    const ranks *r = c->ranks;
    const bool sends = r->rank >= first && r->rank < end;
    int n = 0;
    for (int other = 0; other < r->size; other++) {
        const bool to = sends && goes(c, round, r->rank, other);
        const bool from = other >= first && other < end && goes(c, round, other, r->rank);
        if (!to && !from) continue;
        c->sent[n] = to ? of(c, r->rank) : (ranks_message){0};
        c->received[n] = from ? of(c, other) : (ranks_message){0};
        c->sent[n].rank = other;
        c->received[n++].rank = other;
    }
    r->exchange(r->self, n, c->sent, c->received);
}

/* Of the ranks whose numbers leave the same rest one has a portion there at a time. */
static dem_status make_room(carrying *c, dem_index round)
{
    for (int other = 0; other < c->ranks->size; other++) {
        const int k = other % AT_ONCE;
        if (!goes(c, round, other, c->ranks->rank) || c->sizes[other] <= c->capacity[k]) continue;
        free(c->room[k]);
        c->room[k] = malloc(c->sizes[other]);
        c->capacity[k] = c->room[k] != NULL ? c->sizes[other] : 0;
        CHECK(c->room[k] != NULL, DEM_ERROR_MEMORY, "out of memory for a portion of rank %d", other);
    }
    return DEM_OK;
}

/* That of the rank itself does not go anywhere. */
static dem_status take_own(const carrying *c)
{
    return c->own.n > 0 && c->own.stripe == c->stripe ? field_order_take(&c->order, &c->own) : DEM_OK;
}

static dem_status take_portions(carrying *c, dem_index round)
{
    const ranks *r = c->ranks;
    dem_status status = take_own(c);
    for (int first = 0; first < r->size; first += AT_ONCE) {
        const int end = first + AT_ONCE < r->size ? first + AT_ONCE : r->size;
        pass(c, bytes_of, round, first, end);
        for (int other = first; other < end && status == DEM_OK; other++) {
            field_portion portion = portion_at(c, other, round);
            portion.bytes = c->room[other % AT_ONCE];
            portion.size = c->sizes[other];
            if (goes(c, round, other, r->rank)) status = field_order_take(&c->order, &portion);
        }
    }
    return status;
}

static dem_status carry_out_round(carrying *c)
{
    const ranks *r = c->ranks;
    const dem_index round = c->blocks.round;
    c->own = portion_at(c, r->rank, round);
    row_blocks_next(&c->blocks, c->slice);
    dem_status status = make_portion(c);
    pass(c, size_of, round, 0, r->size);
    if (status == DEM_OK) status = make_room(c, round);
    TRY(reduce_status(r, status, 0.0));
    return reduce_status(r, take_portions(c, round), 0.0);
}

static dem_status carry_out(carrying *c, const dem_simulation *part)
{
    TRY(begin(c, part));
    while (c->blocks.round < c->blocks.n_rounds) TRY(carry_out_round(c));
    return reduce_status(c->ranks, c->stripe >= 0 ? field_order_end(&c->order, c->stripe) : DEM_OK, 0.0);
}

dem_status shared_field_obey(const dem_simulation *part, const field_order *o)
{
    carrying c = {.ranks = part->model->ranks, .order = *o};
    const dem_status status = carry_out(&c, part);
    release(&c);
    return status;
}
