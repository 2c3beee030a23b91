/* SPDX-License-Identifier: BSD-3-Clause */
/* The deflated stream of a chunk, put together from sections that come slice by slice (output/deflater.h). So nobody
 * has the numbers of all slices at once, only what they are packed to. */
#ifndef DEM_OUTPUT_DEFLATED_CHUNK_H
#define DEM_OUTPUT_DEFLATED_CHUNK_H

#include <dem/dem.h>

#include "base/section.h"

/** Sections of a plane that stand one behind the other. */
typedef struct deflated_run {
    unsigned char *bytes; /**< [n] */
    size_t n;             /**< bytes */
    dem_index room;       /**< bytes, of which those that nothing was written to take no memory */
    uint32_t checksum;    /**< Adler-32 of what is packed in them, */
    size_t size;          /**< of so many bytes */
} deflated_run;

/** Zero at first. */
typedef struct deflated_chunk {
    int n_planes, n_shares;
    deflated_run *runs; /**< [n_planes][n_shares] */
    deflated_run all;   /**< the stream, once it has ended */
} deflated_chunk;

/** \param n_shares  into which the slices are divided: those of a share come one after the other
 *  \return DEM_ERROR_MEMORY */
dem_status deflated_chunk_begin(deflated_chunk *c, int n_planes, int n_shares);

/** Adds slices to a share.
 *  \param sections  [n_planes][n_slices] packed
 *  \return DEM_ERROR_MEMORY */
dem_status deflated_chunk_add(deflated_chunk *c, int share, const section *sections, int n_slices);

/** Makes the stream of all shares, c->all.  \return DEM_ERROR_MEMORY */
dem_status deflated_chunk_end(deflated_chunk *c);

void deflated_chunk_free(deflated_chunk *c);

#endif
