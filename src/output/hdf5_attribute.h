/* SPDX-License-Identifier: BSD-3-Clause */
/* What a file says about itself: attributes of its objects, and texts. */
#ifndef DEM_OUTPUT_HDF5_ATTRIBUTE_H
#define DEM_OUTPUT_HDF5_ATTRIBUTE_H

#include "output/hdf5_rows.h"

/** Makes or overwrites an attribute: a scalar for count 1, else [count]. The group `object` is made if need be. */
dem_status hdf5_write_attribute(const hdf5_file *file, const char *object, const char *name, hdf5_kind kind,
                                hsize_t count, const void *data);

/** Makes a scalar ASCII attribute of fixed length without a terminator. */
dem_status hdf5_write_attribute_text(const hdf5_file *file, const char *object, const char *name, const char *text);

/** Makes or replaces a scalar UTF-8 string of fixed length. */
dem_status hdf5_write_text(const hdf5_file *file, const char *name, const char *text);

/** Reads such a string and terminates it; DEM_ERROR_ARGUMENT if it needs more than `size` bytes. */
dem_status hdf5_read_text(const hdf5_file *file, const char *name, char *text, size_t size);

/** DEM_ERROR_IO unless the scalar integer attribute is `value`. */
dem_status hdf5_expect_attribute(const hdf5_file *file, const char *object, const char *name, int64_t value);

#endif
