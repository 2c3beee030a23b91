/* SPDX-License-Identifier: BSD-3-Clause */
/* Shuffled, the first bytes of all numbers stand one behind the other, then their second bytes, and so on: the *planes*
 * of a chunk. A *slice* of the chunk, some rows of it, has a range of each plane, which is a *section* of the stream:
 * deflated with nothing before it to refer to, and ended at a whole byte (Z_SYNC_FLUSH). The stream of a chunk is
 *   78 01      zlib's header: a window of 32 KiB, no dictionary
 *   sections   plane by plane, in each of them slice by slice
 *   03 00      an empty last block
 *   checksum   Adler-32 of all that is shuffled, joined from those of the sections, the highest byte first
 * which inflates as if it had been made at once. */
#include "output/deflater.h"

#include "base/status.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum { HEADER = 2, LAST_BLOCK = 2, CHECKSUM = 4, FLUSH = 16 /* more than zlib adds to end a section at a byte */ };

typedef struct section {
    size_t begin, size; /* in what is shuffled */
    size_t at, n;       /* where its bytes are in what is packed: first the room for them, then what they take */
    int strategy;
    uLong checksum;
} section;

/* Numbers `first` to `end` - 1 of `all`, a slice of them. */
typedef struct span {
    size_t first, end, all;
} span;

/* A chunk that is being packed, and how it is cut. */
typedef struct chunk {
    deflater *deflater;
    deflater_numbers numbers;
    size_t all;   /* numbers */
    int n_slices; /* at least 1 */
    int n_planes; /* that are sections; 1: all planes are one */
} chunk;

static chunk chunk_of(deflater *d, deflater_numbers m)
{
    const size_t all = m.rows * m.columns, n = m.rows / DEFLATER_SLICE + (m.rows % DEFLATER_SLICE != 0);
    return (chunk){d, m, all, n > 1 ? (int)n : 1, all >= DEFLATER_CUT ? (int)m.width : 1};
}

static int count_sections(const chunk *c)
{
    return c->n_slices * c->n_planes;
}

/* The last slice may have less numbers than others. */
static span span_of(const chunk *c, int slice)
{
    const size_t most = DEFLATER_SLICE * c->numbers.columns, first = (size_t)slice * most;
    return (span){first, first + most < c->all ? first + most : c->all, c->all};
}

/* ---- shuffling ---- */

static void shuffle_8(unsigned char *out, const unsigned char *data, span s)
{
    for (size_t k = s.first; k < s.end; k++) {
        uint64_t bits;
        memcpy(&bits, data + 8 * k, sizeof bits);
        for (int b = 0; b < 8; b++) out[(size_t)b * s.all + k] = (unsigned char)(bits >> 8 * b);
    }
}

static void put_4(unsigned char *out, size_t n, size_t k, uint32_t bits)
{
    for (int b = 0; b < 4; b++) out[(size_t)b * n + k] = (unsigned char)(bits >> 8 * b);
}

static void shuffle_4(unsigned char *out, const unsigned char *data, span s)
{
    for (size_t k = s.first; k < s.end; k++) {
        uint32_t bits;
        memcpy(&bits, data + 4 * k, sizeof bits);
        put_4(out, s.all, k, bits);
    }
}

static void shuffle_narrowed(unsigned char *out, const double *data, span s)
{
    for (size_t k = s.first; k < s.end; k++) {
        const float value = (float)data[k];
        uint32_t bits;
        memcpy(&bits, &value, sizeof bits);
        put_4(out, s.all, k, bits);
    }
}

/* HDF5 leaves single bytes as they are. */
static void shuffle(unsigned char *out, deflater_numbers m, span s)
{
    if (m.narrows)
        shuffle_narrowed(out, m.data, s);
    else if (m.width == 8)
        shuffle_8(out, m.data, s);
    else if (m.width == 4)
        shuffle_4(out, m.data, s);
    else
        memcpy(out + s.first, (const unsigned char *)m.data + s.first, s.end - s.first);
}

/* ---- room ---- */

/* Room for so many bytes, NULL if there is no memory; what was there is lost. */
static void *make_room(void *before, size_t *room, size_t bytes)
{
    if (bytes <= *room) return before;
    free(before);
    void *buffer = malloc(bytes);
    *room = buffer != NULL ? bytes : 0;
    return buffer;
}

static void end(deflater *d)
{
    for (int k = 0; k < d->n_streams; k++) (void)deflateEnd(&d->streams[k]);
    free(d->streams);
    d->streams = NULL;
    d->n_streams = 0;
}

/* A stream for each of n threads. */
static dem_status begin(deflater *d, int level, int n)
{
    enum { RAW = -15, MEMORY = 8 }; /* zlib's defaults, without its header and checksum */
    if (d->n_streams >= n && d->level == level) return DEM_OK;
    end(d);
    d->streams = calloc((size_t)n, sizeof *d->streams);
    CHECK_MEMORY(d->streams);
    for (d->n_streams = 0; d->n_streams < n; d->n_streams++) {
        z_stream *z = &d->streams[d->n_streams];
        if (deflateInit2(z, level, Z_DEFLATED, RAW, MEMORY, Z_DEFAULT_STRATEGY) != Z_OK) break;
    }
    const bool begun = d->n_streams == n;
    if (!begun) end(d);
    CHECK(begun, DEM_ERROR_MEMORY, "out of memory to deflate");
    d->level = level;
    return DEM_OK;
}

