/* SPDX-License-Identifier: BSD-3-Clause */
/* The peaks of a run in its file: arrays that every frame shows, and the group /most_stressed. */
#ifndef DEM_OUTPUT_PEAKS_FILE_H
#define DEM_OUTPUT_PEAKS_FILE_H

#include "output/frames.h"

typedef struct peaks_report {
    const dem_peaks *peaks;
    const dem_lattice *lattice;
    dem_index most; /* nodes and springs to be listed, at most */
} peaks_report;

/** Arrays of the frames that are there.  \param f  with its scratch */
dem_status peaks_file_write_arrays(const hdf5_file *file, const peaks_report *report, const frames *f);

dem_status peaks_file_write_lists(const hdf5_file *file, const peaks_report *report);

/** How many bytes both add to a file of n frames, at most. */
hsize_t peaks_file_bytes(const peaks_report *report, hsize_t n);

#endif
