/* SPDX-License-Identifier: BSD-3-Clause */
/* What a run may take. */
#ifndef DEM_LIMITS_H
#define DEM_LIMITS_H

#include "estimate.h"

typedef struct limits {
    double memory; /* bytes */
    double steps;
    double disk; /* bytes; infinite: none */
} limits;

typedef enum limits_breach { LIMITS_KEPT, LIMITS_MEMORY, LIMITS_STEPS, LIMITS_DISK } limits_breach;

/** The memory that this process may get of the machine, 1e10 steps, any output. */
limits limits_default(void);

/** Sets the limit of an option, "--max-memory", "--max-steps" or "--max-disk", from its argument: a number > 0, the
 *  first and the last in GB. False if it is none, or NULL.
 *  \param option  one for which limits_is_option() is true */
bool limits_set(limits *most, const char *option, const char *argument);
bool limits_is_option(const char *word);

/** Sets the limit of the disk to what is free in a folder and what the files of a run there take already. False where
 *  the file system does not tell; nothing is set then. */
bool limits_see_disk(limits *most, const char *folder, const char *name);

/** Reports, with the option that goes beyond it, each limit that a run would exceed.
 *  \return the first of them */
limits_breach limits_check(const limits *most, const estimate *needed, const deck *d, namelist_errors *errors);

/** The least limit of a hierarchy of control groups, version 2, bytes; infinite without one.
 *  \param root  where it is mounted
 *  \param list  the process's groups, as in /proc/self/cgroup */
double limits_of_groups(const char *root, const char *list);

#endif
