/* SPDX-License-Identifier: BSD-3-Clause */
/* A body drawn as an image: its bright pixels are material, or its dark ones. Its own origin is the middle of the
 * image's lower edge. */
#ifndef DEM_MASK_H
#define DEM_MASK_H

#include "image.h"

typedef struct mask {
    size_t width, height; /* pixels */
    size_t n_solid;       /* pixels that are material */
    double scale;         /* m, side of a pixel */
    unsigned char *solid; /* [height][width] 1 for material, the lowest row first; owned */
} mask;

/* Reads an image; what is at least `threshold` times white is material, or, with `invert`, what is darker.
 * \param[out] fault  [IMAGE_FAULT] what is wrong behind "PATH:", with a line where there is one, if IMAGE_REFUSED */
image_status mask_read(mask *out, char *fault, const char *path, double scale, double threshold, bool invert);

/* Width and height of an image, m, from its first bytes alone; false where they do not have them. */
bool mask_measure(double size[2], const char *path, double scale);

void mask_free(mask *m);

/* Whether there is material at most `slack` from x, m. */
bool mask_has(const mask *m, const double x[2], double slack);

/* Whether a disc about x is all material. */
bool mask_fits(const mask *m, const double x[2], double radius);

/* Where row k of pixels, from below, begins and ends to be material, ascending, m; at most mask->width + 1 places.
 * \return their number, which is even */
size_t mask_slice(const mask *m, size_t k, double *x);

#endif
