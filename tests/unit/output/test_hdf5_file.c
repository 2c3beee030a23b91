/* SPDX-License-Identifier: BSD-3-Clause */
/* hdf5_file.c, hdf5_rows.c, hdf5_attribute.c: what is stored is looked at through HDF5 itself, failures through their
 * messages. */
#include "verification/support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/status.h"
#include "harness/cleanup_hdf5.h"
#include "output/hdf5_attribute.h"
#include "unit/scratch.h"

static const char *path, *other;

static hdf5_file open_new(void)
{
    hdf5_file file;
    assert_ok(hdf5_open_new(&file, path, 0));
    return file;
}

static hdf5_file open_again(void)
{
    hdf5_file file;
    assert_ok(hdf5_open_write(&file, path, 0));
    return file;
}

/* Whatever was done to it, nothing in the file is still open but the file itself. */
static void finish(hdf5_file *file)
{
    assert_int_equal(H5Fget_obj_count(file->id, H5F_OBJ_ALL), 1);
    assert_ok(hdf5_close(file, DEM_OK));
}

static void assert_message(const char *expected)
{
    const char *message = dem_status_message();
    if (strncmp(message, path, strlen(path)) != 0) fail_msg("'%s' does not begin with '%s'", message, path);
    assert_string_equal(message + strlen(path), expected);
}

static void assert_message_has(const char *part)
{
    if (strstr(dem_status_message(), part) == NULL) fail_msg("'%s' is not in '%s'", part, dem_status_message());
}

/* ---- datasets, with HDF5's own calls ---- */

typedef struct table {
    int rank;
    hsize_t extent[3], chunk[3];
    hid_t type; /* in the file; to be closed */
    int n_filters;
    double value[64];
} table;

static table look(const hdf5_file *file, const char *name)
{
    table t = {.extent = {0}};
    CLEANUP(free_h5) const hid_t dataset = H5Dopen2(file->id, name, H5P_DEFAULT);
    if (dataset < 0) fail_msg("there is no %s", name);
    CLEANUP(free_h5) const hid_t space = H5Dget_space(dataset), layout = H5Dget_create_plist(dataset);
    t.rank = H5Sget_simple_extent_dims(space, t.extent, NULL);
    assert_int_equal(H5Pget_chunk(layout, 3, t.chunk), t.rank);
    t.n_filters = H5Pget_nfilters(layout);
    t.type = H5Dget_type(dataset);
    assert_in_range(H5Sget_simple_extent_npoints(space), 0, 64);
    assert_true(H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, t.value) >= 0);
    return t;
}

static void expect_values(const hdf5_file *file, const char *name, const double *expected, hsize_t n)
{
    const table t = look(file, name);
    hsize_t cells = 1;
    for (int d = 0; d < t.rank; d++) cells *= t.extent[d];
    assert_int_equal(cells, n);
    for (hsize_t k = 0; k < n; k++) assert_close(t.value[k], expected[k], 0.0);
    (void)H5Tclose(t.type);
}

static hsize_t stored_bytes(const hdf5_file *file, const char *name)
{
    CLEANUP(free_h5) const hid_t dataset = H5Dopen2(file->id, name, H5P_DEFAULT);
    const hsize_t n = H5Dget_storage_size(dataset);
    return n;
}

/* ---- rows ---- */

TEST_WITH(rows_come_back_as_they_were_appended, NULL, scratch_sweep)
{
    static const double value[12] = {0.1, -2.0, 3.0, 4.5, 1e300, 6.0, 7.0, 8.0, -0.0, 10.0, 11.0, 12.0};
    const hdf5_rows flat = {"/flat", HDF5_F64, 1, {0, 0}, 4, 0}, pairs = {"/a/pairs", HDF5_F64, 2, {2, 0}, 3, 5};
    const hdf5_rows deep = {"/a/b/deep", HDF5_F64, 3, {3, 2}, 1, 0};
    CLEANUP(finish) hdf5_file file = open_new();
    assert_ok(hdf5_create(&file, &flat));
    assert_ok(hdf5_create(&file, &pairs));
    assert_ok(hdf5_create(&file, &deep));
    expect_values(&file, "/flat", NULL, 0);
    assert_ok(hdf5_append(&file, &flat, 0, 5, value));
    assert_ok(hdf5_append(&file, &flat, 5, 7, value + 5));
    assert_ok(hdf5_append(&file, &pairs, 0, 4, value));
    assert_ok(hdf5_append(&file, &deep, 0, 1, value));
    finish(&file);
    file = open_again();
    assert_ok(hdf5_append(&file, &pairs, 4, 2, value + 8));
    assert_ok(hdf5_append(&file, &deep, 1, 1, value + 6));
    expect_values(&file, "/flat", value, 12);
    expect_values(&file, "/a/pairs", value, 12);
    expect_values(&file, "/a/b/deep", value, 12);
}

