/* SPDX-License-Identifier: BSD-3-Clause */
/* First the sizes, so that all memory is there before bytes are sent. */
#include "base/bundle.h"

#include <stdlib.h>
#include <string.h>

#include "base/grow.h"
#include "base/reduce.h"
#include "base/status.h"

bool bundle_add(bundle *b, const void *bytes, size_t size)
{
    if (!grow_array((void **)&b->bytes, &b->capacity, b->n + (dem_index)size, 1)) return false;
    if (size > 0) memcpy(b->bytes + b->n, bytes, size);
    b->n += (dem_index)size;
    return true;
}

void bundle_take(const bundle *b, dem_index *at, void *bytes, size_t size)
{
    if (size > 0) memcpy(bytes, b->bytes + *at, size);
    *at += (dem_index)size;
}

void bundles_free(bundle *list, int n)
{
    for (int k = 0; k < n && list != NULL; k++) {
        free(list[k].bytes);
        list[k] = (bundle){0};
    }
}

/* One with each other rank. */
typedef struct messages {
    ranks_message *sent, *received; /* [ranks - 1] */
} messages;

static void exchange_sizes(const ranks *r, const messages *m, const bundle *sent, bundle *received)
{
    int n = 0;
    for (int k = 0; k < r->size; k++) {
        if (k == r->rank) continue;
        m->sent[n] = (ranks_message){k, sizeof sent[k].n, (void *)&sent[k].n};
        m->received[n++] = (ranks_message){k, sizeof received[k].n, &received[k].n};
    }
    r->exchange(r->self, n, m->sent, m->received);
}

static void exchange_bytes(const ranks *r, const messages *m, const bundle *sent, const bundle *received)
{
    int n = 0;
    for (int k = 0; k < r->size; k++) {
        if (k == r->rank) continue;
        m->sent[n] = (ranks_message){k, (size_t)sent[k].n, sent[k].bytes};
        m->received[n++] = (ranks_message){k, (size_t)received[k].n, received[k].bytes};
    }
    r->exchange(r->self, n, m->sent, m->received);
}

static dem_status allocate(const ranks *r, bundle *received)
{
    for (int k = 0; k < r->size; k++) {
        received[k].bytes = malloc((size_t)received[k].n + 1);
        CHECK(received[k].bytes != NULL, DEM_ERROR_MEMORY, "out of memory for %lld bytes of rank %d",
              (long long)received[k].n, k);
        received[k].capacity = received[k].n + 1;
    }
    return DEM_OK;
}

static dem_status check_memory(const messages *m)
{
    CHECK_MEMORY(m->sent);
    CHECK_MEMORY(m->received);
    return DEM_OK;
}

dem_status bundles_exchange(const ranks *r, const bundle *sent, bundle *received)
{
    const size_t n = (size_t)r->size;
    const messages m = {calloc(n, sizeof *m.sent), calloc(n, sizeof *m.received)};
    for (int k = 0; k < r->size; k++) received[k] = (bundle){0};
    dem_status status = reduce_status(r, check_memory(&m), 0.0);
    if (status == DEM_OK) {
        exchange_sizes(r, &m, sent, received);
        status = reduce_status(r, allocate(r, received), 0.0);
    }
    if (status == DEM_OK) exchange_bytes(r, &m, sent, received);
    free(m.sent);
    free(m.received);
    return status;
}
