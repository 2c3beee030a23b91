/* SPDX-License-Identifier: BSD-3-Clause */
/* What HDF5 itself finds in a file that is open. */
#ifndef DEM_TEST_FOUND_H
#define DEM_TEST_FOUND_H

#include "unit/close.h"

#include "output/hdf5_file.h"

enum { FOUND_VALUES = 32 };

/** A dataset of n numbers. */
static inline void found_reals(const hdf5_file *file, const char *name, const double *expected, hsize_t n)
{
    double value[FOUND_VALUES] = {0.0};
    const hid_t id = H5Dopen2(file->id, name, H5P_DEFAULT);
    if (id < 0) fail_msg("there is no %s", name);
    const hid_t space = H5Dget_space(id);
    assert_true(n <= FOUND_VALUES);
    assert_int_equal(H5Sget_simple_extent_npoints(space), n);
    assert_true(H5Dread(id, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, value) >= 0);
    for (hsize_t k = 0; k < n; k++) assert_close(value[k], expected[k], 0.0);
    (void)H5Sclose(space);
    (void)H5Dclose(id);
}

/** A text attribute. */
static inline void found_text(const hdf5_file *file, const char *object, const char *name, const char *expected)
{
    char text[64] = "";
    const hid_t id = H5Aopen_by_name(file->id, object, name, H5P_DEFAULT, H5P_DEFAULT);
    if (id < 0) fail_msg("%s has no %s", object, name);
    const hid_t type = H5Aget_type(id);
    assert_true(H5Tget_size(type) < sizeof text);
    assert_true(H5Aread(id, type, text) >= 0);
    assert_string_equal(text, expected);
    (void)H5Tclose(type);
    (void)H5Aclose(id);
}

#endif
