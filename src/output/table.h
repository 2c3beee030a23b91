/* SPDX-License-Identifier: BSD-3-Clause */
/* A group of datasets with one row for each thing that is stored, such as /history: rows are collected in memory and
 * moved to the file together. A table without columns is never written. */
#ifndef DEM_OUTPUT_TABLE_H
#define DEM_OUTPUT_TABLE_H

#include "output/hdf5_rows.h"

enum {
    TABLE_ROWS = 1024, /**< rows that the buffer takes; also rows of a chunk in the file */
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
    int of;             /**< 0: one item in a row; k > 0: table.count[k] items */
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

/** The columns are borrowed. Free with table_free().
 *  \param count  [TABLE_SETS - 1] items in a row of columns with `of` > 0; NULL: there are no such columns */
dem_status table_init(table *out, const table_column *columns, int n_columns, const dem_index *count);
void table_free(table *t);

/** Makes the datasets, empty. */
dem_status table_create(const table *t, const hdf5_file *file);

/** Appends a row and returns its cells, which the caller fills. The buffer must have room. */
table_cell *table_add(table *t);

/** Fill n cells and return the cell behind them. */
table_cell *table_put_reals(table_cell *cell, const double *values, size_t n);
table_cell *table_put_wholes(table_cell *cell, const dem_index *values, size_t n);

/** An upper bound of the bytes that table_flush() adds. */
hsize_t table_bytes(const table *t);

/** Moves the buffered rows to the file. */
dem_status table_flush(table *t, const hdf5_file *file);

/** All rows so far: in earlier files, in this file, and in the buffer. */
hsize_t table_total(const table *t);

/** Copies rows of another file that has this table. */
dem_status table_copy(const table *t, const hdf5_file *from, const hdf5_file *to, hdf5_span span);

/** The number of rows in a file; DEM_ERROR_IO unless every column has as many. */
dem_status table_count(const table *t, const hdf5_file *file, hsize_t *rows);

/** DEM_ERROR_IO unless every column has this number of rows. */
dem_status table_verify(const table *t, const hdf5_file *file, hsize_t rows);

#endif
