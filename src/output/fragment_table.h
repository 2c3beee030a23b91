/* SPDX-License-Identifier: BSD-3-Clause */
/* The group /fragments of a trajectory: for each frame a row for each fragment, and where the rows of a frame begin.
 * Only with the option `fragments`. */
#ifndef DEM_OUTPUT_FRAGMENT_TABLE_H
#define DEM_OUTPUT_FRAGMENT_TABLE_H

#include "output/table.h"

/** A fragment in a frame. */
typedef struct fragment_row {
    dem_index id, nodes;     /**< its lowest node, and how many it has */
    double mass, x[2], v[2]; /**< kg, centre of mass, m, and its velocity, m/s */
    double angular_momentum; /**< about that, kg m^2/s */
    double inertia;          /**< about that, kg m^2 */
    double internal;         /**< J, of the motion that is not that of a rigid body */
    double low[2], high[2];  /**< m, of the box that has its nodes */
} fragment_row;

typedef struct fragment_table {
    table table;
    dem_index n_nodes;
    dem_index *row_of; /**< [n_nodes] the row of each node's fragment in the frame that is measured; NULL: not wanted */
    dem_index n, capacity;
    fragment_row *rows; /**< [n] of that frame, by their ids */
    double t;           /**< s, of that frame */
} fragment_table;

/** Free with fragment_table_free(). */
dem_status fragment_table_init(fragment_table *out, const dem_model *model);
void fragment_table_free(fragment_table *t);

/** Makes the datasets, without a frame. */
dem_status fragment_table_create(const fragment_table *t, const hdf5_file *file);

/** Looks at the fragments of a simulation, for fragment_table_append().  \return DEM_ERROR_MEMORY */
dem_status fragment_table_measure(fragment_table *t, const dem_simulation *simulation);

/** An upper bound of the bytes that fragment_table_append() adds. */
hsize_t fragment_table_bytes(const fragment_table *t);

/** Adds what was measured as that of frame n of this file; what is behind that is cut off. */
dem_status fragment_table_append(fragment_table *t, const hdf5_file *file, dem_index n);

/** Copies frames of another file; in this one they begin at frame span.at. */
dem_status fragment_table_copy(const fragment_table *t, const hdf5_file *from, const hdf5_file *to, hdf5_span span);

/** DEM_ERROR_IO unless there are n frames, with all of their rows. */
dem_status fragment_table_verify(const fragment_table *t, const hdf5_file *file, hsize_t n);

#endif
