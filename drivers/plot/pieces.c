/* SPDX-License-Identifier: BSD-3-Clause */
#include "pieces.h"

#include <math.h>
#include <stdlib.h>

#include "digest.h"
#include "palette.h"

static dem_index body_of(const dem_lattice *l, dem_index node)
{
    return l->body != NULL && l->body[node] >= 0 ? l->body[node] : 0;
}

bool pieces_create(pieces *p, const dem_lattice *lattice)
{
    *p = (pieces){.lattice = lattice, .n_bodies = 1};
    for (dem_index i = 0; i < lattice->n_nodes; i++)
        if (body_of(lattice, i) >= p->n_bodies) p->n_bodies = body_of(lattice, i) + 1;
    p->body_mass = calloc((size_t)p->n_bodies, sizeof *p->body_mass);
    if (p->body_mass == NULL) return false;
    for (dem_index i = 0; i < lattice->n_nodes; i++) p->body_mass[body_of(lattice, i)] += lattice->mass[i];
    return true;
}

void pieces_free(pieces *p)
{
    free(p->body_mass);
    *p = (pieces){0};
}

/* Files may have anything: a fragment is a node not above its own, which is of itself. */
static bool is_fragment(const double *fragment, dem_index node)
{
    const double of = fragment[node];
    return of >= 0.0 && of <= (double)node && of == (double)(dem_index)of && fragment[(dem_index)of] == of;
}

/* Of a node, of 53 bits, which a double has. */
static uint64_t hash_of(dem_index node)
{
    return digest_add(DIGEST_BEGIN, &node, sizeof node) >> 11;
}

/* At the lowest node of each fragment its mass, at others 0. */
static void weigh(const pieces *p, const double *fragment, double *value)
{
    for (dem_index i = 0; i < p->lattice->n_nodes; i++) {
        value[i] = 0.0;
        if (is_fragment(fragment, i)) value[(dem_index)fragment[i]] += p->lattice->mass[i];
    }
}

/* There the least hash of its nodes in place of that; -1 where it is grey. */
static void find_keys(const pieces *p, const double *fragment, double *value)
{
    const dem_lattice *l = p->lattice;
    for (dem_index i = 0; i < l->n_nodes; i++) {
        if (!is_fragment(fragment, i)) continue;
        double *key = &value[(dem_index)fragment[i]];
        if (fragment[i] == (double)i) *key = *key < 0.5 * p->body_mass[body_of(l, i)] ? (double)INFINITY : -1.0;
        *key = fmin(*key, (double)hash_of(i));
    }
}

/* No node above its own needs what stands at a lowest node, so that from the last node on it can be replaced. */
void pieces_shade(const pieces *p, const double *fragment, double *value)
{
    weigh(p, fragment, value);
    find_keys(p, fragment, value);
    for (dem_index i = p->lattice->n_nodes - 1; i >= 0; i--) {
        const double key = is_fragment(fragment, i) ? value[(dem_index)fragment[i]] : -1.0;
        value[i] = key < 0.0 ? 0.0 : 1.0 + (double)((uint64_t)key % (PALETTE_SIZE - 1));
    }
}
