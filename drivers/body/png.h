/* SPDX-License-Identifier: BSD-3-Clause */
/* PNG images, by cairo where that is built in. */
#ifndef DEM_PNG_H
#define DEM_PNG_H

#include "image.h"

enum { PNG_MAX_PIXELS = 1 << 26 }; /* compressed bytes do not say how many there are */

/* Whether bytes begin like one. */
bool png_begins(const char *bytes, size_t size);

/* Width and height that it states in its first bytes; false where they do not have them. */
bool png_measure(image *out, const char *bytes, size_t size);

/* Reads one image as grey of 8 bits, of its luminance on black. The size that it states is looked at before memory is
 * asked for. Parameters as of pgm_parse(); the fault has no line. */
image_status png_parse(image *out, char *fault, const char *bytes, size_t size);

#endif
