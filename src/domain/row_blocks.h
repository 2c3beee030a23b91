/* SPDX-License-Identifier: BSD-3-Clause */
/* Rows of all nodes, springs or triangles in a *block distribution*: each rank gets those of a range of numbers of the
 * whole, its block, from the ranks that own them, one slice of ROWS_CHUNK rows after the other. No slice reaches beyond
 * the end of a stripe, one of equal ranges of all rows. */
#ifndef DEM_DOMAIN_ROW_BLOCKS_H
#define DEM_DOMAIN_ROW_BLOCKS_H

#include "domain/gather.h"

/** What a rank has of the rows. */
typedef struct row_blocks_source {
    const gather_items *items;
    size_t size;      /* bytes of a row */
    const void *rows; /* [items->n][size] of which the own ones are looked at */
} row_blocks_source;

typedef struct row_blocks {
    const ranks *ranks;
    row_blocks_source from;
    int n_stripes;
    dem_index *first_slice;    /* [n_stripes + 1] of each stripe, and behind all */
    dem_index round, n_rounds; /* the next slice of each block, and how many the largest has */
    dem_index *sends, *gets;   /* [ranks][n_rounds] rows of each slice that go to the other ranks, and come from them */
    dem_index *next;           /* [ranks] the first item here that has not gone to each */
    unsigned char *out, *in;   /* messages of a round */
    ranks_message *sent, *received; /* [ranks] */
} row_blocks;

/** Rows of a stripe. */
typedef struct row_slice {
    int stripe;
    dem_index begin;    /* of the stripe, in the whole */
    dem_index first, n; /* from there on; n is 0 where a block has ended */
} row_slice;

/** Tells all ranks what will come from whom. Collective. Borrows all arguments. Free with row_blocks_free(), after a
 *  failure, too.  \return DEM_ERROR_MEMORY, on all ranks */
dem_status row_blocks_create(row_blocks *out, const ranks *r, const row_blocks_source *from, int n_stripes);
void row_blocks_free(row_blocks *b);

/** The slice that a rank gets in a round. */
row_slice row_blocks_slice(const row_blocks *b, int rank, dem_index round);

/** Fills the next slice of each rank. Collective.
 *  \param[out] slice  [n of row_blocks_slice(b, own rank, b->round)][size] */
void row_blocks_next(row_blocks *b, void *slice);

#endif
