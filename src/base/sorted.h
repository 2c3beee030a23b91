/* SPDX-License-Identifier: BSD-3-Clause */
/* Lists of numbers in ascending order. */
#ifndef DEM_BASE_SORTED_H
#define DEM_BASE_SORTED_H

#include <dem/dem.h>

/** Where a number is in a list [n], which has each number once; -1: nowhere. */
static inline dem_index sorted_find(const dem_index *list, dem_index n, dem_index number)
{
    dem_index low = 0, high = n;
    while (low < high) {
        const dem_index middle = low + (high - low) / 2;
        if (list[middle] < number)
            low = middle + 1;
        else
            high = middle;
    }
    return low < n && list[low] == number ? low : -1;
}

#endif
