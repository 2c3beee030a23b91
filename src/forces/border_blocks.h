/* SPDX-License-Identifier: BSD-3-Clause */
/* The blocks of a layout with nodes that other ranks have to know, or that this one knows from them: its ghosts. */
#ifndef DEM_FORCES_BORDER_BLOCKS_H
#define DEM_FORCES_BORDER_BLOCKS_H

#include <stdint.h>

#include "domain/domain.h"

typedef struct border_blocks {
    dem_index n;
    dem_index *list; /* [n] ascending */
    uint8_t *is_in;  /* [n_blocks] 1: is in the list; NULL: the list is empty */
} border_blocks;

/** Lists them, of blocks of consecutive nodes; other nodes are in none. NULL stands for the whole lattice, which has no
 *  border. Free with border_blocks_free().
 *  \return DEM_ERROR_MEMORY */
dem_status border_blocks_create(border_blocks *out, const domain *d, dem_index n_blocks);
void border_blocks_free(border_blocks *b);

#endif
