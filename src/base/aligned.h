/* SPDX-License-Identifier: BSD-3-Clause */
/* Memory for numbers that vector instructions read: arrays begin at a cache line, so that a load at a multiple of
 * its own length never touches two lines. Memory that grows is in grow.h instead. */
#ifndef DEM_BASE_ALIGNED_H
#define DEM_BASE_ALIGNED_H

#include <stdint.h>
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

/** The same in a block to be freed. Of a large block the system clears pages when they are touched, and those that
 *  never are take no memory.  \return where the array begins in the block */
static inline double *aligned_zeros_in(void **block, size_t n)
{
    *block = calloc(n + ALIGNED_TO / sizeof(double), sizeof(double));
    const uintptr_t past = (uintptr_t)*block % ALIGNED_TO;
    return *block != NULL ? (double *)((char *)*block + (past > 0 ? ALIGNED_TO - past : 0)) : NULL;
}

#endif
