/* SPDX-License-Identifier: BSD-3-Clause */
#include "canvas.h"

const colour canvas_black = {26, 26, 26}, canvas_grey = {110, 110, 110}, canvas_light = {205, 205, 205},
             canvas_dark = {66, 68, 72};

double canvas_length(const char *text, double size)
{
    const double mean = 0.56; /* of a letter's width over the size; fonts without serifs have 0.5 to 0.6 */
    double letters = 0;
    for (; *text != '\0'; text++) letters += ((unsigned char)*text & 0xc0) != 0x80;
    return mean * size * letters;
}

void canvas_outline(canvas *c, canvas_pen pen, box b)
{
    const double corners[] = {b.x0, b.y0, b.x1, b.y0, b.x1, b.y1, b.x0, b.y1, b.x0, b.y0};
    c->strokes(c, pen, 5, 1, corners);
}
