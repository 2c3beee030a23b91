/* SPDX-License-Identifier: BSD-3-Clause */
/* Whether bodies run into each other or into themselves, which no force prevents: nodes of the boundary inside
 * triangles of which they are no corners. Ranks look in the triangles that they own. */
#ifndef DEM_MODEL_OVERLAP_H
#define DEM_MODEL_OVERLAP_H

#include "base/box.h"
#include "model/boundary_nodes.h"

/** What one look finds: pairs of node and triangle, and the first by triangle, then node, by numbers of the whole. */
typedef struct overlap_sight {
    dem_index n;
    dem_index triangle, node; /* -1: there is none */
    double x[2];              /* m, where that node is */
} overlap_sight;

typedef struct overlap {
    boundary_nodes nodes;
    dem_index next_room;           /* of `next` */
    const mesh_boundary *boundary; /* of which nodes are listed at the next look; NULL: they are */
    const unsigned char *broken;   /* [n_triangles] 1: broken; NULL: all are whole */
    box reach;                     /* m, around all triangles here */
    dem_index n_cells, columns, rows;
    int32_t *first, *next;              /* [n_cells], [nodes.n] nodes in reach, listed by cells of a grid; < 0: none */
    double left, low, cells_per_length; /* m, where the grid begins; 1/m */
    uint32_t *place;                    /* [n_nodes] row and column of each node of the lattice: scratch of a look;
                                           NULL: there are no triangles, on any rank */
    overlap_sight seen;                 /* in the look in hand */
    dem_overlap found;
} overlap;

/** Collective. Borrows ranks and domain. Free with overlap_destroy(), after a failure, too.
 *  \param d  whose lattice it is; NULL: it is the whole one
 *  \return DEM_ERROR_MEMORY, on all ranks */
dem_status overlap_create(overlap *out, const dem_lattice *lattice, const ranks *r, const domain *d);
void overlap_destroy(overlap *o);

/** Whether there are triangles, on any rank: else there is nothing to look for. */
static inline bool overlap_is_possible(const overlap *o)
{
    return o->place != NULL;
}

/** Makes room for the nodes of a boundary.  \return DEM_ERROR_MEMORY, with all as it was */
dem_status overlap_reserve(overlap *o, const mesh_boundary *boundary);

/** Goes on with the triangles that are whole, from the next look on; what has been found so far stays.
 *  \param boundary  theirs, for which there is room; borrowed
 *  \param broken    [n_triangles] 1: broken; borrowed */
void overlap_break(overlap *o, const mesh_boundary *boundary, const unsigned char *broken);

/** Searches at positions x [n_nodes][2] at t, with those of ghosts. Costs a few comparisons for each triangle.
 *  Collective: what is found is of the whole. */
void overlap_look(overlap *o, const dem_lattice *lattice, double t, const double *x);

#endif
