/* SPDX-License-Identifier: BSD-3-Clause */
/* What surface_contact_evaluate() has found, node by node. */
#ifndef DEM_TESTS_EVALUATED_H
#define DEM_TESTS_EVALUATED_H

#include "surface_contact/surface_contact.h"

/* Force on node i, N. */
static inline vec2 evaluated_force(const surface_contact *c, dem_index i)
{
    const unsigned place = c->compact.place_of[i];
    return place > 0 ? vec2_at(c->compact.force, place - 1) : (vec2){0.0, 0.0};
}

/* How many nodes are pushed. */
static inline dem_index evaluated_pushed(const surface_contact *c)
{
    dem_index n = 0;
    for (dem_index k = 0; k < c->compact.n_nodes; k++) n += surface_contact_acts(vec2_at(c->compact.force, k));
    return n;
}

#endif
