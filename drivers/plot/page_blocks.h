/* SPDX-License-Identifier: BSD-3-Clause */
/* The numbers of a page, as blocks of base64 that its script decodes. Places have 16 bits in the box of their frame, so
 * that they are off by at most 1/131070 of its sides; colours are places in the palette, as dem_plot has them. */
#ifndef DEM_PAGE_BLOCKS_H
#define DEM_PAGE_BLOCKS_H

#include <stdio.h>

#include "page_content.h"

/** Letters that the blocks take: those of all frames together, those of each, and those of a row of the history. */
double page_blocks_fixed(const page_content *p);
double page_blocks_per_frame(const page_content *p);
double page_blocks_per_row(const page_content *p);

/** False after a fault, which is reported; whether all was written the file tells. */
bool page_blocks_write(const page_content *p, FILE *out, outcome *o);

#endif
