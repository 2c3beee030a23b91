/* SPDX-License-Identifier: BSD-3-Clause */
/* Rows that go to other ranks as nodes are shared out anew: whoever owned them keeps them, while its domain ends and
 * another one is made. */
#ifndef DEM_DOMAIN_MIGRATION_H
#define DEM_DOMAIN_MIGRATION_H

#include "domain/gather.h"

/** Those that this rank has owned. */
typedef struct migrating_rows {
    gather_items owned;
    size_t size;         /* bytes of a row; 0: there are none */
    unsigned char *rows; /* [owned.n][size] */
} migrating_rows;

/** Copies the rows of own items. Free with migration_free().
 *  \param items  of which own ones have numbers that follow each other, as in slabs
 *  \param rows   [items->n][size]
 *  \return DEM_ERROR_MEMORY; then there are none */
dem_status migration_begin(migrating_rows *out, const gather_items *items, size_t size, const void *rows);
void migration_free(migrating_rows *m);

/** Gives each rank the rows of what it has now, and frees those that it has kept. Collective.
 *  \param[out] to  [items->n][size]
 *  \return DEM_ERROR_MEMORY, on all ranks */
dem_status migration_end(migrating_rows *m, const ranks *r, const gather_items *items, void *to);

#endif
