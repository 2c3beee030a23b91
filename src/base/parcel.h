/* SPDX-License-Identifier: BSD-3-Clause */
/* Arrays that rank 0 sends to another rank, which has no memory for them yet. Both list them in the same order. */
#ifndef DEM_BASE_PARCEL_H
#define DEM_BASE_PARCEL_H

#include <stdbool.h>

#include <dem/dem.h>

#include "base/ranks.h"

typedef struct parcel_item {
    void *at; /* the address of the pointer to the array */
    size_t size;
} parcel_item;

typedef struct parcel {
    dem_index n, capacity;
    parcel_item *items; /* [n] */
    bool lacks_memory;  /* for the list */
} parcel;

/** Adds an array to the list.
 *  \param at    the address of the pointer to it. On rank 0 a pointer that is NULL stands for no array; on the other
 *               rank it is overwritten by memory that is to be freed with free(), or by NULL
 *  \param size  bytes; looked at on rank 0 only */
void parcel_add(parcel *p, void *at, size_t size);

/** Sends the arrays to rank `to`, which is not 0, and frees the list. Collective; on other ranks the list is empty.
 *  \return DEM_ERROR_MEMORY, on all ranks; then there is none of the arrays on the other rank */
dem_status parcel_send(const ranks *r, int to, parcel *p);

/** Sends bytes whose number both ranks know. Collective. */
void parcel_pass(const ranks *r, int to, void *bytes, size_t size);

#endif
