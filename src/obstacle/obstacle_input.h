/* SPDX-License-Identifier: BSD-3-Clause */
/* Reads callers' obstacles, whose struct may be of another version of the library. */
#ifndef DEM_OBSTACLE_OBSTACLE_INPUT_H
#define DEM_OBSTACLE_OBSTACLE_INPUT_H

#include <dem/model.h>

/** Reads a caller's obstacle. The points remain the caller's.  \return DEM_ERROR_ARGUMENT */
dem_status obstacle_input_read(dem_obstacle *ours, const dem_obstacle *theirs);

/** Reads n of them into an array to be freed.  \return DEM_ERROR_ARGUMENT, DEM_ERROR_MEMORY */
dem_status obstacle_input_read_all(void **ours, const dem_obstacle *theirs, dem_index n);

#endif
