/* SPDX-License-Identifier: BSD-3-Clause */
/* table.c: rows whose cells are functions of their number, and what becomes of them in the file. */
#include "verification/support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <unistd.h>

#include "harness/cleanup_hdf5.h"
#include "output/table.h"
#include "unit/scratch.h"

enum { most_cells = 1 << 14, n_columns = 5 };

static const table_column columns[n_columns] = {{"/rows/real", HDF5_F64, 0, 1},
                                                {"/rows/whole", HDF5_I64, 0, 1},
                                                {"/rows/vector", HDF5_F64, 0, 2},
                                                {"/rows/vectors", HDF5_F64, 1, 2},
                                                {"/rows/wholes", HDF5_I64, 2, 1}};
static const char *path;

typedef struct stored {
    table table;
    hdf5_file file;
} stored;

static stored begin(dem_index first, dem_index second)
{
    stored s;
    const dem_index count[TABLE_SETS - 1] = {first, second, 0};
    assert_ok(table_init(&s.table, columns, n_columns, count));
    assert_ok(hdf5_open_new(&s.file, path, table_bytes(&s.table)));
    assert_ok(table_create(&s.table, &s.file));
    return s;
}

static void end(stored *s)
{
    assert_ok(hdf5_close(&s->file, DEM_OK));
    table_free(&s->table);
    assert_int_equal(unlink(path), 0);
}

/* Cell k of row n is n + k/64, of columns of wholes 1000 n + k. */
static double real_of(hsize_t row, hsize_t k)
{
    return (double)row + (double)k / 64.0;
}

static dem_index whole_of(hsize_t row, hsize_t k)
{
    return (dem_index)(1000 * row + k);
}

static void add(stored *s, hsize_t row)
{
    table_cell *cell = table_add(&s->table);
    for (int c = 0; c < n_columns; c++) {
        const hsize_t width = s->table.count[columns[c].of] * columns[c].components;
        for (hsize_t k = 0; k < width; k++)
            cell = columns[c].kind == HDF5_F64 ? table_put_reals(cell, (const double[]){real_of(row, k)}, 1)
                                               : table_put_wholes(cell, (const dem_index[]){whole_of(row, k)}, 1);
    }
}

static void add_rows(stored *s, hsize_t first, hsize_t n)
{
    for (hsize_t row = first; row < first + n; row++) add(s, row);
}

/* ---- looking into the file ---- */

typedef struct dataset {
    int rank;
    hsize_t extent[3];
    int is_integer;
    double value[most_cells];
} dataset;

static const dataset *look(const stored *s, const char *name)
{
    static dataset d;
    CLEANUP(free_h5) const hid_t id = H5Dopen2(s->file.id, name, H5P_DEFAULT);
    if (id < 0) fail_msg("there is no %s", name);
    CLEANUP(free_h5) const hid_t space = H5Dget_space(id), type = H5Dget_type(id);
    d.extent[0] = d.extent[1] = d.extent[2] = 1;
    d.rank = H5Sget_simple_extent_dims(space, d.extent, NULL);
    d.is_integer = H5Tget_class(type) == H5T_INTEGER;
    assert_in_range(H5Sget_simple_extent_npoints(space), 0, most_cells);
    assert_true(H5Dread(id, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, d.value) >= 0);
    return &d;
}

static void expect_rows(const stored *s, hsize_t n_rows)
{
    for (int c = 0; c < n_columns; c++) {
        const hsize_t width = s->table.count[columns[c].of] * columns[c].components;
        if (width == 0) continue;
        const dataset *d = look(s, columns[c].name);
        assert_int_equal(d->extent[0], n_rows);
        for (hsize_t k = 0; k < n_rows * width; k++) {
            const hsize_t row = k / width, cell = k % width;
            assert_close(d->value[k], d->is_integer ? (double)whole_of(row, cell) : real_of(row, cell), 0.0);
        }
    }
}

static hsize_t stored_bytes(const stored *s)
{
    hsize_t n = 0;
    for (int c = 0; c < n_columns; c++) {
        CLEANUP(free_h5) const hid_t id = H5Dopen2(s->file.id, columns[c].name, H5P_DEFAULT);
        n += H5Dget_storage_size(id);
    }
    return n;
}

/* ---- columns ---- */

/* One index for what a row tells of, one for the components of a vector; counts are integers. */
TEST(columns_have_the_shapes_of_what_they_tell)
{
    static const struct {
        int is_integer, rank;
        hsize_t extent[3];
    } shapes[n_columns] = {
        {0, 1, {1, 1, 1}}, {1, 1, {1, 1, 1}}, {0, 2, {1, 2, 1}}, {0, 3, {1, 3, 2}}, {1, 2, {1, 1, 1}}};
    CLEANUP(end) stored s = begin(3, 1);
    add(&s, 0);
    assert_ok(table_flush(&s.table, &s.file));
    for (int c = 0; c < n_columns; c++) {
        const dataset *d = look(&s, columns[c].name);
        assert_int_equal(d->is_integer, shapes[c].is_integer);
        assert_int_equal(d->rank, shapes[c].rank);
        assert_memory_equal(d->extent, shapes[c].extent, sizeof d->extent);
    }
    expect_rows(&s, 1);
}

