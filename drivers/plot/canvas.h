/* SPDX-License-Identifier: BSD-3-Clause */
/* What pictures are drawn on: lengths in pixels, y down. Failures are kept and reported when the canvas is closed. */
#ifndef DEM_CANVAS_H
#define DEM_CANVAS_H

#include <stddef.h>
#include <stdint.h>

#include "box.h"
#include "palette.h"

typedef enum canvas_anchor { CANVAS_START, CANVAS_MIDDLE, CANVAS_END } canvas_anchor;

typedef struct canvas_label {
    double x, y, size;    /* of the anchor on the base line; height of the letters */
    canvas_anchor anchor; /* which end of the text is there */
    bool upright;         /* read from below to above */
    colour ink;
    const char *text; /* UTF-8 */
} canvas_label;

typedef struct canvas_pen {
    colour ink;
    double width;
} canvas_pen;

/** Colours of pixels, the top row first. */
typedef struct canvas_image {
    int width, height;
    uint32_t *argb; /* [height][width], alpha in the highest byte: 0 or 255 */
} canvas_image;

typedef struct canvas canvas;

struct canvas {
    /** Begins a part of the picture. Formats that have names for parts keep `attributes`, of XML; nothing is drawn
     *  outside of `clip` until the part ends, if it is not NULL. */
    void (*begin)(canvas *c, const char *attributes, const box *clip);
    void (*end)(canvas *c);
    /** n lines of `corners` points each, xy [n][corners][2], with round ends: one of no length is a dot. */
    void (*strokes)(canvas *c, canvas_pen pen, size_t corners, size_t n, const double *xy);
    /** n polygons of `corners` points each; without seams where they share a side. */
    void (*fills)(canvas *c, colour ink, size_t corners, size_t n, const double *xy);
    void (*write)(canvas *c, const canvas_label *label);
    void (*image)(canvas *c, box place, const canvas_image *image);
    /** Ends the picture and frees the canvas; `note` goes into the file where the format has a place for it.
     *  Returns false if anything has failed. */
    bool (*close)(canvas *c, const char *note);
};

extern const colour canvas_black, canvas_grey, canvas_light, canvas_dark;

/** About how long a text becomes, whatever the font. */
double canvas_length(const char *text, double size);

/** A rectangle drawn with a pen. */
void canvas_outline(canvas *c, canvas_pen pen, box b);

#endif
