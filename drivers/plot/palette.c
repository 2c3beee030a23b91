/* SPDX-License-Identifier: BSD-3-Clause */
#include "palette.h"

#include <math.h>

typedef struct shade {
    double light, a, b; /* CIE L*, a*, b* */
} shade;

enum { STOPS = 7 };

enum { DIVERGING, SEQUENTIAL };

static const shade stops[][STOPS] = {
    [DIVERGING] = {{30, 8, -46}, {42, 0, -45}, {58, -7, -34}, {78, 0, 0}, {58, 36, 42}, {42, 53, 46}, {30, 45, 36}},
    [SEQUENTIAL] =
        {{88, -6, 40}, {77, 12, 50}, {65, 32, 41}, {53, 46, 20}, {41, 45, -12}, {30, 34, -30}, {18, 20, -33}},
};

/* Which part of which row of stops a palette has. */
static const struct {
    int row, first, last;
} parts[] = {[PALETTE_DIVERGING] = {DIVERGING, 0, STOPS - 1},
             [PALETTE_SEQUENTIAL] = {SEQUENTIAL, 0, STOPS - 1},
             [PALETTE_UPPER] = {DIVERGING, STOPS / 2, STOPS - 1},
             [PALETTE_LOWER] = {DIVERGING, 0, STOPS / 2}};

/* f of the CIE, turned round: X/X_white = f^-1(...). */
static double unbend(double t)
{
    const double knee = 6.0 / 29.0;
    return t > knee ? t * t * t : 3.0 * knee * knee * (t - 4.0 / 29.0);
}

static unsigned char encode(double linear)
{
    const double x = linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1.0 / 2.4) - 0.055;
    return (unsigned char)lround(255.0 * fmin(fmax(x, 0.0), 1.0));
}

/* To sRGB, under the white of day (D65). */
static colour render(shade s)
{
    const double y = (s.light + 16.0) / 116.0;
    const double X = 0.95047 * unbend(y + s.a / 500.0), Y = unbend(y), Z = 1.08883 * unbend(y - s.b / 200.0);
    return (colour){encode(3.2404542 * X - 1.5371385 * Y - 0.4985314 * Z),
                    encode(-0.9692660 * X + 1.8760108 * Y + 0.0415560 * Z),
                    encode(0.0556434 * X - 0.2040259 * Y + 1.0572252 * Z)};
}

/* Hues a golden section of the circle apart, in three lightnesses, so that places near each other differ in both. */
static palette make_pieces(void)
{
    static const double lightness[] = {48.0, 63.0, 78.0}, turn = 2.399963229728653, vivid = 48.0;
    palette made = {.kind = PALETTE_PIECES};
    made.of[0] = render((shade){72.0, 0.0, 0.0});
    for (int k = 1; k < PALETTE_SIZE; k++)
        made.of[k] = render((shade){lightness[k % 3], vivid * cos(turn * k), vivid * sin(turn * k)});
    return made;
}

palette palette_make(palette_kind kind)
{
    if (kind == PALETTE_PIECES) return make_pieces();
    palette made = {.kind = kind};
    const shade *row = stops[parts[kind].row];
    const int first = parts[kind].first, last = parts[kind].last;
    for (int k = 0; k < PALETTE_SIZE; k++) {
        const double place = first + (double)k * (last - first) / (PALETTE_SIZE - 1);
        const int stop = place < STOPS - 1 ? (int)place : STOPS - 2;
        const shade from = row[stop], to = row[stop + 1];
        const double u = place - stop;
        made.of[k] = render((shade){from.light + u * (to.light - from.light), from.a + u * (to.a - from.a),
                                    from.b + u * (to.b - from.b)});
    }
    return made;
}

palette_kind palette_between(palette_kind kind, double lo, double hi)
{
    if (kind != PALETTE_DIVERGING || (lo != 0.0 && hi != 0.0)) return kind;
    return lo == 0.0 ? PALETTE_UPPER : PALETTE_LOWER;
}

palette palette_plain(colour ink)
{
    palette made = {.kind = PALETTE_DIVERGING};
    for (int k = 0; k < PALETTE_SIZE; k++) made.of[k] = ink;
    return made;
}

int palette_index(double value, double lo, double hi)
{
    const double u = (value - lo) / (hi - lo);
    return (int)lround((PALETTE_SIZE - 1) * fmin(fmax(u, 0.0), 1.0)); /* fmax: what is no number gets the lower end's */
}
