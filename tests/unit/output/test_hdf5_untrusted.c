/* SPDX-License-Identifier: BSD-3-Clause */
/* hdf5_untrusted.c: what is believed of a file and what is not. More of it in test_lattice_file.c and
 * test_trajectory_reader.c. */
#include "unit/output/stored.h"

#include "harness/cleanup_hdf5.h"
#include "output/hdf5_attribute.h"
#include "output/hdf5_untrusted.h"

#define REFUSED(call, reason)                                                                                          \
    do {                                                                                                               \
        assert_int_equal((call), DEM_ERROR_IO);                                                                        \
        if (strstr(dem_status_message(), reason) == NULL) fail_msg("'%s', not '%s'", dem_status_message(), reason);    \
    } while (0)

static const double numbers[12] = {0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0};

static int open_stored(void **state)
{
    stored *s = calloc(1, sizeof *s);
    assert_non_null(s);
    stored_open(s);
    assert_ok(hdf5_write(&s->file, (hdf5_rows){"/a/b/of_three", HDF5_F32, 3, {3, 2}, 0, 1}, 2, numbers));
    *state = s;
    return 0;
}

static int close_stored(void **state)
{
    stored_close(*state);
    free(*state);
    return 0;
}

/* A dataset without numbers in it. */
static void make(const stored *s, const char *name, hid_t type, hid_t space, hid_t layout)
{
    CLEANUP(free_h5) const hid_t dataset = H5Dcreate2(s->file.id, name, type, space, H5P_DEFAULT, layout, H5P_DEFAULT);
    assert_true(dataset >= 0);
    (void)H5Sclose(space);
}

TEST_WITH(shape_and_numbers_are_found, open_stored, close_stored)
{
    const stored *s = *test_state;
    hdf5_untrusted_shape shape;
    double found[8] = {0.0};
    bool present = false;
    assert_ok(hdf5_untrusted_find(&s->file, "/a/b/of_three", &present));
    assert_true(present);
    assert_ok(hdf5_untrusted_measure(&s->file, "/a/b/of_three", HDF5_F64, &shape));
    assert_int_equal(shape.stored, HDF5_F32);
    assert_int_equal(shape.rank, 3);
    assert_true(shape.extent[0] == 2 && shape.extent[1] == 3 && shape.extent[2] == 2);
    assert_ok(hdf5_untrusted_read(&s->file, "/a/b/of_three", HDF5_F64, (hdf5_untrusted_rows){1, 1, 0}, found));
    assert_memory_equal(found, numbers + 6, 6 * sizeof *found);
    assert_ok(hdf5_untrusted_read(&s->file, "/a/b/of_three", HDF5_F64, (hdf5_untrusted_rows){1, 1, 2}, found));
    assert_memory_equal(found, numbers + 6, 4 * sizeof *found);
    assert_ok(hdf5_untrusted_read(&s->file, "/a/b/of_three", HDF5_F64, (hdf5_untrusted_rows){7, 0, 0}, found));
    REFUSED(hdf5_untrusted_read(&s->file, "/a/b/of_three", HDF5_F64, (hdf5_untrusted_rows){2, 1, 0}, found),
            "cannot be read");
}

TEST_WITH(rows_of_deflated_chunks_are_a_unit, open_stored, close_stored)
{
    const stored *s = *test_state;
    static const struct {
        hdf5_rows rows;
        hsize_t unit;
    } cases[] = {{{"/deflated", HDF5_F64, 1, {0}, 3, 1}, 3}, {{"/plain", HDF5_F64, 2, {2}, 3, 0}, 1}};
    hdf5_untrusted_shape shape;
    for (int k = 0; k < 2; k++) {
        assert_ok(hdf5_write(&s->file, cases[k].rows, 5, numbers));
        assert_ok(hdf5_untrusted_measure(&s->file, cases[k].rows.name, HDF5_F64, &shape));
        assert_int_equal(shape.unit, cases[k].unit);
    }
    make(s, "/contiguous", H5T_IEEE_F64LE, H5Screate_simple(1, (hsize_t[1]){0}, NULL), H5P_DEFAULT);
    assert_ok(hdf5_untrusted_measure(&s->file, "/contiguous", HDF5_F64, &shape));
    assert_int_equal(shape.unit, 1);
}

TEST_WITH(a_number_that_does_not_fit_is_refused, open_stored, close_stored)
{
    const stored *s = *test_state;
    const int64_t wholes[2] = {255, 256};
    unsigned char found[2] = {0};
    assert_ok(hdf5_write(&s->file, (hdf5_rows){"/c", HDF5_I64, 1, {0}, 0, 0}, 2, wholes));
    assert_ok(hdf5_untrusted_read(&s->file, "/c", HDF5_U8, (hdf5_untrusted_rows){0, 1, 0}, found));
    assert_int_equal(found[0], 255);
    REFUSED(hdf5_untrusted_read(&s->file, "/c", HDF5_U8, (hdf5_untrusted_rows){0, 2, 0}, found),
            "/c: cannot be read (can't handle conversion exception)");
}

