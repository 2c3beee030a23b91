/* SPDX-License-Identifier: BSD-3-Clause */
/* The texts of /provenance, kept in memory so that every file of a run can have them. */
#ifndef DEM_OUTPUT_PROVENANCE_H
#define DEM_OUTPUT_PROVENANCE_H

#include "output/hdf5_file.h"

enum { PROVENANCE_PATH = 96 /**< bytes */ };

typedef struct provenance_entry {
    char path[PROVENANCE_PATH];
    char *text;
} provenance_entry;

typedef struct provenance {
    dem_index n, capacity;
    provenance_entry *entries;
} provenance;

/** The path of a note in a file; DEM_ERROR_ARGUMENT if it cannot have this name. */
dem_status provenance_path(char path[PROVENANCE_PATH], const char *name);

/** Adds a note, or replaces the one of this path; on failure nothing has changed. Free with provenance_free(). */
dem_status provenance_put(provenance *all, const char *path, const char *text);
void provenance_free(provenance *all);

dem_status provenance_write(const provenance *all, const hdf5_file *file);

/** An upper bound of the bytes that provenance_write() adds. */
hsize_t provenance_bytes(const provenance *all);

#endif
