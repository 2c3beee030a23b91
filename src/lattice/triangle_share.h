/* SPDX-License-Identifier: BSD-3-Clause */
/* What a triangle of any shape gives to its three edges so that it resists every uniform strain as Hooke's law asks:
 * a stiffness to each edge, and a coupling to each pair of edges (docs/method.md, Coupled springs). */
#ifndef DEM_LATTICE_TRIANGLE_SHARE_H
#define DEM_LATTICE_TRIANGLE_SHARE_H

#include "base/vec2.h"

/** Edge c goes from corner c to the next one. Couplings are at the corner where two edges meet. */
typedef struct triangle_share {
    double weight[3];   /* stiffness of edge c over that of the rule of equilateral triangles, (8/3) G h A/|e| */
    double coupling[3]; /* tension of one edge at corner c per change of length of the other, over (8/3) G h */
} triangle_share;

/** The share of independent springs, which is exact for equilateral triangles: weights 1, couplings 0. */
static inline triangle_share triangle_share_independent(void)
{
    return (triangle_share){{1.0, 1.0, 1.0}, {0.0, 0.0, 0.0}};
}

/** The share of coupled springs, for counter-clockwise corners; an equilateral triangle has the one above to the
 *  bit. */
triangle_share triangle_share_coupled(const vec2 corner[3]);

#endif
