/* SPDX-License-Identifier: BSD-3-Clause */
/* Hashes, FNV-1a, by which problems and plotted data are known. */
#ifndef DEM_DIGEST_H
#define DEM_DIGEST_H

#include <stddef.h>
#include <stdint.h>

#define DIGEST_BEGIN UINT64_C(0xcbf29ce484222325)

static inline uint64_t digest_add(uint64_t hash, const void *bytes, size_t size)
{
    const unsigned char *b = bytes;
    for (size_t k = 0; k < size; k++) hash = (hash ^ b[k]) * UINT64_C(0x100000001b3);
    return hash;
}

#endif
