/* SPDX-License-Identifier: BSD-3-Clause */
/* The ring buffer in which a sweep leaves forces until their nodes sum them up (layout.h). It consists of streams. A
 * stream has room for one force of each of `rows` nodes, and a block writes into it at most once. Behind its end a
 * stream repeats its first places, so that a run of eight never has to be cut. */
#ifndef DEM_ELASTIC_RING_STREAMS_H
#define DEM_ELASTIC_RING_STREAMS_H

#include <stdint.h>

#include <dem/dem.h>

typedef struct ring_stream {
    int64_t key, used; /* what it was used for, and the last block that did */
} ring_stream;

typedef struct ring_streams {
    dem_index rows; /* a power of 2 */
    dem_index n, capacity;
    ring_stream *list; /* [n] */
} ring_streams;

/** Finds a stream for a block. `key` is what an entry does relative to its block: blocks that do the same use the same
 *  stream, so that their entries are equal. Otherwise the stream that has not been used for longest is taken, or a new
 *  one if this block uses all of them already.
 *  \param[out] start  of the stream, in forces */
dem_status ring_streams_find(ring_streams *r, int64_t key, dem_index block, int32_t *start);

/** Of the ring, in forces. */
dem_index ring_streams_length(const ring_streams *r);

/** Where in its stream the force for lane 0 would be if all forces of a group lay side by side, round the ring. */
int32_t ring_streams_base(const ring_streams *r, int32_t force, int lane);

void ring_streams_free(ring_streams *r);

#endif
