/* SPDX-License-Identifier: BSD-3-Clause */
/* Bodies of equilateral triangles, seen as rows of nodes: to the right of node c of a lattice row stands node c + 1,
 * and above it nodes c - 1 and c of the next row,
 *
 *       next row    c-1     c
 *                     \    / \
 *                      \  /   \
 *       row             c ---- c+1
 *
 * so that each spring is an edge of one triangle c, c + 1, c above, and blocks of eight such triangles are all alike.
 * Places without a node, at the ends of lattice rows and in holes, have springs without stiffness and infinite mass.
 * lattice_rows.c says how lattice rows are found, lattice_step_body.h what is done with them. */
#ifndef DEM_ELASTIC_LATTICE_ROWS_H
#define DEM_ELASTIC_LATTICE_ROWS_H

#include <stdbool.h>
#include <stdint.h>

#include "base/intern.h"
#include "elastic/layout_lanes.h"
#include "elastic/springs.h"
#include "elastic/triangles.h"

/** Nodes side by side in a lattice row. */
typedef struct lattice_segment {
    int32_t node, n; /* the first one, and how many */
    int32_t place;   /* of the first one, from the first stored place of the lattice row on */
} lattice_segment;

/** A lattice row. Beside its nodes it has places for all springs to the next one, and one block before and one behind
 *  at least of what the lattice row below has springs to. Columns are counted in blocks of LAYOUT_LANES places. */
typedef struct lattice_row {
    int32_t stored, n_stored; /* column of the first stored block, and how many */
    int32_t first, n_blocks;  /* column of the first block that is evaluated, and how many */
    int32_t segment, n_segments;
    int32_t block; /* where its evaluated blocks begin */
} lattice_row;

/** What eight triangles c, c + 1, c above have, and the nodes c: places in the sets. Of springs [2 LAYOUT_LANES]:
 *  stiffness, N, 0 where there is none, and rest length, m. */
typedef struct lattice_block {
    int32_t right, up, back;     /* springs c to c + 1, c to c above, and c + 1 to c above */
    int32_t inverse_mass;        /* [LAYOUT_LANES] 1/kg, 0 where there is no node */
    int32_t upright, overturned; /* [LAYOUT_LANES] areas, m^2, below which the guard of the triangle c, c + 1, c above
                                    may act, and of c, c above, c - 1 above; -inf: never, or
                                    all of its corners are ghosts */
} lattice_block;

typedef struct lattice_rows {
    dem_index n_rows, n_blocks;
    lattice_row *row;         /* [n_rows] the last one, and one before each body, has no nodes */
    lattice_segment *segment; /* of all lattice rows in turn */
    int32_t *block;           /* [n_blocks] numbers of records, of all lattice rows in turn */
    intern records;           /* of lattice_block */
    intern sets;              /* of [LAYOUT_LANES] numbers */
    int32_t most_stored;      /* blocks of a lattice row */
    bool guarded;             /* whether any guard may act */
} lattice_rows;

/** What lattice rows are compiled from. Nodes have their own order. */
typedef struct lattice_rows_input {
    const springs *springs;
    const triangles *triangles;
    const double *x;               /* [n_nodes][2] at rest, m */
    const double *inverse_mass;    /* [n_nodes] 1/kg */
    const unsigned char *is_ghost; /* [n_nodes] 1: what the node does is not asked for; NULL: of no node */
} lattice_rows_input;

/** Compiles. Where a body is not made of equilateral triangles in lattice rows one above the other, or more than
 *  half of the places have no node, there are no lattice rows: n_rows is 0. Free with lattice_rows_destroy().
 *  \return DEM_ERROR_MEMORY */
dem_status lattice_rows_create(lattice_rows *out, const lattice_rows_input *from);
void lattice_rows_destroy(lattice_rows *r);

#endif
