/* SPDX-License-Identifier: BSD-3-Clause */
/* The peaks of a run in its file: arrays that are shown in every frame, and the group /most_stressed. */
#ifndef DEM_OUTPUT_PEAKS_FILE_H
#define DEM_OUTPUT_PEAKS_FILE_H

#include "lattice/lattice_source.h"
#include "output/frames.h"

typedef struct peaks_report {
    const dem_peaks *peaks;
    lattice_source lattice;
    dem_index most; /* the largest number of nodes, and of springs, to be listed */
} peaks_report;

/** Writes the arrays of peaks.  \param f  the frames of this file, whose scratch is used */
dem_status peaks_file_write_arrays(const hdf5_file *file, const peaks_report *report, const frames *f);

dem_status peaks_file_write_lists(const hdf5_file *file, const peaks_report *report);

/** An upper bound of the bytes that both add to a file of n frames. */
hsize_t peaks_file_bytes(const peaks_report *report, hsize_t n);

#endif
