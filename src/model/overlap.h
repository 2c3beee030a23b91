/* SPDX-License-Identifier: BSD-3-Clause */
/* Whether bodies run into each other or into themselves, which no force prevents: nodes of the boundary inside
 * triangles of which they are no corners. */
#ifndef DEM_MODEL_OVERLAP_H
#define DEM_MODEL_OVERLAP_H

#include "model/mesh_boundary.h"

typedef struct overlap {
    dem_index n, *nodes;           /* [n] on the boundary of the triangulation, ascending */
    dem_index capacity, next_room; /* of `nodes` and of `next` */
    const mesh_boundary *boundary; /* of which they are listed at the next look; NULL: they are */
    const unsigned char *broken;   /* [n_triangles] 1: broken; NULL: all are whole */
    dem_index n_cells, columns, rows;
    int32_t *first, *next; /* [n_cells], [n] nodes in the cells of a grid over them all, as lists; < 0: none */
    double left, low, cells_per_length; /* m, where the grid begins; 1/m */
    uint32_t *place;                    /* [n_nodes] row and column of each node of the lattice: scratch of a look */
    dem_overlap found;
} overlap;

/** Free with overlap_destroy. */
dem_status overlap_create(overlap *out, const dem_lattice *lattice);
void overlap_destroy(overlap *o);

/** Makes room for the nodes of a boundary.  \return DEM_ERROR_MEMORY, with all as it was */
dem_status overlap_reserve(overlap *o, const mesh_boundary *boundary);

/** Goes on with the triangles that are whole, from the next look on; what has been found so far stays.
 *  \param boundary  theirs, for which there is room; borrowed
 *  \param broken    [n_triangles] 1: broken; borrowed */
void overlap_break(overlap *o, const mesh_boundary *boundary, const unsigned char *broken);

/** Searches at positions x [n_nodes][2] at t. Costs a few comparisons for each triangle. */
void overlap_look(overlap *o, const dem_lattice *lattice, double t, const double *x);

#endif
