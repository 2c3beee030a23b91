/* SPDX-License-Identifier: BSD-3-Clause */
/* Memory for numbers that vector instructions read: arrays begin at a cache line, so that a load at a multiple of
 * its own length never touches two lines. Memory that grows is in grow.h instead. */
#ifndef DEM_BASE_ALIGNED_H
#define DEM_BASE_ALIGNED_H

#include <stdlib.h>
#include <string.h>

enum { ALIGNED_TO = 64 };

/** An array of n numbers that are not set; it has memory for n = 0, too. NULL if there is no memory. Free with
 *  free(). */
static inline double *aligned_reals(size_t n)
{
    const size_t line = ALIGNED_TO / sizeof(double);
    return aligned_alloc(ALIGNED_TO, (n / line + 1) * ALIGNED_TO);
}

/** The same, filled with zeros. */
static inline double *aligned_zeros(size_t n)
{
    double *array = aligned_reals(n);
    return array != NULL ? memset(array, 0, n * sizeof *array) : NULL;
}

#endif
