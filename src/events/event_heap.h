/* SPDX-License-Identifier: BSD-3-Clause */
/* Keys 0 .. n_keys - 1 and the times at which they are due: which is due first, of those due at the same time that of
 * the lowest generation (event_source.h), and of these the one that an order of the caller's has first. A binary heap,
 * in which a key's time can be changed. The contact source has one, with a key for each candidate. */
#ifndef DEM_EVENTS_EVENT_HEAP_H
#define DEM_EVENTS_EVENT_HEAP_H

#include <stdbool.h>
#include <stdint.h>

#include <dem/dem.h>

/** An order of keys by what they stand for: whether a comes before b. */
typedef struct event_key_order {
    bool (*before)(const void *self, dem_index a, dem_index b);
    const void *self;
} event_key_order;

typedef struct event_heap {
    event_key_order order;
    dem_index n;
    int32_t *keys;       /* [n] none is due before its parent, which is at (place - 1)/2 */
    int32_t *place;      /* [n_keys] in `keys`, or -1 */
    int32_t *generation; /* [n_keys] of those in `keys` */
    double *due;         /* [n_keys] s, of those in `keys` */
} event_heap;

/** Empty. Free with event_heap_destroy().  \return DEM_ERROR_MEMORY; DEM_ERROR_MODEL for 2^31 keys */
dem_status event_heap_create(event_heap *out, dem_index n_keys, event_key_order order);
void event_heap_destroy(event_heap *h);

void event_heap_clear(event_heap *h);

/** Sets when a key is due; infinity: never. */
void event_heap_set(event_heap *h, dem_index key, double due, dem_index generation);

/** The generation with which a key is due at t, or -1 if it is not. */
static inline dem_index event_heap_generation(const event_heap *h, dem_index key, double t)
{
    return h->place[key] >= 0 && h->due[key] == t ? h->generation[key] : -1;
}

/** The key that is due first, or -1. */
static inline dem_index event_heap_first(const event_heap *h)
{
    return h->n > 0 ? h->keys[0] : -1;
}

#endif
