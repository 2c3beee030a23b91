/* SPDX-License-Identifier: BSD-3-Clause */
/* Quotas as Linux has them: in the second version of control groups `cpu.max` has "QUOTA PERIOD" or "max PERIOD", us;
 * in the first one cpu.cfs_quota_us and cpu.cfs_period_us are files of their own, and a quota of -1 is none. Affinity
 * is the line "Cpus_allowed:" of a thread's status, a mask of hexadecimal digits. */
#include "base/cores.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MOST_PATH = 4096 };

/* The numbers that a file begins with, up to two. NAN in the place of those that are none. */
static void read_numbers(const char *folder, const char *name, double value[2])
{
    char path[MOST_PATH + 64];
    value[0] = value[1] = (double)NAN;
    (void)snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "r");
    if (file == NULL) return;
    if (fscanf(file, "%lf %lf", &value[0], &value[1]) < 1) value[0] = (double)NAN;
    (void)fclose(file);
}

/* Quota of one group, in cores; infinite if it has none. */
static double quota_of(const char *folder)
{
    double both[2], quota[2], period[2];
    read_numbers(folder, "cpu.max", both);
    if (both[0] / both[1] > 0.0) return both[0] / both[1];
    read_numbers(folder, "cpu.cfs_quota_us", quota);
    read_numbers(folder, "cpu.cfs_period_us", period);
    return quota[0] / period[0] > 0.0 ? quota[0] / period[0] : INFINITY;
}

/* The least quota of a group below `root` and of all groups that it is in. */
static double least_quota(const char *root, const char *group)
{
    char folder[MOST_PATH];
    double least = INFINITY;
    if (snprintf(folder, sizeof folder, "%s%s", root, group) >= MOST_PATH) return least;
    for (char *end = folder + strlen(folder); end != NULL && end >= folder + strlen(root); end = strrchr(folder, '/')) {
        *end = '\0';
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

/* Bits that are set in hexadecimal digits, whatever is between these. */
static int count_bits(const char *mask)
{
    int n = 0;
    for (; *mask != '\0'; mask++) {
        const char digit[2] = {*mask, '\0'};
        for (long bits = isxdigit((unsigned char)*mask) ? strtol(digit, NULL, 16) : 0; bits > 0; bits /= 2)
            n += bits % 2 != 0;
    }
    return n;
}

int cores_affinity(const char *status)
{
    static const char key[] = "Cpus_allowed:";
    char line[MOST_PATH];
    int n = 0;
    FILE *file = fopen(status, "r");
    if (file == NULL) return 0;
    while (n == 0 && fgets(line, sizeof line, file) != NULL)
        if (strncmp(line, key, sizeof key - 1) == 0) n = count_bits(line + sizeof key - 1);
    (void)fclose(file);
    return n;
}

int cores_allowed(void)
{
    const double quota = ceil(cores_quota("/proc/self/cgroup", "/sys/fs/cgroup"));
    const int listed = cores_affinity("/proc/thread-self/status");
    const int cores = listed > 0 ? listed : (int)sysconf(_SC_NPROCESSORS_ONLN);
    return quota < cores ? (int)quota : cores;
}
