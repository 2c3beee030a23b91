/* SPDX-License-Identifier: BSD-3-Clause */
/* Elements and the times at which they are due: which is due first. There is room for those alone that are due at all,
 * which are few of a body. */
#ifndef DEM_FRACTURE_DUE_ELEMENTS_H
#define DEM_FRACTURE_DUE_ELEMENTS_H

#include <math.h>
#include <stdint.h>

#include <dem/dem.h>

typedef struct due_element {
    double t; /* s */
    dem_index element;
} due_element;

typedef struct due_elements {
    dem_index n, capacity;
    due_element *list; /* [n] a heap: none is due before its parent, which is at (place - 1)/2 */
    dem_index n_cells; /* a power of 2, at least 2 capacity */
    int32_t *cells;    /* [n_cells] places in the list, by hashed elements; -1: empty */
    dem_status status; /* DEM_ERROR_MEMORY: some have found no room since due_elements_clear() */
} due_elements;

/** Of one that was zero. */
void due_elements_destroy(due_elements *d);

void due_elements_clear(due_elements *d);

/** Sets when an element is due; infinity: never. */
void due_elements_set(due_elements *d, dem_index element, double t);

/** When the first is due, s; infinity: none is. */
static inline double due_elements_first(const due_elements *d)
{
    return d->n > 0 ? d->list[0].t : (double)INFINITY;
}

#endif
