/* SPDX-License-Identifier: BSD-3-Clause */
/* shared_sections.c: what ranks pack for rank 0 is what it would have packed. */
#include "harness/test.h"

#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "harness/rank_threads.h"
#include "simulation/shared_sections.h"

enum { MOST = 9, SIZE = 3000, MOST_RANKS = 5, ROOM = 2 * MOST * SIZE };

/* Sections of different lengths, as rank 0 has them, and as one process packs them. */
typedef struct shared_case {
    int n;
    section sections[MOST], alone[MOST];
    unsigned char bytes[MOST * SIZE], packed[ROOM], packed_alone[ROOM];
    dem_status status[MOST_RANKS];
    rank_threads_counts counts[MOST_RANKS];
} shared_case;

static size_t size_of(int k)
{
    return SIZE - 100 * (size_t)k;
}

static void place(const shared_case *c, section *sections, unsigned char *packed)
{
    size_t at = 0;
    for (int k = 0; k < c->n; k++) {
        const section s = {.size = size_of(k), .level = 1, .only_runs = k % 3 == 0};
        sections[k] = s;
        sections[k].bytes = (unsigned char *)(uintptr_t)c->bytes + at;
        sections[k].packed = packed;
        at += size_of(k);
        packed += section_room(size_of(k));
    }
}

static void pack(const ranks *r, void *context)
{
    shared_case *c = context;
    section_streams z = {0};
    c->status[r->rank] = shared_sections_pack(r, &z, NULL, r->rank == 0 ? c->sections : NULL, c->n);
    c->counts[r->rank] = rank_threads_count(r);
    section_streams_free(&z);
}

/* Also fewer sections than ranks. */
TEST(ranks_pack_what_one_process_packs)
{
    uint64_t state = 3;
    shared_case *c = calloc(1, sizeof *c);
    assert_non_null(c);
    for (int k = 0; k < MOST * SIZE; k++) c->bytes[k] = (unsigned char)(20.0 * random_next(&state) + 20.0);
    for (int n_ranks = 1; n_ranks <= MOST_RANKS; n_ranks++)
        for (c->n = 1; c->n <= MOST; c->n += 2) {
            section_streams z = {0};
            place(c, c->sections, c->packed);
            place(c, c->alone, c->packed_alone);
            assert_int_equal(section_pack(&z, c->alone, c->n, NULL), DEM_OK);
            section_streams_free(&z);
            rank_threads_run(n_ranks, pack, c);
            for (int r = 0; r < n_ranks; r++) {
                assert_int_equal(c->status[r], DEM_OK);
                assert_int_equal(c->counts[r].reductions, 3);
                assert_int_equal(c->counts[r].exchanges, 4);
            }
            assert_int_equal(section_checksum(c->sections, c->n), section_checksum(c->alone, c->n));
            for (int k = 0; k < c->n; k++) {
                assert_int_equal(c->sections[k].n_packed, c->alone[k].n_packed);
                assert_memory_equal(c->sections[k].packed, c->alone[k].packed, c->alone[k].n_packed);
            }
        }
    free(c);
}

/* Rank 1 gets a level that zlib does not have. */
TEST(what_fails_on_one_rank_fails_on_all)
{
    shared_case *c = calloc(1, sizeof *c);
    assert_non_null(c);
    c->n = 2;
    place(c, c->sections, c->packed);
    c->sections[1].level = 17;
    rank_threads_run(2, pack, c);
    for (int r = 0; r < 2; r++) assert_int_equal(c->status[r], DEM_ERROR_MEMORY);
    free(c);
}