TEST(what_there_is_none_of_has_no_column)
{
    CLEANUP(end) stored s = begin(2, 0);
    add_rows(&s, 0, 2);
    assert_ok(table_flush(&s.table, &s.file));
    assert_int_equal(H5Lexists(s.file.id, "/rows/wholes", H5P_DEFAULT), 0);
    assert_true(H5Lexists(s.file.id, "/rows/vectors", H5P_DEFAULT) > 0);
    expect_rows(&s, 2);
    assert_ok(table_verify(&s.table, &s.file, s.table.written));
}

TEST(a_table_without_columns_is_never_written)
{
    CLEANUP(end) stored s = begin(1, 1);
    CLEANUP(table_free) table none = {0};
    assert_int_equal(table_bytes(&none), 0);
    assert_ok(table_create(&none, &s.file));
    assert_ok(table_flush(&none, &s.file));
    assert_ok(table_verify(&none, &s.file, 0));
}

TEST(columns_are_made_once)
{
    CLEANUP(end) stored s = begin(1, 1);
    assert_int_equal(table_create(&s.table, &s.file), DEM_ERROR_IO);
    assert_non_null(strstr(dem_status_message(), "/rows/real: cannot be created"));
}

/* The last chunk is written again at every flush: deflated it would move and leave a hole. */
TEST(a_chunk_is_a_buffer_and_stored_plain)
{
    hsize_t chunk[3] = {0};
    CLEANUP(end) stored s = begin(2, 1);
    CLEANUP(free_h5)
    const hid_t id = H5Dopen2(s.file.id, "/rows/vectors", H5P_DEFAULT), layout = H5Dget_create_plist(id);
    assert_int_equal(H5Pget_nfilters(layout), 0);
    assert_int_equal(H5Pget_chunk(layout, 3, chunk), 3);
    assert_int_equal(chunk[0], TABLE_ROWS);
}

/* ---- buffer ---- */

TEST(flushing_goes_on_where_it_ended)
{
    CLEANUP(end) stored s = begin(2, 3);
    hsize_t n = 0;
    for (hsize_t piece = 0; piece < 4; n += piece++) {
        add_rows(&s, n, piece);
        assert_int_equal(s.table.buffered, piece);
        assert_ok(table_flush(&s.table, &s.file));
        assert_int_equal(s.table.buffered, 0);
        assert_int_equal(s.table.written, n + piece);
        assert_ok(table_verify(&s.table, &s.file, s.table.written));
    }
    expect_rows(&s, 6);
}

TEST(a_full_buffer_is_written_and_takes_no_more_room_than_said)
{
    CLEANUP(end) stored s = begin(2, 1);
    hsize_t before = 0, n = 0;
    for (int piece = 0; piece < 3; piece++) {
        const hsize_t rows = piece == 0 ? TABLE_ROWS / 2 : TABLE_ROWS;
        add_rows(&s, n, rows);
        n += rows;
        assert_ok(table_flush(&s.table, &s.file));
        const hsize_t now = stored_bytes(&s);
        assert_in_range(now - before, 1, table_bytes(&s.table));
        before = now;
    }
    expect_rows(&s, n);
    assert_ok(table_verify(&s.table, &s.file, s.table.written));
}

/* ---- failures ---- */

static void cut(const stored *s, const char *name, hsize_t rows)
{
    hsize_t extent[3] = {0};
    CLEANUP(free_h5) const hid_t id = H5Dopen2(s->file.id, name, H5P_DEFAULT), space = H5Dget_space(id);
    (void)H5Sget_simple_extent_dims(space, extent, NULL);
    extent[0] = rows;
    assert_true(H5Dset_extent(id, extent) >= 0);
}

TEST(a_lost_row_or_column_is_noticed)
{
    CLEANUP(end) stored s = begin(1, 1);
    add_rows(&s, 0, 3);
    assert_ok(table_flush(&s.table, &s.file));
    cut(&s, "/rows/wholes", 2);
    assert_int_equal(table_verify(&s.table, &s.file, s.table.written), DEM_ERROR_IO);
    assert_non_null(strstr(dem_status_message(), "/rows/wholes: has 2 rows, 3 were written"));
    assert_true(H5Ldelete(s.file.id, "/rows/whole", H5P_DEFAULT) >= 0);
    assert_int_equal(table_verify(&s.table, &s.file, s.table.written), DEM_ERROR_IO);
    assert_non_null(strstr(dem_status_message(), "/rows/whole: cannot be opened"));
}

TEST(rows_that_could_not_be_written_stay_in_the_buffer)
{
    CLEANUP(end) stored s = begin(1, 1);
    add_rows(&s, 0, 2);
    assert_ok(hdf5_close(&s.file, DEM_OK));
    assert_ok(hdf5_open_read(&s.file, path));
    assert_int_equal(table_flush(&s.table, &s.file), DEM_ERROR_IO);
    assert_non_null(strstr(dem_status_message(), "/rows/real: cannot be written"));
    assert_int_equal(s.table.buffered, 2);
    assert_int_equal(s.table.written, 0);
    assert_ok(hdf5_close(&s.file, DEM_OK));
    assert_ok(hdf5_open_write(&s.file, path, table_bytes(&s.table)));
    assert_ok(table_flush(&s.table, &s.file));
    assert_ok(table_verify(&s.table, &s.file, s.table.written));
    expect_rows(&s, 2);
}

SCRATCH_GROUP({&path, "a.h5"});
