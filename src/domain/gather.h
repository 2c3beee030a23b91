/* SPDX-License-Identifier: BSD-3-Clause */
/* Rows of all nodes, springs or triangles on rank 0, from the ranks that own them. */
#ifndef DEM_DOMAIN_GATHER_H
#define DEM_DOMAIN_GATHER_H

#include "base/ranks.h"
#include "base/rows_taker.h"
#include "domain/domain.h"

/** The nodes, springs or triangles that a rank has. */
typedef struct gather_items {
    dem_index n, n_whole;        /* here, and in the whole lattice */
    const dem_index *number;     /* [n] in the whole lattice, ascending; NULL: all from `first` on */
    const unsigned char *is_own; /* [nodes] 1: owned here, as by no other rank; NULL: all are */
    int n_corners;               /* nodes of a spring or triangle, which belongs to the lowest one; 0: it is a node */
    const dem_index *corners;    /* [n][n_corners] */
    dem_index first;
} gather_items;

/** Those of a domain.  \param l  its lattice */
static inline gather_items gather_nodes(const domain *d)
{
    return (gather_items){d->n_nodes, d->n_whole, d->number, d->is_own, 0, NULL, 0};
}

static inline gather_items gather_springs(const domain *d, const dem_lattice *l)
{
    return (gather_items){l->n_springs, d->n_springs, d->spring, d->is_own, 2, l->ends, 0};
}

static inline gather_items gather_triangles(const domain *d, const dem_lattice *l)
{
    return (gather_items){l->n_triangles, d->n_triangles, d->triangle, d->is_own, 3, l->triangles, 0};
}

/** Whether item i of those here is one of this rank's own. */
static inline bool gather_owns(const gather_items *items, dem_index i)
{
    const int n = items->n_corners;
    return items->is_own == NULL || items->is_own[n > 0 ? domain_lowest(items->corners + n * i, n) : i] != 0;
}

/** Its number in the whole lattice. */
static inline dem_index gather_number(const gather_items *items, dem_index i)
{
    return items->number != NULL ? items->number[i] : items->first + i;
}

/** Bytes of a message of the numbers of n items and their rows, aligned for numbers. */
static inline size_t gather_message(dem_index n, size_t size)
{
    const size_t bytes = (size_t)n * (sizeof(dem_index) + size), align = sizeof(dem_index);
    return (bytes + align - 1) / align * align;
}

/** Puts what each rank has of its own items in an array into that of rank 0, so many at a time that messages take
 *  little memory. Collective.
 *  \param size       bytes of a row
 *  \param from       [n][size]
 *  \param[out] whole [n_whole][size] on rank 0; not looked at elsewhere
 *  \return DEM_ERROR_MEMORY, on all ranks */
dem_status gather_rows(const ranks *r, const gather_items *items, size_t size, const void *from, void *whole);

/** Hands them to a function of rank 0 instead, ROWS_CHUNK at a time, so that nobody needs memory for all. Collective.
 *  \param take  on rank 0; not called elsewhere. Once it fails it is not called again
 *  \return its failure, and DEM_ERROR_MEMORY, on all ranks */
dem_status gather_chunks(const ranks *r, const gather_items *items, size_t size, const void *from, rows_taker *take,
                         void *context);

/** The other way round: gives each rank the rows of what it has, owned or not, ROWS_CHUNK at a time. Collective.
 *  \param read    reads rows of the whole, on rank 0; not called elsewhere. Once it fails it is not called again
 *  \param[out] to [n][size]
 *  \return its failure, and DEM_ERROR_MEMORY, on all ranks */
dem_status gather_back(const ranks *r, const gather_items *items, size_t size, rows_reader *read, void *context,
                       void *to);

/** Both ways at once, when items are shared out anew: gives each rank the rows of what it has from those that have
 *  owned it, ROWS_CHUNK at a time. Collective.
 *  \param owned  what a rank has owned; \param from  [owned->n][size]
 *  \param items  what it has now, owned or not; \param[out] to  [items->n][size]
 *  \return DEM_ERROR_MEMORY, on all ranks */
dem_status gather_migrate(const ranks *r, const gather_items *owned, size_t size, const void *from,
                          const gather_items *items, void *to);

#endif
