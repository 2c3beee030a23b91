/* SPDX-License-Identifier: BSD-3-Clause */
/* Moves nodes of a lattice, or of a part of one, at random. */
#ifndef DEM_LATTICE_JITTER_H
#define DEM_LATTICE_JITTER_H

#include <dem/dem.h>

/** Where a part stands in a whole lattice. Nodes `begin` to `end` have all of their triangles; the others are its
 *  rim. */
typedef struct jitter_part {
    dem_index first; /* the number in the whole of node `begin`, which those up to `end` follow */
    dem_index begin, end;
    const dem_index *rim;              /* [rim] numbers in the whole of the others, in their order */
    const unsigned char *rim_boundary; /* [rim] 1: a node is on the boundary of the whole */
} jitter_part;

/** Moves the nodes of a part as dem_lattice_jitter() moves those of the whole.
 *  \return DEM_ERROR_ARGUMENT; DEM_ERROR_MODEL, also where a triangle of a part that has a rim would be squeezed;
 *          DEM_ERROR_MEMORY; nothing has changed then */
dem_status jitter_move(dem_lattice *lattice, const jitter_part *part, double radius, uint64_t seed);

#endif
