/* SPDX-License-Identifier: BSD-3-Clause */
/* Publishing a file: sync the file, rename it to its final name, sync the folder, in this order. A rename replaces the
 * name at once, but without the first sync the name may reach the disk before the bytes do, and without the last one
 * the rename itself may be lost. Whenever the machine stops, a name therefore stands for a whole file, old or new. What
 * is written into the files is the business of checkpoint_entries.c and of output/; this file sees paths only. */
#include "base/publish.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/status.h"

/* A read-only descriptor is enough for fsync() and works for folders as well. EINVAL means that the file system cannot
 * sync this kind of file: that is no error of the file. */
dem_status publish_sync(const char *path)
{
    const int descriptor = open(path, O_RDONLY | O_CLOEXEC);
    CHECK(descriptor >= 0, DEM_ERROR_IO, "%s: cannot be opened to sync it (%s)", path, strerror(errno));
    const int result = fsync(descriptor), cause = errno;
    (void)close(descriptor);
    CHECK(result == 0 || cause == EINVAL, DEM_ERROR_IO, "%s: cannot be synced (%s)", path, strerror(cause));
    return DEM_OK;
}

/* The rename is an entry of the folder, which has to be synced in its own right. */
static dem_status sync_folder_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    if (slash == NULL) return publish_sync(".");
    if (slash == path) return publish_sync("/");
    char *folder = strdup(path);
    CHECK_MEMORY(folder);
    folder[slash - path] = '\0';
    const dem_status status = publish_sync(folder);
    free(folder);
    return status;
}

dem_status publish_rename(const char *part, const char *path)
{
    CHECK(rename(part, path) == 0, DEM_ERROR_IO, "%s: cannot be renamed to %s (%s)", part, path, strerror(errno));
    return sync_folder_of(path);
}

dem_status dem_publish(const char *part, const char *path)
{
    CHECK(part != NULL && path != NULL, DEM_ERROR_ARGUMENT, "dem_publish: %s is NULL", part == NULL ? "part" : "path");
    TRY(publish_sync(part));
    return publish_rename(part, path);
}
