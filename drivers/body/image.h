/* SPDX-License-Identifier: BSD-3-Clause */
/* A grey image. */
#ifndef DEM_IMAGE_H
#define DEM_IMAGE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { IMAGE_MAX_SIDE = 32768, IMAGE_FAULT = 240 }; /* pixels: all of an image fit in 2 GiB; bytes of a fault */

typedef struct image {
    size_t width, height; /* pixels, 1 to IMAGE_MAX_SIDE */
    unsigned white;       /* the largest value a pixel may have, 1 to 65535 */
    uint16_t *grey;       /* [height][width], the top row first; 0 is black */
} image;

typedef enum image_status { IMAGE_READ, IMAGE_REFUSED, IMAGE_MEMORY } image_status;

/* Of the size and white of *out; all black. False when memory runs out. Caller owns out->grey. */
bool image_create(image *out);
void image_free(image *picture);

#endif
