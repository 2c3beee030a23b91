/* SPDX-License-Identifier: BSD-3-Clause */
/* Canvases of cairo: PNG and PDF. */
#ifndef DEM_PAINT_H
#define DEM_PAINT_H

#include <stdio.h>

#include "canvas.h"

/** On an open file, which stays the caller's. NULL without memory. */
canvas *paint_open_png(FILE *file, double width, double height);

/** Vectors; a pixel is 1/96 inch. */
canvas *paint_open_pdf(FILE *file, double width, double height);

/** Hands the bytes of an image as PNG to `put`, piece by piece; false if that or memory fails. */
bool paint_png(const canvas_image *image, bool (*put)(void *to, const unsigned char *bytes, size_t size), void *to);

#endif
