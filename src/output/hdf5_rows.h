/* SPDX-License-Identifier: BSD-3-Clause */
/* Datasets of numbers that grow row by row. */
#ifndef DEM_OUTPUT_HDF5_ROWS_H
#define DEM_OUTPUT_HDF5_ROWS_H

#include "output/deflated_chunk.h"
#include "output/hdf5_file.h"
#include "output/hdf5_stripes.h"

/** Types of numbers in a file. In memory HDF5_F32 is double and HDF5_I8 is int64_t; the others are the same. */
typedef enum hdf5_kind { HDF5_F64, HDF5_F32, HDF5_I64, HDF5_I32, HDF5_I8, HDF5_U8 } hdf5_kind;

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

/** The types of numbers in a file, and in memory. */
hid_t hdf5_file_type(hdf5_kind kind);
hid_t hdf5_memory_type(hdf5_kind kind);

/** Bytes of a row in memory. */
size_t hdf5_row_bytes(const hdf5_rows *rows);

/** Makes a dataset without rows. */
dem_status hdf5_create(const hdf5_file *file, const hdf5_rows *rows);

/** Stores `count` rows from row `first` on; rows behind them are cut off. */
dem_status hdf5_append(const hdf5_file *file, const hdf5_rows *rows, hsize_t first, hsize_t count, const void *data);

/** The same of a chunk of rows that is packed. */
dem_status hdf5_append_packed(const hdf5_file *file, const hdf5_rows *rows, hsize_t first, const deflated_run *chunk);

/** Whether whole chunks of these rows can be packed by others (output/deflater.h), and the numbers to be packed of some
 *  rows in memory. */
bool hdf5_packs(const hdf5_rows *rows);
deflater_numbers hdf5_numbers(const hdf5_rows *rows, hsize_t count, const void *data);

/** Gives a dataset so many rows, and stores some of them. */
dem_status hdf5_extend(const hdf5_file *file, const hdf5_rows *rows, hsize_t count);
dem_status hdf5_put(const hdf5_file *file, const hdf5_rows *rows, hsize_t first, hsize_t count, const void *data);

/** Makes a dataset whose rows stand in n other files, in place of one of that name.
 *  \param count    rows; 0 of one that grows
 *  \param stripes  [n], which have all rows together, and all or none of which grow; those without rows are left out */
dem_status hdf5_map(const hdf5_file *file, const hdf5_rows *rows, hsize_t count, const hdf5_stripe *stripes, int n);

/** Reads `count` existing rows from row `first` on. */
dem_status hdf5_read(const hdf5_file *file, const hdf5_rows *rows, hsize_t first, hsize_t count, void *data);

/** Copies rows to the end of a dataset of another file, which are a chunk of both, as they are stored.
 *  \param source, target  one of each file
 *  \param[out] is_done    false: they are no such chunk, and nothing has been done */
dem_status hdf5_copy_chunk(const hdf5_file *from, const hdf5_file *to, const hdf5_rows *source, const hdf5_rows *target,
                           hdf5_span span, bool *is_done);

/** Copies rows of a dataset to the end of that in another file, a chunk at a time. */
dem_status hdf5_copy(const hdf5_file *from, const hdf5_file *to, const hdf5_rows *rows, hdf5_span span);

/** Makes a dataset without rows, to which `count` rows are going to be appended, and none later.
 *  \param[in,out] rows  their chunk becomes all rows where it is 0, or more */
dem_status hdf5_create_for(const hdf5_file *file, hdf5_rows *rows, hsize_t count);

/** Makes one, and appends them chunk by chunk. */
dem_status hdf5_write(const hdf5_file *file, hdf5_rows rows, hsize_t count, const void *data);

dem_status hdf5_count_rows(const hdf5_file *file, const char *name, hsize_t *count);

/** DEM_ERROR_IO unless the dataset has this kind of numbers, these extents and `count` rows, and those that stand in
 *  other files are there. */
dem_status hdf5_expect_rows(const hdf5_file *file, const hdf5_rows *rows, hsize_t count);

#endif
