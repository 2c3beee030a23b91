/* SPDX-License-Identifier: BSD-3-Clause */
/* Tables: rows are collected in memory one after another, and stored in the file column by column, a dataset for each
 * column (history, events, probes). A row is an array of cells, and its columns are consecutive runs of them:
 *   buffer   row 0: t | x y | contacts of obstacle 0, 1, ... | ...     [TABLE_ROWS][width]
 *            row 1: t | x y | ...
 *   column   one of these runs from all buffered rows, gathered for HDF5
 * Which columns there are is decided by the files that own a table; files and their order are in trajectory.c. */
#include "output/table.h"

#include "base/status.h"

#include <stdlib.h>
#include <string.h>

/* Cells that a column takes in a row: the number of items (bodies, obstacles, ...; 1 for columns about the whole) times
 * their components. */
static hsize_t column_width(const table *t, const table_column *c)
{
    return t->count[c->of] * c->components;
}

/* The dataset of a column: [rows], [rows][components], [rows][items] or [rows][items][components]. It is stored plain:
 * the last chunk is rewritten at every flush, and a deflated one would move and leave a hole. */
static hdf5_rows layout(const table *t, const table_column *c)
{
    /* A column about the whole has no dimension of items, one with a single component none of components. */
    const int rank = 1 + (c->of != 0) + (c->components > 1);
    const hsize_t first = c->of != 0 ? t->count[c->of] : c->components;
    return (hdf5_rows){c->name, c->kind, rank, {first, c->components}, TABLE_ROWS, 0};
}

/* One allocation: the buffer of rows, and behind it room for the widest column. */
dem_status table_init(table *out, const table_column *columns, int n_columns, const dem_index *count)
{
    table t = {.columns = columns, .n_columns = n_columns, .count = {1}};
    hsize_t widest = 1;
    for (int k = 1; k < TABLE_SETS && count != NULL; k++) t.count[k] = (hsize_t)count[k - 1];
    for (int c = 0; c < n_columns; c++) {
        const hsize_t width = column_width(&t, &columns[c]);
        t.width += width;
        if (width > widest) widest = width;
    }
    t.buffer = calloc((size_t)(t.width + widest), TABLE_ROWS * sizeof *t.buffer);
    CHECK_MEMORY(t.buffer);
    t.column = t.buffer + TABLE_ROWS * t.width;
    *out = t;
    return DEM_OK;
}

void table_free(table *t)
{
    free(t->buffer);
}

/* A column without items has no dataset. */
dem_status table_create(const table *t, const hdf5_file *file)
{
    for (int c = 0; c < t->n_columns; c++) {
        const hdf5_rows rows = layout(t, &t->columns[c]);
        if (column_width(t, &t->columns[c]) > 0) TRY(hdf5_create(file, &rows));
    }
    return DEM_OK;
}

/* The caller flushes before the buffer is full, and fills all cells. */
table_cell *table_add(table *t)
{
    return t->buffer + t->buffered++ * t->width;
}

table_cell *table_put_reals(table_cell *cell, const double *values, size_t n)
{
    for (size_t k = 0; k < n; k++) cell[k].real = values[k];
    return cell + n;
}

table_cell *table_put_wholes(table_cell *cell, const dem_index *values, size_t n)
{
    for (size_t k = 0; k < n; k++) cell[k].whole = values[k];
    return cell + n;
}

/* The rows of a buffer may begin two chunks. */
hsize_t table_bytes(const table *t)
{
    return 2 * TABLE_ROWS * t->width * sizeof *t->buffer;
}

/* Gathers each column from the rows and appends it. If that fails half-way, the buffer is kept: the next try writes the
 * same rows at the same place. */
dem_status table_flush(table *t, const hdf5_file *file)
{
    hsize_t offset = 0;
    for (int c = 0; c < t->n_columns && t->buffered > 0; c++) {
        const hdf5_rows rows = layout(t, &t->columns[c]);
        const hsize_t width = column_width(t, &t->columns[c]);
        /* From rows to a column. */
        for (hsize_t r = 0; r < t->buffered; r++)
            memcpy(t->column + r * width, t->buffer + r * t->width + offset, (size_t)width * sizeof *t->buffer);
        if (width > 0) TRY(hdf5_append(file, &rows, t->written, t->buffered, t->column));
        offset += width;
    }
    t->written += t->buffered;
    t->buffered = 0;
    return DEM_OK;
}

hsize_t table_total(const table *t)
{
    return t->before + t->written + t->buffered;
}

dem_status table_copy(const table *t, const hdf5_file *from, const hdf5_file *to, hdf5_span span)
{
    for (int c = 0; c < t->n_columns; c++) {
        const hdf5_rows rows = layout(t, &t->columns[c]);
        if (column_width(t, &t->columns[c]) > 0) TRY(hdf5_copy(from, to, &rows, span));
    }
    return DEM_OK;
}

/* The first column is of one item, hence there; the others must agree with it. */
dem_status table_count(const table *t, const hdf5_file *file, hsize_t *rows)
{
    *rows = 0;
    if (t->n_columns > 0) TRY(hdf5_count_rows(file, t->columns[0].name, rows));
    return table_verify(t, file, *rows);
}

dem_status table_verify(const table *t, const hdf5_file *file, hsize_t rows)
{
    for (int c = 0; c < t->n_columns; c++) {
        const hdf5_rows column = layout(t, &t->columns[c]);
        if (column_width(t, &t->columns[c]) > 0) TRY(hdf5_expect_rows(file, &column, rows));
    }
    return DEM_OK;
}