TEST_WITH(what_is_appended_are_the_last_rows, NULL, scratch_sweep)
{
    static const double value[6] = {1.0, 2.0, 3.0, 4.0, 5.0, 6.0}, less[3] = {1.0, 2.0, 9.0}, new[1] = {9.0};
    const hdf5_rows rows = {"/r", HDF5_F64, 1, {0, 0}, 4, 0};
    CLEANUP(finish) hdf5_file file = open_new();
    assert_ok(hdf5_create(&file, &rows));
    assert_ok(hdf5_append(&file, &rows, 0, 6, value));
    assert_ok(hdf5_append(&file, &rows, 2, 1, new));
    expect_values(&file, "/r", less, 3);
    assert_ok(hdf5_append(&file, &rows, 2, 0, NULL));
    expect_values(&file, "/r", less, 2);
}

TEST_WITH(a_linked_dataset_has_the_same_rows_under_both_names, NULL, scratch_sweep)
{
    const double value[3] = {1.0, -2.0, 3.0};
    const hdf5_rows rows = {"/a/rows", HDF5_F64, 1, {0, 0}, 4, 0};
    CLEANUP(finish) hdf5_file file = open_new();
    assert_ok(hdf5_create(&file, &rows));
    assert_ok(hdf5_link(&file, "/b/same", "/a/rows"));
    assert_ok(hdf5_append(&file, &rows, 0, 3, value));
    finish(&file);
    file = open_again();
    expect_values(&file, "/a/rows", value, 3);
    expect_values(&file, "/b/same", value, 3);
    assert_int_equal(hdf5_link(&file, "/c", "/none"), DEM_ERROR_IO);
    assert_message_has(": /c: cannot be linked (");
}

/* Where they lead to need not be there yet. Reading a file back does not follow them: the other file is no part of
 * it. */
TEST_WITH(links_by_name_lead_to_what_comes_later_and_to_another_file, NULL, scratch_sweep)
{
    const double value[3] = {1.0, -2.0, 3.0};
    const hdf5_rows rows = {"/a/rows", HDF5_F64, 1, {0, 0}, 0, 0};
    CLEANUP(finish) hdf5_file file = open_new();
    assert_ok(hdf5_link_name(&file, "/b/same", "/a/rows"));
    assert_ok(hdf5_link_file(&file, "/c/other", strrchr(other, '/') + 1, "/b/same"));
    assert_ok(hdf5_write(&file, rows, 3, value));
    expect_values(&file, "/b/same", value, 3);
    finish(&file);
    assert_ok(hdf5_publish(path, path));
    assert_int_equal(rename(path, other), 0);
    file = open_new();
    assert_ok(hdf5_link_file(&file, "/c/other", strrchr(other, '/') + 1, "/b/same"));
    expect_values(&file, "/c/other", value, 3);
    assert_int_equal(hdf5_link_file(&file, "/c/other", "none.h5", "/a"), DEM_ERROR_IO);
    assert_message_has(": /c/other: cannot be linked (");
    assert_int_equal(unlink(other), 0);
}

TEST_WITH(numbers_are_stored_little_endian_in_their_own_width, NULL, scratch_sweep)
{
    const double reals[2] = {0.1, -4.0};
    const int64_t wide[2] = {INT64_C(1) << 40, -7};
    const int64_t codes[2] = {127, -1};
    const int32_t narrow[2] = {INT32_MAX, -8};
    const unsigned char bytes[2] = {255, 9};
    const struct {
        hdf5_kind kind;
        hid_t stored;
        const void *data;
        double first, second;
    } cases[] = {{HDF5_F64, H5T_IEEE_F64LE, reals, 0.1, -4.0},
                 {HDF5_F32, H5T_IEEE_F32LE, reals, (double)0.1f, -4.0},
                 {HDF5_I64, H5T_STD_I64LE, wide, 1099511627776.0, -7.0},
                 {HDF5_I32, H5T_STD_I32LE, narrow, 2147483647.0, -8.0},
                 {HDF5_I8, H5T_STD_I8LE, codes, 127.0, -1.0},
                 {HDF5_U8, H5T_STD_U8LE, bytes, 255.0, 9.0}};
    CLEANUP(finish) hdf5_file file = open_new();
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        const char name[] = {'/', (char)('a' + k), '\0'};
        const hdf5_rows rows = {name, cases[k].kind, 1, {0, 0}, 0, 0};
        assert_ok(hdf5_write(&file, rows, 2, cases[k].data));
        const table t = look(&file, name);
        assert_true(H5Tequal(t.type, cases[k].stored) > 0);
        assert_close(t.value[0], cases[k].first, 0.0);
        assert_close(t.value[1], cases[k].second, 0.0);
        (void)H5Tclose(t.type);
    }
    assert_true(H5Tequal(hdf5_memory_type(HDF5_F32), H5T_NATIVE_DOUBLE) > 0);
    assert_true(H5Tequal(hdf5_memory_type(HDF5_I8), H5T_NATIVE_INT64) > 0);
}

