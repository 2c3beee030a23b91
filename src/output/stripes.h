/* SPDX-License-Identifier: BSD-3-Clause */
/* The stripes of a run's files (stripe_file.h), which rank 0 has other ranks write: those of the segment with a number,
 * or of the part that becomes it, NAME.00001.1of4.h5 to NAME.00001.4of4.h5, and those of the whole, number 0,
 * NAME.1of4.h5 to NAME.4of4.h5. Their names do not change when a part becomes a segment. */
#ifndef DEM_OUTPUT_STRIPES_H
#define DEM_OUTPUT_STRIPES_H

#include "lattice/lattice_source.h"
#include "output/frame_stripes.h"

/** All functions but stripes_prune() do nothing where n is 0. */
typedef struct stripes {
    int n;                            /**< stripes; 0: none */
    const dem_simulation *simulation; /**< whose ranks write */
    const char *path;                 /**< NAME.vtkhdf */
    bool stay_open;                   /**< between frames (dem_trajectory_options.stays_open) */
    lattice_source lattice;           /**< of the run */
    int64_t run;                      /**< of stripes_run(), where n is not 0 */
} stripes;

/** A number by which files are known to be of this run: of its lattice.  \return DEM_ERROR_MEMORY */
dem_status stripes_run(int64_t *out, const lattice_source *lattice);

/** Makes the files of a number, without frames. Those of number 0 have temporary names.
 *  \return DEM_ERROR_IO, also if a file of such a name, or one of the whole's names, was not begun by this run */
dem_status stripes_create(const stripes *s, const frames *f, dem_index number);

/** Writes the arrays of the present state of the simulation as a frame. */
dem_status stripes_append(const stripes *s, const frames *f, dem_index number, const dem_simulation *simulation);

/** Closes what is open, before the files are read. */
dem_status stripes_close(const stripes *s, const frames *f);

/** Makes the files of number 0 of those of another one, if these have n frames and no more, and can have two names. */
dem_status stripes_link(const stripes *s, const frames *f, dem_index number, hsize_t n);

/** Copies frames of a file that has all rows, be they in stripes or not, behind those that are there. */
dem_status stripes_copy(const stripes *s, const frames *f, dem_index number, const char *source, hdf5_span span);

/** Syncs the files and reads them back, and gives those of number 0 their names. */
dem_status stripes_publish(const stripes *s, const frames *f, dem_index number);

/** Lets a file have frames in the files of a number. */
dem_status stripes_map(const stripes *s, const frames *f, dem_index number, const hdf5_file *file,
                       frame_stripes_mapped n);

/** Removes the files of numbers above `above`, and temporary ones, of any number of writers, but none that this run
 *  has not begun. What cannot be removed does no harm. */
void stripes_prune(const stripes *s, dem_index above);

/** The same where a new whole is there: all but its own. */
void stripes_prune_to_whole(const stripes *s);

#endif
