/* SPDX-License-Identifier: BSD-3-Clause */
/* Shuffled, the first bytes of all numbers stand one behind the other, then their second bytes, and so on: the *planes*
 * of a chunk. A *slice* of the chunk, some rows of it, has a range of each plane, which is a *section* of the stream:
 * deflated with nothing before it to refer to, and ended at a whole byte. The stream of a chunk is
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

enum { HEADER = 2, LAST_BLOCK = 2, CHECKSUM = 4 };

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

/* The sections as they stand in the stream, each in what is shuffled and with the room that it can take at most. */
static void place(const chunk *c)
{
    unsigned char *bytes = c->deflater->shuffled, *packed = c->deflater->packed + HEADER;
    for (section *s = c->deflater->sections; s < c->deflater->sections + count_sections(c); s++) {
        s->bytes = bytes;
        s->packed = packed;
        bytes += s->size;
        packed += section_room(s->size);
    }
}

/* \return bytes that the stream can take at most */
static size_t measure(const chunk *c, int level)
{
    size_t room = HEADER + LAST_BLOCK + CHECKSUM;
    section *s = c->deflater->sections;
    for (int plane = 0; plane < c->n_planes; plane++)
        for (int slice = 0; slice < c->n_slices; slice++, s++) {
            const span p = span_of(c, slice);
            s->size = (p.end - p.first) * (c->numbers.width / (size_t)c->n_planes);
            s->level = level;
            room += section_room(s->size);
        }
    return room;
}

static dem_status prepare(const chunk *c, int level)
{
    deflater *d = c->deflater;
    d->sections = make_room(d->sections, &d->sections_room, (size_t)count_sections(c) * sizeof *d->sections);
    CHECK_MEMORY(d->sections);
    d->shuffled = make_room(d->shuffled, &d->room, c->all * c->numbers.width);
    CHECK_MEMORY(d->shuffled);
    d->packed = make_room(d->packed, &d->packed_room, measure(c, level));
    CHECK_MEMORY(d->packed);
    place(c);
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
        section *s = &d->sections[plane * c->n_slices + slice];
        s->only_runs = s->level == 1 && !repeats(d->shuffled + seen * p.all + p.first, p.end - p.first);
    }
}

/* Moves the sections together, and writes what is before and behind them. */
static void join(deflater *d, int n_sections)
{
    static const unsigned char header[HEADER] = {0x78, 0x01}, last_block[LAST_BLOCK] = {0x03, 0x00};
    const uint32_t sum = section_checksum(d->sections, n_sections);
    unsigned char *out = d->packed;
    memcpy(out, header, sizeof header);
    out += sizeof header;
    for (const section *s = d->sections; s < d->sections + n_sections; s++) {
        memmove(out, s->packed, s->n_packed);
        out += s->n_packed;
    }
    memcpy(out, last_block, sizeof last_block);
    out += sizeof last_block;
    for (int shift = 24; shift >= 0; shift -= 8) *out++ = (unsigned char)(sum >> shift);
    d->n_packed = (size_t)(out - d->packed);
}

dem_status deflater_pack(deflater *d, deflater_numbers numbers, int level, deflater_helpers h)
{
    const chunk c = chunk_of(d, numbers);
    const int n = count_sections(&c);
    bool by_ranks = false;
    TRY(prepare(&c, level));
    team_run(h.team, c.n_slices, shuffle_slice, &c);
    if (h.simulation != NULL && n > 1) TRY(section_pack_by_ranks(h.simulation, d->sections, n, &by_ranks));
    if (!by_ranks) TRY(section_pack(&d->streams, d->sections, n, h.team));
    join(d, n);
    return DEM_OK;
}

void deflater_free(deflater *d)
{
    section_streams_free(&d->streams);
    free(d->shuffled);
    free(d->packed);
    free(d->sections);
    *d = (deflater){0};
}
