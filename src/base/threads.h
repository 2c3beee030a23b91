/* SPDX-License-Identifier: BSD-3-Clause */
/* Loops over threads. Work is given out in shares that do not depend on timing, and each share writes its own results,
 * so the number of threads changes no bit. In a build without OpenMP the shares are taken one after the other. */
#ifndef DEM_BASE_THREADS_H
#define DEM_BASE_THREADS_H

#include <dem/dem.h>

#ifdef _OPENMP
#include <omp.h>
#define THREADS_DO(directive) _Pragma(#directive)
#define THREADS_MOST          omp_get_num_procs() /* cores that affinity leaves to the process */
#else
#define THREADS_DO(directive)
#define THREADS_MOST 1
#endif

/** Runs a statement for t = 0 to n - 1, each in a thread of its own. A single one is not left to OpenMP: creating a
 *  team of one takes a tenth of the time of a small body's step. */
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

/** Where share k of n items begins when they are divided among `threads` threads; share k ends where share k + 1
 *  begins. */
static inline dem_index threads_share(dem_index n, int threads, int k)
{
    return n * k / threads;
}

#endif
