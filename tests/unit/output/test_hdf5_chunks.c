/* SPDX-License-Identifier: BSD-3-Clause */
/* hdf5_chunks.c: chunks that hold less than their extent says, as a damaged file or one made to do harm has them, are
 * refused. Memory checkers see what HDF5 reads beyond its own. */
#include "unit/output/stored.h"

#include "output/hdf5_attribute.h"
#include "output/hdf5_untrusted.h"

#include <zlib.h>

enum { ROWS = 8192, DEFLATE = 2 /* the second filter, behind shuffle */ };

static int open_file(void **state)
{
    stored *s = calloc(1, sizeof *s);
    assert_non_null(s);
    stored_open(s);
    *state = s;
    return 0;
}

static int close_file(void **state)
{
    stored_close(*state);
    free(*state);
    return 0;
}

/* A dataset whose only chunk stores these bytes, with these filters left out. */
static hdf5_rows make(const stored *s, int deflate, uint32_t left_out, const void *bytes, size_t size)
{
    const hdf5_rows rows = {"/x", HDF5_F64, 1, {0}, ROWS, deflate};
    const hsize_t start = 0, whole = ROWS;
    assert_ok(hdf5_create(&s->file, &rows));
    const hid_t dataset = H5Dopen2(s->file.id, rows.name, H5P_DEFAULT);
    assert_true(H5Dset_extent(dataset, &whole) >= 0);
    assert_true(H5Dwrite_chunk(dataset, H5P_DEFAULT, left_out, &start, size, bytes) >= 0);
    (void)H5Dclose(dataset);
    return rows;
}

/* As the file of a run of one's own and as one that may be damaged. */
static void is_refused(const stored *s, const hdf5_rows *rows, const char *reason)
{
    double last = 0.0;
    assert_int_equal(hdf5_read(&s->file, rows, ROWS - 1, 1, &last), DEM_ERROR_IO);
    if (strstr(dem_status_message(), reason) == NULL) fail_msg("'%s', not '%s'", dem_status_message(), reason);
    assert_int_equal(hdf5_untrusted_read(&s->file, rows->name, HDF5_F64, (hdf5_untrusted_rows){ROWS - 1, 1, 0}, &last),
                     DEM_ERROR_IO);
    if (strstr(dem_status_message(), reason) == NULL) fail_msg("'%s', not '%s'", dem_status_message(), reason);
}

/* The end of the chunk would be behind that of the file. */
TEST_WITH(a_plain_chunk_is_not_read_beyond_what_is_stored, open_file, close_file)
{
    const hdf5_rows rows = make(*test_state, 0, 0, (char[64]){0}, 64);
    is_refused(*test_state, &rows, "/x: cannot be read");
}

TEST_WITH(a_chunk_that_was_not_packed_is_refused_if_it_is_short, open_file, close_file)
{
    const hdf5_rows rows = make(*test_state, 1, DEFLATE | 1, (char[64]){0}, 64);
    is_refused(*test_state, &rows, "/x: cannot be read (a chunk is shorter than its extent)");
}

TEST_WITH(a_packed_chunk_is_refused_if_it_unpacks_to_less, open_file, close_file)
{
    unsigned char packed[64];
    uLongf size = sizeof packed;
    assert_int_equal(compress(packed, &size, (unsigned char[100]){1, 2}, 100), Z_OK);
    const hdf5_rows rows = make(*test_state, 1, 0, packed, size);
    is_refused(*test_state, &rows, "/x: cannot be read (a chunk is shorter than its extent)");
}

TEST_WITH(a_packed_chunk_that_is_cut_off_is_refused, open_file, close_file)
{
    static unsigned char numbers[ROWS * sizeof(double)], packed[2 * sizeof numbers];
    uLongf size = sizeof packed;
    for (size_t k = 0; k < sizeof numbers; k++) numbers[k] = (unsigned char)(k * k % 251);
    assert_int_equal(compress(packed, &size, numbers, sizeof numbers), Z_OK);
    const hdf5_rows rows = make(*test_state, 1, 0, packed, size / 2);
    is_refused(*test_state, &rows, "/x: cannot be read (a chunk is shorter than its extent)");
}

/* HDF5 leaves deflate out where it saves nothing; such a chunk is whole. */
TEST_WITH(a_chunk_that_was_not_packed_is_read_if_it_is_whole, open_file, close_file)
{
    static double numbers[ROWS];
    double last = 0.0;
    numbers[ROWS - 1] = 7.0;
    const stored *s = *test_state;
    const hdf5_rows rows = make(s, 1, DEFLATE | 1, numbers, sizeof numbers);
    assert_ok(hdf5_read(&s->file, &rows, ROWS - 1, 1, &last));
    assert_true(last == 7.0);
}

