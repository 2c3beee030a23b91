/* SPDX-License-Identifier: BSD-3-Clause */
/* Loops whose rounds may run at the same time; one after the other in a build without OpenMP. */
#ifndef DEM_THREADS_H
#define DEM_THREADS_H

#include <dem/dem.h>

#ifdef _OPENMP
#define THREADS_DO(directive) _Pragma(#directive)
/** Before a `for` over the shares of `n` threads. */
#define THREADS_EACH(n) THREADS_DO(omp parallel for num_threads(n) schedule(static) if (n > 1))
#else
#define THREADS_EACH(n)
#endif

/** Where share k of n things for `threads` threads begins. */
static inline dem_index threads_share(dem_index n, int threads, int k)
{
    return n * k / threads;
}

#endif
