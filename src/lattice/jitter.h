/* SPDX-License-Identifier: BSD-3-Clause */
/* Moves nodes of a lattice, or of a part of one, at random. */
#ifndef DEM_LATTICE_JITTER_H
#define DEM_LATTICE_JITTER_H

#include <dem/dem.h>

/** Where a part stands in a whole lattice. The whole goes on beside the nodes before `begin`, and from `end` on:
 *  between two of either no edge is taken for one of its boundary. */
typedef struct jitter_part {
    dem_index first; /* the number in the whole of node 0 */
    dem_index begin, end;
} jitter_part;

/** Moves the nodes of a part as dem_lattice_jitter() moves those of the whole, where no triangle is squeezed.
 *  \return DEM_ERROR_ARGUMENT, DEM_ERROR_MODEL, DEM_ERROR_MEMORY; nothing has changed then */
dem_status jitter_move(dem_lattice *lattice, const jitter_part *part, double radius, uint64_t seed);

#endif
