/* SPDX-License-Identifier: BSD-3-Clause */
/* Sections of a deflated stream: bytes that are deflated with nothing before them to refer to, and end at a whole byte,
 * so that any thread or rank makes them, to the same bytes, and they can stand one behind the other in a stream. */
#ifndef DEM_BASE_SECTION_H
#define DEM_BASE_SECTION_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <dem/dem.h>

#include "base/team.h"

typedef struct section {
    unsigned char *bytes; /**< [size] to be deflated; only read */
    size_t size;
    int level;             /**< of zlib, 1 to 9; of sections that are packed together the same */
    bool only_runs;        /**< only runs of equal bytes are looked for */
    unsigned char *packed; /**< room for section_room(size) bytes */
    size_t n_packed;       /**< bytes that they take */
    uint32_t checksum;     /**< Adler-32 of `bytes` */
} section;

/** What zlib needs to deflate, kept from one packing to the next. Zero at first. */
typedef struct section_streams {
    struct z_stream_s *streams; /**< [n] */
    int n, level;
} section_streams;

size_t section_room(size_t size);

/** Deflates n sections by the threads of a team; NULL: the caller alone.
 *  \return DEM_ERROR_MEMORY; DEM_ERROR_IO if zlib fails */
dem_status section_pack(section_streams *z, section *sections, int n, team *t);

/** The Adler-32 of bytes, and of a section's behind them; that of none is SECTION_NO_CHECKSUM. */
#define SECTION_NO_CHECKSUM ((uint32_t)1)
uint32_t section_join(uint32_t checksum, uint32_t next, size_t size);

void section_streams_free(section_streams *z);

#endif
