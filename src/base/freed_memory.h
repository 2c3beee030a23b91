/* SPDX-License-Identifier: BSD-3-Clause */
/* Memory that was needed for a moment and has been freed. The C library keeps it for arrays to come, unless it is asked
 * to give it back. */
#ifndef DEM_BASE_FREED_MEMORY_H
#define DEM_BASE_FREED_MEMORY_H

#include <stdlib.h>

#include <dem/dem.h>

#ifdef __GLIBC__
#include <malloc.h>
#endif

enum { FREED_MEMORY_NODES = 10000 };

/** Gives freed memory back to the system, before or after the set-up of a run of so many nodes, or of a part of it.
 *  Else the C library would make arrays of it of which a run uses few pages, and clear them whole. Of small bodies
 *  there is little, and they may be set up often. */
static inline void freed_memory_return(dem_index n_nodes)
{
#ifdef __GLIBC__
    if (n_nodes >= FREED_MEMORY_NODES) (void)malloc_trim(0);
#else
    (void)n_nodes;
#endif
}

#endif
