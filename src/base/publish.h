/* SPDX-License-Identifier: BSD-3-Clause */
/* A finished file takes its place: what a name stands for is whole, whenever the machine stops. */
#ifndef DEM_BASE_PUBLISH_H
#define DEM_BASE_PUBLISH_H

#include <dem/checkpoint.h>

/** Brings a closed file, or a folder, to the disk. */
dem_status publish_sync(const char *path);

/** Renames a synced file and syncs the folder that it is in then. */
dem_status publish_rename(const char *part, const char *path);

#endif