/* Lays the sections out in the stream, each with the room that it can take at most, so that one call of zlib is
 * enough.  \return the room of all */
static size_t lay_out(const chunk *c)
{
    size_t at = HEADER;
    section *s = c->deflater->sections;
    for (int plane = 0; plane < c->n_planes; plane++)
        for (int slice = 0; slice < c->n_slices; slice++, s++) {
            const span p = span_of(c, slice);
            s->begin = (size_t)plane * p.all + p.first;
            s->size = (p.end - p.first) * (c->numbers.width / (size_t)c->n_planes);
            s->at = at;
            s->n = deflateBound(c->deflater->streams, s->size) + FLUSH;
            at += s->n;
        }
    return at + LAST_BLOCK + CHECKSUM;
}

static dem_status prepare(const chunk *c, int level, int threads)
{
    deflater *d = c->deflater;
    const int n = count_sections(c);
    TRY(begin(d, level, threads < n ? threads : n));
    d->sections = make_room(d->sections, &d->sections_room, (size_t)n * sizeof *d->sections);
    CHECK_MEMORY(d->sections);
    d->shuffled = make_room(d->shuffled, &d->room, c->all * c->numbers.width);
    CHECK_MEMORY(d->shuffled);
    d->packed = make_room(d->packed, &d->packed_room, lay_out(c));
    CHECK_MEMORY(d->packed);
    return DEM_OK;
}

/* ---- deflating ---- */

/* Whether a third of the sequences of four bytes come again, as those of a lattice at rest do row by row, and those of
 * signs and exponents. Of the other bytes of computed numbers some do, beside the zeros of the third direction. */
static bool repeats(const unsigned char *bytes, size_t n)
{
    enum { LOOK = 16384, SLOTS = 4096 };
    const size_t end = n < LOOK ? n : LOOK;
    uint32_t seen[SLOTS] = {0}, four;
    size_t again = 0;
    for (size_t k = 0; k + sizeof four <= end; k++) {
        memcpy(&four, bytes + k, sizeof four);
        uint32_t *slot = &seen[four * 2654435761u >> 20];
        again += *slot == four;
        *slot = four;
    }
    return 3 * again > end;
}

/* Shuffles a slice, and chooses how its sections are deflated: at level 1 their bytes tell whether more is to be found
 * than runs of equal ones; of a section of all planes those in the middle of the numbers do. */
static void shuffle_slice(const void *context, int slice, int thread)
{
    const chunk *c = context;
    const deflater *d = c->deflater;
    const span p = span_of(c, slice);
    (void)thread;
    shuffle(d->shuffled, c->numbers, p);
    for (int plane = 0; plane < c->n_planes; plane++) {
        const size_t seen = c->n_planes > 1 ? (size_t)plane : c->numbers.width / 2;
        const bool all = d->level > 1 || repeats(d->shuffled + seen * p.all + p.first, p.end - p.first);
        d->sections[plane * c->n_slices + slice].strategy = all ? Z_DEFAULT_STRATEGY : Z_RLE;
    }
}

/* Leaves 0 bytes if zlib fails. */
static void deflate_section(const void *context, int number, int thread)
{
    const deflater *d = ((const chunk *)context)->deflater;
    section *s = &d->sections[number];
    z_stream *z = &d->streams[thread];
    (void)deflateReset(z);
    z->next_in = d->shuffled + s->begin;
    z->avail_in = (uInt)s->size;
    z->next_out = d->packed + s->at;
    z->avail_out = (uInt)s->n;
    (void)deflateParams(z, d->level, s->strategy);
    const bool done = deflate(z, Z_SYNC_FLUSH) == Z_OK && z->avail_in == 0 && z->avail_out > 0;
    s->n = done ? z->total_out : 0;
    s->checksum = adler32(adler32(0, NULL, 0), d->shuffled + s->begin, (uInt)s->size);
}

/* Moves the sections together, and writes what is before and behind them.  \return false if one is missing */
static bool join(deflater *d, int n_sections)
{
    static const unsigned char header[HEADER] = {0x78, 0x01}, last_block[LAST_BLOCK] = {0x03, 0x00};
    unsigned char *out = d->packed;
    uLong sum = adler32(0, NULL, 0);
    memcpy(out, header, sizeof header);
    out += sizeof header;
    for (const section *s = d->sections; s < d->sections + n_sections; s++) {
        if (s->n == 0) return false;
        memmove(out, d->packed + s->at, s->n);
        out += s->n;
        sum = adler32_combine(sum, s->checksum, (z_off_t)s->size);
    }
    memcpy(out, last_block, sizeof last_block);
    out += sizeof last_block;
    for (int shift = 24; shift >= 0; shift -= 8) *out++ = (unsigned char)(sum >> shift);
    d->n_packed = (size_t)(out - d->packed);
    return true;
}

dem_status deflater_pack(deflater *d, deflater_numbers numbers, int level, team *t)
{
    const chunk c = chunk_of(d, numbers);
    const int n = count_sections(&c);
    TRY(prepare(&c, level, team_threads(t)));
    team_run(t, c.n_slices, shuffle_slice, &c);
    team_run(t, n, deflate_section, &c);
    CHECK(join(d, n), DEM_ERROR_IO, "%zu bytes cannot be deflated", c.all * numbers.width);
    return DEM_OK;
}

void deflater_free(deflater *d)
{
    end(d);
    free(d->shuffled);
    free(d->packed);
    free(d->sections);
    *d = (deflater){0};
}
