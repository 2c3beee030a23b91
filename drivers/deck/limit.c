/* SPDX-License-Identifier: BSD-3-Clause */
#include "limit.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/statvfs.h>
#include <unistd.h>

/* ---- what there is ---- */

/* Of one group; infinite where it has none, "max". */
static double limit_of_group(const char *root, const char *group)
{
    char path[8192];
    double bytes = (double)INFINITY;
    const int n = snprintf(path, sizeof path, "%s%s/memory.max", root, group);
    FILE *file = n > 0 && (size_t)n < sizeof path ? fopen(path, "r") : NULL;
    if (file == NULL) return bytes;
    if (fscanf(file, "%lf", &bytes) != 1) bytes = (double)INFINITY;
    (void)fclose(file);
    return bytes;
}

double limit_of_groups(const char *root, const char *list)
{
    char group[4096] = "";
    FILE *file = fopen(list, "r");
    while (file != NULL && fgets(group, sizeof group, file) != NULL && strncmp(group, "0::", 3) != 0) group[0] = '\0';
    if (file != NULL) (void)fclose(file);
    group[strcspn(group, "\n")] = '\0';
    double least = (double)INFINITY;
    for (char *end = strrchr(group, '/'); end != NULL; end = strrchr(group, '/')) {
        least = fmin(least, limit_of_group(root, group + 3));
        *end = '\0';
    }
    return group[0] != '\0' ? fmin(least, limit_of_group(root, "")) : least;
}

limits limit_default(void)
{
    struct rlimit space;
    const double machine = (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
    limits most = {.memory = fmin(machine, limit_of_groups("/sys/fs/cgroup", "/proc/self/cgroup")),
                   .steps = 1e10,
                   .disk = (double)INFINITY};
    if (getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY)
        most.memory = fmin(most.memory, (double)space.rlim_cur);
    return most;
}

static bool ends_with(const char *text, const char *end)
{
    const size_t n = strlen(text), m = strlen(end);
    return n >= m && strcmp(text + n - m, end) == 0;
}

/* Whether there are files NAME.*.vtkhdf. */
static bool has_begun(const char *folder, const char *name)
{
    const size_t n = strlen(name);
    bool found = false;
    DIR *files = opendir(folder);
    for (const struct dirent *entry; files != NULL && !found && (entry = readdir(files)) != NULL;)
        found = strncmp(entry->d_name, name, n) == 0 && entry->d_name[n] == '.' && ends_with(entry->d_name, ".vtkhdf");
    if (files != NULL) (void)closedir(files);
    return found;
}

/* Cuts a path down to what there is of it. */
static void go_up(char *path)
{
    while (access(path, F_OK) != 0) {
        char *slash = strrchr(path, '/');
        if (slash == NULL || slash == path) {
            (void)strcpy(path, slash == NULL ? "." : "/");
            return;
        }
        *slash = '\0';
    }
}

bool limit_see_disk(limits *most, const char *folder, const char *name)
{
    char path[4096];
    struct statvfs system;
    const int n = snprintf(path, sizeof path, "%s", folder);
    if (n < 0 || (size_t)n >= sizeof path || has_begun(folder, name)) return true; /* too long: it is refused */
    go_up(path);
    if (statvfs(path, &system) != 0 || system.f_blocks == 0) return false;
    most->disk = (double)system.f_bavail * (double)system.f_frsize;
    return true;
}

bool limit_set(double *limit, const char *text, double unit)
{
    char *end = NULL;
    const double value = text != NULL ? strtod(text, &end) : 0.0;
    if (end == text || *end != '\0' || !isfinite(value * unit) || value <= 0.0) return false;
    *limit = value * unit;
    return true;
}
