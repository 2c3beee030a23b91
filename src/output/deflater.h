/* SPDX-License-Identifier: BSD-3-Clause */
/* Packs the numbers of a chunk as HDF5's filters shuffle and deflate do, so that any reader unpacks them, but without
 * making a new zlib stream for each, and in sections of the stream that depend on nothing but their own numbers, so
 * that threads and ranks make them in any order; output/deflated_chunk.h puts them together. At level 1 only runs of
 * equal bytes are looked for where little else would be found in twice the time, as in numbers of a body that is
 * deformed (docs/performance.md). */
#ifndef DEM_OUTPUT_DEFLATER_H
#define DEM_OUTPUT_DEFLATER_H

#include <dem/dem.h>
#include <stdbool.h>

#include "base/rows_taker.h"
#include "base/section.h"

/** Rows of a slice of a chunk. In chunks of DEFLATER_CUT numbers or more each byte of the numbers of a slice is a
 *  section, in smaller ones all is: each section costs five bytes, and time to begin. */
enum { DEFLATER_SLICE = ROWS_CHUNK, DEFLATER_CUT = 16384 };

/** Zero at first. */
typedef struct deflater {
    section_streams streams;
    unsigned char *shuffled;                 /**< [room] */
    unsigned char *packed;                   /**< [packed_room] */
    section *sections;                       /**< [n_planes][n_slices] of what was packed last */
    int n_planes, n_slices;                  /**< where there is one plane, it is all of them */
    size_t room, packed_room, sections_room; /**< bytes */
} deflater;

typedef struct deflater_numbers {
    const void *data;
    size_t rows, columns;
    size_t width; /**< bytes of a number as it is stored: 1, 4 or 8 */
    bool narrows; /**< `data` are doubles, of which floats are stored */
} deflater_numbers;

/** Into how many planes the numbers of a chunk are cut. Its data are not looked at. */
int deflater_planes(deflater_numbers chunk);

/** Packs some slices of a chunk, at least one, into d->sections, which the next call overwrites.
 *  \param slices    whole ones, but for the last one of the chunk
 *  \param n_planes  deflater_planes() of the chunk
 *  \param level     1 to 9
 *  \param t         whose threads do it; NULL: the caller
 *  \return DEM_ERROR_MEMORY */
dem_status deflater_pack(deflater *d, deflater_numbers slices, int n_planes, int level, team *t);

void deflater_free(deflater *d);

#endif
