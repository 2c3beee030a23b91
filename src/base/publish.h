/* SPDX-License-Identifier: BSD-3-Clause */
/* Publishing a finished file under its final name, so that this name always stands for a whole file. */
#ifndef DEM_BASE_PUBLISH_H
#define DEM_BASE_PUBLISH_H

#include <dem/checkpoint.h>

/** Makes sure that a closed file, or a folder, is on the disk. */
dem_status publish_sync(const char *path);

/** Renames a synced file and syncs its new folder. */
dem_status publish_rename(const char *part, const char *path);

#endif
