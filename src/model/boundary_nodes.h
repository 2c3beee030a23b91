/* SPDX-License-Identifier: BSD-3-Clause */
/* Nodes on the boundary of the triangulation of the whole, and where they are, on every rank. What may break is common
 * to all ranks, so that each knows by itself which common nodes are on the boundary, and where. The others are on it,
 * or not, for good: ranks tell each other about these. */
#ifndef DEM_MODEL_BOUNDARY_NODES_H
#define DEM_MODEL_BOUNDARY_NODES_H

#include "base/all_rows.h"
#include "domain/domain.h"
#include "model/mesh_boundary.h"

typedef struct boundary_nodes {
    const ranks *ranks;
    const domain *domain; /* NULL: the whole is here */
    dem_index n;
    dem_index *number; /* [n] in the whole, each once */
    double *x;         /* [n][2] m */
    all_rows sent;     /* of them come first those that ranks tell each other; none where the whole is here */
    dem_index *own;    /* [those of this rank] which nodes here they are */
    dem_index *here;   /* [n - sent.n] and then, ascending, those that are known here */
    dem_index room;    /* for so many of all there is memory */
} boundary_nodes;

/** Lists them where nothing is broken. Collective. Borrows ranks and domain. Free with boundary_nodes_free(), after a
 *  failure, too.
 *  \param lattice  the whole, or of the domain
 *  \return DEM_ERROR_MEMORY, on all ranks */
dem_status boundary_nodes_create(boundary_nodes *out, const dem_lattice *lattice, const ranks *r, const domain *d);
void boundary_nodes_free(boundary_nodes *b);

/** Makes room for the nodes of a boundary.  \return DEM_ERROR_MEMORY, with all as it was */
dem_status boundary_nodes_reserve(boundary_nodes *b, const mesh_boundary *boundary);

/** Lists those of a boundary for which there is room, after triangles have broken, of which all ranks have all. */
void boundary_nodes_follow(boundary_nodes *b, const mesh_boundary *boundary);

/** Finds where they are. Collective.  \param x  [n_nodes][2] of all nodes here; ghosts are not read */
void boundary_nodes_locate(boundary_nodes *b, const double *x);

#endif
