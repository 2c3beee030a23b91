/* SPDX-License-Identifier: BSD-3-Clause */
/* Lattice files that others wrote, dataset by dataset. A test says before what its file is: WRITTEN_PATH. */
#ifndef DEM_TEST_WRITTEN_H
#define DEM_TEST_WRITTEN_H

#include "unit/close.h"

#include "harness/cleanup_hdf5.h"

#include <stdint.h>
#include <unistd.h>

static const char path[] = WRITTEN_PATH;

/* Two triangles that share the edge 0-2, as a square 0 1 2 3 with node 4 in the middle of nothing but a spring. */
static const double x[10] = {0, 0, 1, 0, 1, 1, 0, 1, 0.5, 2};
static const double ones[6] = {1, 1, 1, 1, 1, 1};
static const int64_t ends[12] = {0, 1, 1, 2, 2, 3, 3, 0, 0, 2, 3, 4};
static const int64_t corners[6] = {0, 1, 2, 0, 2, 3};

/* ---- writing such files ---- */

static inline hid_t open_group(void)
{
    const hid_t file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
    assert_true(file >= 0);
    const hid_t group = H5Gopen2(file, "lattice", H5P_DEFAULT);
    assert_true(group >= 0);
    (void)H5Fclose(file); /* the group keeps it open */
    return group;
}

/* Replaces a dataset; width 0 makes it of rank 1. */
static inline void put_as(const char *name, hid_t layout, hid_t stored, hid_t given, hsize_t n, hsize_t width,
                          const void *data)
{
    CLEANUP(free_h5)
    const hid_t group = open_group(), space = H5Screate_simple(width > 0 ? 2 : 1, (hsize_t[2]){n, width}, NULL);
    if (H5Lexists(group, name, H5P_DEFAULT) > 0) assert_true(H5Ldelete(group, name, H5P_DEFAULT) >= 0);
    CLEANUP(free_h5) const hid_t dataset = H5Dcreate2(group, name, stored, space, H5P_DEFAULT, layout, H5P_DEFAULT);
    assert_true(dataset >= 0);
    if (data != NULL) assert_true(H5Dwrite(dataset, given, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0);
}

static inline void put_real(const char *name, hsize_t n, hsize_t width, const double *data)
{
    put_as(name, H5P_DEFAULT, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, n, width, data);
}

static inline void put_whole(const char *name, hsize_t n, hsize_t width, const int64_t *data)
{
    put_as(name, H5P_DEFAULT, H5T_STD_I64LE, H5T_NATIVE_INT64, n, width, data);
}

/* Five flags, the second of them set, as h5py stores booleans if the names are FALSE and TRUE. */
static inline void put_flags(const char *name, const char *no, const char *yes)
{
    CLEANUP(free_h5) const hid_t type = H5Tenum_create(H5T_NATIVE_INT8);
    assert_true(H5Tenum_insert(type, no, &(signed char){0}) >= 0);
    assert_true(H5Tenum_insert(type, yes, &(signed char){1}) >= 0);
    put_as(name, H5P_DEFAULT, type, type, 5, 0, (const signed char[5]){0, 1, 0, 0, 0});
}

static inline void drop(const char *name)
{
    CLEANUP(free_h5) const hid_t group = open_group();
    assert_true(H5Ldelete(group, name, H5P_DEFAULT) >= 0);
}

/* The datasets that every lattice has. */
static inline int write_lattice(void **state)
{
    (void)state;
    const hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t group = H5Gcreate2(file, "lattice", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    (void)H5Gclose(group);
    (void)H5Fclose(file);
    put_real("x", 5, 2, x);
    put_real("mass", 5, 0, ones);
    put_whole("ends", 6, 2, ends);
    put_real("rest_length", 6, 0, ones);
    put_real("stiffness", 6, 0, ones);
    return 0;
}

static inline int remove_lattice(void **state)
{
    (void)state;
    return unlink(path);
}

#endif
