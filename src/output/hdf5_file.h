/* SPDX-License-Identifier: BSD-3-Clause */
/* HDF5 for this library: files, datasets that grow row by row, and failures as a status that names file, dataset and
 * cause. Names are absolute paths within the file; missing groups on the way are made. */
#ifndef DEM_OUTPUT_HDF5_FILE_H
#define DEM_OUTPUT_HDF5_FILE_H

#include <dem/dem.h>

#include "output/deflater.h"
#include "output/hdf5_api.h"
#include "output/kept_datasets.h"

/** Types of numbers in a file. In memory HDF5_F32 is double and HDF5_I8 is int64_t; the others are the same. */
typedef enum hdf5_kind { HDF5_F64, HDF5_F32, HDF5_I64, HDF5_I32, HDF5_I8, HDF5_U8 } hdf5_kind;

/** An open file. It must be opened and closed by the same thread, and until it is closed other threads wait to open
 *  theirs. Meanwhile HDF5 prints no errors in this thread, and loads no plugins (programs that a file names) in this
 *  process. */
typedef struct hdf5_file {
    hid_t id;
    const char *path;
    H5E_auto2_t report; /**< how errors were printed before */
    void *report_data;
    unsigned plugins;   /**< whether plugins were loaded before */
    deflater *deflater; /**< of a file that is written to */
    kept_datasets *kept;
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

/** Rows of a file, and where they go in another one. */
typedef struct hdf5_span {
    hsize_t first, count; /**< rows that are taken */
    hsize_t at;           /**< where the first of them goes: the number of rows that are there already */
} hdf5_span;

dem_status hdf5_open_read(hdf5_file *out, const char *path);

/** Opens to add up to about `bytes`, after reserving room for them: if HDF5 1.10 itself meets a full disk, the file
 *  cannot be opened any more. Takes no lock, so that programs may look at the file during a run. */
dem_status hdf5_open_write(hdf5_file *out, const char *path, hsize_t bytes);

/** The same with a new, empty file in place of an older one. */
dem_status hdf5_open_new(hdf5_file *out, const char *path, hsize_t bytes);

/** Keeps the datasets that rows are appended to from now on open until the file is closed. */
void hdf5_keep(hdf5_file *file);

/** Flushes, so that on the disk is a whole file, and gives back the lock; the file stays open. After a failure, which
 *  may be `status`, it is closed. */
dem_status hdf5_pause(hdf5_file *file, dem_status status);

/** After a pause, what hdf5_open_write() does; after a failure the pause goes on. Or the file is closed after it. */
dem_status hdf5_resume(hdf5_file *file, hsize_t bytes);
dem_status hdf5_close_paused(hdf5_file *file);

/** Flushes and closes.
 *  \return `status` if that is a failure already; otherwise whether closing succeeded */
dem_status hdf5_close(hdf5_file *file, dem_status status);

/** DEM_ERROR_IO with "path: name: what (innermost cause given by HDF5)". To be called before any other HDF5 call. */
dem_status hdf5_fail(const hdf5_file *file, const char *name, const char *what);

hid_t hdf5_memory_type(hdf5_kind kind);

/** Makes a dataset without rows. */
dem_status hdf5_create(const hdf5_file *file, const hdf5_rows *rows);

/** Gives a dataset a second name. */
dem_status hdf5_link(const hdf5_file *file, const char *name, const char *target);

/** Stores `count` rows from row `first` on; rows behind them are cut off. */
dem_status hdf5_append(const hdf5_file *file, const hdf5_rows *rows, hsize_t first, hsize_t count, const void *data);

/** Reads `count` existing rows from row `first` on. */
dem_status hdf5_read(const hdf5_file *file, const hdf5_rows *rows, hsize_t first, hsize_t count, void *data);

/** Copies rows of a dataset to the end of that in another file, a chunk at a time. */
dem_status hdf5_copy(const hdf5_file *from, const hdf5_file *to, const hdf5_rows *rows, hdf5_span span);

/** Makes a dataset with `count` rows in one chunk. */
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

/** Syncs the closed file `part`, reads all of it back, renames it to `path` and syncs the folder. HDF5 1.10 may report
 *  success on a full disk, so that only reading shows whether the file is whole. */
dem_status hdf5_publish(const char *part, const char *path);

#endif
