/* SPDX-License-Identifier: BSD-3-Clause */
/* deflater.c, deflated_chunk.c: what they pack is unpacked by zlib and put in order here, and read by HDF5's own
 * filters. */
#include "verification/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include <unistd.h>

#include "base/random.h"
#include "harness/cleanup_hdf5.h"
#include "output/deflated_chunk.h"
#include "output/deflater.h"
#include "output/hdf5_rows.h"
#include "unit/scratch.h"

enum { N = 500, LARGE = 2 * DEFLATER_SLICE + 20000 /* rows: two slices and a part of one */ };

static const char *path;

/* Zero at first. */
typedef struct packer {
    deflater deflater;
    deflated_chunk chunk;
} packer;

static void release(packer *p)
{
    deflater_free(&p->deflater);
    deflated_chunk_free(&p->chunk);
}

/* All of a chunk at once. */
static const deflated_run *pack(packer *p, deflater_numbers m, int level, team *t)
{
    deflater *d = &p->deflater;
    assert_ok(deflated_chunk_begin(&p->chunk, deflater_planes(m), 1));
    assert_ok(deflater_pack(d, m, p->chunk.n_planes, level, t));
    assert_ok(deflated_chunk_add(&p->chunk, 0, d->sections, d->n_slices));
    assert_ok(deflated_chunk_end(&p->chunk));
    return &p->chunk.all;
}

/* Deflates the numbers, inflates them, and puts byte k of number j where it belongs. */
static void pack_and_unpack(packer *p, deflater_numbers m, int level, void *out)
{
    const size_t count = m.rows * m.columns;
    CLEANUP(free_memory) void *shuffled = malloc(count * m.width);
    uLongf n = count * m.width;
    const deflated_run *all = pack(p, m, level, NULL);
    assert_int_equal(uncompress(shuffled, &n, all->bytes, all->n), Z_OK);
    assert_int_equal(n, count * m.width);
    for (size_t j = 0; j < count; j++)
        for (size_t k = 0; k < m.width; k++)
            ((unsigned char *)out)[j * m.width + k] = ((unsigned char *)shuffled)[k * count + j];
}

TEST(numbers_of_every_width_come_back)
{
    double reals[N], back[N];
    float floats[N];
    int32_t wholes[N];
    unsigned char out[8 * N], bytes[N];
    CLEANUP(release) packer p = {0};
    for (int k = 0; k < N; k++) reals[k] = sin(k), wholes[k] = k * k - 1000, bytes[k] = (unsigned char)(k / 100);
    for (int level = 1; level <= 9; level += 4) {
        pack_and_unpack(&p, (deflater_numbers){reals, N, 1, 8, false}, level, out);
        memcpy(back, out, sizeof back);
        assert_memory_equal(back, reals, sizeof reals);
        pack_and_unpack(&p, (deflater_numbers){reals, N / 2, 2, 4, true}, level, out);
        memcpy(floats, out, sizeof floats);
        for (int k = 0; k < N; k++) assert_close((double)floats[k], (double)(float)reals[k], 0.0);
        pack_and_unpack(&p, (deflater_numbers){wholes, N, 1, 4, false}, level, out);
        assert_memory_equal(out, wholes, sizeof wholes);
        pack_and_unpack(&p, (deflater_numbers){bytes, N, 1, 1, false}, level, out);
        assert_memory_equal(out, bytes, sizeof bytes);
    }
}

TEST(equal_numbers_take_a_fiftieth_of_their_room)
{
    const double zeros[N] = {0.0};
    CLEANUP(release) packer p = {0};
    assert_in_range(pack(&p, (deflater_numbers){zeros, N, 1, 8, false}, 1, NULL)->n, 1, sizeof zeros / 50);
}

/* Rows of 50 nodes: without runs of equal bytes a tenth of the bytes are new. Where none come again they take their
 * room, but for the exponents. */
