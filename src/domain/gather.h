/* SPDX-License-Identifier: BSD-3-Clause */
/* Rows of all nodes, springs or triangles on rank 0, from the ranks that own them. */
#ifndef DEM_DOMAIN_GATHER_H
#define DEM_DOMAIN_GATHER_H

#include "base/ranks.h"
#include "domain/domain.h"

/** The nodes, springs or triangles that a rank has. */
typedef struct gather_items {
    dem_index n, n_whole;        /* here, and in the whole lattice */
    const dem_index *number;     /* [n] in the whole lattice, ascending */
    const unsigned char *is_own; /* [n] 1: its row comes from here, as from no other rank */
} gather_items;

/** The nodes of a domain. */
static inline gather_items gather_nodes(const domain *d)
{
    return (gather_items){d->n_nodes, d->n_whole, d->number, d->is_own};
}

/** Puts what each rank has of its own items in an array into that of rank 0, so many at a time that messages take
 *  little memory. Collective.
 *  \param size       bytes of a row
 *  \param from       [n][size]
 *  \param[out] whole [n_whole][size] on rank 0; not looked at elsewhere
 *  \return DEM_ERROR_MEMORY, on all ranks */
dem_status gather_rows(const ranks *r, const gather_items *items, size_t size, const void *from, void *whole);

#endif
