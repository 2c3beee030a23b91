/* SPDX-License-Identifier: BSD-3-Clause */
/* A file that a test writes through hdf5_file.h, and what HDF5 itself finds in it. */
#ifndef DEM_TEST_STORED_H
#define DEM_TEST_STORED_H

#include "verification/support.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "output/hdf5_file.h"
#include "unit/output/found.h"
#include "unit/scratch.h"

enum { STORED_VALUES = 4096 };

typedef struct stored {
    scratch_folder folder;
    const char *path;
    hdf5_file file;
} stored;

static inline void stored_open(stored *s)
{
    folder_open(&s->folder);
    s->path = folder_file(&s->folder, "a.h5");
    assert_ok(hdf5_open_new(&s->file, s->path, 1 << 20));
}

static inline void stored_close(stored *s)
{
    assert_ok(hdf5_close(&s->file, DEM_OK));
    folder_close(&s->folder);
}

static inline int stored_has(const stored *s, const char *name)
{
    return H5Lexists(s->file.id, name, H5P_DEFAULT) > 0;
}

/** The values of a dataset; fails unless it has the extents and, if bytes > 0, numbers of that size. */
static inline const double *stored_values(const stored *s, const char *name, hsize_t rows, hsize_t width, size_t bytes)
{
    static double values[STORED_VALUES];
    hsize_t extent[3] = {0, 1, 1};
    const hid_t id = H5Dopen2(s->file.id, name, H5P_DEFAULT);
    if (id < 0) fail_msg("there is no %s", name);
    const hid_t space = H5Dget_space(id), type = H5Dget_type(id);
    assert_int_equal(H5Sget_simple_extent_dims(space, extent, NULL), width > 1 ? 2 : 1);
    if (extent[0] != rows || extent[1] != width)
        fail_msg("%s is of %llu x %llu", name, (unsigned long long)extent[0], (unsigned long long)extent[1]);
    if (bytes > 0) assert_int_equal(H5Tget_size(type), bytes);
    assert_true(rows * width <= STORED_VALUES);
    assert_true(H5Dread(id, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0);
    (void)H5Tclose(type);
    (void)H5Sclose(space);
    (void)H5Dclose(id);
    return values;
}

/** An attribute of n whole numbers. */
static inline void stored_expect_wholes(const stored *s, const char *object, const char *name, int n,
                                        const dem_index *expected)
{
    dem_index found[4] = {0};
    const hid_t id = H5Aopen_by_name(s->file.id, object, name, H5P_DEFAULT, H5P_DEFAULT);
    if (id < 0) fail_msg("%s has no %s", object, name);
    const hid_t space = H5Aget_space(id);
    assert_int_equal(H5Sget_simple_extent_npoints(space), n);
    assert_true(H5Aread(id, H5T_NATIVE_INT64, found) >= 0);
    for (int k = 0; k < n; k++) assert_int_equal(found[k], expected[k]);
    (void)H5Sclose(space);
    (void)H5Aclose(id);
}

#endif
