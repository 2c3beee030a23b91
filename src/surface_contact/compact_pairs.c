/* SPDX-License-Identifier: BSD-3-Clause */
/* Arrays of nodes have room for all nodes of the lattice; the memory that is never written to is no memory yet. */
#include "surface_contact/compact_pairs.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "base/grow.h"
#include "base/status.h"

dem_status compact_pairs_create(compact_pairs *out, dem_index n_all)
{
    const size_t n = (size_t)n_all;
    *out = (compact_pairs){.nodes = malloc(n * sizeof *out->nodes),
                           .x = malloc(2 * n * sizeof *out->x),
                           .force = malloc(2 * n * sizeof *out->force),
                           .place_of = calloc(n, sizeof *out->place_of)};
    if (out->nodes != NULL && out->x != NULL && out->force != NULL && out->place_of != NULL) return DEM_OK;
    compact_pairs_destroy(out);
    return status_fail(DEM_ERROR_MEMORY, "out of memory for the contact of %lld nodes", (long long)n_all);
}

void compact_pairs_destroy(compact_pairs *c)
{
    free(c->pairs);
    free(c->nodes);
    free(c->x);
    free(c->force);
    free(c->place_of);
    *c = (compact_pairs){0};
}

void compact_pairs_clear(compact_pairs *c)
{
    for (dem_index k = 0; k < c->n_nodes; k++) c->place_of[c->nodes[k]] = 0;
    c->n_nodes = c->n = c->n_fillings = 0;
}

unsigned compact_pairs_row(compact_pairs *c, dem_index node)
{
    const unsigned place = (unsigned)c->n_nodes;
    if (c->place_of[node] > 0) return (unsigned)vec2_row(c->place_of[node] - 1);
    c->nodes[place] = node;
    c->place_of[node] = 1 + place;
    c->n_nodes++;
    vec2_put(c->force, place, (vec2){0.0, 0.0});
    return (unsigned)vec2_row(place);
}

static compact_pair compact(compact_pairs *c, const contact_pair *p)
{
    compact_pair out = {.is_plain = !p->ends_at_second && !p->fills, .thickness = p->thickness, .weight = p->weight};
    for (int which = 0; which < CONTACT_PAIR_PUSHED; which++) out.rows[which] = compact_pairs_row(c, p->nodes[which]);
    return out;
}

dem_status compact_pairs_take(compact_pairs *c, const contact_pair *list, dem_index n)
{
    compact_pairs_clear(c);
    CHECK(n <= INT_MAX / vec2_row(CONTACT_PAIR_NODES), DEM_ERROR_MODEL, "%lld close contact pairs are too many",
          (long long)n);
    CHECK(grow_array((void **)&c->pairs, &c->capacity, n, sizeof *c->pairs), DEM_ERROR_MEMORY,
          "out of memory for %lld contact pairs", (long long)n);
    c->list = list;
    for (; c->n < n; c->n++) {
        c->pairs[c->n] = compact(c, &list[c->n]);
        c->n_fillings += list[c->n].fills;
    }
    return DEM_OK;
}

void compact_pairs_read(compact_pairs *c, const double *x)
{
    for (dem_index k = 0; k < c->n_nodes; k++) vec2_put(c->x, k, vec2_at(x, c->nodes[k]));
}

void compact_pairs_clear_forces(compact_pairs *c)
{
    memset(c->force, 0, 2 * (size_t)c->n_nodes * sizeof *c->force);
}