TEST(numbers_that_come_again_row_by_row_take_a_fifth_of_their_room)
{
    double rows[N], others[N];
    CLEANUP(release) packer p = {0};
    for (int k = 0; k < N; k++) rows[k] = sin(k % 50), others[k] = sin(k);
    assert_in_range(pack(&p, (deflater_numbers){rows, N, 1, 8, false}, 1, NULL)->n, 1, sizeof rows / 5);
    assert_in_range(pack(&p, (deflater_numbers){others, N, 1, 8, false}, 1, NULL)->n, sizeof others / 2, sizeof others);
}

/* The upper three bytes come again after 50 numbers, the others are anything. */
TEST(bytes_that_come_again_are_found_beside_those_that_do_not)
{
    enum { UPPER = 24, LOWER = 64 - UPPER };
    CLEANUP(free_memory) uint64_t *number = malloc(LARGE * sizeof *number);
    CLEANUP(release) packer p = {0};
    for (uint64_t k = 0; k < LARGE; k++) number[k] = random_mix(k % 50) << LOWER | random_mix(k) >> UPPER;
    assert_in_range(pack(&p, (deflater_numbers){number, LARGE, 1, 8, false}, 1, NULL)->n, 5 * LARGE,
                    5 * LARGE + LARGE / 8);
}

/* As computing leaves them: signs and exponents are few, the last bytes are anything, and every third number is 0. */
static void draw(double *out, size_t n, uint64_t seed)
{
    for (size_t k = 0; k < n; k++) out[k] = k % 3 == 2 ? 0.0 : 1e3 * random_next(&seed);
}

/* Of every length about where a chunk is cut into planes, and into slices. */
TEST(random_numbers_come_back_however_a_chunk_is_cut)
{
    static const size_t rows[] = {
        1, DEFLATER_CUT / 3, DEFLATER_CUT / 3 + 1, DEFLATER_SLICE - 1, DEFLATER_SLICE, DEFLATER_SLICE + 1, LARGE};
    CLEANUP(free_memory) double *value = malloc(3 * LARGE * sizeof *value);
    CLEANUP(free_memory) double *back = malloc(3 * LARGE * sizeof *back);
    CLEANUP(free_memory) float *narrow = malloc(3 * LARGE * sizeof *narrow);
    CLEANUP(release) packer p = {0};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const size_t n = 3 * rows[k];
        draw(value, n, k);
        pack_and_unpack(&p, (deflater_numbers){value, rows[k], 3, 8, false}, 1, back);
        assert_memory_equal(back, value, n * sizeof *value);
        pack_and_unpack(&p, (deflater_numbers){value, rows[k], 3, 4, true}, 1, narrow);
        for (size_t j = 0; j < n; j++) assert_close((double)narrow[j], (double)(float)value[j], 0.0);
        pack_and_unpack(&p, (deflater_numbers){value, rows[k], 24, 1, false}, 6, back);
        assert_memory_equal(back, value, n * sizeof *value);
    }
}

/* Bytes of the sections, without what is before and behind them. */
static size_t bytes_of(packer *p, const double *value, size_t rows)
{
    return pack(p, (deflater_numbers){value, rows, 1, 8, false}, 1, NULL)->n - 8;
}

/* So that anybody can make them. */
TEST(sections_depend_on_nothing_but_their_piece)
{
    enum { ROWS = DEFLATER_SLICE + DEFLATER_CUT };
    CLEANUP(free_memory) double *value = malloc(ROWS * sizeof *value);
    CLEANUP(free_memory) unsigned char *first = malloc(9 * DEFLATER_SLICE);
    CLEANUP(release) packer p = {0};
    draw(value, ROWS, 7);
    const size_t n = bytes_of(&p, value + DEFLATER_SLICE, DEFLATER_CUT);
    const size_t m = bytes_of(&p, value, DEFLATER_SLICE);
    assert_int_equal(bytes_of(&p, value, ROWS), m + n);
    /* As bytes they have one plane, so that the sections are one behind the other. */
    const deflater_numbers all = {value, ROWS, 1, 1, false}, one = {value, DEFLATER_SLICE, 1, 1, false};
    const size_t size = pack(&p, one, 1, NULL)->n - 6;
    memcpy(first, p.chunk.all.bytes, size);
    assert_memory_equal(pack(&p, all, 1, NULL)->bytes, first, size);
}

