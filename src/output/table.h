/* SPDX-License-Identifier: BSD-3-Clause */
/* A group of datasets with one row for each thing that is stored, such as /history: rows are collected in memory and
 * moved to the file together. A table without columns is never written. */
#ifndef DEM_OUTPUT_TABLE_H
#define DEM_OUTPUT_TABLE_H

#include "output/hdf5_file.h"

enum {
    TABLE_ROWS = 1024, /**< that the buffer takes, and of a chunk in the file */
    TABLE_SETS = 4
};

typedef union table_cell {
    double real;
    int64_t whole;
} table_cell;

/** A dataset of the table. */
typedef struct table_column {
    const char *name;   /**< absolute path */
    hdf5_kind kind;     /**< HDF5_F64 from table_put_reals(), HDF5_I64 or HDF5_I8 from table_put_wholes() */
    int of;             /**< 0: one item a row; 1 and more: as many as the table's count says */
    hsize_t components; /**< of an item */
} table_column;

typedef struct table {
    const table_column *columns; /**< [n_columns], in the order in which a row's cells lie */
    int n_columns;
    hsize_t count[TABLE_SETS]; /**< items of a row; columns of which there are 0 are left out */
    hsize_t width;             /**< cells of a row */
    hsize_t before;            /**< rows in files before this one */
    hsize_t written;           /**< rows in the file */
    hsize_t buffered;          /**< rows in the buffer */
    table_cell *buffer;        /**< [TABLE_ROWS][width] */
    table_cell *column;        /**< [TABLE_ROWS * widest column] */
} table;

/** Columns are borrowed. Free with table_free().
 *  \param count  [TABLE_SETS - 1], of the columns with `of` 1 and more; NULL: no such */
dem_status table_init(table *out, const table_column *columns, int n_columns, const dem_index *count);
void table_free(table *t);

/** Makes the datasets, empty. */
dem_status table_create(const table *t, const hdf5_file *file);

/** The cells of a new last row, to be filled; the buffer must have room. */
table_cell *table_add(table *t);

/** Fill cells; return the one behind. */
table_cell *table_put_reals(table_cell *cell, const double *values, size_t n);
table_cell *table_put_wholes(table_cell *cell, const dem_index *values, size_t n);

/** How many bytes table_flush() adds, at most. */
hsize_t table_bytes(const table *t);

/** Moves the buffered rows to the file. */
dem_status table_flush(table *t, const hdf5_file *file);

/** All rows so far. */
hsize_t table_total(const table *t);

/** Copies rows of another file that has this table. */
dem_status table_copy(const table *t, const hdf5_file *from, const hdf5_file *to, hdf5_span span);

/** The rows of a file that has this table; DEM_ERROR_IO unless every column has as many. */
dem_status table_count(const table *t, const hdf5_file *file, hsize_t *rows);

/** DEM_ERROR_IO unless every column has so many rows. */
dem_status table_verify(const table *t, const hdf5_file *file, hsize_t rows);

#endif
