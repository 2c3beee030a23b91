/* SPDX-License-Identifier: BSD-3-Clause */
/* Arrays that grow as items are appended, at a cost per item that does not depend on their length. */
#ifndef DEM_BASE_GROW_H
#define DEM_BASE_GROW_H

#include <stdbool.h>
#include <stdlib.h>

#include <dem/dem.h>

/** Makes sure that an array of items of `size` bytes has room for `needed` of them. Where it has to grow, it gets room
 *  for twice as many. False if there is no memory: the array is then as it was. */
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
