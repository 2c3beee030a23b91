/* SPDX-License-Identifier: BSD-3-Clause */
/* The items of the whole are gathered chunk by chunk. Of each chunk a rank sends first how many it owns, and then their
 * rows behind their numbers. Back to the ranks each chunk goes as a whole. */
#include "domain/gather.h"

#include <stdlib.h>
#include <string.h>

#include "base/reduce.h"
#include "base/status.h"

typedef struct collection {
    const ranks *ranks;
    const gather_items *items;
    size_t size;                    /* bytes of a row */
    const unsigned char *from;      /* [n][size] */
    dem_index next;                 /* the first item here that is in no chunk so far */
    dem_index *n;                   /* [ranks] items of the chunk, of which rank 0 knows all, another one its own */
    unsigned char **bytes, *buffer; /* [ranks] what each sends: numbers of items, then their rows; and where */
    ranks_message *sent, *received; /* [ranks] */
} collection;

/* From each of the others to rank 0. */
static void send_to_root(const collection *c, bool counts)
{
    const ranks *r = c->ranks;
    const int n = r->rank == 0 ? r->size - 1 : 1;
    for (int k = 0; k < n; k++) {
        const int other = r->rank == 0 ? k + 1 : 0, of = r->rank == 0 ? other : r->rank;
        const ranks_message count = {other, sizeof *c->n, &c->n[of]};
        const ranks_message rows = {other, gather_message(c->n[of], c->size), c->bytes[of]};
        const ranks_message full = counts ? count : rows, empty = {other, 0, NULL};
        c->sent[k] = r->rank == 0 ? empty : full;
        c->received[k] = r->rank == 0 ? full : empty;
    }
    r->exchange(r->self, n, c->sent, c->received);
}

/* \param end  of the chunk, by numbers of the whole  \return behind its last item here */
static dem_index count(const collection *c, dem_index end)
{
    const gather_items *items = c->items;
    dem_index *n = &c->n[c->ranks->rank], i = c->next;
    for (*n = 0; i < items->n && gather_number(items, i) < end; i++) *n += gather_owns(items, i);
    return i;
}

/* One behind the other; other ranks have their own only. */
static void lay_out(const collection *c)
{
    const ranks *r = c->ranks;
    unsigned char *at = c->buffer;
    c->bytes[r->rank] = at;
    for (int k = 0; k < r->size && r->rank == 0; k++) {
        c->bytes[k] = at;
        at += gather_message(c->n[k], c->size);
    }
}

static void pack(const collection *c, dem_index behind)
{
    const gather_items *items = c->items;
    dem_index *number = (dem_index *)(void *)c->bytes[c->ranks->rank];
    unsigned char *to = (unsigned char *)(number + c->n[c->ranks->rank]);
    for (dem_index i = c->next; i < behind; i++) {
        if (!gather_owns(items, i)) continue;
        *number++ = gather_number(items, i);
        memcpy(to, c->from + (size_t)i * c->size, c->size);
        to += c->size;
    }
}

/* \param to  of the rows of the whole from row `first` on */
static void unpack(const collection *c, dem_index first, unsigned char *to)
{
    for (int k = 0; k < c->ranks->size; k++) {
        const dem_index *number = (const dem_index *)(void *)c->bytes[k];
        const unsigned char *from = (const unsigned char *)(number + c->n[k]);
        for (dem_index q = 0; q < c->n[k]; q++)
            memcpy(to + (size_t)(number[q] - first) * c->size, from + (size_t)q * c->size, c->size);
    }
}

static void collect_chunk(collection *c, dem_index first, unsigned char *to)
{
    const dem_index behind = count(c, first + ROWS_CHUNK);
    send_to_root(c, true);
    lay_out(c);
    pack(c, behind);
    send_to_root(c, false);
    if (c->ranks->rank == 0) unpack(c, first, to);
    c->next = behind;
}

/* An item is owned once, so that all ranks together send a chunk, and any of them may get one. */
static dem_status allocate(collection *c)
{
    const size_t n = (size_t)c->ranks->size;
    const dem_index most = c->items->n_whole;
    c->n = calloc(n, sizeof *c->n);
    c->bytes = calloc(n, sizeof *c->bytes);
    c->sent = calloc(n, sizeof *c->sent);
    c->received = calloc(n, sizeof *c->received);
    c->buffer = malloc(gather_message(most < ROWS_CHUNK ? most : ROWS_CHUNK, c->size) + n * sizeof(dem_index));
    CHECK(c->n && c->bytes && c->sent && c->received && c->buffer, DEM_ERROR_MEMORY,
          "out of memory for rows of %d ranks", c->ranks->size);
    return DEM_OK;
}

static void release(collection *c)
{
    free(c->n);
    free(c->bytes);
    free(c->sent);
    free(c->received);
    free(c->buffer);
}

