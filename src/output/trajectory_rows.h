/* SPDX-License-Identifier: BSD-3-Clause */
/* What a file of a trajectory holds, be it the whole run or a part of it: lattice, obstacles, notes, and rows of some
 * kinds: frames, and those of the tables. */
#ifndef DEM_OUTPUT_TRAJECTORY_ROWS_H
#define DEM_OUTPUT_TRAJECTORY_ROWS_H

#include "output/event_table.h"
#include "output/frames.h"
#include "output/history.h"
#include "output/probe.h"
#include "output/provenance.h"

enum { REEL_FRAMES, REEL_HISTORY, REEL_EVENTS, REEL_PROBES /**< the first of them */ }; /* kinds of rows */

typedef struct reel {
    const dem_model *model;
    dem_trajectory_options options;
    frames frames;
    history history;
    table events;  /* without columns unless wanted */
    probe *probes; /* [options.n_probes] */
    notes notes;
    int n_kinds;
} reel;

/** `out` is zero; free with reel_free(), after a failure too. Model and peaks are borrowed. */
dem_status reel_init(reel *out, const dem_simulation *simulation, const dem_trajectory_options *options);
void reel_free(reel *r);

/** Makes everything but rows, and how many bytes that adds, at most. */
dem_status reel_create(const reel *r, const hdf5_file *file);
hsize_t reel_create_bytes(const reel *r);

/** Moves the buffered rows to the file, and how many bytes that adds, at most. */
dem_status reel_flush(reel *r, const hdf5_file *file);
hsize_t reel_flush_bytes(const reel *r);

/** Writes the peaks, if there are any, into a file of n frames, and how many bytes that adds, at most. */
dem_status reel_write_peaks(const reel *r, const hdf5_file *file, hsize_t n);
hsize_t reel_peaks_bytes(const reel *r, hsize_t n);

/** Rows so far, and those of them that are in the present file. */
hsize_t reel_total(const reel *r, int kind);
hsize_t reel_written(const reel *r, int kind);

/** So many rows stand in files before the present one, and so many in that. */
void reel_place(reel *r, int kind, hsize_t before, hsize_t written);

/** What a kind is called in messages. */
const char *reel_name(const reel *r, int kind);

/** Copies rows of another file.  \param spans  [n_kinds] */
dem_status reel_copy(const reel *r, const hdf5_file *from, const hdf5_file *to, const hdf5_span *spans);

/** The rows of a file.  \param[out] spans  [n_kinds] their counts
 *  \return DEM_ERROR_IO if a dataset is of another type or shape, or has not as many rows as others of its kind */
dem_status reel_count(const reel *r, const hdf5_file *file, hdf5_span *spans);

/** DEM_ERROR_IO unless the file has these counts of rows. */
dem_status reel_verify(const reel *r, const hdf5_file *file, const hdf5_span *spans);

#endif
