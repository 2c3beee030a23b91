/* SPDX-License-Identifier: BSD-3-Clause */
/* Nodes whose weighted sum is the point of a contact, and what follows from the weights: velocity, mobility, the effect
 * of an impulse, the coupling of two contacts that share nodes. */
#ifndef DEM_CONTACT_CONTACT_NODES_H
#define DEM_CONTACT_CONTACT_NODES_H

#include <dem/dem.h>

#include "base/vec2.h"

enum { CONTACT_NODES = 4 };

/** Of the point of the body the weights sum to 1: one node on a segment, two of an edge on a vertex. A partner that
 *  takes part in the motion adds its own with weights that sum to -1; impulses do not move those of inverse mass 0.
 *  Nodes of rigid ground would be such: they are not the model's, and the velocity of the obstacle replaces theirs. */
typedef struct contact_nodes {
    int n;
    dem_index node[CONTACT_NODES];
    double weight[CONTACT_NODES];
} contact_nodes;

/** Weighted sum of the nodes' vectors in `v` [n_nodes][2]: of velocities, that of the contact. */
static inline vec2 contact_nodes_sum(const contact_nodes *c, const double *v)
{
    vec2 sum = vec2_scale(c->weight[0], vec2_at(v, c->node[0]));
    for (int p = 1; p < c->n; p++) sum = vec2_add(sum, vec2_scale(c->weight[p], vec2_at(v, c->node[p])));
    return sum;
}

/** Motion of the contact per unit of an impulse at it, 1/kg: sum of weight^2/m. */
static inline double contact_nodes_mobility(const contact_nodes *c, const double *inverse_mass)
{
    double sum = 0.0;
    for (int p = 0; p < c->n; p++) sum += c->weight[p] * c->weight[p] * inverse_mass[c->node[p]];
    return sum;
}

/** The same per unit of an impulse at another contact, by the nodes that they share. */
static inline double contact_nodes_coupling(const contact_nodes *c, const contact_nodes *other,
                                            const double *inverse_mass)
{
    double sum = 0.0;
    for (int p = 0; p < c->n; p++)
        for (int q = 0; q < other->n; q++)
            if (c->node[p] == other->node[q]) sum += c->weight[p] * other->weight[q] * inverse_mass[c->node[p]];
    return sum;
}

/** Adds to `v` what an impulse at the contact does, `size` times `push`. */
static inline void contact_nodes_push(const contact_nodes *c, const double *inverse_mass, double size, vec2 push,
                                      double *v)
{
    for (int p = 0; p < c->n; p++) {
        const double step = c->weight[p] * inverse_mass[c->node[p]] * size;
        vec2_put(v, c->node[p], vec2_along(vec2_at(v, c->node[p]), step, push));
    }
}

#endif
