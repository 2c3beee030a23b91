/* SPDX-License-Identifier: BSD-3-Clause */
/** dem/reader.h -- a trajectory read back: its frames, tables, lattice and obstacles. The file may be a finished one,
 *  the part of a run that goes on, or a segment. Types, ranks, extents, storage and links are checked as
 *  dem_lattice_read() does, before anything is allocated; arrays of frames may be in files beside it, NAME.1of4.h5 and
 *  so on, which are checked likewise.
 *  The file is opened for each call and closed again, so that looking at a run does not disturb it; what was there when
 *  the trajectory was opened is what is seen. docs/output.md lists every dataset. */
#ifndef DEM_READER_H
#define DEM_READER_H

#include <dem/dem.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct dem_reader dem_reader;

/** What numbers are in the file; all are read as double, to which a 64-bit integer beyond 2^53 is rounded. */
typedef enum dem_reader_type {
    DEM_READER_F64,
    DEM_READER_F32,
    DEM_READER_I64,
    DEM_READER_I32,
    DEM_READER_I8,
    DEM_READER_U8
} dem_reader_type;

/** \return DEM_ERROR_IO with the file, dataset and reason; DEM_ERROR_MODEL for an inconsistent lattice. A part that is
 *          being written at this moment may be refused: then try again */
DEM_API dem_status dem_reader_open(dem_reader **out, const char *path);

/** Accepts NULL. Views end with it. */
DEM_API void dem_reader_close(dem_reader *reader);

/** The lattice at rest, and where and how fast it started; a view. */
DEM_API const dem_lattice *dem_reader_lattice(const dem_reader *reader);

/** How many obstacles there are. */
DEM_API dem_index dem_reader_n_obstacles(const dem_reader *reader);

/** An obstacle; a view.
 *  \param obstacle  0 <= obstacle < dem_reader_n_obstacles(); NULL, and a dem_status_message(), for any other */
DEM_API const dem_obstacle *dem_reader_obstacle(const dem_reader *reader, dem_index obstacle);

/** Times of the frames, s, ascending, [*n_frames]; a view. */
DEM_API const double *dem_reader_times(const dem_reader *reader, dem_index *n_frames);

/* ---- frames ----------------------------------------------------------------------------------------------------- */

/** An array shown on the lattice: of nodes or springs, one for each frame or the same in all. */
typedef struct dem_reader_array {
    const char *name; /**< as in the file: "velocity", "stress", "von_mises", "strain", "force", "body", ... */
    const char *unit; /**< "m/s", "Pa", ...; "1" of a ratio; "" of a number that counts or names, or of one unknown */
    dem_reader_type type; /**< in the file */
    bool of_springs;      /**< true: [n_springs][components]; false: [n_nodes][components] */
    int components;       /**< 1 to 9; vectors have 3, z = 0; symmetric tensors 6: xx yy zz xy yz xz */
    bool constant;        /**< true: the same in all frames, as "id", "body" and "peak_von_mises" */
} dem_reader_array;

/** All of them, those of nodes first, else by name, [*n]; a view. Positions are not among them:
 *  dem_reader_positions(). */
DEM_API const dem_reader_array *dem_reader_arrays(const dem_reader *reader, dem_index *n);

/** NULL if there is none of this name. */
DEM_API const dem_reader_array *dem_reader_array_find(const dem_reader *reader, const char *name);

/** \param frame   0 <= frame < n_frames
 *  \param[out] x  [n_nodes][2] m
 *  \return DEM_ERROR_ARGUMENT if there is no such frame; DEM_ERROR_IO with the file, dataset and reason */
DEM_API dem_status dem_reader_positions(const dem_reader *reader, dem_index frame, double *x);

/** \param array        one of dem_reader_arrays()
 *  \param frame        0 <= frame < n_frames; any, of a constant array
 *  \param[out] values  [n_nodes or n_springs][components]
 *  \return as dem_reader_positions() */
DEM_API dem_status dem_reader_read(const dem_reader *reader, const dem_reader_array *array, dem_index frame,
                                   double *values);

/** Which triangles are broken; springs that are have the array "broken".
 *  \param frame          0 <= frame < n_frames
 *  \param[out] triangle  [n_triangles] 1: broken, else 0; all 0 where the file is of a version that did not write them
 *  \return as dem_reader_positions() */
DEM_API dem_status dem_reader_broken_triangles(const dem_reader *reader, dem_index frame, unsigned char *triangle);

/* ---- tables ----------------------------------------------------------------------------------------------------- */

/** A column of a table: "history", "events", "breaks", "probes/NAME", "most_stressed/nodes", "most_stressed/springs",
 *  "fragments", which has a row for each fragment in each frame, and "frames", which has one for each frame: energies
 *  and contacts. */
typedef struct dem_reader_column {
    const char *table, *name;
    const char *unit;     /**< as of arrays */
    dem_reader_type type; /**< in the file */
    dem_index n_rows;     /**< the same in all columns of a table */
    dem_index items;      /**< of a row: bodies, obstacles or boundaries of "history"; else 1 */
    dem_index components; /**< of an item: 2 of a vector, 3 of a stress: xx yy xy */
    dem_index width;      /**< numbers in a row: items * components */
} dem_reader_column;

/** All of them, table by table, "t" first, else by name, [*n]; a view. */
DEM_API const dem_reader_column *dem_reader_columns(const dem_reader *reader, dem_index *n);

/** NULL if there is none. */
DEM_API const dem_reader_column *dem_reader_column_find(const dem_reader *reader, const char *table, const char *name);

/** Which rows of the table "fragments" are those of a frame, by the ids of fragments.
 *  \param frame              0 <= frame < n_frames
 *  \param[out] first, count  for dem_reader_read_rows(); 0 and 0 where there is no such table
 *  \return DEM_ERROR_ARGUMENT if there is no such frame */
DEM_API dem_status dem_reader_fragments(const dem_reader *reader, dem_index frame, dem_index *first, dem_index *count);

/** \param column       one of dem_reader_columns()
 *  \param[out] values  [n_rows][items][components]
 *  \return DEM_ERROR_IO with the file, dataset and reason */
DEM_API dem_status dem_reader_read_column(const dem_reader *reader, const dem_reader_column *column, double *values);

/** A part of it, for tables that are longer than memory.
 *  \param first, count  rows, 0 <= first, count and first + count <= n_rows, else DEM_ERROR_ARGUMENT
 *  \param[out] values   [count][items][components] */
DEM_API dem_status dem_reader_read_rows(const dem_reader *reader, const dem_reader_column *column, dem_index first,
                                        dem_index count, double *values);

#ifdef __cplusplus
}
#endif

#endif
