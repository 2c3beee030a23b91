/* SPDX-License-Identifier: BSD-3-Clause */
/* Lists of numbers in ascending order. */
#ifndef DEM_BASE_SORTED_H
#define DEM_BASE_SORTED_H

#include <stdbool.h>
#include <stdlib.h>

#include <dem/dem.h>

static inline int sorted_compare(const void *a, const void *b)
{
    const dem_index first = *(const dem_index *)a, second = *(const dem_index *)b;
    return (first > second) - (first < second);
}

/** Whether a list [n] is in ascending order, with each number once. */
static inline bool sorted_is(const dem_index *list, dem_index n)
{
    for (dem_index k = 1; k < n; k++)
        if (list[k - 1] >= list[k]) return false;
    return true;
}

/** Puts a list [n] in ascending order, each number once.  \return how many there are */
static inline dem_index sorted_make(dem_index *list, dem_index n)
{
    dem_index kept = 0;
    if (sorted_is(list, n)) return n;
    qsort(list, (size_t)n, sizeof *list, sorted_compare);
    for (dem_index k = 0; k < n; k++)
        if (kept == 0 || list[k] != list[kept - 1]) list[kept++] = list[k];
    return kept;
}

/** Merges two such lists, whose common numbers come once.
 *  \param[out] out  [n_a + n_b]  \return how many there are */
static inline dem_index sorted_merge(dem_index *out, const dem_index *a, dem_index n_a, const dem_index *b,
                                     dem_index n_b)
{
    dem_index n = 0, p = 0, q = 0;
    while (p < n_a || q < n_b) {
        const bool from_a = q == n_b || (p < n_a && a[p] <= b[q]), from_b = p == n_a || (q < n_b && b[q] <= a[p]);
        out[n++] = from_a ? a[p] : b[q];
        p += from_a;
        q += from_b;
    }
    return n;
}

/** The place in a list [n] of the first number that is not below `number`; n: there is none. */
static inline dem_index sorted_first(const dem_index *list, dem_index n, dem_index number)
{
    dem_index low = 0, high = n;
    while (low < high) {
        const dem_index middle = low + (high - low) / 2;
        if (list[middle] < number)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/** Where a number is in a list [n], which has each number once; -1: nowhere. */
static inline dem_index sorted_find(const dem_index *list, dem_index n, dem_index number)
{
    const dem_index first = sorted_first(list, n, number);
    return first < n && list[first] == number ? first : -1;
}

#endif
