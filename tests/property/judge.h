/* SPDX-License-Identifier: BSD-3-Clause */
/* Depth by brute force, with nothing of the library's: points in polygons, and distances to every edge. */
#ifndef DEM_TEST_JUDGE_H
#define DEM_TEST_JUDGE_H

#include "scene.h"

/** How deep x is where it must not be: inside the polygon, or outside a room; else 0. m */
double judge_depth(const solid *s, const double x[2]);

/** Distance from x to the segment ab, m. */
double judge_distance(const double x[2], const double a[2], const double b[2]);

/** Boundary of a triangulation: sides of one triangle only, ends [n][2], to be freed. */
typedef struct boundary_condition {
    dem_index n;
    dem_index *ends;
} boundary_condition;
void judge_boundary(boundary_condition *out, const dem_lattice *l);

/** Deepest node in a solid, and deepest convex vertex of an obstacle in the body, at positions x. A vertex is in the
 *  body if more triangles that contain it keep their orientation than have lost it: that counts the turns of the
 *  boundary round it, so that neither a fold nor an overlap of the body with itself is mistaken. */
double judge_nodes(const scene *sc, const double *x);
double judge_vertices(const scene *sc, const boundary_condition *b, const double *x);

/** Smallest distance between the body and anything that the library is given, m. */
double judge_clearance(const scene *sc, const boundary_condition *b, const double *x);

#endif
