/* SPDX-License-Identifier: BSD-3-Clause */
#include "strip.h"

#include <math.h>

static const double margin = 12.0, gap = 10.0, above = 26.0, below = 66.0; /* pixels */
static const double highest = 0.75;                                        /* of a picture, over its width */
static const double narrowest = 20.0;                                      /* panel, pixels */
static const double flattest = 0.25;                                       /* a panel's height over its width */

static double across_of(double width, size_t columns)
{
    return floor((width - 2.0 * margin - (double)(columns - 1) * gap) / (double)columns);
}

static double height_of(size_t rows, double down)
{
    return 2.0 * margin + (double)rows * (above + down) + (double)(rows - 1) * gap + below;
}

static size_t divide_up(size_t n, size_t by)
{
    return (n + by - 1) / by;
}

static size_t most_columns(size_t n, double width)
{
    const size_t room = (size_t)((width - 2.0 * margin + gap) / (narrowest + gap));
    return n < room ? n : room;
}

/* More rows make larger panels, and a higher picture; a last row with few panels looks forgotten. */
static size_t choose_columns(size_t n, double shape, double width)
{
    size_t columns = most_columns(n, width);
    for (size_t rows = divide_up(n, columns) + 1; rows <= n; rows++) {
        const size_t fewer = divide_up(n, rows), last = n - (divide_up(n, fewer) - 1) * fewer;
        if (height_of(divide_up(n, fewer), shape * across_of(width, fewer)) > highest * width) break;
        if (3 * last >= 2 * fewer) columns = fewer;
    }
    return columns;
}

/* About its middle, to a shape: height over width. */
static box widen(box view, double shape)
{
    const double more_x = box_height(view) / shape - box_width(view),
                 more_y = shape * box_width(view) - box_height(view);
    if (more_x > 0.0) view.x0 -= 0.5 * more_x, view.x1 += 0.5 * more_x;
    if (more_y > 0.0) view.y0 -= 0.5 * more_y, view.y1 += 0.5 * more_y;
    return view;
}

strip strip_plan(size_t n, box view, double width, size_t columns)
{
    strip s = {.n = n, .width = 2.0 * ceil(0.5 * width)};
    const double shape = fmax(box_height(view) / box_width(view), flattest);
    s.columns = columns > 0 ? most_columns(columns < n ? columns : n, s.width) : choose_columns(n, shape, s.width);
    s.rows = divide_up(n, s.columns);
    s.across = across_of(s.width, s.columns);
    const double room = (highest * s.width - height_of(s.rows, 0.0)) / (double)s.rows;
    const bool is_limited = columns == 0 || s.rows == 1;
    s.down = round(is_limited ? fmin(shape * s.across, fmax(room, narrowest)) : shape * s.across);
    s.height = 2.0 * ceil(0.5 * height_of(s.rows, s.down));
    s.view = widen(view, s.down / s.across);
    return s;
}

panel strip_panel(const strip *s, size_t k)
{
    const size_t row = k / s->columns, column = k % s->columns;
    const double x = margin + (double)column * (s->across + gap);
    const double y = margin + above + (double)row * (above + s->down + gap);
    return (panel){s->view, {x, y, x + s->across, y + s->down}};
}

box strip_colours(const strip *s)
{
    const double length = fmin(0.36 * s->width, 420.0), y = s->height - margin - 38.0;
    const double x = s->width - margin - 30.0 - length;
    return (box){x, y, x + length, y + 13.0};
}

box strip_scale(const strip *s)
{
    const double y = s->height - margin - 30.0;
    return (box){margin + 2.0, y, margin + fmin(0.8 * s->across, 0.3 * s->width), y};
}

/* What of a segment lies in the box, by Liang and Barsky's clipping; empty if nothing. */
static box clip(const double *from, const double *to, box b)
{
    const double dx = to[0] - from[0], dy = to[1] - from[1];
    const double p[] = {-dx, dx, -dy, dy};
    const double q[] = {from[0] - b.x0, b.x1 - from[0], from[1] - b.y0, b.y1 - from[1]};
    double begin = 0.0, end = 1.0;
    for (int k = 0; k < 4; k++) {
        if (p[k] == 0.0 && q[k] < 0.0) return box_empty();
        if (p[k] < 0.0) begin = fmax(begin, q[k] / p[k]);
        if (p[k] > 0.0) end = fmin(end, q[k] / p[k]);
    }
    if (begin > end) return box_empty();
    const double ends[] = {from[0] + begin * dx, from[1] + begin * dy, from[0] + end * dx, from[1] + end * dy};
    return box_around(2, ends);
}

/* The larger side of the bodies' box; 1 for a single point that does not move. */
static double unit_of(box bodies)
{
    const double size = fmax(box_width(bodies), box_height(bodies));
    return size > 0.0 ? size : 1.0;
}

box strip_view(box bodies)
{
    return box_grown(bodies, 0.04 * unit_of(bodies));
}

box strip_view_with(box view, box bodies, const dem_obstacle *obstacle)
{
    const double unit = unit_of(bodies);
    const box near = {bodies.x0 - 0.10 * unit, bodies.y0 - 0.22 * unit, bodies.x1 + 0.10 * unit,
                      bodies.y1 + 0.10 * unit};
    for (dem_index k = 1; k < obstacle->n_points; k++) {
        const double *p = obstacle->points + 2 * k;
        const box seen = clip(p - 2, p, near);
        if (!box_is_empty(seen)) view = box_join(view, box_grown(seen, 0.04 * unit));
    }
    return view;
}

box strip_view_of_all(box bodies, const dem_reader *reader)
{
    box view = strip_view(bodies);
    for (dem_index k = 0; k < dem_reader_n_obstacles(reader); k++)
        view = strip_view_with(view, bodies, dem_reader_obstacle(reader, k));
    return view;
}
