/* SPDX-License-Identifier: BSD-3-Clause */
/* The surface of the bodies: nodes that may touch obstacles, and boundary edges of the triangulation between them. */
#ifndef DEM_MODEL_SURFACE_H
#define DEM_MODEL_SURFACE_H

#include "model/mesh_boundary.h"

typedef struct surface {
    dem_index n_nodes;
    dem_index *nodes; /* [n_nodes] that may touch, ascending */
    dem_index n_edges;
    dem_index *ends; /* [n_edges][2] from node to node, the body on the left; along each boundary one after another */
    dem_index *next, *previous; /* [n_edges] along the boundary, in the same fan of triangles where it pinches; or -1 */
    int32_t *row;               /* [n_nodes + 1] */
    dem_index *at;              /* [2 n_edges] edges at node i: slots row[i] .. row[i+1]-1 */
} surface;

/** Which boundary edges a surface has. */
typedef enum surface_extent {
    SURFACE_TOUCHING, /* those that may touch obstacles: both nodes may, and one of them moves */
    SURFACE_WHOLE     /* all */
} surface_extent;

/** Finds nodes and edges; `flags` of the lattice must be filled. Free with surface_free. */
dem_status surface_compile(surface *out, const dem_lattice *lattice, surface_extent extent);
void surface_free(surface *s);

/** The same of a boundary that is known, of the triangles that are whole. */
dem_status surface_compile_boundary(surface *out, const dem_lattice *lattice, const mesh_boundary *boundary,
                                    surface_extent extent);

/** The surface that may touch obstacles, of the triangles that are whole. What was inside before anything broke may
 *  touch as soon as it is not, fixed nodes and those of rigid bodies apart; what was on the boundary keeps its flag.
 *  \param broken    [n_triangles] 1: broken
 *  \param excluded  [n_nodes] not 0: never touches; NULL: none
 *  \return DEM_ERROR_MEMORY */
dem_status surface_compile_broken(surface *out, const mesh_boundary *boundary, const unsigned char *broken,
                                  const unsigned char *excluded);

#endif
