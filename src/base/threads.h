/* SPDX-License-Identifier: BSD-3-Clause */
/* Work in shares that threads do at the same time; one after the other in a build without OpenMP. */
#ifndef DEM_BASE_THREADS_H
#define DEM_BASE_THREADS_H

#include <dem/dem.h>

#ifdef _OPENMP
#define THREADS_DO(directive) _Pragma(#directive)
#else
#define THREADS_DO(directive)
#endif

/** Makes a call for each of n threads, of number `t`. A single one is not left to OpenMP: to make a team of one takes a
 *  tenth of the time of a small body's step. */
#define THREADS_RUN(n, t, ...)                                                                                         \
    do {                                                                                                               \
        if ((n) == 1) {                                                                                                \
            const int t = 0;                                                                                           \
            __VA_ARGS__;                                                                                               \
            break;                                                                                                     \
        }                                                                                                              \
        THREADS_DO(omp parallel for num_threads(n) schedule(static))                                                   \
        for (int t = 0; t < (n); t++) __VA_ARGS__;                                                                     \
    } while (0)

/** Where share k of n things for `threads` threads begins. */
static inline dem_index threads_share(dem_index n, int threads, int k)
{
    return n * k / threads;
}

#endif
