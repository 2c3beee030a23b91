/* SPDX-License-Identifier: BSD-3-Clause */
/* Shuffled, the first bytes of all numbers stand one behind the other, then their second bytes, and so on: the *planes*
 * of a chunk. A *slice* of the chunk, some rows of it, has a range of each plane, which is a *section* of the stream:
 * deflated with nothing before it to refer to, and ended at a whole byte. Here slices are shuffled as if they were all
 * of the chunk, and so have the same ranges. */
#include "output/deflater.h"

#include "base/status.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Numbers `first` to `end` - 1 of `all`, a slice of them. */
typedef struct span {
    size_t first, end, all;
} span;

/* What is being packed. */
typedef struct packing {
    deflater *deflater;
    deflater_numbers numbers;
    size_t all; /* numbers */
} packing;

int deflater_planes(deflater_numbers chunk)
{
    return chunk.rows * chunk.columns >= DEFLATER_CUT ? (int)chunk.width : 1;
}

static int count_sections(const deflater *d)
{
    return d->n_slices * d->n_planes;
}

/* The last slice may have less numbers than others. */
static span span_of(const packing *p, int slice)
{
    const size_t most = DEFLATER_SLICE * p->numbers.columns, first = (size_t)slice * most;
    return (span){first, first + most < p->all ? first + most : p->all, p->all};
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

/* Each section in what is shuffled, and with the room that it can take at most. */
static void place(const deflater *d)
{
    unsigned char *bytes = d->shuffled, *packed = d->packed;
    for (section *s = d->sections; s < d->sections + count_sections(d); s++) {
        s->bytes = bytes;
        s->packed = packed;
        bytes += s->size;
        packed += section_room(s->size);
    }
}

/* \return bytes that all sections can take at most */
static size_t measure(const packing *p, int level)
{
    const deflater *d = p->deflater;
    size_t room = 0;
    section *s = d->sections;
    for (int plane = 0; plane < d->n_planes; plane++)
        for (int slice = 0; slice < d->n_slices; slice++, s++) {
            const span range = span_of(p, slice);
            s->size = (range.end - range.first) * (p->numbers.width / (size_t)d->n_planes);
            s->level = level;
            room += section_room(s->size);
        }
    return room;
}

static dem_status prepare(const packing *p, int level)
{
    deflater *d = p->deflater;
    d->sections = make_room(d->sections, &d->sections_room, (size_t)count_sections(d) * sizeof *d->sections);
    CHECK_MEMORY(d->sections);
    d->shuffled = make_room(d->shuffled, &d->room, p->all * p->numbers.width);
    CHECK_MEMORY(d->shuffled);
    d->packed = make_room(d->packed, &d->packed_room, measure(p, level));
    CHECK_MEMORY(d->packed);
    place(d);
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
    const packing *p = context;
    const deflater *d = p->deflater;
    const span range = span_of(p, slice);
    (void)thread;
    shuffle(d->shuffled, p->numbers, range);
    for (int plane = 0; plane < d->n_planes; plane++) {
        const size_t seen = d->n_planes > 1 ? (size_t)plane : p->numbers.width / 2;
        section *s = &d->sections[plane * d->n_slices + slice];
        s->only_runs = s->level == 1 && !repeats(d->shuffled + seen * p->all + range.first, range.end - range.first);
    }
}

dem_status deflater_pack(deflater *d, deflater_numbers slices, int n_planes, int level, team *t)
{
    const packing p = {d, slices, slices.rows * slices.columns};
    d->n_slices = (int)((slices.rows + DEFLATER_SLICE - 1) / DEFLATER_SLICE);
    d->n_planes = n_planes;
    TRY(prepare(&p, level));
    team_run(t, d->n_slices, shuffle_slice, &p);
    return section_pack(&d->streams, d->sections, count_sections(d), t);
}

void deflater_free(deflater *d)
{
    section_streams_free(&d->streams);
    free(d->shuffled);
    free(d->packed);
    free(d->sections);
    *d = (deflater){0};
}
