/* SPDX-License-Identifier: BSD-3-Clause */
/* Holds lists of items so that equal lists are stored once: a hash table with open addressing over the lists added so
 * far. A regular lattice has few different lists of coefficients and instructions for its blocks of nodes, so that the
 * sweep (elastic/layout.c) reads them from the cache. Items are compared as bytes; their meaning does not belong
 * here. */
#include "base/intern.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/aligned.h"
#include "base/grow.h"
#include "base/status.h"

/* Multiplies in each 8-byte word and mixes the high bits down. The hash decides only where a list is looked for: which
 * lists are equal, and the order in which they are stored, do not depend on it. */
static uint64_t hash_of(const void *items, size_t bytes)
{
    uint64_t hash = bytes, word;
    for (size_t k = 0; k < bytes; k += sizeof word) {
        memcpy(&word, (const char *)items + k, sizeof word);
        hash = (hash ^ word) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 29;
    }
    return hash;
}

/* Whether list number `list` has exactly these n items. */
static bool is_list(const intern *p, int32_t list, const void *items, dem_index n)
{
    const intern_span s = p->lists[list];
    return s.end - s.first == n &&
           (n == 0 || memcmp((const char *)p->items + (size_t)s.first * p->unit, items, (size_t)n * p->unit) == 0);
}

/* The slot that holds the list's number, or else the free one where it belongs. The number of slots is a power of 2,
 * and at most half of them are used, so the linear search meets a free one soon. */
static int32_t *slot_of(const intern *p, const void *items, dem_index n)
{
    const uint64_t last = (uint64_t)(p->n_slots - 1);
    uint64_t slot = hash_of(items, (size_t)n * p->unit) & last;
    while (p->slots[slot] >= 0 && !is_list(p, p->slots[slot], items, n)) slot = (slot + 1) & last;
    return &p->slots[slot];
}

/* Doubles the table and enters all lists again. */
static dem_status rehash(intern *p)
{
    const dem_index n_slots = p->n_slots > 0 ? 2 * p->n_slots : 64;
    int32_t *slots = malloc((size_t)n_slots * sizeof *slots);
    CHECK_MEMORY(slots);
    free(p->slots);
    p->slots = slots;
    p->n_slots = n_slots;
    for (dem_index k = 0; k < n_slots; k++) slots[k] = -1;
    for (dem_index k = 0; k < p->n_lists; k++) {
        const intern_span s = p->lists[k];
        *slot_of(p, (const char *)p->items + (size_t)s.first * p->unit, s.end - s.first) = (int32_t)k;
    }
    return DEM_OK;
}

/* An array of items that begins at a cache line. NULL if there is no memory. */
static void *copy_items(const intern *p, dem_index capacity)
{
    double *items = aligned_reals((size_t)capacity * p->unit / sizeof *items);
    if (items != NULL && p->n > 0) memcpy(items, p->items, (size_t)p->n * p->unit);
    return items;
}

/* As grow_array(), and the items stay aligned: they may be read before they are settled. */
static bool grow_items(intern *p, dem_index needed)
{
    if (needed <= p->capacity) return true;
    void *larger = copy_items(p, 2 * needed + 64);
    if (larger == NULL) return false;
    free(p->items);
    p->items = larger;
    p->capacity = 2 * needed + 64;
    return true;
}

/* Spans hold indices rather than pointers, because the items move when the array grows. */
dem_status intern_find(intern *p, const void *items, dem_index n, intern_span *out)
{
    if (2 * p->n_lists >= p->n_slots) TRY(rehash(p));
    int32_t *slot = slot_of(p, items, n);
    if (*slot < 0) {
        CHECK(p->n + n < INT32_MAX, DEM_ERROR_MODEL, "too many springs or triangles");
        CHECK(grow_items(p, p->n + n), DEM_ERROR_MEMORY, "out of memory");
        CHECK(grow_array((void **)&p->lists, &p->list_capacity, p->n_lists + 1, sizeof *p->lists), DEM_ERROR_MEMORY,
              "out of memory");
        if (n > 0) memcpy((char *)p->items + (size_t)p->n * p->unit, items, (size_t)n * p->unit);
        p->lists[p->n_lists] = (intern_span){(int32_t)p->n, (int32_t)(p->n + n)};
        *slot = (int32_t)p->n_lists++;
        p->n += n;
    }
    *out = p->lists[*slot];
    return DEM_OK;
}

dem_status intern_copy(intern *out, const intern *from)
{
    *out = (intern){.unit = from->unit, .items = copy_items(from, from->n), .n = from->n, .capacity = from->n};
    CHECK_MEMORY(out->items);
    return DEM_OK;
}

/* After the last list has been added the table is of no use. Spans that have been given out stay valid. */
dem_status intern_settle(intern *p)
{
    intern settled;
    TRY(intern_copy(&settled, p));
    intern_free(p);
    *p = settled;
    return DEM_OK;
}

void intern_free(intern *p)
{
    free(p->items);
    free(p->lists);
    free(p->slots);
    *p = (intern){0};
}
