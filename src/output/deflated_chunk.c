/* SPDX-License-Identifier: BSD-3-Clause */
/* The stream of a chunk is
 *   78 01      zlib's header: a window of 32 KiB, no dictionary
 *   sections   plane by plane, in each of them slice by slice
 *   03 00      an empty last block
 *   checksum   Adler-32 of all that is shuffled, joined from those of the sections, the highest byte first
 * which inflates as if it had been made at once. */
#include "output/deflated_chunk.h"

#include <stdlib.h>
#include <string.h>

#include "base/grow.h"
#include "base/status.h"

static dem_status add_bytes(deflated_run *r, const void *bytes, size_t n)
{
    CHECK(grow_array((void **)&r->bytes, &r->room, (dem_index)(r->n + n), 1), DEM_ERROR_MEMORY,
          "out of memory for %zu deflated bytes", r->n + n);
    if (n > 0) memcpy(r->bytes + r->n, bytes, n);
    r->n += n;
    return DEM_OK;
}

static void join_checksum(deflated_run *r, uint32_t checksum, size_t size)
{
    r->checksum = section_join(r->checksum, checksum, size);
    r->size += size;
}

static void empty(deflated_run *r)
{
    free(r->bytes);
    *r = (deflated_run){.checksum = SECTION_NO_CHECKSUM};
}

void deflated_chunk_free(deflated_chunk *c)
{
    for (int k = 0; k < c->n_planes * c->n_shares; k++) empty(&c->runs[k]);
    empty(&c->all);
    free(c->runs);
    *c = (deflated_chunk){0};
}

dem_status deflated_chunk_begin(deflated_chunk *c, int n_planes, int n_shares)
{
    deflated_chunk_free(c);
    c->runs = calloc((size_t)n_planes * (size_t)n_shares, sizeof *c->runs);
    CHECK_MEMORY(c->runs);
    c->n_planes = n_planes;
    c->n_shares = n_shares;
    for (int k = 0; k < n_planes * n_shares; k++) empty(&c->runs[k]);
    empty(&c->all);
    return DEM_OK;
}

dem_status deflated_chunk_add(deflated_chunk *c, int share, const section *sections, int n_slices)
{
    for (int plane = 0; plane < c->n_planes; plane++) {
        deflated_run *r = &c->runs[plane * c->n_shares + share];
        for (const section *s = sections + plane * n_slices; s < sections + (plane + 1) * n_slices; s++) {
            TRY(add_bytes(r, s->packed, s->n_packed));
            join_checksum(r, s->checksum, s->size);
        }
    }
    return DEM_OK;
}

/* Each run is given up as soon as its bytes are copied. */
static dem_status join_runs(deflated_chunk *c)
{
    for (int k = 0; k < c->n_planes * c->n_shares; k++) {
        deflated_run *r = &c->runs[k];
        TRY(add_bytes(&c->all, r->bytes, r->n));
        join_checksum(&c->all, r->checksum, r->size);
        empty(r);
    }
    return DEM_OK;
}

dem_status deflated_chunk_end(deflated_chunk *c)
{
    static const unsigned char header[] = {0x78, 0x01}, last_block[] = {0x03, 0x00};
    unsigned char sum[sizeof c->all.checksum];
    TRY(add_bytes(&c->all, header, sizeof header));
    TRY(join_runs(c));
    for (size_t k = 0; k < sizeof sum; k++) sum[k] = (unsigned char)(c->all.checksum >> 8 * (sizeof sum - 1 - k));
    TRY(add_bytes(&c->all, last_block, sizeof last_block));
    return add_bytes(&c->all, sum, sizeof sum);
}