TEST_WITH(what_is_not_there_is_absent, open_stored, close_stored)
{
    const stored *s = *test_state;
    static const char *const names[] = {"/b", "/a/c", "/a/c/d", "/a/b/of_three/d"};
    hdf5_untrusted_shape shape;
    for (size_t k = 0; k < sizeof names / sizeof names[0]; k++) {
        bool present = true;
        assert_ok(hdf5_untrusted_find(&s->file, names[k], &present));
        assert_false(present);
    }
    REFUSED(hdf5_untrusted_measure(&s->file, "/a/c", HDF5_F64, &shape), "/a/c: is not a readable dataset");
}

TEST_WITH(links_on_the_way_are_refused, open_stored, close_stored)
{
    const stored *s = *test_state;
    bool present;
    assert_true(H5Lcreate_soft("/a", s->file.id, "/soft", H5P_DEFAULT, H5P_DEFAULT) >= 0);
    assert_true(H5Lcreate_external("other.h5", "/a", s->file.id, "/a/out", H5P_DEFAULT, H5P_DEFAULT) >= 0);
    REFUSED(hdf5_untrusted_find(&s->file, "/soft/b", &present), "/soft: is a soft or external link");
    REFUSED(hdf5_untrusted_find(&s->file, "/a/out", &present), "/a/out: is a soft or external link");
}

TEST_WITH(types_are_reported_and_checked, open_stored, close_stored)
{
    const stored *s = *test_state;
    const struct {
        hid_t type;
        hdf5_kind stored;
        const char *not_whole;
    } types[] = {{H5T_STD_U16BE, HDF5_I32, NULL},
                 {H5T_STD_I8LE, HDF5_I8, NULL},
                 {H5T_STD_U8LE, HDF5_U8, NULL},
                 {H5T_STD_U64LE, HDF5_I64, NULL},
                 {H5T_IEEE_F32BE, HDF5_F32, "is not integer"},
                 {H5T_NATIVE_LDOUBLE, HDF5_F64, "is not integer"}};
    for (size_t k = 0; k < sizeof types / sizeof types[0]; k++) {
        char name[8];
        hdf5_untrusted_shape shape;
        (void)snprintf(name, sizeof name, "/%zu", k);
        make(s, name, types[k].type, H5Screate_simple(1, (hsize_t[]){0}, NULL), H5P_DEFAULT);
        assert_ok(hdf5_untrusted_measure(&s->file, name, HDF5_F64, &shape));
        assert_int_equal(shape.stored, types[k].stored);
        if (types[k].not_whole != NULL)
            REFUSED(hdf5_untrusted_measure(&s->file, name, HDF5_I64, &shape), types[k].not_whole);
        else
            assert_ok(hdf5_untrusted_measure(&s->file, name, HDF5_I64, &shape));
    }
}

TEST_WITH(a_shape_of_another_kind_has_no_rank, open_stored, close_stored)
{
    const stored *s = *test_state;
    const hid_t spaces[] = {H5Screate(H5S_SCALAR), H5Screate(H5S_NULL),
                            H5Screate_simple(4, (hsize_t[]){1, 1, 1, 1}, NULL)};
    for (size_t k = 0; k < sizeof spaces / sizeof spaces[0]; k++) {
        char name[8];
        hdf5_untrusted_shape shape;
        (void)snprintf(name, sizeof name, "/%zu", k);
        make(s, name, H5T_IEEE_F64LE, spaces[k], H5P_DEFAULT);
        assert_ok(hdf5_untrusted_measure(&s->file, name, HDF5_F64, &shape));
        assert_int_equal(shape.rank, 0);
    }
}

