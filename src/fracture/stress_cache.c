/* SPDX-License-Identifier: BSD-3-Clause */
/* A node has one place, by the last digits of its number. */
#include "fracture/stress_cache.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"

dem_status stress_cache_create(stress_cache *out, const dem_model *model, const element_state *elements, dem_index room)
{
    stress_cache c = {.model = model, .elements = elements, .n = 64};
    TRY(stress_prepare(&model->stress));
    while (c.n < room) c.n *= 2;
    c.slots = calloc((size_t)c.n, sizeof *c.slots);
    CHECK(c.slots != NULL, DEM_ERROR_MEMORY, "out of memory for the stresses of %lld nodes", (long long)c.n);
    *out = c;
    return DEM_OK;
}

void stress_cache_destroy(stress_cache *c)
{
    free(c->slots);
    *c = (stress_cache){0};
}

/* Numbers begin anew after 2^32 of them. */
void stress_cache_begin(stress_cache *c, const double *x)
{
    c->x = x;
    if (++c->number != 0) return;
    memset(c->slots, 0, (size_t)c->n * sizeof *c->slots);
    c->number = 1;
}

static stress_cache_slot *slot_of(const stress_cache *c, dem_index i)
{
    return &c->slots[i & (c->n - 1)];
}

bool stress_cache_has(const stress_cache *c, dem_index i)
{
    const stress_cache_slot *slot = slot_of(c, i);
    return slot->number == c->number && slot->node == i;
}

void stress_cache_find(stress_cache *c, dem_index i, double stress[3])
{
    stress_cache_slot *slot = slot_of(c, i);
    if (!stress_cache_has(c, i)) {
        node_stress(c->model, c->elements, NODE_STRESS_EFFECTIVE, i, c->x, slot->stress);
        slot->number = c->number;
        slot->node = (int32_t)i;
    }
    memcpy(stress, slot->stress, sizeof slot->stress);
}

void stress_cache_forget(stress_cache *c, dem_index i)
{
    stress_cache_slot *slot = slot_of(c, i);
    if (slot->node == i) slot->number = 0;
}
