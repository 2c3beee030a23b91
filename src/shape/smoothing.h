/* SPDX-License-Identifier: BSD-3-Clause */
/* Moves the nodes at the rim of a lattice on to the edges of its shape, so that mass, bending and stresses at curved
 * and slanted edges converge. Triangles stay sound: none gets an angle below 20 degrees. */
#ifndef DEM_SHAPE_SMOOTHING_H
#define DEM_SHAPE_SMOOTHING_H

#include <dem/dem.h>

struct shape;

/* What came out. */
typedef struct smoothing {
    dem_index n_rim;       /* nodes at the rim */
    dem_index n_off;       /* of them those that could not be moved on to an edge */
    dem_index n_cut;       /* corners that no node is near, so that they are cut off */
    double farthest;       /* m, that the worst of these n_off nodes is off its edge */
    dem_index n_unsettled; /* triangles of a part that would take more passes: what comes of it may be wrong */
} smoothing;

/* Where a lattice is rows of a shape_mesh(), what comes of nodes and triangles at heights >= `from` and < `to` is what
 * comes of them in the whole, if no part of the whole has unsettled ones. Only of these are numbers counted. */
typedef struct smoothing_part {
    double from, to; /* m, of places in the grid */
} smoothing_part;

/* Rows that are there beyond such a part on each side, unless the mesh ends. What is missing beyond them has an effect
 * on 12 rows after trimming, as pieces of up to 4 triangles are looked at twice; on 6 more with each of 4 passes over
 * ears, as two rim nodes may be near one corner; on one with each of 3 layers and of 8 sweeps; on 5 for the pairs of
 * triangles near a pair; then, as triangles may be two rows high, on two more with each of the 2 last sweeps and of 5
 * passes over unsound triangles: 66 rows. */
enum { SMOOTHING_ROWS = 72 };

/* Rows that the nodes of a triangle are apart at most, where its pair has got the other diagonal. */
enum { SMOOTHING_HEIGHT = 2 };

/* Cuts a smooth shape out of its shape_mesh(), or out of rows of it, and moves the nodes at the rim. A few pairs of
 * triangles get their other diagonal as their common side.
 * \param part  NULL: the lattice is the whole
 * \return DEM_OK, DEM_ERROR_MEMORY, or DEM_ERROR_MODEL if nothing is left; *out of a part is known then, too */
dem_status smoothing_apply(smoothing *out, dem_lattice *lattice, const struct shape *s, const smoothing_part *part);

#endif
