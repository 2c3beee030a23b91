/* SPDX-License-Identifier: BSD-3-Clause */
/* The boundary of the triangles that are whole: sides that one of them has alone. Where some break it is found from the
 * boundary before and from what is beside them, without a look at all triangles. */
#ifndef DEM_MODEL_MESH_BOUNDARY_H
#define DEM_MODEL_MESH_BOUNDARY_H

#include "model/element_state.h"

typedef struct mesh_boundary_edge {
    dem_index lower, upper; /* its nodes */
    dem_index triangle;     /* that has it */
} mesh_boundary_edge;

typedef struct mesh_boundary {
    const dem_lattice *lattice;
    dem_index n;
    mesh_boundary_edge *list; /* [n] ascending by lower, then upper node */
    unsigned char *outer;     /* [n_nodes] 1: on the boundary when all is whole */
} mesh_boundary;

/** Finds it from all triangles. Borrows the lattice.
 *  \param broken  [n_triangles] 1: broken; NULL: all are whole
 *  \return DEM_ERROR_MEMORY. Free with mesh_boundary_free() */
dem_status mesh_boundary_create(mesh_boundary *out, const dem_lattice *lattice, const unsigned char *broken);
void mesh_boundary_free(mesh_boundary *b);

/** The same from an earlier one, since which the n elements of `list` have broken.  \return DEM_ERROR_MEMORY */
dem_status mesh_boundary_follow(mesh_boundary *out, const mesh_boundary *before, const element_state *state,
                                const dem_index *list, dem_index n);

/** Sets bits in the flags [n_nodes] of the nodes on it. */
void mesh_boundary_mark(const mesh_boundary *b, unsigned char *flags, unsigned char bits);

/** The same of all triangles of a lattice, of which no boundary is kept.  \return DEM_ERROR_MEMORY */
dem_status mesh_boundary_mark_nodes(const dem_lattice *lattice, unsigned char *flags, unsigned char bits);

#endif