dem_status gather_rows(const ranks *r, const gather_items *items, size_t size, const void *from, void *whole)
{
    collection c = {.ranks = r, .items = items, .size = size, .from = from};
    const dem_status status = reduce_status(r, allocate(&c), 0.0);
    for (dem_index first = 0; status == DEM_OK && first < items->n_whole; first += ROWS_CHUNK)
        collect_chunk(&c, first, r->rank == 0 ? (unsigned char *)whole + (size_t)first * size : NULL);
    release(&c);
    return status;
}

/* A chunk on rank 0, beside the messages of which it is made. */
static dem_status allocate_chunk(const collection *c, unsigned char **chunk)
{
    const dem_index all = c->items->n_whole, most = all < ROWS_CHUNK ? all : ROWS_CHUNK;
    *chunk = c->ranks->rank == 0 ? malloc((size_t)most * c->size + 1) : NULL;
    CHECK(c->ranks->rank > 0 || *chunk != NULL, DEM_ERROR_MEMORY, "out of memory for rows of %d ranks", c->ranks->size);
    return DEM_OK;
}

dem_status gather_chunks(const ranks *r, const gather_items *items, size_t size, const void *from, rows_taker *take,
                         void *context)
{
    collection c = {.ranks = r, .items = items, .size = size, .from = from};
    const dem_index all = items->n_whole;
    unsigned char *chunk = NULL;
    dem_status ready = allocate(&c);
    if (ready == DEM_OK) ready = allocate_chunk(&c, &chunk);
    ready = reduce_status(r, ready, 0.0);
    dem_status taken = ready;
    for (dem_index first = 0; ready == DEM_OK && first < all; first += ROWS_CHUNK) {
        const dem_index left = all - first, n = left < ROWS_CHUNK ? left : ROWS_CHUNK;
        collect_chunk(&c, first, chunk);
        if (r->rank == 0 && taken == DEM_OK) taken = take(context, first, n, chunk);
    }
    free(chunk);
    release(&c);
    return ready == DEM_OK ? reduce_status(r, taken, 0.0) : ready;
}

/* ---- back ---- */

/* Of the buffer, from rank 0 to all others. */
static void send_chunk(const collection *c, size_t bytes)
{
    const ranks *r = c->ranks;
    const int n = r->rank == 0 ? r->size - 1 : 1;
    for (int k = 0; k < n; k++) {
        const int other = r->rank == 0 ? k + 1 : 0;
        const ranks_message full = {other, bytes, c->buffer}, empty = {other, 0, NULL};
        c->sent[k] = r->rank == 0 ? full : empty;
        c->received[k] = r->rank == 0 ? empty : full;
    }
    r->exchange(r->self, n, c->sent, c->received);
}

/* \param first, end  of the chunk, by numbers of the whole */
static void take_rows(collection *c, dem_index first, dem_index end, unsigned char *to)
{
    const gather_items *items = c->items;
    for (; c->next < items->n && gather_number(items, c->next) < end; c->next++)
        memcpy(to + (size_t)c->next * c->size, c->buffer + (size_t)(gather_number(items, c->next) - first) * c->size,
               c->size);
}

/* A chunk that could not be read is sent all the same, as others wait for it. */
dem_status gather_back(const ranks *r, const gather_items *items, size_t size, rows_reader *read, void *context,
                       void *to)
{
    collection c = {.ranks = r, .items = items, .size = size};
    const dem_status ready = reduce_status(r, allocate(&c), 0.0);
    dem_status got = ready;
    for (dem_index first = 0, n; ready == DEM_OK && first < items->n_whole; first += n) {
        n = items->n_whole - first < ROWS_CHUNK ? items->n_whole - first : ROWS_CHUNK;
        if (r->rank == 0 && got == DEM_OK) got = read(context, first, n, c.buffer);
        send_chunk(&c, (size_t)n * size);
        take_rows(&c, first, first + n, to);
    }
    release(&c);
    return ready == DEM_OK ? reduce_status(r, got, 0.0) : ready;
}

/* ---- from owner to owner ---- */

dem_status gather_migrate(const ranks *r, const gather_items *owned, size_t size, const void *from,
                          const gather_items *items, void *to)
{
    collection there = {.ranks = r, .items = owned, .size = size, .from = from}, back = there;
    back.items = items;
    dem_status status = allocate(&there);
    if (status == DEM_OK) status = allocate(&back);
    status = reduce_status(r, status, 0.0);
    for (dem_index first = 0, n; status == DEM_OK && first < items->n_whole; first += n) {
        n = items->n_whole - first < ROWS_CHUNK ? items->n_whole - first : ROWS_CHUNK;
        collect_chunk(&there, first, back.buffer);
        send_chunk(&back, (size_t)n * size);
        take_rows(&back, first, first + n, to);
    }
    release(&there);
    release(&back);
    return status;
}
