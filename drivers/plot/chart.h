/* SPDX-License-Identifier: BSD-3-Clause */
/* A plot of numbers over time, or over decades of another number: axes with round ticks, lines, and their names
 * beside. */
#ifndef DEM_CHART_H
#define DEM_CHART_H

#include "canvas.h"

typedef struct chart_line {
    const char *name; /* "": it needs none */
    colour ink;
    size_t stride;   /* from one number to the next */
    const double *y; /* [n][stride] */
} chart_line;

enum { CHART_LINES = 13 };

typedef struct chart {
    const char *label, *unit; /* of the numbers; unit "" of counts */
    bool by_decades;          /* logarithmic; what is not > 0 is left out */
    const char *across;       /* NULL: the axis is of times; else what its numbers are, of which `t` has logarithms */
    size_t n;
    const double *t;   /* [n] s, ascending, or logarithms of base 10 */
    double begin, end; /* of the axis, s */
    int n_lines;
    chart_line line[CHART_LINES];
} chart;

/** Colours that can be distinguished, also by the colour-blind; the 0th is black. */
colour chart_ink(int k);

/** In `place`, with everything but the labels of the time axis, which only the lowest of several has.
 *  False without memory. */
bool chart_draw(const chart *of, box place, bool has_times, canvas *c);

/** A line thinned out to what a picture shows of it: of all points in one of `columns` equal parts of the time the
 *  first, the least, the largest and the last, in their order; what is not finite is left out.
 *  \param[out] xy  [4 columns][2] time and number
 *  \return how many */
size_t chart_thin(const chart *of, int line, size_t columns, double *xy);

#endif
