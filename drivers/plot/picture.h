/* SPDX-License-Identifier: BSD-3-Clause */
/* A picture's file: its name gives the format, and it takes its place when it is whole. */
#ifndef DEM_PICTURE_H
#define DEM_PICTURE_H

#include "canvas.h"
#include "outcome.h"
#include "part_file.h"

typedef enum picture_format { PICTURE_NONE, PICTURE_PNG, PICTURE_SVG, PICTURE_PDF } picture_format;

/** By the end of the name; PICTURE_NONE: it has none of these. */
picture_format picture_format_of(const char *path);

typedef struct picture {
    canvas *face; /* to draw on */
    part_file place;
} picture;

/** Width and height in pixels. False after a fault, which is reported; then nothing is to be closed. */
bool picture_open(picture *p, const char *path, double width, double height, outcome *o);

/** Ends the drawing and lets the file take its place, over an older picture of that name. False after a fault, which is
 *  reported; nothing is left then. `note` is kept in SVG and PDF. */
bool picture_close(picture *p, const char *note, outcome *o);

/** Nothing is left of it. */
void picture_drop(picture *p);

#endif
