/* SPDX-License-Identifier: BSD-3-Clause */
/* Sides of the triangles of a lattice, sorted: the edges of a triangulation, and which of them are its boundary. */
#ifndef DEM_LATTICE_MESH_EDGES_H
#define DEM_LATTICE_MESH_EDGES_H

#include <stdbool.h>

#include <dem/dem.h>

typedef struct mesh_edge_slot {
    dem_index upper, triangle;
} mesh_edge_slot;

/* Sides in the order of lower node, upper node, triangle: slots row[i] to row[i + 1] - 1 have the lower node i. An edge
 * between two triangles has two slots, an edge on the boundary has one. */
typedef struct mesh_edges {
    dem_index *row;       /* [n_nodes + 2] */
    mesh_edge_slot *list; /* [3 n_triangles] */
} mesh_edges;

/* Lists the sides; the corners of triangles must be valid node numbers. Free with mesh_edges_free(). */
dem_status mesh_edges_create(mesh_edges *out, const dem_lattice *lattice);
void mesh_edges_free(mesh_edges *s);

/* Whether slot p of row i is the first of its edge. */
bool mesh_edges_is_first(const mesh_edges *s, dem_index i, dem_index p);

/* Whether slot p of row i is the only one of its edge, which is then on the boundary. */
bool mesh_edges_is_boundary(const mesh_edges *s, dem_index i, dem_index p);

/* Fills in the flags that flags = NULL stands for: DEM_NODE_CONTACT on the boundary, or on all nodes without triangles.
 * \param[out] flags  [n_nodes] */
dem_status mesh_edges_contact_flags(unsigned char *flags, const dem_lattice *lattice);

#endif
