/* SPDX-License-Identifier: BSD-3-Clause */
/* A file has one grid for VTK's readers, in the group /VTKHDF, and that of a run is its springs. Its triangles are a
 * grid of their own, in the group FRAMES_BODIES of the same file, over the same data (frames.c). This file has nothing
 * but a link, /VTKHDF, to that group: readers that follow it find triangles where they look for a grid. It need not be
 * written again when frames are added. */
#include "output/body_file.h"

#include "base/status.h"
#include "output/frames.h"
#include "output/hdf5_file.h"

#include <string.h>
#include <unistd.h>

/* The link has no folder, so that the files of a run may be moved together. */
dem_status body_file_publish(const char *part, const char *path, const char *run)
{
    hdf5_file file;
    const char *slash = strrchr(run, '/'), *name = slash != NULL ? slash + 1 : run;
    dem_status status = hdf5_open_new(&file, part, 0);
    if (status == DEM_OK) status = hdf5_close(&file, hdf5_link_file(&file, "/VTKHDF", name, FRAMES_BODIES));
    if (status == DEM_OK) status = hdf5_publish(part, path);
    if (status != DEM_OK) (void)unlink(part);
    return status;
}
