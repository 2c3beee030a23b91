/* SPDX-License-Identifier: BSD-3-Clause */
/* How many cores this process may use. A cluster or a container gives a process fewer than the machine has: by a set of
 * cores (affinity), or by a quota of time of its control group (cgroup). More threads than that wait for each other. */
#ifndef DEM_BASE_CORES_H
#define DEM_BASE_CORES_H

/** At least 1: what affinity and quota both allow. */
int cores_allowed(void);

/** The least quota of a control group and of those it is in, in cores.
 *  \param groups  file that says which groups the process is in, as /proc/self/cgroup
 *  \param root    where groups are mounted, as /sys/fs/cgroup
 *  \return infinite if there is none, or if it cannot be read */
double cores_quota(const char *groups, const char *root);

/** How many cores the affinity of a thread has.
 *  \param status  a file such as /proc/self/status
 *  \return 0 if it does not say */
int cores_affinity(const char *status);

#endif
