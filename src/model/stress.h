/* SPDX-License-Identifier: BSD-3-Clause */
/* Stress of nodes from springs and triangles. A triangle's stress is what its share of its springs' r x f, and its own
 * energy, make of its rest volume; a node's stress is the mean of its triangles' by volume. Where the strain is uniform
 * it is therefore exact on boundaries, too. docs/method.md has the formulas. */
#ifndef DEM_MODEL_STRESS_H
#define DEM_MODEL_STRESS_H

#include "elastic/couplings.h"
#include "elastic/springs.h"
#include "elastic/triangles.h"

/** Which springs make up the stress of which node. */
typedef struct stress_map {
    dem_index *row;    /* [n_nodes + 1] */
    dem_index *spring; /* slots row[i] .. row[i + 1] - 1: springs of the lattice */
    double *share;     /* of their r x f, over the node's volume, 1/m^3 */
    double *volume;    /* [n_nodes] m^3, a third of the triangles at rest; 0 of a node in no triangle, without stress */
    const couplings *couplings; /* borrowed */
} stress_map;

/** Borrows the couplings. Free with stress_free(). */
dem_status stress_compile(stress_map *out, const dem_lattice *lattice, const springs *s, const couplings *c);
void stress_free(stress_map *map);

/** Stress of node i at positions x [n][2], Pa: xx, yy, xy.  \param lattice, t  from which the map was compiled */
void stress_of_node(const stress_map *map, const dem_lattice *lattice, const triangles *t, dem_index i, const double *x,
                    double stress[3]);

/** The square of the von Mises stress of plane stress, Pa^2. */
static inline double stress_square(const double stress[3])
{
    const double xx = stress[0], yy = stress[1], xy = stress[2];
    return xx * xx - xx * yy + yy * yy + 3.0 * xy * xy;
}

#endif
