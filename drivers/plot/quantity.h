/* SPDX-License-Identifier: BSD-3-Clause */
/* What colours stand for: a number of each spring or of each node, from the arrays of a trajectory. */
#ifndef DEM_QUANTITY_H
#define DEM_QUANTITY_H

#include <stdbool.h>
#include <stdio.h>

#include <dem/reader.h>

#include "outcome.h"
#include "palette.h"

typedef struct quantity {
    const char *name, *label;       /* as after --color, and beside the colours */
    const dem_reader_array *source; /* NULL: there is none, all springs have one colour */
    int part;                       /* component, or -1: the length of the vector */
    palette_kind scale;
} quantity;

enum { QUANTITY_KNOWN = 18 };

/** The k-th that has a name, k < QUANTITY_KNOWN; false if the trajectory does not have it. */
bool quantity_at(quantity *q, const dem_reader *reader, size_t k);

/** By its name; NULL: the first of strain, force, von_mises and speed that the trajectory has, or none. False after a
 *  fault, which is reported. */
bool quantity_find(quantity *q, const dem_reader *reader, const char *name, outcome *o);

/** Whether there is such a name. */
bool quantity_is_known(const char *name);

/** Whether colours stand for what has no order, as the numbers of fragments. */
bool quantity_is_unordered(const char *name);

/** Prints all names, with commas between. */
void quantity_list(FILE *out);

/** Whether it is drawn as triangles: the values of nodes fill them. Where there are none, and without values of nodes,
 *  springs are drawn. */
bool quantity_fills_triangles(const quantity *q, const dem_lattice *lattice);

/** How many numbers it has in a frame: of springs, or of nodes; 0 of none. */
size_t quantity_count(const quantity *q, const dem_lattice *lattice);

/** Those of a frame.
 *  \param[out] value  [quantity_count()]
 *  \param rows        [quantity_count()] times the components of the source, to work in */
dem_status quantity_read(const quantity *q, const dem_reader *reader, dem_index frame, double *value, double *rows);

#endif
