/* SPDX-License-Identifier: BSD-3-Clause */
/* A .vtu file: an UnstructuredGrid in VTK's XML, numbers in raw form behind it. */
#ifndef DEM_PIECE_H
#define DEM_PIECE_H

#include "sheet.h"

typedef enum piece_section {
    PIECE_FIELD,
    PIECE_POINT_DATA,
    PIECE_CELL_DATA,
    PIECE_POINTS,
    PIECE_CELLS,
    PIECE_SECTIONS
} piece_section;

typedef struct piece_array {
    piece_section section;
    const char *name;
    dem_reader_type type;
    int components;
    dem_index n;                  /* tuples */
    const double *values;         /* [n][components] */
    const dem_reader_array *what; /* where `values` is NULL: to be read when it is written */
} piece_array;

typedef struct piece {
    dem_index n_points, n_cells;
    dem_index n_arrays;
    const piece_array *arrays;
    dem_index frame; /* of what is to be read */
    double *scratch; /* room for the largest of that */
} piece;

/** False, and the outcome, if it cannot be written. */
bool piece_write(const task *t, const char *behind, const piece *p);

/** Text with &, <, > and " as XML has them. */
void piece_print_text(sheet *s, const char *text);

#endif
