/* SPDX-License-Identifier: BSD-3-Clause */
/* The triangles at every node of a triangulation, by which the neighbour of a triangle is found. */
#ifndef DEM_SHAPE_STARS_H
#define DEM_SHAPE_STARS_H

#include <stdbool.h>

#include <dem/dem.h>

/* Side 3 t + k of a lattice goes from corner k of triangle t to its next corner. */
typedef struct stars {
    dem_index *first; /* [n_nodes + 1] where the triangles of a node begin */
    dem_index *list;  /* [3 n_triangles] */
} stars;

/* Returns false when memory runs out; *out is then empty. */
bool stars_create(stars *out, const dem_lattice *lattice);
void stars_free(stars *s);

/* The end of a side. */
dem_index stars_end(const dem_lattice *lattice, dem_index side);

/* The side of another triangle that runs the other way between the same nodes; -1 on the rim.
 * \param lattice  that of the stars; a triangle that has got other nodes since is found at those that it has kept */
dem_index stars_across(const stars *s, const dem_lattice *lattice, dem_index side);

#endif
