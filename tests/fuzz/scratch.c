/* SPDX-License-Identifier: BSD-3-Clause */
#include "scratch.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MOST = 8 };

static char folder[256];
static char paths[MOST][288];

/* Other files than those that were named may have been made beside them. */
static void sweep(void)
{
    DIR *list = opendir(folder);
    for (struct dirent *entry; list != NULL && (entry = readdir(list)) != NULL;)
        (void)unlinkat(dirfd(list), entry->d_name, 0);
    if (list != NULL) (void)closedir(list);
    (void)rmdir(folder);
}

static void make_folder(void)
{
    const char *parent = getenv("TMPDIR");
    (void)snprintf(folder, sizeof folder, "%s/dem_fuzz_XXXXXX", parent != NULL ? parent : "/tmp");
    if (mkdtemp(folder) == NULL || atexit(sweep) != 0) abort();
}

const char *scratch_path(const char *name)
{
    int k = 0;
    if (folder[0] == '\0') make_folder();
    for (; k < MOST && paths[k][0] != '\0'; k++)
        if (strcmp(strrchr(paths[k], '/') + 1, name) == 0) return paths[k];
    if (k == MOST || snprintf(paths[k], sizeof paths[k], "%s/%s", folder, name) >= (int)sizeof paths[k]) abort();
    return paths[k];
}

void scratch_write(const char *path, const void *data, size_t size)
{
    FILE *file = fopen(path, "wb");
    if (file == NULL || fwrite(data, 1, size, file) != size || fclose(file) != 0) abort();
}

size_t scratch_read(const char *path, void *data, size_t most)
{
    FILE *file = fopen(path, "rb");
    if (file == NULL) abort();
    const size_t size = fread(data, 1, most, file);
    if (fclose(file) != 0 || size == most) abort();
    return size;
}
