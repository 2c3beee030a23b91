/* SPDX-License-Identifier: BSD-3-Clause */
/* Portable grey maps: P2 (text) and P5 (bytes), of 8 and 16 bits. */
#ifndef DEM_PGM_H
#define DEM_PGM_H

#include "image.h"

/* Whether bytes begin like one. */
bool pgm_begins(const char *bytes, size_t size);

/* Width, height and white from its first bytes; false where they do not have them. */
bool pgm_measure(image *out, const char *bytes, size_t size);

/* Reads one image. Anything may come in: sizes are held against the number of bytes before memory is asked for.
 * \param bytes       [size]
 * \param[out] out    owned by the caller; empty unless IMAGE_READ is returned
 * \param[out] fault  [IMAGE_FAULT] "LINE: what is wrong", where IMAGE_REFUSED is returned */
image_status pgm_parse(image *out, char *fault, const char *bytes, size_t size);

#endif
