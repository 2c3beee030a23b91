/* SPDX-License-Identifier: BSD-3-Clause */
/* chunkwise.c: datasets of more rows than a piece has are the rows one behind the other, in chunks that end there. */
#include "verification/support.h"

#include <stddef.h>
#include <stdlib.h>

#include "output/chunkwise.h"
#include "unit/output/found.h"
#include "unit/scratch.h"

enum { MANY = 150001 };

static const char *path;

static void fill_squares(const void *context, hsize_t first, hsize_t n, void *rows)
{
    double *row = rows;
    (void)context;
    for (hsize_t k = 0; k < n; k++) row[k] = (double)((first + k) * (first + k));
}

/* Rows of a chunk; HDF5 reads them all. */
static hsize_t read_all(const hdf5_file *file, const char *name, hid_t type, void *out)
{
    hsize_t chunk = 0;
    const hid_t id = H5Dopen2(file->id, name, H5P_DEFAULT), layout = H5Dget_create_plist(id);
    assert_true(H5Dread(id, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, out) >= 0);
    assert_int_equal(H5Pget_chunk(layout, 1, &chunk), 1);
    (void)H5Pclose(layout);
    (void)H5Dclose(id);
    return chunk;
}

TEST(rows_are_filled_in)
{
    CLEANUP(free_memory) double *row = malloc(MANY * sizeof *row);
    const hdf5_rows rows = {"/squares", HDF5_F64, 1, {0}, 0, 1};
    hdf5_file file;
    assert_ok(hdf5_open_new(&file, path, 1 << 20));
    assert_ok(chunkwise_fill(&file, rows, MANY, fill_squares, NULL));
    assert_int_equal(read_all(&file, "/squares", H5T_NATIVE_DOUBLE, row), ROWS_CHUNK);
    for (dem_index k = 0; k < MANY; k++) assert_true(row[k] == (double)(k * k));
    assert_ok(hdf5_close(&file, DEM_OK));
}

TEST(an_item_may_give_several_rows)
{
    CLEANUP(free_memory) dem_index *ends = malloc(2 * MANY * sizeof *ends), *row = malloc(2 * MANY * sizeof *row);
    const hdf5_rows rows = {"/ends", HDF5_I64, 1, {0}, 0, 1};
    dem_lattice l = dem_lattice_empty();
    const lattice_source from = {.lattice = &l};
    hdf5_file file;
    for (dem_index k = 0; k < 2 * MANY; k++) ends[k] = k * 7 % 5;
    l.n_springs = MANY;
    l.ends = ends;
    assert_ok(hdf5_open_new(&file, path, 1 << 20));
    assert_ok(chunkwise_copy(&file, rows, &from, offsetof(dem_lattice, ends), MANY, 2));
    assert_int_equal(read_all(&file, "/ends", H5T_NATIVE_INT64, row), 2 * ROWS_CHUNK);
    assert_memory_equal(row, ends, 2 * MANY * sizeof *ends);
    assert_ok(hdf5_close(&file, DEM_OK));
}

TEST(there_may_be_no_rows)
{
    const hdf5_rows rows = {"/squares", HDF5_F64, 1, {0}, 0, 1};
    hdf5_file file;
    assert_ok(hdf5_open_new(&file, path, 4096));
    assert_ok(chunkwise_fill(&file, rows, 0, fill_squares, NULL));
    found_reals(&file, "/squares", NULL, 0);
    assert_ok(hdf5_close(&file, DEM_OK));
}

SCRATCH_GROUP({&path, "a.h5"});
