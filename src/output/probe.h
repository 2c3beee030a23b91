/* SPDX-License-Identifier: BSD-3-Clause */
/* The groups /probes/NAME of a trajectory: a node, a spring or a gauge over time (docs/output.md). */
#ifndef DEM_OUTPUT_PROBE_H
#define DEM_OUTPUT_PROBE_H

#include <stdbool.h>

#include <dem/trajectory.h>

#include "lattice/lattice_source.h"
#include "output/table.h"

enum { PROBE_COLUMNS = 5 /**< at most */ };

typedef struct probe {
    dem_probe what;    /**< with a name of the probe's own */
    double initial;    /**< distance of a gauge's nodes at rest, m; the rest length of a spring, */
    dem_index ends[2]; /**< and its nodes */
    dem_index left;    /**< accepted steps until the next row */
    bool seen;         /**< whether there was a step */
    double last;       /**< time of the last step, s */
    char *text;        /**< the names, one allocation */
    table_column columns[PROBE_COLUMNS];
    table table; /**< refers to the columns: a probe must stay where it is */
} probe;

/** What a checkpoint keeps of a probe, in words of 8 bytes. */
typedef struct probe_progress {
    char name[64];
    int64_t kind, number[2], every;
    int64_t rows, left, seen;
    double last;
} probe_progress;

/** Checks and copies; `out` is left empty on failure. Free with probe_free(). */
dem_status probe_init(probe *out, const dem_probe *what, const lattice_source *lattice);
void probe_free(probe *p);

/** Makes the group: datasets without rows, with their units, and attributes that say what is probed. */
dem_status probe_create(const probe *p, const hdf5_file *file);

/** Appends the state as a row if one is due. The table's buffer must have room.
 *  \return DEM_ERROR_MEMORY */
dem_status probe_record(probe *p, const dem_simulation *simulation);

probe_progress probe_progress_of(const probe *p);

/** Goes on from there. The rows in files are the caller's task. DEM_ERROR_ARGUMENT if it is another probe's. */
dem_status probe_restore(probe *p, const probe_progress *memory);

#endif
