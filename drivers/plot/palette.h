/* SPDX-License-Identifier: BSD-3-Clause */
/* Colours of numbers. Both scales run straight lines in CIELAB from lightness to lightness, so that they can be
 * distinguished without seeing hues: docs/pictures.md. */
#ifndef DEM_PALETTE_H
#define DEM_PALETTE_H

typedef struct colour {
    unsigned char red, green, blue;
} colour;

typedef enum palette_kind {
    PALETTE_DIVERGING,  /* blue, grey in the middle, red: both ends equally dark */
    PALETTE_SEQUENTIAL, /* from a light yellow to a dark blue */
    PALETTE_UPPER,      /* half of the diverging one, from grey to red */
    PALETTE_LOWER,      /* the other half, from blue to grey */
    PALETTE_PIECES      /* grey, and behind it colours of no order that can be distinguished */
} palette_kind;

enum { PALETTE_SIZE = 255 }; /* odd: there is a middle */

typedef struct palette {
    palette_kind kind;
    colour of[PALETTE_SIZE];
} palette;

palette palette_make(palette_kind kind);

/** What a scale becomes between these limits: a diverging one its half where one of them is 0. */
palette_kind palette_between(palette_kind kind, double lo, double hi);

/** Of one colour, for what stands for nothing. */
palette palette_plain(colour ink);

/** The place of a value in a palette from lo to hi; what lies outside gets the end's. */
int palette_index(double value, double lo, double hi);

#endif
