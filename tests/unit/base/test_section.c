/* SPDX-License-Identifier: BSD-3-Clause */
/* section.c: each section inflates by itself, and all of them one behind the other, whoever has made them. */
#include "harness/test.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "base/random.h"
#include "base/section.h"
#include "harness/cleanup.h"

enum { N = 5, SIZE = 20000 };

/* N sections, one behind the other, and room for what is packed of each. */
typedef struct sample {
    section sections[N];
    unsigned char bytes[N * SIZE], packed[2 * N * SIZE];
    section_streams streams;
} sample;

static sample *begin(int level)
{
    sample *s = calloc(1, sizeof *s);
    uint64_t state = 1;
    assert_non_null(s);
    for (int k = 0; k < N * SIZE; k++) s->bytes[k] = (unsigned char)(k / SIZE * random_next(&state));
    for (int k = 0; k < N; k++)
        s->sections[k] = (section){.bytes = s->bytes + (size_t)k * SIZE,
                                   .size = SIZE,
                                   .level = level,
                                   .only_runs = k % 2 == 1,
                                   .packed = s->packed + 2 * (size_t)k * SIZE};
    return s;
}

static void end(sample **s)
{
    section_streams_free(&(*s)->streams);
    free(*s);
}

/* Inflates what has no header. Each section ends at a byte, but is not the end of a stream. */
static void inflate_raw(const section *s, unsigned char *out)
{
    z_stream z = {.next_in = s->packed, .avail_in = (uInt)s->n_packed, .next_out = out, .avail_out = SIZE + 1};
    assert_int_equal(inflateInit2(&z, -15), Z_OK);
    assert_int_equal(inflate(&z, Z_SYNC_FLUSH), Z_OK);
    assert_int_equal(z.avail_in, 0);
    assert_int_equal(z.total_out, SIZE);
    assert_int_equal(inflateEnd(&z), Z_OK);
}

TEST(each_section_inflates_by_itself)
{
    for (int level = 1; level <= 9; level += 4) {
        CLEANUP(end) sample *s = begin(level);
        unsigned char out[SIZE + 1];
        assert_int_equal(section_pack(&s->streams, s->sections, N, NULL), DEM_OK);
        for (int k = 0; k < N; k++) {
            inflate_raw(&s->sections[k], out);
            assert_memory_equal(out, s->sections[k].bytes, SIZE);
            assert_int_equal(s->sections[k].checksum, adler32(1, out, SIZE));
            assert_in_range(s->sections[k].n_packed, 1, section_room(SIZE) - 1);
        }
        uint32_t sum = SECTION_NO_CHECKSUM;
        for (int k = 0; k < N; k++) sum = section_join(sum, s->sections[k].checksum, SIZE);
        assert_int_equal(sum, adler32(1, s->bytes, N * SIZE));
    }
}

TEST(any_number_of_threads_makes_the_same_bytes)
{
    CLEANUP(end) sample *one = begin(1);
    assert_int_equal(section_pack(&one->streams, one->sections, N, NULL), DEM_OK);
    for (int threads = 2; threads <= 4; threads++) {
        CLEANUP(end) sample *several = begin(1);
        team *t = team_create(threads, 1);
        assert_int_equal(section_pack(&several->streams, several->sections, N, t), DEM_OK);
        assert_memory_equal(several->packed, one->packed, sizeof one->packed);
        team_destroy(t);
    }
}
