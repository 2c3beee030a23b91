/* SPDX-License-Identifier: BSD-3-Clause */
/* What a run may take. */
#ifndef DEM_LIMIT_H
#define DEM_LIMIT_H

#include <stdbool.h>

typedef struct limits {
    double memory; /* bytes */
    double steps;
    double disk; /* bytes; infinite: none */
} limits;

/** The memory that this process may get of the machine, 1e10 steps, any output. */
limits limit_default(void);

/** Sets a limit from the text of a number > 0, times `unit`. False if it is none, or NULL. */
bool limit_set(double *limit, const char *text, double unit);

/** Sets the limit of the disk to what is free in a folder, or where it would be made, unless a run of this name has
 *  left files there, which then goes on. False where the file system does not say. */
bool limit_see_disk(limits *most, const char *folder, const char *name);

/** The least limit of a hierarchy of control groups, version 2, bytes; infinite without one.
 *  \param root  where it is mounted
 *  \param list  the process's groups, as in /proc/self/cgroup */
double limit_of_groups(const char *root, const char *list);

#endif
