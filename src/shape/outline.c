/* SPDX-License-Identifier: BSD-3-Clause */
/* Square roots only, so that pores lie at the same places on every machine. */
#include "shape/outline.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static outline_side side_of_polygon(const outline *o, size_t k)
{
    const double *a = o->points + 2 * k, *b = o->points + 2 * (k + 1 < o->n_points ? k + 1 : 0);
    return (outline_side){{a[0], a[1]}, {b[0], b[1]}};
}

/* ---- distance ---- */

static double rectangle_distance(const outline *o, double x, double y)
{
    const double dx = fabs(x) - 0.5 * o->size[0], dy = fabs(y) - 0.5 * o->size[1];
    const double ox = fmax(dx, 0.0), oy = fmax(dy, 0.0);
    return sqrt(ox * ox + oy * oy) + fmin(fmax(dx, dy), 0.0);
}

/* Where on a side its nearest point is: 0 at its first end, 1 at its second. */
static double side_share(outline_side e, double x, double y)
{
    const double tx = e.b[0] - e.a[0], ty = e.b[1] - e.a[1], dx = x - e.a[0], dy = y - e.a[1];
    return fmin(fmax((dx * tx + dy * ty) / (tx * tx + ty * ty), 0.0), 1.0);
}

static double side_distance(outline_side e, double x, double y)
{
    const double tx = e.b[0] - e.a[0], ty = e.b[1] - e.a[1], dx = x - e.a[0], dy = y - e.a[1];
    const double s = side_share(e, x, y);
    const double rx = dx - s * tx, ry = dy - s * ty;
    return sqrt(rx * rx + ry * ry);
}

/* Whether the line of height y crosses a side, and where. Of the ends the upper one counts as beyond: so a corner is
 * crossed once or twice, never in between. */
static bool crosses(outline_side e, double y, double *x)
{
    if ((e.a[1] > y) == (e.b[1] > y)) return false;
    *x = e.a[0] + (e.b[0] - e.a[0]) * ((y - e.a[1]) / (e.b[1] - e.a[1]));
    return true;
}

static double polygon_distance(const outline *o, double x, double y)
{
    double least = (double)INFINITY, at = 0.0;
    bool inside = false;
    for (size_t k = 0; k < o->n_points; k++) {
        const outline_side e = side_of_polygon(o, k);
        least = fmin(least, side_distance(e, x, y));
        if (crosses(e, y, &at) && at > x) inside = !inside;
    }
    return inside ? -least : least;
}

double outline_distance(const outline *o, double x, double y)
{
    const double dx = x - o->centre[0], dy = y - o->centre[1];
    switch (o->kind) {
    case DEM_OUTLINE_RECTANGLE:
        return rectangle_distance(o, dx, dy);
    case DEM_OUTLINE_DISC:
        return sqrt(dx * dx + dy * dy) - o->radius;
    case DEM_OUTLINE_RING:
        return fmax(sqrt(dx * dx + dy * dy) - o->radius, o->inner - sqrt(dx * dx + dy * dy));
    case DEM_OUTLINE_POLYGON:
        return polygon_distance(o, x, y);
    }
    return (double)INFINITY;
}

/* ---- nearest point ---- */

/* On the side that is nearest, or, from outside, where clamping both coordinates leads. */
static void nearest_of_rectangle(const outline *o, const double x[2], double near[2])
{
    const double dx = x[0] - o->centre[0], dy = x[1] - o->centre[1];
    const double half[2] = {0.5 * o->size[0], 0.5 * o->size[1]};
    const double depth[2] = {half[0] - fabs(dx), half[1] - fabs(dy)};
    double at[2] = {fmin(fabs(dx), half[0]), fmin(fabs(dy), half[1])};
    if (depth[0] > 0.0 && depth[1] > 0.0) {
        const int c = depth[0] < depth[1] ? 0 : 1;
        at[c] = half[c];
    }
    near[0] = o->centre[0] + copysign(at[0], dx);
    near[1] = o->centre[1] + copysign(at[1], dy);
}

/* From the centre every direction is as good; the right one is taken. */
static void nearest_of_circle(const outline *o, double radius, const double x[2], double near[2])
{
    const double dx = x[0] - o->centre[0], dy = x[1] - o->centre[1], r = sqrt(dx * dx + dy * dy);
    near[0] = o->centre[0] + (r > 0.0 ? radius * (dx / r) : radius);
    near[1] = o->centre[1] + (r > 0.0 ? radius * (dy / r) : 0.0);
}

