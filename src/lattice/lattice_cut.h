/* SPDX-License-Identifier: BSD-3-Clause */
/* A part of a lattice, made without a copy of the whole. */
#ifndef DEM_LATTICE_LATTICE_CUT_H
#define DEM_LATTICE_LATTICE_CUT_H

#include "lattice/lattice_arrays.h"

/** Which nodes, springs and triangles are in the part, by kind of items. */
typedef struct lattice_cut {
    dem_index n[LATTICE_ITEMS];
    const dem_index *numbers[LATTICE_ITEMS]; /* [n] in the whole, ascending; those of corners are among the nodes */
    const dem_index *node; /* [nodes of the whole] their numbers in the part; NULL: corners keep those of the whole */
} lattice_cut;

/** Copies it. Node numbers of the whole are known to be valid. Free with dem_lattice_free().
 *  \return DEM_ERROR_MEMORY */
dem_status lattice_cut_create(dem_lattice *out, const dem_lattice *whole, const lattice_cut *cut);

/** Leaves nothing but the part in its arrays, which shrink in place. No two of them are the same. */
void lattice_cut_shrink(dem_lattice *whole, const lattice_cut *cut);

#endif
