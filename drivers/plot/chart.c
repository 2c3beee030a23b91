/* SPDX-License-Identifier: BSD-3-Clause */
#include "chart.h"

#include <stdio.h>
#include <stdlib.h>

#include "legend.h"
#include "ticks.h"

static const double letters = 14.0, beside = 150.0, before = 74.0, below = 42.0; /* pixels around the axes */

/* Okabe and Ito, but for the yellow, which is pale on white; behind them as many as make up all energies. */
colour chart_ink(int k)
{
    static const colour inks[] = {{26, 26, 26},   {0, 114, 178}, {213, 94, 0},    {0, 158, 115},  {204, 121, 167},
                                  {86, 180, 233}, {230, 159, 0}, {110, 110, 110}, {102, 51, 153}, {128, 84, 42},
                                  {140, 150, 0},  {0, 80, 80},   {170, 0, 70}};
    return inks[k % (int)(sizeof inks / sizeof *inks)];
}

static double number(const chart *of, int line, size_t k)
{
    const chart_line *l = &of->line[line];
    return l->y[l->stride * k];
}

static bool is_shown(const chart *of, double y)
{
    return isfinite(y) && (!of->by_decades || y > 0.0);
}

/* ---- thinning ---- */

/* The points of a part: which is first, least, largest and last. */
typedef struct bundle {
    bool any;
    size_t k[4];
    double least, most;
} bundle;

static void bundle_add(bundle *b, size_t k, double y)
{
    if (!b->any) *b = (bundle){true, {k, k, k, k}, y, y};
    if (y < b->least) b->least = y, b->k[1] = k;
    if (y > b->most) b->most = y, b->k[2] = k;
    b->k[3] = k;
}

static size_t bundle_put(const bundle *b, const chart *of, int line, double *xy)
{
    size_t n = 0;
    if (!b->any) return 0;
    const size_t a = b->k[1] < b->k[2] ? b->k[1] : b->k[2], z = b->k[1] < b->k[2] ? b->k[2] : b->k[1];
    const size_t order[] = {b->k[0], a, z, b->k[3]};
    for (int i = 0; i < 4; i++) {
        if (i > 0 && order[i] == order[i - 1]) continue;
        xy[2 * n] = of->t[order[i]];
        xy[2 * n + 1] = number(of, line, order[i]);
        n++;
    }
    return n;
}

size_t chart_thin(const chart *of, int line, size_t columns, double *xy)
{
    const double begin = of->begin, whole = of->end - begin;
    size_t n = 0, column = 0;
    bundle b = {0};
    for (size_t k = 0; k < of->n; k++) {
        const double y = number(of, line, k), u = whole > 0.0 ? (of->t[k] - begin) / whole : 0.0;
        const size_t here = u < 1.0 ? (size_t)(u * (double)columns) : columns - 1;
        if (!is_shown(of, y)) continue;
        if (here != column) {
            n += bundle_put(&b, of, line, xy + 2 * n);
            b = (bundle){0};
            column = here;
        }
        bundle_add(&b, k, y);
    }
    return n + bundle_put(&b, of, line, xy + 2 * n);
}

/* ---- axes ---- */

/* From lo to hi in numbers, in `place` in the picture; decades are drawn by their logarithms. */
typedef struct axes {
    box place;
    double t0, t1, lo, hi;
    bool by_decades;
} axes;

static double across(const axes *a, double t)
{
    return a->place.x0 + box_width(a->place) * (t - a->t0) / (a->t1 - a->t0);
}

static double up(const axes *a, double y)
{
    const double u = a->by_decades ? log10(y / a->lo) / log10(a->hi / a->lo) : (y - a->lo) / (a->hi - a->lo);
    return a->place.y1 - box_height(a->place) * u;
}

static void reach(const chart *of, double *lo, double *hi)
{
    *lo = (double)INFINITY, *hi = -(double)INFINITY;
    for (int line = 0; line < of->n_lines; line++)
        for (size_t k = 0; k < of->n; k++) {
            const double y = number(of, line, k);
            if (is_shown(of, y)) *lo = fmin(*lo, y), *hi = fmax(*hi, y);
        }
}

static axes axes_of(const chart *of, box place)
{
    axes a = {.place = place, .t0 = of->begin, .t1 = of->end, .by_decades = of->by_decades};
    if (!(a.t1 > a.t0)) a.t1 = a.t0 + 1.0;
    reach(of, &a.lo, &a.hi);
    if (!(a.lo <= a.hi)) a.lo = a.by_decades ? 0.1 : 0.0, a.hi = 1.0;
    if (a.by_decades) {
        a.lo *= 0.7, a.hi *= 1.4;
        return a;
    }
    a.lo = fmin(a.lo, 0.0), a.hi = fmax(a.hi, 0.0);
    if (a.lo == a.hi) a.hi = 1.0;
    const double room = 0.06 * (a.hi - a.lo);
    if (a.lo < 0.0) a.lo -= room;
    if (a.hi > 0.0) a.hi += room;
    return a;
}

static void write_text(canvas *c, double x, double y, canvas_anchor anchor, const char *text)
{
    c->write(c, &(canvas_label){x, y, letters, anchor, false, canvas_black, text});
}

static void draw_line(canvas *c, colour ink, double x0, double y0, double x1, double y1)
{
    const double xy[] = {x0, y0, x1, y1};
    c->strokes(c, (canvas_pen){ink, 1.0}, 2, 1, xy);
}