TEST_WITH(rows_are_written_chunk_by_chunk, NULL, scratch_sweep)
{
    const double value[10] = {1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0};
    CLEANUP(finish) hdf5_file file = open_new();
    for (int deflate = 0; deflate < 2; deflate++) {
        const hdf5_rows rows = {deflate ? "/deflated" : "/plain", HDF5_F64, 2, {2, 0}, 2, deflate};
        double back[10] = {0.0};
        assert_ok(hdf5_write(&file, rows, 5, value));
        assert_ok(hdf5_read(&file, &rows, 0, 5, back));
        assert_memory_equal(back, value, sizeof value);
        const table t = look(&file, rows.name);
        assert_int_equal(t.chunk[0], 2);
        assert_int_equal(t.extent[0], 5);
        (void)H5Tclose(t.type);
    }
}

TEST_WITH(a_chunk_has_the_rows_asked_for, NULL, scratch_sweep)
{
    const double value[6] = {1.0, 2.0, 3.0, 4.0, 5.0, 6.0};
    const hdf5_rows none = {"/none", HDF5_F64, 1, {0, 0}, 0, 0}, three = {"/three", HDF5_F64, 2, {2, 0}, 3, 0};
    CLEANUP(finish) hdf5_file file = open_new();
    assert_ok(hdf5_create(&file, &none));
    assert_ok(hdf5_create(&file, &three));
    assert_ok(hdf5_write(&file, (hdf5_rows){"/whole", HDF5_F64, 2, {2, 0}, 77, 0}, 3, value));
    assert_ok(hdf5_write(&file, (hdf5_rows){"/empty", HDF5_F64, 2, {2, 0}, 77, 0}, 0, NULL));
    static const char *const names[] = {"/none", "/three", "/whole", "/empty"};
    static const hsize_t chunk[] = {1, 3, 3, 1}, extent[] = {0, 0, 3, 0};
    for (int k = 0; k < 4; k++) {
        const table t = look(&file, names[k]);
        assert_int_equal(t.chunk[0], chunk[k]);
        assert_int_equal(t.extent[0], extent[k]);
        (void)H5Tclose(t.type);
    }
}

TEST_WITH(deflated_rows_take_less_room_and_come_back_the_same, NULL, scratch_sweep)
{
    static double value[4096];
    static double back[4096];
    const hdf5_rows plain = {"/plain", HDF5_F64, 1, {0, 0}, 0, 0}, small = {"/small", HDF5_F64, 1, {0, 0}, 0, 9};
    for (int k = 0; k < 4096; k++) value[k] = 1.0 + k;
    CLEANUP(finish) hdf5_file file = open_new();
    assert_ok(hdf5_write(&file, plain, 4096, value));
    assert_ok(hdf5_write(&file, small, 4096, value));
    assert_int_equal(stored_bytes(&file, "/plain"), sizeof value);
    assert_true(stored_bytes(&file, "/small") < sizeof value / 8); /* shuffled, six of eight bytes change rarely */
    const hid_t dataset = H5Dopen2(file.id, "/small", H5P_DEFAULT);
    assert_true(H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, back) >= 0);
    (void)H5Dclose(dataset);
    assert_memory_equal(back, value, sizeof value);
}

TEST_WITH(rows_that_cannot_be_stored_are_named, NULL, scratch_sweep)
{
    const double value = 1.0;
    const hdf5_rows rows = {"/a/r", HDF5_F64, 1, {0, 0}, 1, 0}, below = {"/a/r/x", HDF5_F64, 1, {0, 0}, 1, 0};
    const hdf5_rows bad = {"/bad", HDF5_F64, 1, {0, 0}, 1, 10};
    CLEANUP(finish) hdf5_file file = open_new();
    assert_int_equal(hdf5_append(&file, &rows, 0, 1, &value), DEM_ERROR_IO);
    assert_message_has("a.h5: /a/r: cannot be written (");
    assert_ok(hdf5_create(&file, &rows));
    assert_int_equal(hdf5_create(&file, &rows), DEM_ERROR_IO);
    assert_message_has("a.h5: /a/r: cannot be created (");
    assert_int_equal(hdf5_create(&file, &below), DEM_ERROR_IO);
    assert_message_has("a.h5: /a/r/x: cannot be created (");
    assert_int_equal(hdf5_create(&file, &bad), DEM_ERROR_IO); /* there is no such compression */
    assert_message_has("a.h5: /bad: cannot be created (");
    assert_ok(hdf5_append(&file, &rows, 0, 1, &value)); /* the file is as good as before */
}

