/* SPDX-License-Identifier: BSD-3-Clause */
/* The motion of an obstacle that a program moved, as the history of the run has it. */
#ifndef DEM_OUTPUT_MOTION_RECORD_H
#define DEM_OUTPUT_MOTION_RECORD_H

#include "output/hdf5_untrusted.h"

typedef struct motion_record {
    dem_index n;
    double *t, *place, *angle; /* [n] s, [n][2] m, [n] rad; owned */
} motion_record;

/** Reads it from /history; without one there are no rows. Free with motion_record_free() in any case. */
dem_status motion_record_read(motion_record *out, const hdf5_file *file, dem_index obstacle, dem_index n_obstacles);
void motion_record_free(motion_record *r);

/** The pose at t on the straight line between two rows, at rest: for drawing. `context` is a motion_record. */
dem_status motion_record_pose(void *context, double t, dem_pose *pose);

#endif
