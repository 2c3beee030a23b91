/* SPDX-License-Identifier: BSD-3-Clause */
/* Quotas as Linux has them: in the second version of control groups `cpu.max` has "QUOTA PERIOD" or "max PERIOD", us;
 * in the first one cpu.cfs_quota_us and cpu.cfs_period_us are files of their own, and a quota of -1 is none. */
#include "base/cores.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/threads.h"

enum { MOST_PATH = 4096 };

/* The first word of a file as a number; NAN if there is none. */
static double read_number(const char *folder, const char *name)
{
    char path[MOST_PATH + 64], word[32] = "", *end;
    (void)snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "r");
    if (file == NULL) return (double)NAN;
    const bool found = fscanf(file, "%31s", word) == 1;
    (void)fclose(file);
    const double value = strtod(word, &end);
    return found && end != word && *end == '\0' ? value : (double)NAN;
}

/* What follows the first word. */
static double read_second(const char *folder, const char *name)
{
    char path[MOST_PATH + 64];
    double value = (double)NAN;
    (void)snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "r");
    if (file == NULL) return value;
    if (fscanf(file, "%*s %lf", &value) != 1) value = (double)NAN;
    (void)fclose(file);
    return value;
}

/* Quota of one group, in cores; infinite if it has none. */
static double quota_of(const char *folder)
{
    const double second = read_number(folder, "cpu.max") / read_second(folder, "cpu.max");
    const double first = read_number(folder, "cpu.cfs_quota_us") / read_number(folder, "cpu.cfs_period_us");
    return second > 0.0 ? second : first > 0.0 ? first : INFINITY;
}

/* The least quota of a group below `root` and of all groups that it is in. */
static double least_quota(const char *root, const char *group)
{
    char folder[MOST_PATH];
    double least = INFINITY;
    if (snprintf(folder, sizeof folder, "%s%s", root, group) >= MOST_PATH) return least;
    for (size_t end = strlen(folder); end >= strlen(root); end--) {
        if (folder[end] != '\0' && folder[end] != '/') continue;
        folder[end] = '\0';
        least = fmin(least, quota_of(folder));
    }
    return least;
}

/* A line is NUMBER:CONTROLLERS:GROUP. In the second version there are no controllers, and groups are right below the
 * root; in the first the controllers are a folder. */
static double quota_of_line(char *line, const char *root)
{
    char mount[MOST_PATH], *controllers = strchr(line, ':');
    char *group = controllers != NULL ? strchr(controllers + 1, ':') : NULL;
    if (group == NULL) return INFINITY;
    *group++ = '\0';
    group[strcspn(group, "\n")] = '\0';
    if (controllers[1] == '\0') return least_quota(root, group);
    if (strstr(controllers, "cpu") == NULL) return INFINITY;
    return snprintf(mount, sizeof mount, "%s/%s", root, controllers + 1) < MOST_PATH ? least_quota(mount, group)
                                                                                     : INFINITY;
}

double cores_quota(const char *groups, const char *root)
{
    char line[MOST_PATH];
    double least = INFINITY;
    FILE *file = fopen(groups, "r");
    if (file == NULL) return least;
    while (fgets(line, sizeof line, file) != NULL) least = fmin(least, quota_of_line(line, root));
    (void)fclose(file);
    return least;
}

int cores_allowed(void)
{
    const double quota = ceil(cores_quota("/proc/self/cgroup", "/sys/fs/cgroup"));
    return quota < THREADS_MOST ? (int)quota : THREADS_MOST;
}