TEST_WITH(a_lost_row_and_another_type_are_noticed, NULL, scratch_sweep)
{
    const double value[6] = {1.0, 2.0, 3.0, 4.0, 5.0, 6.0};
    const hdf5_rows rows = {"/r", HDF5_F64, 2, {2, 0}, 1, 0}, none = {"/s", HDF5_F64, 1, {0, 0}, 1, 0};
    const hdf5_rows others[] = {{"/r", HDF5_F32, 2, {2, 0}, 1, 0},
                                {"/r", HDF5_I64, 2, {2, 0}, 1, 0},
                                {"/r", HDF5_F64, 1, {0, 0}, 1, 0},
                                {"/r", HDF5_F64, 3, {2, 1}, 1, 0},
                                {"/r", HDF5_F64, 2, {3, 0}, 1, 0}};
    hsize_t count = 0;
    CLEANUP(finish) hdf5_file file = open_new();
    assert_ok(hdf5_write(&file, rows, 3, value));
    assert_ok(hdf5_count_rows(&file, "/r", &count));
    assert_int_equal(count, 3);
    assert_ok(hdf5_expect_rows(&file, &rows, 3));
    assert_int_equal(hdf5_expect_rows(&file, &rows, 4), DEM_ERROR_IO);
    assert_message(": /r: has 3 rows, 4 were written");
    for (size_t k = 0; k < sizeof others / sizeof others[0]; k++) {
        assert_int_equal(hdf5_expect_rows(&file, &others[k], 3), DEM_ERROR_IO);
        assert_message(": /r: is of another type or shape");
    }
    assert_int_equal(hdf5_expect_rows(&file, &none, 0), DEM_ERROR_IO);
    assert_message_has("a.h5: /s: cannot be opened (");
    assert_int_equal(hdf5_count_rows(&file, "/s", &count), DEM_ERROR_IO);
}

/* Of five rows in chunks of two, those from 1 to 4 go behind the one that is there, so no block begins with a chunk. */
TEST_WITH(rows_are_read_and_copied, NULL, scratch_sweep)
{
    const double reals[10] = {0.5, 1.5, 2.5, 3.5, NAN, -0.0, INFINITY, 7.5, 8.5, 9.5};
    const int64_t bytes[5] = {-128, -1, 0, 1, 127};
    const hdf5_rows real = {"/a/r", HDF5_F32, 2, {2, 0}, 2, 1}, byte = {"/b", HDF5_I8, 1, {0, 0}, 2, 0};
    double back[8];
    int64_t wholes[4];
    hdf5_file file = open_new(), copy;
    assert_ok(hdf5_open_new(&copy, other, 0));
    assert_ok(hdf5_create(&file, &real));
    assert_ok(hdf5_create(&file, &byte));
    assert_ok(hdf5_append(&file, &real, 0, 5, reals));
    assert_ok(hdf5_append(&file, &byte, 0, 5, bytes));
    assert_ok(hdf5_create(&copy, &real));
    assert_ok(hdf5_create(&copy, &byte));
    assert_ok(hdf5_append(&copy, &real, 0, 1, reals));
    assert_ok(hdf5_append(&copy, &byte, 0, 1, bytes));
    assert_ok(hdf5_copy(&file, &copy, &real, (hdf5_span){1, 3, 1}));
    assert_ok(hdf5_copy(&file, &copy, &byte, (hdf5_span){1, 3, 1}));
    assert_ok(hdf5_copy(&file, &copy, &byte, (hdf5_span){5, 0, 4}));
    assert_ok(hdf5_expect_rows(&copy, &real, 4));
    assert_ok(hdf5_expect_rows(&copy, &byte, 4));
    assert_ok(hdf5_read(&copy, &real, 0, 4, back));
    assert_ok(hdf5_read(&copy, &byte, 0, 4, wholes));
    assert_memory_equal(wholes, bytes, sizeof wholes);
    for (int k = 0; k < 8; k++)
        assert_true(k == 4 ? isnan(back[k]) : back[k] == reals[k] && !signbit(back[k]) == !signbit(reals[k]));
    assert_int_equal(hdf5_read(&file, &real, 4, 2, back), DEM_ERROR_IO);
    assert_message_has("a.h5: /a/r: cannot be read (");
    assert_int_equal(hdf5_copy(&file, &copy, &byte, (hdf5_span){3, 3, 4}), DEM_ERROR_IO);
    assert_ok(hdf5_close(&copy, DEM_OK));
    finish(&file);
}

/* ---- attributes ---- */

TEST_WITH(attributes_are_made_and_overwritten, NULL, scratch_sweep)
{
    const int64_t version[2] = {2, 0}, one = 1, two = 2;
    int64_t stored[2] = {0, 0};
    CLEANUP(finish) hdf5_file file = open_new();
    assert_ok(hdf5_write_attribute(&file, "/VTK/Steps", "NSteps", HDF5_I64, 1, &one));
    assert_ok(hdf5_write_attribute(&file, "/VTK/Steps", "NSteps", HDF5_I64, 1, &two));
    assert_ok(hdf5_write_attribute(&file, "/VTK", "Version", HDF5_I64, 2, version));
    assert_ok(hdf5_expect_attribute(&file, "/VTK/Steps", "NSteps", 2));
    const hid_t attribute = H5Aopen_by_name(file.id, "/VTK", "Version", H5P_DEFAULT, H5P_DEFAULT);
    assert_int_equal(H5Aget_storage_size(attribute), sizeof stored);
    assert_true(H5Aread(attribute, H5T_NATIVE_INT64, stored) >= 0);
    (void)H5Aclose(attribute);
    assert_int_equal(stored[0], 2);
    assert_int_equal(stored[1], 0);
}

