/* SPDX-License-Identifier: BSD-3-Clause */
/* Rows that are handed over, or read, some after the other, in their order, so that nobody needs memory for all. */
#ifndef DEM_BASE_ROWS_TAKER_H
#define DEM_BASE_ROWS_TAKER_H

#include <stddef.h>

#include <dem/dem.h>

/** Takes n rows, from row `first` on, which are lost afterwards. It asks other ranks for nothing, as they may be taking
 *  part in what hands rows over.
 *  \return a failure ends the handing over, and is its result */
typedef dem_status rows_taker(void *context, dem_index first, dem_index n, const void *rows);

/** Copies n rows, from row `first` on, to `rows`. */
typedef dem_status rows_reader(void *context, dem_index first, dem_index n, void *rows);

/** Rows that are handed over at once, but for the last. Chunks of files have so many, too. */
enum { ROWS_CHUNK = 1 << 16 };

/** Hands over n rows that are here.
 *  \param size  bytes of a row  \return that of `take` */
dem_status rows_hand_over(const void *rows, size_t size, dem_index n, rows_taker *take, void *context);

/** Rows that are read when they are wanted. */
typedef struct rows_source {
    rows_reader *read;
    void *context;
    size_t size; /* bytes of a row */
    dem_index n;
} rows_source;

/** Reads all and hands them over.  \return that of `read` or `take`; DEM_ERROR_MEMORY */
dem_status rows_pass_on(const rows_source *from, rows_taker *take, void *context);

/** What rows_taker_copy() takes: all. */
typedef struct rows_copy {
    size_t size; /* bytes of a row */
    void *out;   /* [rows][size] */
} rows_copy;

dem_status rows_taker_copy(void *copy, dem_index first, dem_index n, const void *rows);

/** What rows_reader_copy() reads. */
typedef struct rows_here {
    size_t size;      /* bytes of a row */
    const void *rows; /* [rows][size] */
} rows_here;

dem_status rows_reader_copy(void *here, dem_index first, dem_index n, void *rows);

/** What rows_taker_pick() takes: some. */
typedef struct rows_pick {
    size_t size; /* bytes of a row */
    const dem_index *list;
    dem_index n; /* in the list */
    void *out;   /* [n][size] */
} rows_pick;

dem_status rows_taker_pick(void *pick, dem_index first, dem_index n, const void *rows);

#endif
