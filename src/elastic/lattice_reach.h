/* SPDX-License-Identifier: BSD-3-Clause */
/* Which blocks of a lattice row the steps of a wave evaluate. On several ranks ghosts are taken along so that own nodes
 * are right at the end of the last step: before it the neighbours of these have to be right, before that the neighbours
 * of those, and of ghosts farther away nothing is asked any more. */
#ifndef DEM_ELASTIC_LATTICE_REACH_H
#define DEM_ELASTIC_LATTICE_REACH_H

#include "elastic/lattice_rows.h"

/** Blocks of a lattice row, columns as in lattice_row. */
typedef struct lattice_span {
    int32_t first, n_blocks; /* n_blocks 0: none */
} lattice_span;

typedef struct lattice_reach {
    int n_levels;      /* 1 without ghosts: all blocks in each step */
    lattice_span *row; /* [n_rows][n_levels] by how many steps follow */
} lattice_reach;

/** Finds them for up to `most` steps. Free with lattice_reach_destroy().
 *  \param is_ghost  [n_nodes] 1: what the node does is not asked for; NULL: of no node
 *  \return DEM_ERROR_MEMORY */
dem_status lattice_reach_create(lattice_reach *out, const lattice_rows *rows, const unsigned char *is_ghost, int most);
void lattice_reach_destroy(lattice_reach *r);

/** Those of a lattice row in a step that so many others follow. */
static inline lattice_span lattice_reach_span(const lattice_reach *r, dem_index row, int n_follow)
{
    return r->row[row * r->n_levels + (n_follow < r->n_levels ? n_follow : r->n_levels - 1)];
}

#endif