TEST_WITH(a_wrong_or_missing_attribute_is_noticed, NULL, scratch_sweep)
{
    const int64_t three = 3;
    CLEANUP(finish) hdf5_file file = open_new();
    assert_ok(hdf5_write_attribute(&file, "/g", "n", HDF5_I64, 1, &three));
    assert_int_equal(hdf5_expect_attribute(&file, "/g", "n", 4), DEM_ERROR_IO);
    assert_message(": /g: n is 3, 4 was written");
    assert_int_equal(hdf5_expect_attribute(&file, "/g", "m", 3), DEM_ERROR_IO);
    assert_message_has("a.h5: /g: an attribute cannot be opened (");
    assert_int_equal(hdf5_expect_attribute(&file, "/h", "n", 3), DEM_ERROR_IO);
    finish(&file);
    assert_ok(hdf5_open_read(&file, path));
    assert_int_equal(hdf5_write_attribute(&file, "/h", "n", HDF5_I64, 1, &three), DEM_ERROR_IO);
    assert_message_has("a.h5: /h: an attribute cannot be written (");
}

TEST_WITH(a_text_attribute_has_its_characters_and_no_terminator, NULL, scratch_sweep)
{
    char text[20] = "                   ";
    CLEANUP(finish) hdf5_file file = open_new();
    assert_ok(hdf5_write_attribute_text(&file, "/VTK", "Type", "UnstructuredGrid"));
    CLEANUP(free_h5) const hid_t attribute = H5Aopen_by_name(file.id, "/VTK", "Type", H5P_DEFAULT, H5P_DEFAULT);
    CLEANUP(free_h5) const hid_t type = H5Aget_type(attribute);
    assert_int_equal(H5Tget_size(type), 16);
    assert_int_equal(H5Tget_cset(type), H5T_CSET_ASCII);
    assert_int_equal(H5Tis_variable_str(type), 0);
    assert_true(H5Aread(attribute, type, text) >= 0);
    assert_memory_equal(text, "UnstructuredGrid ", 17);
}

/* ---- texts ---- */

static void expect_text(const hdf5_file *file, const char *name, const char *expected)
{
    char text[64];
    memset(text, '#', sizeof text);
    assert_ok(hdf5_read_text(file, name, text, sizeof text));
    assert_string_equal(text, expected);
}

TEST_WITH(texts_are_kept_and_replaced_by_longer_and_shorter_ones, NULL, scratch_sweep)
{
    CLEANUP(finish) hdf5_file file = open_new();
    static const char *const texts[] = {"two words", "\xC3\xA9t\xC3\xA9 of more words,\nin two lines", "x", ""};
    for (size_t k = 0; k < 4; k++) {
        assert_ok(hdf5_write_text(&file, "/provenance/title", texts[k]));
        expect_text(&file, "/provenance/title", texts[k]);
    }
    assert_ok(hdf5_write_text(&file, "/provenance/other", "untouched"));
    assert_ok(hdf5_write_text(&file, "/provenance/title", "y"));
    expect_text(&file, "/provenance/other", "untouched");
    finish(&file);
    assert_ok(hdf5_open_read(&file, path));
    expect_text(&file, "/provenance/title", "y");
    assert_int_equal(hdf5_write_text(&file, "/provenance/title", "z"), DEM_ERROR_IO); /* opened to read */
}

TEST_WITH(a_text_needs_room_for_its_end, NULL, scratch_sweep)
{
    char text[6] = "#####";
    CLEANUP(finish) hdf5_file file = open_new();
    assert_ok(hdf5_write_text(&file, "/t", "12345"));
    assert_int_equal(hdf5_read_text(&file, "/t", text, 5), DEM_ERROR_ARGUMENT);
    assert_message(": /t: 5 characters and the end do not fit into 5");
    assert_string_equal(text, "#####");
    assert_ok(hdf5_read_text(&file, "/t", text, 6));
    assert_string_equal(text, "12345");
}