static void nearest_of_polygon(const outline *o, const double x[2], double near[2])
{
    double least = (double)INFINITY;
    for (size_t k = 0; k < o->n_points; k++) {
        const outline_side e = side_of_polygon(o, k);
        const double distance = side_distance(e, x[0], x[1]), s = side_share(e, x[0], x[1]);
        if (distance >= least) continue;
        least = distance;
        for (int c = 0; c < 2; c++) near[c] = s < 1.0 ? e.a[c] + s * (e.b[c] - e.a[c]) : e.b[c];
    }
}

void outline_nearest(const outline *o, const double x[2], double near[2])
{
    const double dx = x[0] - o->centre[0], dy = x[1] - o->centre[1], r = sqrt(dx * dx + dy * dy);
    switch (o->kind) {
    case DEM_OUTLINE_RECTANGLE:
        nearest_of_rectangle(o, x, near);
        break;
    case DEM_OUTLINE_DISC:
        nearest_of_circle(o, o->radius, x, near);
        break;
    case DEM_OUTLINE_RING:
        nearest_of_circle(o, r - o->inner < o->radius - r ? o->inner : o->radius, x, near);
        break;
    case DEM_OUTLINE_POLYGON:
        nearest_of_polygon(o, x, near);
        break;
    }
}

/* ---- corners ---- */

size_t outline_corners(const outline *o)
{
    return o->kind == DEM_OUTLINE_POLYGON ? o->n_points : (o->kind == DEM_OUTLINE_RECTANGLE ? 4 : 0);
}

/* Those of a rectangle begin at the lower left. */
static outline_corner corner_of_rectangle(const outline *o, size_t k)
{
    const double right = k == 1 || k == 2 ? 0.5 : -0.5, top = k >= 2 ? 0.5 : -0.5;
    return (outline_corner){{o->centre[0] + right * o->size[0], o->centre[1] + top * o->size[1]}, 0.0};
}

outline_corner outline_corner_at(const outline *o, size_t k)
{
    if (o->kind == DEM_OUTLINE_RECTANGLE) return corner_of_rectangle(o, k);
    const outline_side before = side_of_polygon(o, k > 0 ? k - 1 : o->n_points - 1), e = side_of_polygon(o, k);
    const double ux = before.b[0] - before.a[0], uy = before.b[1] - before.a[1];
    const double vx = e.b[0] - e.a[0], vy = e.b[1] - e.a[1];
    return (outline_corner){{e.a[0], e.a[1]}, (ux * vx + uy * vy) / sqrt((ux * ux + uy * uy) * (vx * vx + vy * vy))};
}

outline_side outline_side_at(const outline *o, size_t k)
{
    if (o->kind == DEM_OUTLINE_POLYGON) return side_of_polygon(o, k);
    const outline_corner a = corner_of_rectangle(o, k), b = corner_of_rectangle(o, (k + 1) % 4);
    return (outline_side){{a.x[0], a.x[1]}, {b.x[0], b.x[1]}};
}

/* ---- box ---- */

void outline_box(const outline *o, double box[4])
{
    const double half[2] = {o->kind == DEM_OUTLINE_RECTANGLE ? 0.5 * o->size[0] : o->radius,
                            o->kind == DEM_OUTLINE_RECTANGLE ? 0.5 * o->size[1] : o->radius};
    for (int c = 0; c < 2; c++) {
        box[c] = o->centre[c] - half[c];
        box[c + 2] = o->centre[c] + half[c];
    }
    if (o->kind != DEM_OUTLINE_POLYGON) return;
    for (int c = 0; c < 2; c++) box[c] = box[c + 2] = o->points[c];
    for (size_t k = 0; k < 2 * o->n_points; k++) {
        box[k % 2] = fmin(box[k % 2], o->points[k]);
        box[k % 2 + 2] = fmax(box[k % 2 + 2], o->points[k]);
    }
}

/* ---- slices ---- */

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static size_t slice_polygon(const outline *o, double y, double *x)
{
    size_t n = 0;
    for (size_t k = 0; k < o->n_points; k++) n += crosses(side_of_polygon(o, k), y, x + n);
    qsort(x, n, sizeof *x, by_size);
    return n;
}

/* Half the chord of a circle at height dy from its centre; 0: it is not cut. */
static double chord(double radius, double dy)
{
    return fabs(dy) < radius ? sqrt((radius - dy) * (radius + dy)) : 0.0;
}

