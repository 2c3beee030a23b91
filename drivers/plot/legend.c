/* SPDX-License-Identifier: BSD-3-Clause */
#include "legend.h"

#include <stdio.h>
#include <string.h>

#include "ticks.h"

double legend_unit(char unit[LEGEND_UNIT], double largest, const char *base)
{
    char digits[TICKS_TEXT];
    const bool is_ratio = strcmp(base, "1") == 0 || base[0] == '\0';
    const bool is_readable = is_ratio ? largest >= 2e-3 && largest < 1e5 : largest >= 1e-12 && largest < 1e15;
    if (is_readable || !(largest > 0.0) || isinf(largest)) {
        const ticks_prefix prefix = is_ratio ? (ticks_prefix){1.0, ""} : ticks_prefix_of(largest);
        (void)snprintf(unit, LEGEND_UNIT, "%s%s", prefix.name, is_ratio ? "" : base);
        return prefix.factor;
    }
    const double power = pow(10.0, floor(log10(largest) + 1e-9));
    ticks_print_power(digits, power);
    (void)snprintf(unit, LEGEND_UNIT, "%s%s%s", digits, is_ratio ? "" : " ", is_ratio ? "" : base);
    return power;
}

static void draw_text(canvas *c, double x, double y, canvas_anchor anchor, const char *text)
{
    c->write(c, &(canvas_label){x, y, LEGEND_LETTERS, anchor, false, canvas_black, text});
}

void legend_draw_scale(double pixels_per_metre, double x, double y, double room, canvas *c)
{
    const double length = ticks_below(room / pixels_per_metre), right = x + length * pixels_per_metre;
    const ticks_prefix prefix = ticks_prefix_of(length);
    char text[TICKS_TEXT + 8];
    const double bar[] = {x, y, right, y}, ends[] = {x, y - 5.0, x, y + 5.0, right, y - 5.0, right, y + 5.0};
    c->strokes(c, (canvas_pen){canvas_black, 2.0}, 2, 1, bar);
    c->strokes(c, (canvas_pen){canvas_black, 2.0}, 2, 2, ends);
    (void)snprintf(text, sizeof text, "%.0f %sm", length / prefix.factor, prefix.name);
    const double middle = x + 0.5 * fmax(right - x, canvas_length(text, LEGEND_LETTERS));
    draw_text(c, middle, y - 9.0, CANVAS_MIDDLE, text);
}

static void draw_arrows(const palette *colours, colour_range range, box place, canvas *c)
{
    const double middle = 0.5 * (place.y0 + place.y1), tip = 0.8 * box_height(place);
    const double left[] = {place.x0, place.y0, place.x0, place.y1, place.x0 - tip, middle};
    const double right[] = {place.x1, place.y0, place.x1, place.y1, place.x1 + tip, middle};
    if (range.below) c->fills(c, colours->of[0], 3, 1, left);
    if (range.above) c->fills(c, colours->of[PALETTE_SIZE - 1], 3, 1, right);
}

/* The ends and the middles between them and 0 where both sides are as long; else round numbers. */
static ticks numbers_of(double lo, double hi, int most)
{
    const ticks five = {5, {-hi, -0.5 * hi, 0.0, 0.5 * hi, hi}, ticks_decimals(0.5 * hi)};
    const ticks three = {3, {-hi, 0.0, hi}, ticks_decimals(hi)};
    return lo != -hi ? ticks_linear(lo, hi, most) : most < 5 ? three : five;
}

/* As many as have room, of the width of the longest that is to be expected. */
static int most_numbers(colour_range range, double factor, double room)
{
    char text[TICKS_TEXT];
    ticks_print(text, -fmax(fabs(range.lo), fabs(range.hi)) / factor, ticks_decimals(0.5 * range.hi / factor));
    return (int)fmin(fmax(room / (canvas_length(text, LEGEND_LETTERS) + 12.0), 2.0), 7.0);
}

static void draw_numbers(colour_range range, double factor, box place, canvas *c)
{
    const ticks at = numbers_of(range.lo / factor, range.hi / factor, most_numbers(range, factor, box_width(place)));
    for (int k = 0; k < at.n; k++) {
        char text[TICKS_TEXT];
        const double u = (at.at[k] * factor - range.lo) / (range.hi - range.lo), x = place.x0 + u * box_width(place);
        const double mark[] = {x, place.y1, x, place.y1 + 4.0};
        c->strokes(c, (canvas_pen){canvas_black, 1.0}, 2, 1, mark);
        ticks_print(text, at.at[k], at.at[k] == 0.0 ? 0 : at.decimals);
        draw_text(c, x, place.y1 + 5.0 + LEGEND_LETTERS, CANVAS_MIDDLE, text);
    }
}

/* Colours of fragments have no order: a bar of some of them, and grey, is all that can be said. */
static void draw_pieces(const quantity *q, const palette *colours, box place, canvas *c)
{
    enum { SHOWN = 12 };
    const double across = box_width(place) / SHOWN;
    c->begin(c, "id=\"colours\"", NULL);
    for (int k = 0; k < SHOWN; k++) {
        const double x0 = place.x0 + k * across, x1 = x0 + across;
        const double corners[] = {x0, place.y0, x1, place.y0, x1, place.y1, x0, place.y1};
        c->fills(c, colours->of[k], 4, 1, corners);
    }
    draw_text(c, 0.5 * (place.x0 + place.x1), place.y0 - 7.0, CANVAS_MIDDLE, q->label);
    c->end(c);
}

void legend_draw_colours(const quantity *q, const palette *colours, colour_range range, box place, canvas *c)
{
    if (q->scale == PALETTE_PIECES) {
        draw_pieces(q, colours, place, c);
        return;
    }
    uint32_t argb[PALETTE_SIZE];
    for (int k = 0; k < PALETTE_SIZE; k++) {
        const colour shade = colours->of[k];
        argb[k] = UINT32_C(0xff000000) | (uint32_t)shade.red << 16 | (uint32_t)shade.green << 8 | shade.blue;
    }
    char unit[LEGEND_UNIT], label[120];
    const double factor = legend_unit(unit, fmax(fabs(range.lo), fabs(range.hi)), q->source->unit);
    c->begin(c, "id=\"colours\"", NULL);
    c->image(c, place, &(canvas_image){PALETTE_SIZE, 1, argb});
    draw_arrows(colours, range, place, c);
    draw_numbers(range, factor, place, c);
    (void)snprintf(label, sizeof label, "%s%s%s", q->label, unit[0] == '\0' ? "" : ", ", unit);
    draw_text(c, 0.5 * (place.x0 + place.x1), place.y0 - 7.0, CANVAS_MIDDLE, label);
    c->end(c);
}
