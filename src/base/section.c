/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/section.h"

#include <stdlib.h>
#include <zlib.h>

#include "base/status.h"

enum { FLUSH = 16 /* more bytes than zlib adds to end a section */ };

/* All of zlib's settings are its defaults, for which this bound is. */
size_t section_room(size_t size)
{
    return compressBound(size) + FLUSH;
}

void section_streams_free(section_streams *z)
{
    for (int k = 0; k < z->n; k++) (void)deflateEnd(&z->streams[k]);
    free(z->streams);
    *z = (section_streams){0};
}

/* A stream for each of n threads. */
static dem_status begin(section_streams *z, int level, int n)
{
    enum { RAW = -15, MEMORY = 8 }; /* zlib's defaults, without its header and checksum */
    if (z->n >= n && z->level == level) return DEM_OK;
    section_streams_free(z);
    z->streams = calloc((size_t)n, sizeof *z->streams);
    CHECK_MEMORY(z->streams);
    for (; z->n < n; z->n++)
        if (deflateInit2(&z->streams[z->n], level, Z_DEFLATED, RAW, MEMORY, Z_DEFAULT_STRATEGY) != Z_OK) break;
    const bool begun = z->n == n;
    if (!begun) section_streams_free(z);
    CHECK(begun, DEM_ERROR_MEMORY, "out of memory to deflate");
    z->level = level;
    return DEM_OK;
}

typedef struct packing {
    const section_streams *streams;
    section *sections;
} packing;

/* The room is what a section can take at most, so that one call is enough. Leaves 0 bytes if zlib fails. */
static void pack(const void *context, int number, int thread)
{
    const packing *p = context;
    section *s = &p->sections[number];
    z_stream *z = &p->streams->streams[thread];
    (void)deflateReset(z);
    z->next_in = s->bytes;
    z->avail_in = (uInt)s->size;
    z->next_out = s->packed;
    z->avail_out = (uInt)section_room(s->size);
    (void)deflateParams(z, s->level, s->only_runs ? Z_RLE : Z_DEFAULT_STRATEGY);
    const bool done = deflate(z, Z_SYNC_FLUSH) == Z_OK && z->avail_in == 0 && z->avail_out > 0;
    s->n_packed = done ? z->total_out : 0;
    s->checksum = (uint32_t)adler32(adler32(0, NULL, 0), s->bytes, (uInt)s->size);
}

dem_status section_pack(section_streams *z, section *sections, int n, team *t)
{
    const int threads = team_threads(t);
    if (n == 0) return DEM_OK;
    TRY(begin(z, sections->level, threads < n ? threads : n));
    team_run(t, n, pack, &(packing){z, sections});
    for (int k = 0; k < n; k++)
        CHECK(sections[k].n_packed > 0, DEM_ERROR_IO, "%zu bytes cannot be deflated", sections[k].size);
    return DEM_OK;
}

uint32_t section_join(uint32_t checksum, uint32_t next, size_t size)
{
    return (uint32_t)adler32_combine(checksum, next, (z_off_t)size);
}
