/* SPDX-License-Identifier: BSD-3-Clause */
/* deflater.c: what it packs is unpacked by zlib and put in order here, and read by HDF5's own filters. */
#include "verification/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include <unistd.h>

#include "harness/cleanup_hdf5.h"
#include "output/deflater.h"
#include "output/hdf5_rows.h"
#include "unit/scratch.h"

enum { N = 500 };

static const char *path;

/* Deflates the numbers, inflates them, and puts byte k of number j where it belongs. */
static void pack_and_unpack(deflater *d, deflater_numbers m, int level, unsigned char *out)
{
    unsigned char shuffled[8 * N];
    uLongf n = sizeof shuffled;
    assert_ok(deflater_pack(d, m, level));
    assert_int_equal(uncompress(shuffled, &n, d->packed, d->n_packed), Z_OK);
    assert_int_equal(n, m.count * m.width);
    for (size_t j = 0; j < m.count; j++)
        for (size_t k = 0; k < m.width; k++) out[j * m.width + k] = shuffled[k * m.count + j];
}

TEST(numbers_of_every_width_come_back)
{
    double reals[N], back[N];
    float floats[N];
    int32_t wholes[N];
    unsigned char out[8 * N], bytes[N];
    CLEANUP(deflater_free) deflater d = {0};
    for (int k = 0; k < N; k++) reals[k] = sin(k), wholes[k] = k * k - 1000, bytes[k] = (unsigned char)(k / 100);
    for (int level = 1; level <= 9; level += 4) {
        pack_and_unpack(&d, (deflater_numbers){reals, N, 8, false}, level, out);
        memcpy(back, out, sizeof back);
        assert_memory_equal(back, reals, sizeof reals);
        pack_and_unpack(&d, (deflater_numbers){reals, N, 4, true}, level, out);
        memcpy(floats, out, sizeof floats);
        for (int k = 0; k < N; k++) assert_close((double)floats[k], (double)(float)reals[k], 0.0);
        pack_and_unpack(&d, (deflater_numbers){wholes, N, 4, false}, level, out);
        assert_memory_equal(out, wholes, sizeof wholes);
        pack_and_unpack(&d, (deflater_numbers){bytes, N, 1, false}, level, out);
        assert_memory_equal(out, bytes, sizeof bytes);
    }
}

TEST(equal_numbers_take_a_fiftieth_of_their_room)
{
    const double zeros[N] = {0.0};
    CLEANUP(deflater_free) deflater d = {0};
    assert_ok(deflater_pack(&d, (deflater_numbers){zeros, N, 8, false}, 1));
    assert_in_range(d.n_packed, 1, sizeof zeros / 50);
}

/* Rows of 50 nodes: without runs of equal bytes a tenth of the bytes are new. Where none come again they take their
 * room, but for the exponents. */
TEST(numbers_that_come_again_row_by_row_take_a_fifth_of_their_room)
{
    double rows[N], others[N];
    CLEANUP(deflater_free) deflater d = {0};
    for (int k = 0; k < N; k++) rows[k] = sin(k % 50), others[k] = sin(k);
    assert_ok(deflater_pack(&d, (deflater_numbers){rows, N, 8, false}, 1));
    assert_in_range(d.n_packed, 1, sizeof rows / 5);
    assert_ok(deflater_pack(&d, (deflater_numbers){others, N, 8, false}, 1));
    assert_in_range(d.n_packed, sizeof others / 2, sizeof others);
}

/* Rows that fill a chunk are packed here, others by HDF5: both come back the same, whatever is cut off in between. */
TEST_WITH(chunks_are_read_by_filters_of_hdf5, NULL, scratch_sweep)
{
    static const hdf5_kind kinds[] = {HDF5_F64, HDF5_F32};
    static const char *const names[] = {"/exact", "/narrow"};
    double value[2 * N], back[2 * N];
    hdf5_file file;
    assert_ok(hdf5_open_new(&file, path, 0));
    for (int k = 0; k < 2 * N; k++) value[k] = cos(k);
    for (int q = 0; q < 2; q++) {
        const hdf5_rows rows = {names[q], kinds[q], 2, {2, 0}, N / 2, 1};
        assert_ok(hdf5_create(&file, &rows));
        assert_ok(hdf5_append(&file, &rows, 0, N / 2, value));
        assert_ok(hdf5_append(&file, &rows, N / 2, N / 4, value));
        assert_ok(hdf5_append(&file, &rows, N / 2, N / 2, value + N));
        assert_ok(hdf5_read(&file, &rows, 0, N, back));
        for (int k = 0; k < 2 * N; k++) assert_close(back[k], q == 0 ? value[k] : (double)(float)value[k], 0.0);
    }
    assert_ok(hdf5_close(&file, DEM_OK));
}

SCRATCH_GROUP({&path, "a.h5"});