TEST_WITH(sizes_are_borne_out_by_bytes, open_stored, close_stored)
{
    const stored *s = *test_state;
    const hsize_t large[2] = {(hsize_t)1 << 41, 2}, wide[2] = {1, (hsize_t)1 << 45}, some[1] = {4},
                  chunk[1] = {1 << 20};
    CLEANUP(free_h5) const hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
    hdf5_untrusted_shape shape;
    make(s, "/large", H5T_IEEE_F64LE, H5Screate_simple(2, large, NULL), H5P_DEFAULT);
    REFUSED(hdf5_untrusted_measure(&s->file, "/large", HDF5_F64, &shape), "/large: has more than 2^40 rows");
    make(s, "/wide", H5T_IEEE_F64LE, H5Screate_simple(2, wide, NULL), H5P_DEFAULT);
    REFUSED(hdf5_untrusted_measure(&s->file, "/wide", HDF5_F64, &shape), "/wide: has more than 2^44 numbers");
    make(s, "/empty", H5T_IEEE_F64LE, H5Screate_simple(1, some, NULL), H5P_DEFAULT);
    REFUSED(hdf5_untrusted_measure(&s->file, "/empty", HDF5_F64, &shape),
            "/empty: claims more data than the file holds");
    (void)H5Pset_chunk(layout, 1, chunk);
    (void)H5Pset_deflate(layout, 9);
    make(s, "/chunk", H5T_IEEE_F64LE, H5Screate_simple(1, some, (hsize_t[]){H5S_UNLIMITED}), layout);
    const hid_t dataset = H5Dopen2(s->file.id, "/chunk", H5P_DEFAULT); /* 8 MiB for four numbers, of 16 bytes */
    const uint32_t no_filter = 0;
    assert_true(H5Dwrite_chunk(dataset, H5P_DEFAULT, no_filter, (hsize_t[]){0}, 16, numbers) >= 0);
    (void)H5Dclose(dataset);
    REFUSED(hdf5_untrusted_measure(&s->file, "/chunk", HDF5_F64, &shape),
            "/chunk: claims more data than the file holds");
}

TEST_WITH(attributes_are_single_and_of_their_kind, open_stored, close_stored)
{
    const stored *s = *test_state;
    const double half = 0.5, pair[2] = {1.0, 2.0};
    const int64_t seven = 7;
    double real = 0.0;
    int64_t whole = 0;
    char text[8];
    assert_ok(hdf5_write_attribute(&s->file, "/a", "half", HDF5_F64, 1, &half));
    assert_ok(hdf5_write_attribute(&s->file, "/a", "pair", HDF5_F64, 2, pair));
    assert_ok(hdf5_write_attribute(&s->file, "/a", "seven", HDF5_I64, 1, &seven));
    assert_ok(hdf5_write_attribute_text(&s->file, "/a", "word", "coulomb"));
    assert_ok(hdf5_write_attribute_text(&s->file, "/a", "words", "coulomb "));
    assert_ok(hdf5_untrusted_read_attribute(&s->file, "/a", "half", HDF5_F64, &real));
    assert_ok(hdf5_untrusted_read_attribute(&s->file, "/a", "seven", HDF5_I64, &whole));
    assert_ok(hdf5_untrusted_read_attribute_text(&s->file, "/a", "word", text, sizeof text));
    assert_close(real, 0.5, 0.0);
    assert_int_equal(whole, 7);
    assert_string_equal(text, "coulomb");
    REFUSED(hdf5_untrusted_read_attribute(&s->file, "/a", "pair", HDF5_F64, &real),
            "/a: has no attribute pair that is a number");
    REFUSED(hdf5_untrusted_read_attribute(&s->file, "/a", "half", HDF5_I64, &whole), "half that is an integer");
    REFUSED(hdf5_untrusted_read_attribute(&s->file, "/a", "word", HDF5_F64, &real), "word that is a number");
    REFUSED(hdf5_untrusted_read_attribute(&s->file, "/b", "half", HDF5_F64, &real), "/b: has no attribute half");
    REFUSED(hdf5_untrusted_read_attribute_text(&s->file, "/a", "half", text, sizeof text),
            "half that is a short string");
    REFUSED(hdf5_untrusted_read_attribute_text(&s->file, "/a", "words", text, sizeof text),
            "words that is a short string");
}

static dem_status count_names(void *context, const char *name)
{
    int *left = context;
    assert_true(strlen(name) == 1);
    return --*left >= 0 ? DEM_OK : DEM_STOPPED;
}

TEST_WITH(names_are_listed_until_one_is_not_taken, open_stored, close_stored)
{
    const stored *s = *test_state;
    int left = 2;
    assert_ok(hdf5_write(&s->file, (hdf5_rows){"/b", HDF5_F64, 1, {0}, 0, 0}, 1, numbers));
    assert_ok(hdf5_untrusted_list(&s->file, "/", count_names, &left));
    assert_int_equal(left, 0);
    assert_int_equal(hdf5_untrusted_list(&s->file, "/", count_names, &left), DEM_STOPPED);
    REFUSED(hdf5_untrusted_list(&s->file, "/b", count_names, &left), "/b: is not a readable group");
}

TEST(names_are_printed_safely_and_in_part)
{
    char out[HDF5_UNTRUSTED_PRINTABLE];
    hdf5_untrusted_print(out, "a b\n\x1b[0m\xff");
    assert_string_equal(out, "a?b??[0m?");
    hdf5_untrusted_print(out, "0123456789012345678901234567890123456789012345");
    assert_string_equal(out, "0123456789012345678901234567890123456789");
}

TEST(only_regular_files_are_opened)
{
    hdf5_file file;
    REFUSED(hdf5_untrusted_open(&file, "."), ".: is not a regular file");
    REFUSED(hdf5_untrusted_open(&file, "none.h5"), "none.h5: cannot be opened (No such file or directory)");
}
