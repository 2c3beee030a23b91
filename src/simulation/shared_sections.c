/* SPDX-License-Identifier: BSD-3-Clause */
/* Rank 0 sends what each rank needs to know of its sections, then their bytes, and deflates its own ones; back come
 * what each has got, and then the packed bytes. Those of a block stand one behind the other everywhere, and so are one
 * message. */
#include "simulation/shared_sections.h"

#include <stdlib.h>
#include <string.h>

#include "base/reduce.h"
#include "base/status.h"

/* Of a section: what is to be done, and what has come of it. */
typedef struct note {
    size_t size, n_packed;
    uint32_t checksum;
    int level;
    bool only_runs;
} note;

/* What is passed on between rank 0 and another one. */
enum part { NOTES, BYTES, PACKED };

typedef struct sharing {
    const ranks *ranks;
    int n;
    section *sections;              /* [n], on other ranks those of their block are set */
    note *notes;                    /* [n] likewise */
    ranks_message *sent, *received; /* [ranks] */
    unsigned char *bytes, *packed;  /* of the block, on other ranks */
} sharing;

/* The first section of a rank. */
static int first_of(const sharing *s, int rank)
{
    return (int)team_share(s->n, s->ranks->size, rank);
}

static ranks_message message_of(const sharing *s, enum part part, int rank)
{
    const int first = first_of(s, rank), end = first_of(s, rank + 1);
    ranks_message m = {.bytes = &s->notes[first], .size = (size_t)(end - first) * sizeof *s->notes};
    if (part == NOTES || first == end) return m;
    m.bytes = part == BYTES ? s->sections[first].bytes : s->sections[first].packed;
    m.size = 0;
    for (int k = first; k < end; k++) m.size += part == BYTES ? s->notes[k].size : s->notes[k].n_packed;
    return m;
}

static void pass(const sharing *s, enum part part, bool to_root)
{
    const ranks *r = s->ranks;
    const int n = r->rank == 0 ? r->size - 1 : 1;
    for (int k = 0; k < n; k++) {
        const int other = r->rank == 0 ? k + 1 : 0;
        ranks_message full = message_of(s, part, r->rank == 0 ? other : r->rank);
        full.rank = other;
        const ranks_message empty = {other, 0, NULL};
        s->sent[k] = to_root == (r->rank == 0) ? empty : full;
        s->received[k] = to_root == (r->rank == 0) ? full : empty;
    }
    r->exchange(r->self, n, s->sent, s->received);
}

static dem_status allocate(sharing *s, section *sections)
{
    const size_t size = (size_t)s->ranks->size, n = (size_t)s->n;
    s->sections = s->ranks->rank == 0 ? sections : calloc(n, sizeof *s->sections);
    s->notes = calloc(n, sizeof *s->notes);
    s->sent = calloc(size, sizeof *s->sent);
    s->received = calloc(size, sizeof *s->received);
    CHECK(s->sections && s->notes && s->sent && s->received, DEM_ERROR_MEMORY, "out of memory for %d sections", s->n);
    return DEM_OK;
}

/* On rank 0 from all sections. */
static void write_notes(const sharing *s)
{
    for (int k = 0; k < s->n && s->ranks->rank == 0; k++) {
        const section *of = &s->sections[k];
        s->notes[k] = (note){.size = of->size, .level = of->level, .only_runs = of->only_runs};
    }
}

/* Room for the block of another rank. */
static dem_status lay_out(sharing *s)
{
    const int first = first_of(s, s->ranks->rank), end = first_of(s, s->ranks->rank + 1);
    size_t size = 0, room = 0;
    if (s->ranks->rank == 0) return DEM_OK;
    for (int k = first; k < end; k++) {
        size += s->notes[k].size;
        room += section_room(s->notes[k].size);
    }
    s->bytes = malloc(size + 1);
    s->packed = malloc(room + 1);
    CHECK(s->bytes && s->packed, DEM_ERROR_MEMORY, "out of memory for %zu bytes of rank 0", size);
    unsigned char *bytes = s->bytes, *packed = s->packed;
    for (int k = first; k < end; k++) {
        const note *m = &s->notes[k];
        s->sections[k] = (section){bytes, m->size, m->level, m->only_runs, packed, 0, 0};
        bytes += m->size;
        packed += section_room(m->size);
    }
    return DEM_OK;
}

/* What has come of the block, its packed bytes one behind the other. */
static void note_block(const sharing *s)
{
    const int first = first_of(s, s->ranks->rank), end = first_of(s, s->ranks->rank + 1);
    unsigned char *at = s->packed;
    for (int k = first; k < end; k++) {
        const section *of = &s->sections[k];
        s->notes[k].n_packed = of->n_packed;
        s->notes[k].checksum = of->checksum;
        memmove(at, of->packed, of->n_packed);
        at += of->n_packed;
    }
}

/* On rank 0, what has come of the blocks of others. */
static void take_notes(const sharing *s)
{
    for (int rank = 1; rank < s->ranks->size; rank++)
        for (int first = first_of(s, rank), end = first_of(s, rank + 1), k = first; k < end; k++) {
            section *of = &s->sections[k];
            if (k > first) of->packed = of[-1].packed + of[-1].n_packed;
            of->n_packed = s->notes[k].n_packed;
            of->checksum = s->notes[k].checksum;
        }
}

static dem_status share(sharing *s, section_streams *z, team *t)
{
    const ranks *r = s->ranks;
    const int first = first_of(s, r->rank), n = first_of(s, r->rank + 1) - first;
    write_notes(s);
    pass(s, NOTES, false);
    TRY(reduce_status(r, lay_out(s), 0.0));
    pass(s, BYTES, false);
    TRY(reduce_status(r, section_pack(z, s->sections + first, n, t), 0.0));
    if (r->rank > 0) note_block(s);
    pass(s, NOTES, true);
    pass(s, PACKED, true);
    if (r->rank == 0) take_notes(s);
    return DEM_OK;
}

static void release(const sharing *s)
{
    if (s->ranks->rank > 0) free(s->sections);
    free(s->notes);
    free(s->sent);
    free(s->received);
    free(s->bytes);
    free(s->packed);
}

dem_status shared_sections_pack(const ranks *r, section_streams *z, team *t, section *sections, int n)
{
    sharing s = {.ranks = r, .n = n};
    dem_status status = reduce_status(r, allocate(&s, sections), 0.0);
    if (status == DEM_OK) status = share(&s, z, t);
    release(&s);
    return status;
}
