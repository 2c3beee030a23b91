/* SPDX-License-Identifier: BSD-3-Clause */
/* Rows that each rank has, as many as it likes, of which all ranks get those of all. */
#ifndef DEM_BASE_ALL_ROWS_H
#define DEM_BASE_ALL_ROWS_H

#include <dem/dem.h>

#include "base/ranks.h"

typedef struct all_rows {
    const ranks *ranks;
    dem_index n;                    /* rows of all ranks, in their order */
    dem_index *first;               /* [ranks + 1] the first row of each rank, and behind all */
    ranks_message *sent, *received; /* [ranks] */
} all_rows;

/** Tells all ranks how many rows this one has. Collective. Borrows the ranks. Free with all_rows_free(), after a
 *  failure, too.  \return DEM_ERROR_MEMORY, on all ranks */
dem_status all_rows_create(all_rows *out, const ranks *r, dem_index n);
void all_rows_free(all_rows *a);

/** The first row of this rank. */
static inline dem_index all_rows_own(const all_rows *a)
{
    return a->first[a->ranks->rank];
}

/** Fills in the rows of the other ranks. Collective; without a message if there are none on any rank.
 *  \param size          bytes of a row
 *  \param[in,out] rows  [n][size] those of this rank are there */
void all_rows_share(const all_rows *a, size_t size, void *rows);

#endif
