/* SPDX-License-Identifier: BSD-3-Clause */
/* Obstacles as they were given, in the group /obstacles, and as lines for ParaView, in a file of their own. */
#ifndef DEM_OBSTACLE_FILE_H
#define DEM_OBSTACLE_FILE_H

#include "hdf5_file.h"

/** Makes /obstacles/0, /obstacles/1, ... */
dem_status obstacle_file_write(const hdf5_file *file, const dem_model *model);

/** Makes the file `part`, of lines, and publishes it as `path`; after a failure there is no part. */
dem_status obstacle_file_publish(const char *part, const char *path, const dem_model *model, int deflate);

#endif
