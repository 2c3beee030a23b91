/* SPDX-License-Identifier: BSD-3-Clause */
/* Lists of items, one behind the other in memory, where equal lists are stored once. The sweep reads coefficients and
 * instructions of blocks from it: equal blocks share them, and they stay in the cache. */
#ifndef DEM_BASE_INTERN_H
#define DEM_BASE_INTERN_H

#include <stddef.h>

#include <dem/dem.h>

/** A list: items first to end - 1. */
typedef struct intern_span {
    int32_t first, end;
} intern_span;

typedef struct intern {
    size_t unit; /* bytes of an item, a multiple of 8 without padding */
    void *items; /* [n] from the start of a cache line */
    dem_index n, capacity;
    intern_span *lists; /* [n_lists] those held */
    dem_index n_lists, list_capacity;
    int32_t *slots; /* [n_slots] hash table: numbers of lists, -1: none */
    dem_index n_slots;
} intern;

/** The span of a list with these `n` items; it is appended if there is none yet.
 *  \return DEM_ERROR_MEMORY, or DEM_ERROR_MODEL for more than 2^31 items */
dem_status intern_find(intern *p, const void *items, dem_index n, intern_span *out);

/** Ends the building: frees the hash table and what has not been used. */
dem_status intern_settle(intern *p);

/** Copies the items, so that spans are valid in both. Lists that are found in the copy are new ones behind them. */
dem_status intern_copy(intern *out, const intern *from);

void intern_free(intern *p);

#endif
