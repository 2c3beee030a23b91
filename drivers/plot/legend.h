/* SPDX-License-Identifier: BSD-3-Clause */
/* What lengths and colours of a film strip mean. */
#ifndef DEM_LEGEND_H
#define DEM_LEGEND_H

#include "canvas.h"
#include "quantity.h"
#include "colour_range.h"

enum { LEGEND_LETTERS = 15, LEGEND_UNIT = 40 }; /* pixels; bytes */

/** How numbers up to `largest` are written: divided by the factor that is returned, with the unit put into `unit`:
 *  "kPa" of "Pa", "" of "1", and where that does not do a power of ten. */
double legend_unit(char unit[LEGEND_UNIT], double largest, const char *base);

/** A bar of a round length, at most `room` pixels, from the left end at x; its text stands above y. */
void legend_draw_scale(double pixels_per_metre, double x, double y, double room, canvas *c);

/** A bar of the colours in `place`, its label above and its numbers below; the bar has arrows where values lie beyond
 *  its ends. */
void legend_draw_colours(const quantity *q, const palette *colours, colour_range range, box place, canvas *c);

#endif