TEST(any_number_of_threads_packs_the_same_bytes)
{
    CLEANUP(free_memory) double *value = malloc(3 * LARGE * sizeof *value);
    CLEANUP(release) packer one = {0};
    CLEANUP(release) packer several = {0};
    draw(value, 3 * LARGE, 3);
    for (int threads = 2; threads <= 4; threads++) {
        team *t = team_create(threads, 1);
        for (size_t columns = 1; columns <= 3; columns++)
            for (size_t rows = N; rows <= LARGE; rows += LARGE - N) {
                const deflater_numbers numbers = {value, rows, columns, 4, true};
                const deflated_run *alone = pack(&one, numbers, 1, NULL), *all = pack(&several, numbers, 1, t);
                assert_int_equal(all->n, alone->n);
                assert_memory_equal(all->bytes, alone->bytes, alone->n);
            }
        team_destroy(t);
    }
}

/* Slices that several have packed, the last of them first. */
TEST(shares_come_in_any_order)
{
    enum { SHARES = 3, COLUMNS = 2 };
    CLEANUP(free_memory) double *value = malloc(COLUMNS * LARGE * sizeof *value);
    CLEANUP(release) packer one = {0};
    CLEANUP(release) packer several = {0};
    draw(value, COLUMNS * LARGE, 5);
    const deflater_numbers numbers = {value, LARGE, COLUMNS, 8, false};
    const deflated_run *alone = pack(&one, numbers, 1, NULL);
    assert_ok(deflated_chunk_begin(&several.chunk, deflater_planes(numbers), SHARES));
    for (size_t k = SHARES; k-- > 0;) {
        const size_t first = k * DEFLATER_SLICE, left = LARGE - first;
        const deflater_numbers slice = {value + COLUMNS * first, left < DEFLATER_SLICE ? left : DEFLATER_SLICE, COLUMNS,
                                        8, false};
        assert_ok(deflater_pack(&several.deflater, slice, several.chunk.n_planes, 1, NULL));
        assert_ok(deflated_chunk_add(&several.chunk, (int)k, several.deflater.sections, 1));
    }
    assert_ok(deflated_chunk_end(&several.chunk));
    assert_int_equal(several.chunk.all.n, alone->n);
    assert_memory_equal(several.chunk.all.bytes, alone->bytes, alone->n);
}

/* Rows that fill a chunk are packed here, others by HDF5: both come back the same, whatever is cut off in between. */
static void write_and_read(hdf5_kind kind, size_t chunk, double *value, double *back)
{
    const hdf5_rows rows = {kind == HDF5_F64 ? "/exact" : "/narrow", kind, 2, {2, 0}, chunk, 1};
    hdf5_file file;
    draw(value, 4 * chunk, chunk);
    assert_ok(hdf5_open_new(&file, path, 0));
    assert_ok(hdf5_create(&file, &rows));
    assert_ok(hdf5_append(&file, &rows, 0, chunk, value));
    assert_ok(hdf5_append(&file, &rows, chunk, chunk / 2, value));
    assert_ok(hdf5_append(&file, &rows, chunk, chunk, value + 2 * chunk));
    assert_ok(hdf5_read(&file, &rows, 0, 2 * chunk, back));
    for (size_t k = 0; k < 4 * chunk; k++)
        assert_close(back[k], kind == HDF5_F64 ? value[k] : (double)(float)value[k], 0.0);
    assert_ok(hdf5_close(&file, DEM_OK));
}

TEST_WITH(chunks_are_read_by_filters_of_hdf5, NULL, scratch_sweep)
{
    CLEANUP(free_memory) double *value = malloc(4 * LARGE * sizeof *value);
    CLEANUP(free_memory) double *back = malloc(4 * LARGE * sizeof *back);
    for (int q = 0; q < 2; q++) {
        write_and_read(q == 0 ? HDF5_F64 : HDF5_F32, N / 2, value, back);
        write_and_read(q == 0 ? HDF5_F64 : HDF5_F32, LARGE, value, back);
    }
}

SCRATCH_GROUP({&path, "a.h5"});
