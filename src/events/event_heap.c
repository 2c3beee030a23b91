/* SPDX-License-Identifier: BSD-3-Clause */
/* A binary heap of keys by the time at which each is due. Beside the heap it keeps the place of every key, so that a
 * time can be changed in O(log n), which happens to all candidates near an event. Ties are decided: the order of events
 * must not depend on how the heap came about (docs/algorithms.md, The queue). What a key stands for is the source's own
 * affair. */
#include "events/event_heap.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "base/status.h"

dem_status event_heap_create(event_heap *out, dem_index n_keys, event_key_order order)
{
    const size_t n = (size_t)n_keys + 1;
    CHECK(n_keys < INT32_MAX, DEM_ERROR_MODEL, "%lld keys of events are more than the library takes",
          (long long)n_keys);
    event_heap h = {.order = order,
                    .keys = malloc(n * sizeof *h.keys),
                    .place = malloc(n * sizeof *h.place),
                    .generation = malloc(n * sizeof *h.generation),
                    .due = malloc(n * sizeof *h.due)};
    if (h.keys == NULL || h.place == NULL || h.generation == NULL || h.due == NULL) {
        event_heap_destroy(&h);
        return status_fail(DEM_ERROR_MEMORY, "out of memory for the events of %lld keys", (long long)n_keys);
    }
    for (dem_index k = 0; k < n_keys; k++) h.place[k] = -1;
    *out = h;
    return DEM_OK;
}

void event_heap_destroy(event_heap *h)
{
    free(h->keys);
    free(h->place);
    free(h->generation);
    free(h->due);
    *h = (event_heap){0};
}

void event_heap_clear(event_heap *h)
{
    for (dem_index p = 0; p < h->n; p++) h->place[h->keys[p]] = -1;
    h->n = 0;
}

/* The order of the heap. No two keys are equal in it, so the first one is always the same. */
static bool is_before(const event_heap *h, dem_index a, dem_index b)
{
    if (h->due[a] != h->due[b]) return h->due[a] < h->due[b];
    if (h->generation[a] != h->generation[b]) return h->generation[a] < h->generation[b];
    return h->order.before(h->order.self, a, b);
}

/* Puts a key into a place of the heap. */
static void put(event_heap *h, dem_index p, dem_index key)
{
    h->keys[p] = (int32_t)key;
    h->place[key] = (int32_t)p;
}

/* Moves a key from place p towards the root, as far as it is due before what is there. */
static void rise(event_heap *h, dem_index p, dem_index key)
{
    for (; p > 0 && is_before(h, key, h->keys[(p - 1) / 2]); p = (p - 1) / 2) put(h, p, h->keys[(p - 1) / 2]);
    put(h, p, key);
}

/* Moves a key from place p away from the root, as far as what is there is due before it. */
static void sink(event_heap *h, dem_index p, dem_index key)
{
    for (dem_index next = 2 * p + 1; next < h->n; next = 2 * p + 1) {
        if (next + 1 < h->n && is_before(h, h->keys[next + 1], h->keys[next])) next++;
        if (!is_before(h, h->keys[next], key)) break;
        put(h, p, h->keys[next]);
        p = next;
    }
    put(h, p, key);
}

/* Removes the key at place p. The last key fills the gap; it may be due before its new parent or after its new
 * children, so it is moved both ways, of which one does nothing. */
static void take_out(event_heap *h, dem_index p)
{
    const dem_index last = h->keys[--h->n];
    h->place[h->keys[p]] = -1;
    if (p == h->n) return;
    rise(h, p, last);
    sink(h, h->place[last], last);
}

/* A new key begins at the end of the heap; one that is there begins where it is. `due` infinite removes it. */
void event_heap_set(event_heap *h, dem_index key, double due, dem_index generation)
{
    const dem_index p = h->place[key];
    if (!isfinite(due)) {
        if (p >= 0) take_out(h, p);
        return;
    }
    h->due[key] = due;
    h->generation[key] = (int32_t)generation;
    rise(h, p >= 0 ? p : h->n++, key);
    sink(h, h->place[key], key);
}
