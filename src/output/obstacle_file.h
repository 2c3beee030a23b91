/* SPDX-License-Identifier: BSD-3-Clause */
/* Obstacles in files: as they were given, in the group /obstacles of a trajectory; and as lines for ParaView, in a file
 * of their own. */
#ifndef DEM_OUTPUT_OBSTACLE_FILE_H
#define DEM_OUTPUT_OBSTACLE_FILE_H

#include <stdbool.h>

#include "output/hdf5_file.h"

/** Makes /obstacles/0, /obstacles/1, ... */
dem_status obstacle_file_write(const hdf5_file *file, const dem_model *model);

/** Reads the obstacles [*n] of a file from anywhere. Free them and their points with obstacle_file_free().
 *  \return DEM_ERROR_IO with the dataset and the reason */
dem_status obstacle_file_read(const hdf5_file *file, dem_obstacle **out, dem_index *n);
void obstacle_file_free(dem_obstacle *obstacles, dem_index n);

/** Whether some obstacle moves. */
bool obstacle_file_moves(const dem_model *model);

/** Times at which obstacles are drawn, s. Without any they are drawn at t = 0, in a file without steps. */
typedef struct obstacle_file_times {
    dem_index n;
    const double *t;
} obstacle_file_times;

/** Makes the file `part` with the lines, and publishes it as `path`. After a failure there is no part. */
dem_status obstacle_file_publish(const char *part, const char *path, const dem_model *model, obstacle_file_times at,
                                 int deflate);

#endif
