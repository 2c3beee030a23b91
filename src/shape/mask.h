/* SPDX-License-Identifier: BSD-3-Clause */
/* A body drawn in pixels, of which some are material. The origin is the middle of the lower edge. */
#ifndef DEM_SHAPE_MASK_H
#define DEM_SHAPE_MASK_H

#include <stdbool.h>
#include <stddef.h>

#include <dem/shape.h>

typedef struct mask {
    size_t width, height; /* pixels */
    size_t n_solid;       /* pixels that are material */
    double scale;         /* m, side of a pixel */
    unsigned char *solid; /* [height][width] 1 for material, the lowest row first; owned */
} mask;

/* Of an image in its ranges. Returns false when memory runs out; *out is then without pixels. */
bool mask_create(mask *out, const dem_image *image);

void mask_free(mask *m);

/* Whether there is material at most `slack` from x, m. */
bool mask_has(const mask *m, const double x[2], double slack);

/* Whether a disc about x is all material. */
bool mask_fits(const mask *m, const double x[2], double radius);

/* Where row k of pixels, from below, begins and ends to be material, ascending, m; at most mask->width + 1 places.
 * \return their number, which is even */
size_t mask_slice(const mask *m, size_t k, double *x);

#endif
