/* SPDX-License-Identifier: BSD-3-Clause */
/* A table of slots, in which a node has one by its number: nodes side by side have slots side by side, and two that
 * share one by chance take turns. Equal lists are stored once. In a regular lattice those of local numbers are nearly
 * all equal, and often stiffness and onsets, so that impacts of different nodes read them from the cache. */
#include "forces/local_cache.h"

#include <string.h>

#include "base/grow.h"

/* At most, and of numbers of 8 bytes, for which there may be twice as much memory. When these are used up, all is
 * forgotten: a lattice without equal lists takes 0.6 thousand of them a node. */
enum { SLOTS = 512, NUMBERS = 1 << 18 };

/* The parts: nodes, and indices of all kinds by local numbers, two to a number of 8 bytes; then those of doubles, and
 * coupled triangles. */
enum { NODES, INDICES, STIFFNESS, REST_LENGTH, INVERSE_MASS, ONSET, COUPLED };

void local_cache_destroy(local_cache *c)
{
    free(c->slots);
    free(c->numbers);
    intern_free(&c->items);
    *c = (local_cache){0};
}

/* ---- what is found ---- */

static void *part_of(const local_cache *c, const local_slot *slot, int part)
{
    return (char *)c->items.items + (size_t)slot->parts[part].first * c->items.unit;
}

/* The indices lie one behind the other, in the order of append_indices(). */
static void find_indices(int32_t *at, dem_index n_moving, local_lists *out)
{
    out->places = (local_places *)at;
    const local_places *n = &out->places[n_moving];
    out->bonds = (local_bond *)(out->places + n_moving + 1);
    out->pulls = (int32_t *)(out->bonds + n->bonds);
    out->pushes = out->pulls + n->pulls;
    out->guarded = (local_guarded *)(out->pushes + n->pushes);
}

bool local_cache_find(const local_cache *c, dem_index node, int n_rings, local_record *out)
{
    const local_slot *slot = c->slots != NULL ? &c->slots[node % SLOTS] : NULL;
    if (slot == NULL || slot->node != node || slot->n_rings != n_rings) return false;
    *out = (local_record){.n = slot->end[n_rings], .list = part_of(c, slot, NODES), .end = slot->end};
    local_lists *lists = &out->lists;
    find_indices(part_of(c, slot, INDICES), slot->end[n_rings - 1], lists);
    lists->by_node = slot->by_node;
    lists->pushed = lists->pulled = part_of(c, slot, STIFFNESS);
    lists->rest_length = part_of(c, slot, REST_LENGTH);
    lists->inverse_mass = part_of(c, slot, INVERSE_MASS);
    lists->onset = part_of(c, slot, ONSET);
    lists->coupled = part_of(c, slot, COUPLED);
    return true;
}

/* ---- what is kept ---- */

/* Appends n indices to the scratch, of which *n_all are there. */
static bool append(local_cache *c, dem_index *n_all, const void *indices, dem_index n)
{
    if (!grow_array((void **)&c->numbers, &c->capacity, *n_all + n + 1, sizeof *c->numbers)) return false;
    if (n > 0) memcpy(c->numbers + *n_all, indices, (size_t)n * sizeof *c->numbers);
    *n_all += n;
    return true;
}

/* Stores what is in the scratch. */
static bool store_indices(local_cache *c, dem_index n, intern_span *out)
{
    c->numbers[n] = 0;
    return intern_find(&c->items, c->numbers, (n + 1) / 2, out) == DEM_OK;
}

static bool store_nodes(local_cache *c, const local_nodes *nodes, intern_span *out)
{
    dem_index n = 0;
    for (dem_index j = 0; j < nodes->n; j++) {
        const int32_t node = (int32_t)nodes->list[j];
        if (!append(c, &n, &node, 1)) return false;
    }
    return store_indices(c, n, out);
}

static bool store_lists(local_cache *c, const local_lists *l, dem_index n_moving, intern_span *out)
{
    const local_places *n = &l->places[n_moving];
    dem_index all = 0;
    return append(c, &all, l->places, (n_moving + 1) * (dem_index)(sizeof *l->places / sizeof(int32_t))) &&
           append(c, &all, l->bonds, 2 * n->bonds) && append(c, &all, l->pulls, n->pulls) &&
           append(c, &all, l->pushes, n->pushes) && append(c, &all, l->guarded, 3 * n->guarded) &&
           store_indices(c, all, &out[INDICES]);
}

static bool store(local_cache *c, const void *numbers, dem_index n, intern_span *out)
{
    return intern_find(&c->items, numbers, n, out) == DEM_OK;
}

/* Empties the cache when it is full. */
static bool reserve(local_cache *c)
{
    if (c->items.n > NUMBERS) local_cache_destroy(c);
    if (c->slots != NULL) return true;
    c->items.unit = sizeof(double);
    c->slots = malloc(SLOTS * sizeof *c->slots);
    for (int k = 0; k < SLOTS && c->slots != NULL; k++) c->slots[k].node = -1;
    return c->slots != NULL;
}

void local_cache_keep(local_cache *c, dem_index node, const local_nodes *nodes, const local_lists *lists)
{
    const dem_index n_moving = local_nodes_n_moving(nodes);
    const local_places *n = &lists->places[n_moving];
    const dem_index n_coupled = n->coupled * (dem_index)(sizeof *lists->coupled / sizeof(double));
    if (!reserve(c)) return;
    local_slot *slot = &c->slots[node % SLOTS];
    slot->node = -1;
    slot->n_rings = nodes->n_rings;
    slot->by_node = lists->by_node;
    memcpy(slot->end, nodes->end, sizeof slot->end);
    if (store_nodes(c, nodes, &slot->parts[NODES]) && store_lists(c, lists, n_moving, slot->parts) &&
        store(c, lists->pushed, n->bonds, &slot->parts[STIFFNESS]) &&
        store(c, lists->rest_length, n->bonds, &slot->parts[REST_LENGTH]) &&
        store(c, lists->inverse_mass, n_moving, &slot->parts[INVERSE_MASS]) &&
        store(c, lists->onset, n->guarded, &slot->parts[ONSET]) &&
        store(c, lists->coupled, n_coupled, &slot->parts[COUPLED]))
        slot->node = node;
}
