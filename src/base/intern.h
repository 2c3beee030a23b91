/* SPDX-License-Identifier: BSD-3-Clause */
/* Lists one behind the other, of which equal ones are held once. */
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
    void *items; /* [n] */
    dem_index n, capacity;
    intern_span *lists; /* [n_lists] those held */
    dem_index n_lists, list_capacity;
    int32_t *slots; /* [n_slots] hash table: numbers of lists, -1: none */
    dem_index n_slots;
} intern;

/** Where a list is that has these `n` items; it is added if there is none.
 *  \return DEM_ERROR_MEMORY, or DEM_ERROR_MODEL for more than 2^31 items */
dem_status intern_find(intern *p, const void *items, dem_index n, intern_span *out);

/** Frees what is needed to find lists, and puts the items at the start of a cache line. */
dem_status intern_settle(intern *p);

void intern_free(intern *p);

#endif
