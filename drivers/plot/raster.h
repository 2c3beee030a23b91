/* SPDX-License-Identifier: BSD-3-Clause */
/* Springs and triangles binned to pixels: each pixel they touch gets the value of largest size among them, so that
 * none vanishes for being thinner than a pixel. Coordinates in pixels, y down; what lies outside is left out. */
#ifndef DEM_RASTER_H
#define DEM_RASTER_H

#include "canvas.h"

typedef struct raster {
    int width, height;
    float *value; /* [height][width], the top row first; NaN: nothing there */
} raster;

/** Empty; false without memory. To be freed. */
bool raster_create(raster *r, int width, int height);
void raster_free(raster *r);

/** A line from xy[0], xy[1] to xy[2], xy[3], of `thick` pixels, >= 1. */
void raster_line(raster *r, const double xy[4], int thick, double value);

/** A triangle, between whose corners the value is linear. */
void raster_triangle(raster *r, const double xy[6], const double value[3]);

/** How many pixels are touched. */
long raster_count(const raster *r);

/** Its colours, lo to hi; what is not touched is transparent. False without memory. Caller owns out->argb. */
bool raster_render(const raster *r, const palette *colours, double lo, double hi, canvas_image *out);

#endif
