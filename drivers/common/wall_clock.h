/* SPDX-License-Identifier: BSD-3-Clause */
/* Time on the wall, for progress and for what took long; nothing that is computed depends on it. */
#ifndef DEM_WALL_CLOCK_H
#define DEM_WALL_CLOCK_H

#include <time.h>

/** s, from an arbitrary start; never goes back. */
static inline double wall_clock(void)
{
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

#endif