TEST_WITH(what_is_no_text_is_not_read_as_one, NULL, scratch_sweep)
{
    const double value = 1.0;
    const char *const variable = "of variable length";
    char text[64];
    CLEANUP(finish) hdf5_file file = open_new();
    assert_ok(hdf5_write(&file, (hdf5_rows){"/number", HDF5_F64, 1, {0, 0}, 0, 0}, 1, &value));
    const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
    (void)H5Tset_size(type, H5T_VARIABLE);
    const hid_t dataset = H5Dcreate2(file.id, "/variable", type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, &variable) >= 0);
    (void)H5Dclose(dataset);
    (void)H5Sclose(space);
    (void)H5Tclose(type);
    assert_int_equal(hdf5_read_text(&file, "/number", text, sizeof text), DEM_ERROR_IO);
    assert_message(": /number: is not a string of fixed length");
    assert_int_equal(hdf5_read_text(&file, "/variable", text, sizeof text), DEM_ERROR_IO);
    assert_message(": /variable: is not a string of fixed length");
    assert_int_equal(hdf5_read_text(&file, "/none", text, sizeof text), DEM_ERROR_IO);
    assert_message_has("a.h5: /none: cannot be opened (");
}

/* ---- opening and closing ---- */

TEST_WITH(a_file_that_cannot_be_opened_is_named_with_the_systems_cause, NULL, scratch_sweep)
{
    hdf5_file file;
    assert_int_equal(hdf5_open_read(&file, path), DEM_ERROR_IO);
    assert_message(": cannot be opened (No such file or directory)");
    assert_int_equal(hdf5_open_write(&file, path, 0), DEM_ERROR_IO);
    assert_message(": cannot be opened (No such file or directory)");
    assert_int_equal(hdf5_open_new(&file, "no/such/folder.h5", 0), DEM_ERROR_IO);
    assert_string_equal(dem_status_message(), "no/such/folder.h5: cannot be created (No such file or directory)");
    assert_int_equal(access(path, F_OK), -1);
}

TEST_WITH(a_file_of_another_kind_is_refused_and_left_alone, NULL, scratch_sweep)
{
    hdf5_file file;
    FILE *text = fopen(path, "w");
    assert_non_null(text);
    assert_true(fputs("no HDF5", text) >= 0);
    assert_int_equal(fclose(text), 0);
    assert_int_equal(hdf5_open_read(&file, path), DEM_ERROR_IO);
    assert_message(": cannot be opened (file signature not found)");
}

TEST_WITH(a_new_file_replaces_an_older_one, NULL, scratch_sweep)
{
    CLEANUP(finish) hdf5_file file = open_new();
    assert_ok(hdf5_write_text(&file, "/old", "x"));
    finish(&file);
    file = open_new();
    assert_int_equal(H5Lexists(file.id, "/old", H5P_DEFAULT), 0);
}

/* The room claimed is given back: a file is as long as what it holds, however much was asked for. */
TEST_WITH(room_that_was_not_used_is_given_back, NULL, scratch_sweep)
{
    struct stat plain, roomy;
    hdf5_file file = open_new();
    assert_ok(hdf5_write_text(&file, "/t", "x"));
    finish(&file);
    assert_int_equal(stat(path, &plain), 0);
    assert_ok(hdf5_open_new(&file, path, 5 << 20));
    assert_int_equal(stat(path, &roomy), 0);
    assert_true(roomy.st_size > 5 << 20);
    assert_ok(hdf5_write_text(&file, "/t", "x"));
    finish(&file);
    assert_int_equal(stat(path, &roomy), 0);
    assert_int_equal(roomy.st_size, plain.st_size);
}

/* RLIMIT_FSIZE stands in for a full disk. */
TEST_WITH(without_room_a_file_stays_as_it_was, NULL, scratch_sweep)
{
    struct rlimit kept, small;
    struct stat before, after;
    CLEANUP(finish) hdf5_file file = open_new();
    assert_ok(hdf5_write_text(&file, "/t", "x"));
    finish(&file);
    assert_int_equal(stat(path, &before), 0);
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &kept), 0);
    small = kept;
    small.rlim_cur = 2 << 20;
    void (*handler)(int) = signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    const dem_status status = hdf5_open_write(&file, path, 4 << 20);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &kept), 0);
    (void)signal(SIGXFSZ, handler);
    assert_int_equal(status, DEM_ERROR_IO);
    assert_message(": there is no room for 5242880 bytes more (File too large)");
    assert_int_equal(stat(path, &after), 0);
    assert_int_equal(after.st_size, before.st_size);
    assert_ok(hdf5_open_read(&file, path));
    expect_text(&file, "/t", "x");
}

TEST_WITH(a_small_file_is_there_when_it_is_closed, NULL, scratch_sweep)
{
    hdf5_file file;
    assert_ok(hdf5_open_small(&file, path));
    assert_ok(hdf5_write_text(&file, "/t", "x"));
    assert_int_equal(access(path, F_OK), -1);
    assert_ok(hdf5_close(&file, DEM_OK));
    assert_ok(hdf5_open_write(&file, path, 0));
    expect_text(&file, "/t", "x");
    assert_ok(hdf5_write_text(&file, "/u", "y"));
    finish(&file);
}

