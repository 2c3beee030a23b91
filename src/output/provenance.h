/* SPDX-License-Identifier: BSD-3-Clause */
/* The strings of /provenance, kept so that every file of a run can have them. */
#ifndef DEM_OUTPUT_PROVENANCE_H
#define DEM_OUTPUT_PROVENANCE_H

#include "output/hdf5_file.h"

enum { NOTES_PATH = 96 /**< bytes */ };

typedef struct notes_entry {
    char path[NOTES_PATH];
    char *text;
} notes_entry;

typedef struct notes {
    dem_index n, capacity;
    notes_entry *entries;
} notes;

/** The path of a note in a file; DEM_ERROR_ARGUMENT if it cannot have this name. */
dem_status notes_path(char path[NOTES_PATH], const char *name);

/** Adds a note, or replaces the one of this path; on failure nothing has changed. Free with notes_free(). */
dem_status notes_put(notes *all, const char *path, const char *text);
void notes_free(notes *all);

dem_status notes_write(const notes *all, const hdf5_file *file);

/** How many bytes notes_write() adds, at most. */
hsize_t notes_bytes(const notes *all);

#endif
