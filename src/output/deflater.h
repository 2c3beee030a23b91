/* SPDX-License-Identifier: BSD-3-Clause */
/* Packs the numbers of a chunk as HDF5's filters shuffle and deflate do, so that any reader unpacks them, but without
 * making a new zlib stream for each, and in sections of the stream that depend on nothing but their own numbers, so
 * that threads make them in any order. At level 1 only runs of equal bytes are looked for where little else would be
 * found in twice the time, as in numbers of a body that is deformed (docs/performance.md). */
#ifndef DEM_OUTPUT_DEFLATER_H
#define DEM_OUTPUT_DEFLATER_H

#include <dem/dem.h>
#include <stdbool.h>

#include "base/section.h"

/** Rows of a slice of a chunk. In chunks of DEFLATER_CUT numbers or more each byte of the numbers of a slice is a
 *  section, in smaller ones all is: each section costs five bytes, and time to begin. */
enum { DEFLATER_SLICE = 65536, DEFLATER_CUT = 16384 };

/** Zero at first. */
typedef struct deflater {
    section_streams streams;
    unsigned char *shuffled;                 /**< [room] */
    unsigned char *packed;                   /**< [packed_room] */
    section *sections;                       /**< of the stream */
    size_t room, packed_room, sections_room; /**< bytes */
    size_t n_packed;                         /**< bytes that deflater_pack() has left in `packed` */
} deflater;

typedef struct deflater_numbers {
    const void *data;
    size_t rows, columns;
    size_t width; /**< bytes of a number as it is stored: 1, 4 or 8 */
    bool narrows; /**< `data` are doubles, of which floats are stored */
} deflater_numbers;

/** Who packs, to the same bytes. */
typedef struct deflater_helpers {
    team *team;                       /**< whose threads do it; NULL: the caller */
    const dem_simulation *simulation; /**< whose ranks do it, where it leads some; NULL: no others */
} deflater_helpers;

/** Packs into d->packed, which the next call overwrites.
 *  \param level  1 to 9
 *  \return DEM_ERROR_MEMORY */
dem_status deflater_pack(deflater *d, deflater_numbers numbers, int level, deflater_helpers h);

void deflater_free(deflater *d);

#endif
