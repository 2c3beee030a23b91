/* SPDX-License-Identifier: BSD-3-Clause */
/* What a file of a trajectory holds, be it the whole run or a part of it: lattice, obstacles, provenance, and rows of
 * some kinds: frames, and those of the tables. */
#ifndef DEM_OUTPUT_TRAJECTORY_ROWS_H
#define DEM_OUTPUT_TRAJECTORY_ROWS_H

#include "base/team.h"
#include "output/break_table.h"
#include "output/event_table.h"
#include "output/fragment_table.h"
#include "output/frames.h"
#include "output/history.h"
#include "output/probe.h"
#include "output/provenance.h"
#include "output/stripes.h"

/* Kinds of rows. */
enum { ROWS_FRAMES, ROWS_HISTORY, ROWS_EVENTS, ROWS_BREAKS, ROWS_PROBES /**< the first of them */ };

typedef struct trajectory_rows {
    const dem_model *model;
    lattice_source lattice; /* of the model */
    dem_trajectory_options options;
    frames frames;
    stripes stripes;          /* where arrays of frames are, if not in the file itself */
    fragment_table fragments; /* rows of frames; without columns unless wanted */
    history history;
    table events, breaks; /* without columns unless wanted */
    probe *probes;        /* [options.n_probes] */
    provenance provenance;
    team *team; /* whose threads pack what is written: as many as the simulation has; NULL: none but the caller */
    int n_kinds;
} trajectory_rows;

/** `out` must be zero. Free with trajectory_rows_free(), after a failure too. Model and peaks are borrowed, and so is
 *  the simulation if there are stripes. */
dem_status trajectory_rows_init(trajectory_rows *out, const dem_simulation *simulation,
                                const dem_trajectory_options *options);
void trajectory_rows_free(trajectory_rows *r);

/** Makes everything but rows; and an upper bound of the bytes that this adds. */
dem_status trajectory_rows_create(const trajectory_rows *r, const hdf5_file *file);
hsize_t trajectory_rows_create_bytes(const trajectory_rows *r);

/** Whether the buffer of a table has no room for another row. */
bool trajectory_rows_are_full(const trajectory_rows *r);

/** Moves the buffered rows to the file; and an upper bound of the bytes that this adds. */
dem_status trajectory_rows_flush(trajectory_rows *r, const hdf5_file *file);
hsize_t trajectory_rows_flush_bytes(const trajectory_rows *r);

/** Writes the peaks, if there are any, into a file of n frames; and an upper bound of the bytes that this adds. */
dem_status trajectory_rows_write_peaks(const trajectory_rows *r, const hdf5_file *file, hsize_t n);
hsize_t trajectory_rows_peaks_bytes(const trajectory_rows *r, hsize_t n);

/** All rows of a kind so far; and those of them that are in the present file. */
hsize_t trajectory_rows_total(const trajectory_rows *r, int kind);
hsize_t trajectory_rows_written(const trajectory_rows *r, int kind);

/** Says that so many rows of a kind are in files before the present one, and so many in that. */
void trajectory_rows_place(trajectory_rows *r, int kind, hsize_t before, hsize_t written);

/** The name of a kind of rows, for messages. */
const char *trajectory_rows_name(const trajectory_rows *r, int kind);

/** Copies rows of another file.  \param spans  [n_kinds] */
dem_status trajectory_rows_copy(const trajectory_rows *r, const hdf5_file *from, const hdf5_file *to,
                                const hdf5_span *spans);

/** Counts the rows of a file.
 *  \param[out] spans  [n_kinds] their counts
 *  \return DEM_ERROR_IO if a dataset has another type or shape, or not as many rows as others of its kind */
dem_status trajectory_rows_count(const trajectory_rows *r, const hdf5_file *file, hdf5_span *spans);

/** DEM_ERROR_IO unless the file has these counts of rows. */
dem_status trajectory_rows_verify(const trajectory_rows *r, const hdf5_file *file, const hdf5_span *spans);

#endif
