/* SPDX-License-Identifier: BSD-3-Clause */
/* HDF5 for this library: files, datasets that grow row by row, and failures as a status that names file, dataset and
 * cause. Names are absolute paths within the file; missing groups on the way are made. */
#ifndef DEM_OUTPUT_HDF5_FILE_H
#define DEM_OUTPUT_HDF5_FILE_H

#include <dem/dem.h>

#define H5_USE_110_API /* what functions are called, in every version from 1.10 on */
#include <hdf5.h>

/** Number types. In memory HDF5_F32 is double too, HDF5_I8 is int64_t; the others are what they say. */
typedef enum hdf5_kind { HDF5_F64, HDF5_F32, HDF5_I64, HDF5_I32, HDF5_I8, HDF5_U8 } hdf5_kind;

/** An open file. From its opening to its closing, both in one thread, other threads wait with theirs; HDF5's own error
 *  printing is off in this thread, and in this process the loading of plugins, which are programs that a file names. */
typedef struct hdf5_file {
    hid_t id;
    const char *path;
    H5E_auto2_t report; /**< the printing to restore */
    void *report_data;
    unsigned plugins; /**< the loading to restore */
} hdf5_file;

/** A dataset that grows in its first dimension. */
typedef struct hdf5_rows {
    const char *name;
    hdf5_kind kind;
    int rank;        /**< 1 to 3 */
    hsize_t tail[2]; /**< [rank - 1] extents after the first, all > 0 */
    hsize_t chunk;   /**< rows of a chunk; 0 counts as 1 */
    int deflate;     /**< 0: stored plain; 1 to 9: shuffled and deflated */
} hdf5_rows;

/** Rows of a file and where they go in another. */
typedef struct hdf5_span {
    hsize_t first, count; /**< taken */
    hsize_t at;           /**< row that the first becomes, behind the last of those that are there */
} hdf5_span;

dem_status hdf5_open_read(hdf5_file *out, const char *path);

/** Opens to add up to about `bytes`, which it makes sure there is room for: a full disk found out by HDF5 1.10 itself
 *  leaves a file that cannot be opened any more. Takes no lock, so that looking at the file does not stop a run. */
dem_status hdf5_open_write(hdf5_file *out, const char *path, hsize_t bytes);

/** The same with an empty file, replacing an older one. */
dem_status hdf5_open_new(hdf5_file *out, const char *path, hsize_t bytes);

/** Flushes and closes; returns `status` if that is a failure already, else whether this succeeded. */
dem_status hdf5_close(hdf5_file *file, dem_status status);

/** DEM_ERROR_IO: "path: name: what (innermost cause that HDF5 gives)". To be called before any other HDF5 call. */
dem_status hdf5_fail(const hdf5_file *file, const char *name, const char *what);

hid_t hdf5_memory_type(hdf5_kind kind);

/** Makes the dataset, without rows. */
dem_status hdf5_create(const hdf5_file *file, const hdf5_rows *rows);

/** Gives a dataset another name. */
dem_status hdf5_link(const hdf5_file *file, const char *name, const char *target);

/** Stores `count` rows from row `first` on, which then are the last ones. */
dem_status hdf5_append(const hdf5_file *file, const hdf5_rows *rows, hsize_t first, hsize_t count, const void *data);

/** Reads `count` rows from row `first` on, which are there. */
dem_status hdf5_read(const hdf5_file *file, const hdf5_rows *rows, hsize_t first, hsize_t count, void *data);

/** Copies rows of a dataset to the end of that in another file, a chunk at a time. */
dem_status hdf5_copy(const hdf5_file *from, const hdf5_file *to, const hdf5_rows *rows, hdf5_span span);

/** Makes the dataset with `count` rows in one chunk. */
dem_status hdf5_write(const hdf5_file *file, hdf5_rows rows, hsize_t count, const void *data);

/** Makes or overwrites an attribute: a scalar for count 1, else [count]. The group `object` is made if need be. */
dem_status hdf5_write_attribute(const hdf5_file *file, const char *object, const char *name, hdf5_kind kind,
                                hsize_t count, const void *data);

/** Makes a scalar ASCII attribute of fixed length without a terminator. */
dem_status hdf5_write_attribute_text(const hdf5_file *file, const char *object, const char *name, const char *text);

/** Makes or replaces a scalar UTF-8 string of fixed length. */
dem_status hdf5_write_text(const hdf5_file *file, const char *name, const char *text);

/** Reads such a string and terminates it; DEM_ERROR_ARGUMENT if it needs more than `size` bytes. */
dem_status hdf5_read_text(const hdf5_file *file, const char *name, char *text, size_t size);

dem_status hdf5_count_rows(const hdf5_file *file, const char *name, hsize_t *count);

/** DEM_ERROR_IO unless the dataset has this kind of numbers, these extents and `count` rows. */
dem_status hdf5_expect_rows(const hdf5_file *file, const hdf5_rows *rows, hsize_t count);

/** DEM_ERROR_IO unless the scalar integer attribute is `value`. */
dem_status hdf5_expect_attribute(const hdf5_file *file, const char *object, const char *name, int64_t value);

/** Syncs the closed file `part`, reads all of it back, renames it to `path` and syncs the folder: HDF5 1.10 may report
 *  success on a full disk, so nothing else shows whether the file is whole. */
dem_status hdf5_publish(const char *part, const char *path);

#endif