TEST_WITH(another_rank_is_refused, open_file, close_file)
{
    double read[6];
    const stored *s = *test_state;
    assert_ok(hdf5_write(&s->file, (hdf5_rows){"/x", HDF5_F64, 2, {3}, 0, 0}, 2, (double[6]){0}));
    assert_int_equal(hdf5_read(&s->file, &(hdf5_rows){"/x", HDF5_F64, 1, {0}, 0, 0}, 0, 2, read), DEM_ERROR_IO);
    assert_non_null(strstr(dem_status_message(), "/x: has chunks of rank 2, not 1"));
}

TEST_WITH(an_attribute_of_more_numbers_than_one_is_refused, open_file, close_file)
{
    const stored *s = *test_state;
    const int64_t numbers[64] = {5};
    assert_ok(hdf5_write_attribute(&s->file, "/", "n", HDF5_I64, 64, numbers));
    assert_int_equal(hdf5_expect_attribute(&s->file, "/", "n", 5), DEM_ERROR_IO);
}

/* ---- copies ---- */

static const hdf5_rows target = {"/y", HDF5_F64, 1, {0}, ROWS, 1};

/* By another level than the target's. \return bytes */
static size_t pack(unsigned char *packed, size_t room)
{
    static unsigned char numbers[ROWS * sizeof(double)];
    uLongf size = room;
    for (size_t k = 0; k < sizeof numbers; k++) numbers[k] = (unsigned char)(k * k % 251);
    assert_int_equal(compress2(packed, &size, numbers, sizeof numbers, 9), Z_OK);
    return size;
}

static size_t stored_bytes(const stored *s, const char *name, unsigned char *out)
{
    const hsize_t start = 0;
    hsize_t size = 0;
    uint32_t left_out = 1;
    const hid_t dataset = H5Dopen2(s->file.id, name, H5P_DEFAULT);
    assert_true(H5Dget_chunk_storage_size(dataset, &start, &size) >= 0);
    assert_true(H5Dread_chunk(dataset, H5P_DEFAULT, &start, &left_out, out) >= 0);
    assert_int_equal(left_out, 0);
    (void)H5Dclose(dataset);
    return (size_t)size;
}

static bool is_copied(const stored *s, const hdf5_rows *source, hdf5_span span)
{
    bool is_done = true;
    assert_ok(hdf5_copy_chunk(&s->file, &s->file, source, &target, span, &is_done));
    return is_done;
}

TEST_WITH(a_packed_chunk_is_copied_as_it_is_stored, open_file, close_file)
{
    static unsigned char packed[2 * ROWS * sizeof(double)], copy[sizeof packed];
    static double numbers[ROWS], copied[ROWS];
    const stored *s = *test_state;
    const size_t size = pack(packed, sizeof packed);
    const hdf5_rows source = make(s, 1, 0, packed, size);
    assert_ok(hdf5_create(&s->file, &target));
    assert_true(is_copied(s, &source, (hdf5_span){0, ROWS, 0}));
    assert_int_equal(stored_bytes(s, "/y", copy), size);
    assert_memory_equal(copy, packed, size);
    assert_ok(hdf5_read(&s->file, &source, 0, ROWS, numbers));
    assert_ok(hdf5_read(&s->file, &target, 0, ROWS, copied));
    assert_memory_equal(copied, numbers, sizeof numbers);
}

/* The last byte is of the checksum, which no reader of a part of the rows would see. */
TEST_WITH(a_damaged_chunk_is_not_copied, open_file, close_file)
{
    static unsigned char packed[2 * ROWS * sizeof(double)];
    const stored *s = *test_state;
    const size_t size = pack(packed, sizeof packed);
    bool is_done;
    packed[size - 1] ^= 1;
    const hdf5_rows source = make(s, 1, 0, packed, size);
    assert_ok(hdf5_create(&s->file, &target));
    assert_int_equal(hdf5_copy_chunk(&s->file, &s->file, &source, &target, (hdf5_span){0, ROWS, 0}, &is_done),
                     DEM_ERROR_IO);
    assert_non_null(strstr(dem_status_message(), "/x: cannot be read"));
}

TEST_WITH(what_is_stored_in_another_way_is_left_to_others, open_file, close_file)
{
    static double numbers[ROWS];
    static unsigned char packed[2 * ROWS * sizeof(double)];
    const stored *s = *test_state;
    const size_t size = pack(packed, sizeof packed);
    assert_ok(hdf5_create(&s->file, &target));
    hdf5_rows source = make(s, 1, DEFLATE | 1, numbers, sizeof numbers);
    assert_false(is_copied(s, &source, (hdf5_span){0, ROWS, 0}));
    assert_true(H5Ldelete(s->file.id, "/x", H5P_DEFAULT) >= 0);
    source = make(s, 0, 0, numbers, sizeof numbers);
    assert_false(is_copied(s, &source, (hdf5_span){0, ROWS, 0}));
    assert_true(H5Ldelete(s->file.id, "/x", H5P_DEFAULT) >= 0);
    source = make(s, 1, 0, packed, size);
    assert_false(is_copied(s, &source, (hdf5_span){0, ROWS / 2, 0}));
    assert_false(is_copied(s, &source, (hdf5_span){1, ROWS, 0}));
}
