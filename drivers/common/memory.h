/* SPDX-License-Identifier: BSD-3-Clause */
/* What the program takes, for its log; nothing that is computed depends on it. */
#ifndef DEM_MEMORY_H
#define DEM_MEMORY_H

#include <stdlib.h>

#ifdef __GLIBC__
#include <malloc.h>
#endif

/** Bytes that the C library has given out; 0 where it does not say. */
static inline double memory_in_use(void)
{
#if defined(__GLIBC__) && (__GLIBC__ > 2 || __GLIBC_MINOR__ >= 33)
    const struct mallinfo2 given = mallinfo2();
    return (double)given.uordblks + (double)given.hblkhd;
#else
    return 0.0;
#endif
}

#endif
