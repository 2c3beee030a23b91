/* SPDX-License-Identifier: BSD-3-Clause */
#include "elastic/ring_streams.h"

#include <stdlib.h>

#include "base/grow.h"
#include "base/status.h"
#include "elastic/layout_lanes.h"

static dem_index stride_of(const ring_streams *r)
{
    return r->rows + LAYOUT_LANES;
}

/* \return the stream; that behind the last one if a new one is needed */
static dem_index seek(const ring_streams *r, int64_t key, dem_index block)
{
    dem_index found = -1;
    for (dem_index k = 0; k < r->n && (found < 0 || r->list[found].key != key); k++) {
        const ring_stream *stream = &r->list[k];
        if (stream->used != block && (found < 0 || stream->key == key || stream->used < r->list[found].used)) found = k;
    }
    return found < 0 ? r->n : found;
}

dem_status ring_streams_find(ring_streams *r, int64_t key, dem_index block, int32_t *start)
{
    const dem_index found = seek(r, key, block), end = found + 1;
    CHECK(grow_array((void **)&r->list, &r->capacity, end, sizeof *r->list), DEM_ERROR_MEMORY,
          "out of memory for the layout of springs");
    CHECK(2 * end * stride_of(r) < INT32_MAX, DEM_ERROR_MODEL, "too many springs at a node");
    if (end > r->n) r->n = end;
    r->list[found] = (ring_stream){key, block};
    *start = (int32_t)(found * stride_of(r));
    return DEM_OK;
}

dem_index ring_streams_length(const ring_streams *r)
{
    return r->n * stride_of(r);
}

int32_t ring_streams_base(const ring_streams *r, int32_t force, int lane)
{
    const int32_t stride = (int32_t)stride_of(r), stream = force / stride;
    return stream * stride + ((force - stream * stride - lane) & (int32_t)(r->rows - 1));
}

void ring_streams_free(ring_streams *r)
{
    free(r->list);
}
