/* SPDX-License-Identifier: BSD-3-Clause */
/* HDF5 files that may come from anywhere: links, types, extents, layouts and filters are checked before anything is
 * allocated or read, and a size is believed only as far as the bytes in the file can hold it. */
#ifndef DEM_OUTPUT_HDF5_UNTRUSTED_H
#define DEM_OUTPUT_HDF5_UNTRUSTED_H

#include <stdbool.h>

#include "output/hdf5_rows.h"

enum {
    HDF5_UNTRUSTED_PRINTABLE = 41 /**< bytes */
};

typedef struct hdf5_untrusted_shape {
    hdf5_kind stored;              /**< type of the numbers in the file, or the nearest one of ours */
    int rank;                      /**< 1 to 3; 0: another shape, which is none of this library's */
    hsize_t extent[HDF5_MAX_RANK]; /**< 1 beyond the rank */
    hsize_t unit;                  /**< rows that are unpacked together: those of a chunk with filters, else 1 */
} hdf5_untrusted_shape;

/** Rows of a dataset. */
typedef struct hdf5_untrusted_rows {
    hsize_t first, count;
    hsize_t width; /**< the first so many numbers of each row; 0: all */
} hdf5_untrusted_rows;

/** Opens a file for reading, if it is a regular one. Rows of datasets may stand in files beside it where takes_stripes
 *  is set then. */
dem_status hdf5_untrusted_open(hdf5_file *out, const char *path);

/** Whether there is an object of this absolute path. Soft and external links on the way are refused. */
dem_status hdf5_untrusted_find(const hdf5_file *file, const char *name, bool *present);

/** The shape of a dataset of numbers that can be read as `kind`: reals from reals and integers, integers from integers,
 *  HDF5_U8 also from booleans.  \return DEM_ERROR_IO with the name and the reason */
dem_status hdf5_untrusted_measure(const hdf5_file *file, const char *name, hdf5_kind kind, hdf5_untrusted_shape *out);

/** Reads rows that hdf5_untrusted_measure() has seen while the file was open. A number that does not fit is an
 *  error. */
dem_status hdf5_untrusted_read(const hdf5_file *file, const char *name, hdf5_kind kind, hdf5_untrusted_rows rows,
                               void *data);

/** Reads an attribute that is a single number. */
dem_status hdf5_untrusted_read_attribute(const hdf5_file *file, const char *object, const char *name, hdf5_kind kind,
                                         void *value);

/** Reads an attribute that is a string of fixed length and terminates it. */
dem_status hdf5_untrusted_read_attribute_text(const hdf5_file *file, const char *object, const char *name, char *text,
                                              size_t size);

/** Calls `take` with each name in a group, in no particular order, until it fails. */
dem_status hdf5_untrusted_list(const hdf5_file *file, const char *group,
                               dem_status (*take)(void *context, const char *name), void *context);

/** The beginning of a name for a message, with ? in place of characters that cannot be printed. */
void hdf5_untrusted_print(char out[HDF5_UNTRUSTED_PRINTABLE], const char *name);

/** DEM_ERROR_IO: "path: name: reason". */
dem_status hdf5_untrusted_refuse(const hdf5_file *file, const char *name, const char *reason);

#endif
