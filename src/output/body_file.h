/* SPDX-License-Identifier: BSD-3-Clause */
/* The file by which VTK and ParaView show the triangles of a run as filled bodies. */
#ifndef DEM_OUTPUT_BODY_FILE_H
#define DEM_OUTPUT_BODY_FILE_H

#include <dem/dem.h>

/** Makes the file `part`, which leads to the grid of triangles in `run`, a file of the same folder, and publishes it as
 *  `path`. After a failure there is no part. */
dem_status body_file_publish(const char *part, const char *path, const char *run);

#endif