size_t outline_slice(const outline *o, double y, double *x)
{
    const double dy = y - o->centre[1], middle = o->centre[0];
    if (o->kind == DEM_OUTLINE_POLYGON) return slice_polygon(o, y, x);
    const double half = o->kind != DEM_OUTLINE_RECTANGLE ? chord(o->radius, dy)
                        : fabs(dy) < 0.5 * o->size[1]    ? 0.5 * o->size[0]
                                                         : 0.0;
    const double hole = o->kind == DEM_OUTLINE_RING ? chord(o->inner, dy) : 0.0;
    size_t n = 0;
    if (half == 0.0) return 0;
    x[n++] = middle - half;
    if (hole > 0.0) x[n++] = middle - hole;
    if (hole > 0.0) x[n++] = middle + hole;
    x[n++] = middle + half;
    return n;
}

size_t outline_cuts(const outline *o)
{
    return o->kind == DEM_OUTLINE_POLYGON ? o->n_points : (o->kind == DEM_OUTLINE_RING ? 4 : 2);
}

size_t outline_levels(const outline *o, double *y)
{
    double box[4];
    if (o->kind == DEM_OUTLINE_POLYGON) {
        for (size_t k = 0; k < o->n_points; k++) y[k] = o->points[2 * k + 1];
        return o->n_points;
    }
    outline_box(o, box);
    y[0] = box[1];
    y[1] = box[3];
    if (o->kind != DEM_OUTLINE_RING) return 2;
    y[2] = o->centre[1] - o->inner;
    y[3] = o->centre[1] + o->inner;
    return 4;
}

/* ---- polygons ---- */

/* Twice the area of the triangle to a point: > 0 on the left of the side. */
static double area_to(outline_side e, const double *p)
{
    return (e.b[0] - e.a[0]) * (p[1] - e.a[1]) - (e.b[1] - e.a[1]) * (p[0] - e.a[0]);
}

static bool is_between(double a, double x, double b)
{
    return (a <= x && x <= b) || (b <= x && x <= a);
}

/* A point on the side's line. */
static bool is_on(outline_side e, const double *p)
{
    return is_between(e.a[0], p[0], e.b[0]) && is_between(e.a[1], p[1], e.b[1]);
}

/* Whether two sides share a point. */
static bool meet(outline_side e, outline_side f)
{
    const double fa = area_to(e, f.a), fb = area_to(e, f.b), ea = area_to(f, e.a), eb = area_to(f, e.b);
    const bool apart =
        (fa > 0.0 && fb > 0.0) || (fa < 0.0 && fb < 0.0) || (ea > 0.0 && eb > 0.0) || (ea < 0.0 && eb < 0.0);
    if (fa != 0.0 || fb != 0.0) return !apart;
    return is_on(e, f.a) || is_on(e, f.b) || is_on(f, e.a); /* all on one line */
}

/* Whether a side runs back on the one before. */
static bool folds(outline_side before, outline_side e)
{
    const double along =
        (before.b[0] - before.a[0]) * (e.b[0] - e.a[0]) + (before.b[1] - before.a[1]) * (e.b[1] - e.a[1]);
    return area_to(before, e.b) == 0.0 && along < 0.0;
}

bool outline_crossing(const outline *o, size_t edges[2])
{
    const size_t n = o->n_points;
    for (size_t i = 0; i < n; i++)
        for (size_t j = i + 1; j < n; j++) {
            const outline_side e = side_of_polygon(o, i), f = side_of_polygon(o, j);
            const bool follows = j == i + 1, closes = i == 0 && j == n - 1;
            if (follows ? !folds(e, f) : (closes ? !folds(f, e) : !meet(e, f))) continue;
            edges[0] = i;
            edges[1] = j;
            return true;
        }
    return false;
}

bool outline_place(outline *o, const double turn[2], const double shift[2])
{
    const double w = 0.5 * o->size[0], h = 0.5 * o->size[1], corners[8] = {-w, -h, w, -h, w, h, -w, h};
    if (o->kind == DEM_OUTLINE_RECTANGLE) {
        o->points = malloc(sizeof corners);
        if (o->points == NULL) return false;
        memcpy(o->points, corners, sizeof corners);
        o->n_points = 4;
        o->kind = DEM_OUTLINE_POLYGON;
    }
    for (size_t k = 0; k < o->n_points; k++) {
        double *p = o->points + 2 * k;
        const double x = p[0], y = p[1];
        p[0] = turn[0] * x - turn[1] * y + shift[0];
        p[1] = turn[1] * x + turn[0] * y + shift[1];
    }
    return true;
}

void outline_free(outline *o)
{
    free(o->points);
    *o = (outline){0};
}