TEST_WITH(a_small_file_without_room_is_none, NULL, scratch_sweep)
{
    struct rlimit kept, small;
    hdf5_file file;
    assert_ok(hdf5_open_small(&file, path));
    assert_ok(hdf5_write_text(&file, "/t", "x"));
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &kept), 0);
    small = kept;
    small.rlim_cur = 100;
    void (*handler)(int) = signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    const dem_status status = hdf5_close(&file, DEM_OK);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &kept), 0);
    (void)signal(SIGXFSZ, handler);
    assert_int_equal(status, DEM_ERROR_IO);
    assert_message(": cannot be written (No space left on device)");
    assert_int_equal(access(path, F_OK), -1);
}

TEST_WITH(closing_passes_a_failure_on, NULL, scratch_sweep)
{
    CLEANUP(finish) hdf5_file file = open_new();
    assert_int_equal(hdf5_close(&file, status_fail(DEM_ERROR_MODEL, "something else")), DEM_ERROR_MODEL);
    assert_string_equal(dem_status_message(), "something else");
    assert_ok(hdf5_open_read(&file, path)); /* it is closed and whole all the same */
}

static herr_t print_nothing(hid_t stack, void *context)
{
    (void)stack, (void)context;
    return 0;
}

static void expect_printing(H5E_auto2_t function, const void *data)
{
    H5E_auto2_t now;
    void *now_data;
    assert_true(H5Eget_auto2(H5E_DEFAULT, &now, &now_data) >= 0);
    assert_true(now == function && now_data == data);
}

TEST_WITH(hdf5_is_silent_while_a_file_is_open_and_prints_again_afterwards, NULL, scratch_sweep)
{
    H5E_auto2_t kept;
    void *kept_data;
    int mark;
    hdf5_file file;
    assert_true(H5Eget_auto2(H5E_DEFAULT, &kept, &kept_data) >= 0);
    assert_true(H5Eset_auto2(H5E_DEFAULT, print_nothing, &mark) >= 0);
    assert_int_equal(hdf5_open_read(&file, path), DEM_ERROR_IO);
    expect_printing(print_nothing, &mark);
    file = open_new();
    expect_printing(NULL, NULL);
    finish(&file);
    expect_printing(print_nothing, &mark);
    file = open_again();
    assert_int_equal(hdf5_close(&file, DEM_ERROR_IO), DEM_ERROR_IO);
    expect_printing(print_nothing, &mark);
    assert_true(H5Eset_auto2(H5E_DEFAULT, kept, kept_data) >= 0);
}

static unsigned plugins(void)
{
    unsigned loaded = 99;
    assert_true(H5PLget_loading_state(&loaded) >= 0);
    return loaded;
}

TEST_WITH(no_plugin_is_loaded_while_a_file_is_open, NULL, scratch_sweep)
{
    static const unsigned before[] = {H5PL_ALL_PLUGIN, 0};
    for (int k = 0; k < 2; k++) {
        hdf5_file file;
        assert_true(H5PLset_loading_state(before[k]) >= 0);
        const unsigned kept = plugins();
        assert_int_equal(hdf5_open_read(&file, path), DEM_ERROR_IO);
        assert_int_equal(plugins(), kept);
        file = open_new();
        assert_int_equal(plugins(), 0);
        finish(&file);
        assert_int_equal(plugins(), kept);
        assert_int_equal(unlink(path), 0);
    }
    assert_true(H5PLset_loading_state(H5PL_ALL_PLUGIN) >= 0);
}

/* ---- publishing ---- */

static void fill(const char *text)
{
    static double value[3000];
    for (int k = 0; k < 3000; k++) value[k] = sqrt(k);
    const hdf5_rows rows = {"/g/deflated", HDF5_F64, 2, {3, 0}, 100, 1};
    CLEANUP(finish) hdf5_file file = open_new();
    assert_ok(hdf5_create(&file, &rows));
    assert_ok(hdf5_append(&file, &rows, 0, 1000, value));
    assert_ok(hdf5_write_text(&file, "/t", text));
    assert_ok(hdf5_write_attribute_text(&file, "/g", "a", text));
}

static size_t read_bytes_of(const char *name, unsigned char **bytes)
{
    FILE *file = fopen(name, "rb");
    assert_non_null(file);
    *bytes = malloc(1 << 20);
    assert_non_null(*bytes);
    const size_t n = fread(*bytes, 1, 1 << 20, file);
    assert_int_equal(fclose(file), 0);
    return n;
}

TEST_WITH(equal_data_makes_equal_files, NULL, scratch_sweep)
{
    unsigned char *a, *b;
    H5O_info_t about;
    hdf5_file file;
    fill("text");
    assert_ok(hdf5_open_read(&file, path));
    assert_true(H5Oget_info_by_name(file.id, "/g/deflated", &about, H5P_DEFAULT) >= 0);
    assert_true(about.mtime == 0 && about.ctime == 0); /* both files are made within one second here */
    finish(&file);
    assert_int_equal(rename(path, other), 0);
    fill("text");
    const size_t n = read_bytes_of(path, &a);
    assert_int_equal(read_bytes_of(other, &b), n);
    assert_memory_equal(a, b, n);
    free(a);
    free(b);
}

