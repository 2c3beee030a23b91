/* SPDX-License-Identifier: BSD-3-Clause */
/* Whether bodies run into each other or into themselves, which nothing prevents: nodes of the boundary inside triangles
 * of which they are no corners. */
#ifndef DEM_OVERLAP_H
#define DEM_OVERLAP_H

#include <dem/dem.h>

typedef struct overlap {
    dem_index n, *nodes; /* [n] on the boundary of the triangulation, ascending in x when last looked at */
    dem_index n_cells, columns, rows;
    unsigned char *taken;               /* [n_cells] cells of a grid over them that have one, */
    double left, low, cells_per_length; /* m, where it begins; 1/m */
    dem_overlap found;
} overlap;

/** Free with overlap_destroy. */
dem_status overlap_create(overlap *out, const dem_lattice *lattice);
void overlap_destroy(overlap *o);

/** Looks at positions x [n_nodes][2] at t. Costs a few comparisons for each triangle. */
void overlap_look(overlap *o, const dem_lattice *lattice, double t, const double *x);

#endif