static void draw_numbers(const axes *a, double factor, canvas *c)
{
    const int most = (int)fmin(fmax(box_height(a->place) / 24.0, 2.0), 8.0);
    const ticks at = a->by_decades ? ticks_decades(a->lo / factor, a->hi / factor, most)
                                   : ticks_linear(a->lo / factor, a->hi / factor, most);
    for (int k = 0; k < at.n; k++) {
        char text[TICKS_TEXT];
        const double y = up(a, at.at[k] * factor);
        draw_line(c, canvas_light, a->place.x0, y, a->place.x1, y);
        if (a->by_decades)
            ticks_print_power(text, at.at[k]);
        else
            ticks_print(text, at.at[k], at.decimals);
        write_text(c, a->place.x0 - 8.0, y + 0.35 * letters, CANVAS_END, text);
    }
}

static void draw_times(const axes *a, bool has_labels, canvas *c)
{
    const ticks_prefix prefix = ticks_prefix_of(fmax(fabs(a->t0), fabs(a->t1)));
    const int most = (int)fmin(fmax(box_width(a->place) / 60.0, 2.0), 11.0);
    const ticks at = ticks_linear(a->t0 / prefix.factor, a->t1 / prefix.factor, most);
    const double bottom = a->place.y1;
    char text[TICKS_TEXT];
    for (int k = 0; k < at.n; k++) {
        const double x = across(a, at.at[k] * prefix.factor);
        draw_line(c, canvas_black, x, bottom, x, bottom - 5.0);
        ticks_print(text, at.at[k], at.decimals);
        if (has_labels) write_text(c, x, bottom + 19.0, CANVAS_MIDDLE, text);
    }
    (void)snprintf(text, sizeof text, "time, %ss", prefix.name);
    if (has_labels) write_text(c, 0.5 * (a->place.x0 + a->place.x1), bottom + 38.0, CANVAS_MIDDLE, text);
}

/* The same of powers of ten. */
static void draw_decades(const chart *of, const axes *a, canvas *c)
{
    const int most = (int)fmin(fmax(box_width(a->place) / 60.0, 2.0), 11.0);
    const ticks at = ticks_decades(pow(10.0, a->t0), pow(10.0, a->t1), most);
    const double bottom = a->place.y1;
    for (int k = 0; k < at.n; k++) {
        char text[TICKS_TEXT];
        const double x = across(a, log10(at.at[k]));
        draw_line(c, canvas_black, x, bottom, x, bottom - 5.0);
        ticks_print_power(text, at.at[k]);
        write_text(c, x, bottom + 19.0, CANVAS_MIDDLE, text);
    }
    write_text(c, 0.5 * (a->place.x0 + a->place.x1), bottom + 38.0, CANVAS_MIDDLE, of->across);
}

static void draw_label(const chart *of, const axes *a, const char *unit, canvas *c)
{
    char text[120];
    (void)snprintf(text, sizeof text, "%s%s%s", of->label, unit[0] == '\0' ? "" : ", ", unit);
    c->write(c, &(canvas_label){a->place.x0 - before + letters, 0.5 * (a->place.y0 + a->place.y1), letters,
                                CANVAS_MIDDLE, true, canvas_black, text});
}

static void draw_names(const chart *of, const axes *a, canvas *c)
{
    const double x = a->place.x1 + 12.0;
    for (int k = 0; k < of->n_lines; k++) {
        const double y = a->place.y0 + 10.0 + 19.0 * k, mark[] = {x, y, x + 18.0, y};
        if (of->line[k].name[0] == '\0') continue;
        c->strokes(c, (canvas_pen){of->line[k].ink, 2.5}, 2, 1, mark);
        write_text(c, x + 25.0, y + 0.35 * letters, CANVAS_START, of->line[k].name);
    }
}

static bool draw_curve(const chart *of, int line, const axes *a, canvas *c)
{
    const size_t columns = (size_t)box_width(a->place) + 1;
    double *xy = malloc(8 * columns * sizeof *xy);
    if (xy == NULL) return false;
    const size_t n = chart_thin(of, line, columns, xy);
    for (size_t k = 0; k < n; k++) xy[2 * k] = across(a, xy[2 * k]), xy[2 * k + 1] = up(a, xy[2 * k + 1]);
    if (n > 0) c->strokes(c, (canvas_pen){of->line[line].ink, 1.6}, n, 1, xy);
    free(xy);
    return true;
}

bool chart_draw(const chart *of, box place, bool has_times, canvas *c)
{
    char unit[LEGEND_UNIT], attributes[80];
    const box inner = {place.x0 + before, place.y0, place.x1 - beside, place.y1 - (has_times ? below : 0.0)};
    const axes a = axes_of(of, inner);
    const double factor = of->unit[0] == '\0' ? 1.0 : legend_unit(unit, fmax(fabs(a.lo), fabs(a.hi)), of->unit);
    if (of->unit[0] == '\0') unit[0] = '\0';
    bool drawn = true;
    (void)snprintf(attributes, sizeof attributes, "class=\"chart\" data-rows=\"%zu\"", of->n);
    c->begin(c, attributes, NULL);
    draw_numbers(&a, factor, c);
    if (of->across != NULL)
        draw_decades(of, &a, c);
    else
        draw_times(&a, has_times, c);
    for (int k = of->n_lines - 1; k >= 0 && drawn; k--) drawn = draw_curve(of, k, &a, c);
    canvas_outline(c, (canvas_pen){canvas_black, 1.0}, inner);
    draw_label(of, &a, unit, c);
    draw_names(of, &a, c);
    c->end(c);
    return drawn;
}
