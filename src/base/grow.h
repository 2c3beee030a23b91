/* SPDX-License-Identifier: BSD-3-Clause */
/* Arrays that grow as items are appended. */
#ifndef DEM_BASE_GROW_H
#define DEM_BASE_GROW_H

#include <stdbool.h>
#include <stdlib.h>

#include <dem/dem.h>

/** Makes room for `needed` items of `size` bytes, and as many again. False without memory: the array is as it was. */
static inline bool grow_array(void **array, dem_index *capacity, dem_index needed, size_t size)
{
    if (needed <= *capacity) return true;
    const dem_index more = 2 * needed + 64;
    void *larger = realloc(*array, (size_t)more * size);
    if (larger == NULL) return false;
    *array = larger;
    *capacity = more;
    return true;
}

#endif
