/* SPDX-License-Identifier: BSD-3-Clause */
/* Meshes of a clamped strip, whose outline is smooth: rows of any direction, and none. */
#ifndef DEM_TEST_STRIP_MESH_H
#define DEM_TEST_STRIP_MESH_H

#include <dem/dem.h>

typedef struct strip_mesh {
    double angle, jitter; /* degrees, of the rows; spacings */
    bool rows;            /* false: none */
    uint64_t seed;        /* of `jitter`, and of meshes without rows */
} strip_mesh;

/** A triangulation that is so many spacings of clamped_strip.h wide and high. Caller owns it. */
dem_lattice strip_mesh_make(double width, double height, const strip_mesh *m);

/** The same of squares, whose sides are along the strip, or, if `turned`, at 45 degrees, with teeth at all edges, and a
 *  height of whole half diagonals. Caller owns it. */
dem_lattice strip_mesh_squares(double width, double height, bool turned);

#endif
