/* SPDX-License-Identifier: BSD-3-Clause */
/* The group /history of a trajectory: scalars at accepted steps, one dataset per column, buffered in memory. */
#ifndef DEM_HISTORY_H
#define DEM_HISTORY_H

#include "hdf5_file.h"

typedef union history_cell {
    double real;
    int64_t whole;
} history_cell;

typedef struct history {
    dem_index count[3];   /**< how many runs (1), bodies, obstacles a row tells of */
    hsize_t width;        /**< cells of a row */
    hsize_t written;      /**< rows in the file */
    hsize_t buffered;     /**< rows in the buffer */
    double last;          /**< t of the last row, s */
    history_cell *buffer; /**< [HISTORY_ROWS][width] */
    history_cell *column; /**< [HISTORY_ROWS * widest column] */
} history;

/** Rows the buffer takes, and rows of a chunk in the file. */
enum { HISTORY_ROWS = 1024 };

/** Free with history_free(). */
dem_status history_init(history *out, const dem_model *model);
void history_free(history *h);

/** Makes the datasets, empty. */
dem_status history_create(const history *h, const hdf5_file *file);

/** Appends the state as a row, unless there is a row of that instant. The buffer must have room. */
void history_record(history *h, const dem_simulation *simulation);

/** How many bytes history_flush() adds, at most. */
hsize_t history_bytes(const history *h);

/** Moves the buffered rows to the file. */
dem_status history_flush(history *h, const hdf5_file *file);

/** DEM_ERROR_IO unless the file has every row of every column. */
dem_status history_verify(const history *h, const hdf5_file *file);

#endif
