/* SPDX-License-Identifier: BSD-3-Clause */
/* Sides of the triangles of a lattice, sorted: the edges of a triangulation, and which of them are its boundary. */
#ifndef DEM_LATTICE_MESH_EDGES_H
#define DEM_LATTICE_MESH_EDGES_H

#include <stdbool.h>

#include <dem/dem.h>

typedef struct side {
    dem_index upper, triangle;
} side;

/* In the order of lower node, upper node, triangle: slots row[i] .. row[i+1]-1 have lower node i. An edge between two
 * triangles has two slots, one on the boundary one. */
typedef struct sides {
    dem_index *row; /* [n_nodes + 2] */
    side *list;     /* [3 n_triangles] */
} sides;

/* The corners must be nodes of the lattice. Caller owns *out. */
dem_status sides_create(sides *out, const dem_lattice *lattice);
void sides_free(sides *s);

/* Whether slot p of row i is the first of its edge. */
bool sides_edge_begins(const sides *s, dem_index i, dem_index p);

/* Whether it is the only one: an edge of the boundary. */
bool sides_edge_is_boundary(const sides *s, dem_index i, dem_index p);

/* What flags = NULL stands for: DEM_NODE_CONTACT on the boundary, everywhere without triangles.
 * \param[out] flags  [n_nodes] */
dem_status sides_contact_flags(unsigned char *flags, const dem_lattice *lattice);

#endif
