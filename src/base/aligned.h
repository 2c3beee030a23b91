/* SPDX-License-Identifier: BSD-3-Clause */
/* Memory for numbers that vector instructions read: from the start of a cache line on. */
#ifndef DEM_BASE_ALIGNED_H
#define DEM_BASE_ALIGNED_H

#include <stdlib.h>
#include <string.h>

enum { ALIGNED_TO = 64 };

/** n numbers, not set, never of no bytes; NULL without memory. Free with free(). */
static inline double *aligned_reals(size_t n)
{
    const size_t line = ALIGNED_TO / sizeof(double);
    return aligned_alloc(ALIGNED_TO, (n / line + 1) * ALIGNED_TO);
}

/** n zeros. */
static inline double *aligned_zeros(size_t n)
{
    double *array = aligned_reals(n);
    return array != NULL ? memset(array, 0, n * sizeof *array) : NULL;
}

#endif