/* Opens the same file again and again, a second time within the first; \return how often plugins could be loaded. */
static void *open_and_close(void *unused)
{
    static long faults[2]; /* of each thread one */
    long *faulty = &faults[unused != NULL];
    for (int k = 0; k < 2000; k++) {
        hdf5_file file, within;
        unsigned loaded = 0;
        *faulty += hdf5_open_read(&file, path) != DEM_OK;
        *faulty += hdf5_open_read(&within, path) != DEM_OK || hdf5_close(&within, DEM_OK) != DEM_OK;
        (void)H5PLget_loading_state(&loaded);
        *faulty += loaded != 0;
        *faulty += hdf5_close(&file, DEM_OK) != DEM_OK;
    }
    return faulty;
}

TEST_WITH(threads_take_turns, NULL, scratch_sweep)
{
    pthread_t threads[2];
    fill("text");
    const unsigned before = plugins();
    for (int k = 0; k < 2; k++)
        assert_int_equal(pthread_create(&threads[k], NULL, open_and_close, k == 0 ? NULL : threads), 0);
    for (int k = 0; k < 2; k++) {
        void *faulty;
        assert_int_equal(pthread_join(threads[k], &faulty), 0);
        assert_int_equal(*(long *)faulty, 0);
    }
    assert_int_equal(plugins(), before);
}

TEST_WITH(publishing_renames_and_replaces, NULL, scratch_sweep)
{
    CLEANUP(finish) hdf5_file file;
    fill("old");
    assert_ok(hdf5_publish(path, other));
    fill("new");
    assert_ok(hdf5_publish(path, other));
    assert_int_equal(access(path, F_OK), -1);
    assert_ok(hdf5_open_read(&file, other));
    expect_text(&file, "/t", "new");
}

/* Overwrites the first or last bytes of a deflated chunk, which only reading the data back can notice; at the end its
 * checksum stands. */
static void spoil_a_chunk(bool at_its_end)
{
    static const unsigned char junk[4] = {1};
    hsize_t size = 0, first[2];
    haddr_t address = HADDR_UNDEF;
    unsigned mask;
    hdf5_file file;
    assert_ok(hdf5_open_read(&file, path));
    const hid_t dataset = H5Dopen2(file.id, "/g/deflated", H5P_DEFAULT), space = H5Dget_space(dataset);
    assert_true(H5Dget_chunk_info(dataset, space, 9, first, &mask, &address, &size) >= 0);
    assert_true(size > sizeof junk);
    (void)H5Sclose(space);
    (void)H5Dclose(dataset);
    finish(&file);
    const int descriptor = open(path, O_WRONLY);
    const haddr_t place = at_its_end ? address + size - sizeof junk : address;
    assert_int_equal(pwrite(descriptor, junk, sizeof junk, (off_t)place), sizeof junk);
    assert_int_equal(close(descriptor), 0);
}

TEST_WITH(what_cannot_be_read_back_is_not_published, NULL, scratch_sweep)
{
    fill("old");
    assert_ok(hdf5_publish(path, other));
    for (int k = 0; k < 2; k++) {
        fill("new");
        spoil_a_chunk(k == 1);
        assert_int_equal(hdf5_publish(path, other), DEM_ERROR_IO);
        assert_message_has("a.h5: g/deflated: cannot be read back (");
    }
    assert_int_equal(access(path, F_OK), 0);
    CLEANUP(finish) hdf5_file file;
    assert_ok(hdf5_open_read(&file, other));
    expect_text(&file, "/t", "old");
}

TEST_WITH(a_file_cut_short_is_not_published, NULL, scratch_sweep)
{
    struct stat about;
    fill("x");
    assert_int_equal(stat(path, &about), 0);
    assert_int_equal(truncate(path, about.st_size / 2), 0);
    assert_int_equal(hdf5_publish(path, other), DEM_ERROR_IO);
    assert_message_has("a.h5: cannot be opened (");
    assert_int_equal(access(other, F_OK), -1);
}

TEST_WITH(what_is_not_there_or_has_no_place_is_not_published, NULL, scratch_sweep)
{
    assert_int_equal(hdf5_publish(path, other), DEM_ERROR_IO);
    assert_message(": cannot be opened to sync it (No such file or directory)");
    fill("x");
    assert_int_equal(hdf5_publish(path, "no/such/folder.h5"), DEM_ERROR_IO);
    assert_message(": cannot be renamed to no/such/folder.h5 (No such file or directory)");
    assert_int_equal(access(path, F_OK), 0);
}

SCRATCH_GROUP({&path, "a.h5"}, {&other, "b.h5"});
