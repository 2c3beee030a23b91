/* SPDX-License-Identifier: BSD-3-Clause */
/* Sync the file, rename it, sync the folder: in this order. */
#include "base/publish.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/status.h"

dem_status publish_sync(const char *path)
{
    const int descriptor = open(path, O_RDONLY | O_CLOEXEC);
    CHECK(descriptor >= 0, DEM_ERROR_IO, "%s: cannot be opened to sync it (%s)", path, strerror(errno));
    const int result = fsync(descriptor), cause = errno;
    (void)close(descriptor);
    CHECK(result == 0 || cause == EINVAL, DEM_ERROR_IO, "%s: cannot be synced (%s)", path, strerror(cause));
    return DEM_OK;
}

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
