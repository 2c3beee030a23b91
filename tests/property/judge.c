/* SPDX-License-Identifier: BSD-3-Clause */
/* See judge.h. */
#include "judge.h"

#include <stdlib.h>

static double cross(const double o[2], const double a[2], const double b[2])
{
    return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
}

double judge_distance(const double x[2], const double a[2], const double b[2])
{
    const double dx = b[0] - a[0], dy = b[1] - a[1], px = x[0] - a[0], py = x[1] - a[1];
    const double u = fmin(1.0, fmax(0.0, (px * dx + py * dy) / (dx * dx + dy * dy)));
    return hypot(px - u * dx, py - u * dy);
}

double judge_depth(const solid *s, const double x[2])
{
    int inside = 0;
    double nearest = INFINITY;
    for (dem_index k = 0; k < s->n; k++) {
        const double *a = &s->points[2 * k], *b = &s->points[2 * ((k + 1) % s->n)];
        nearest = fmin(nearest, judge_distance(x, a, b));
        if ((a[1] > x[1]) != (b[1] > x[1]) && x[0] < a[0] + (x[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
            inside = !inside;
    }
    return inside != s->is_room ? nearest : 0.0;
}

/* How many triangles have the side. */
static int sides_like(const dem_lattice *l, dem_index i, dem_index j)
{
    int n = 0;
    for (dem_index t = 0; t < l->n_triangles; t++)
        for (int k = 0; k < 3; k++) {
            const dem_index a = l->triangles[3 * t + k], b = l->triangles[3 * t + (k + 1) % 3];
            n += (a == i && b == j) || (a == j && b == i);
        }
    return n;
}

void judge_boundary(boundary_condition *out, const dem_lattice *l)
{
    *out = (boundary_condition){0, malloc((6 * (size_t)l->n_triangles + 1) * sizeof(dem_index))};
    assert_non_null(out->ends);
    for (dem_index t = 0; t < l->n_triangles; t++)
        for (int k = 0; k < 3; k++) {
            const dem_index a = l->triangles[3 * t + k], b = l->triangles[3 * t + (k + 1) % 3];
            if (sides_like(l, a, b) != 1) continue;
            out->ends[2 * out->n] = a;
            out->ends[2 * out->n + 1] = b;
            out->n++;
        }
}

double judge_nodes(const scene *sc, const double *x)
{
    double deepest = 0.0;
    for (dem_index i = 0; i < sc->body.n_nodes; i++)
        for (int k = 0; k < sc->n && (sc->body.flags == NULL || (sc->body.flags[i] & DEM_NODE_CONTACT)); k++)
            deepest = fmax(deepest, judge_depth(&sc->solids[k], &x[2 * i]));
    return deepest;
}

/* Turns of the body's boundary round the point. */
static int turns_round(const dem_lattice *l, const double *x, const double p[2])
{
    int turns = 0;
    for (dem_index t = 0; t < l->n_triangles; t++) {
        const double *a = &x[2 * l->triangles[3 * t]], *b = &x[2 * l->triangles[3 * t + 1]],
                     *c = &x[2 * l->triangles[3 * t + 2]];
        const double u = cross(a, b, p), v = cross(b, c, p), w = cross(c, a, p);
        if (u > 0.0 && v > 0.0 && w > 0.0) turns++;
        if (u < 0.0 && v < 0.0 && w < 0.0) turns--;
    }
    return turns;
}

/* Whether the obstacle's point k sticks out: the free ends of an open polyline do not count. */
static int is_convex(const solid *s, const dem_obstacle *o, dem_index k)
{
    const int closed = s->n_exposed == s->n + 1;
    if (!closed && (k == 0 || k + 1 == o->n_points)) return 0;
    if (closed && k == s->n) return 0; /* the first again */
    const double *here = &s->points[2 * k], *after = &s->points[2 * ((k + 1) % s->n)],
                 *before = &s->points[2 * ((k + s->n - 1) % s->n)];
    return cross(before, here, after) < 0.0;
}

double judge_vertices(const scene *sc, const boundary_condition *b, const double *x)
{
    double deepest = 0.0;
    for (int o = 0; o < sc->n; o++)
        for (dem_index k = 0; k < sc->obstacles[o].n_points; k++) {
            const double *p = &sc->solids[o].points[2 * k];
            double nearest = INFINITY;
            if (!is_convex(&sc->solids[o], &sc->obstacles[o], k) || turns_round(&sc->body, x, p) <= 0) continue;
            for (dem_index e = 0; e < b->n; e++)
                nearest = fmin(nearest, judge_distance(p, &x[2 * b->ends[2 * e]], &x[2 * b->ends[2 * e + 1]]));
            deepest = fmax(deepest, nearest);
        }
    return deepest;
}

double judge_clearance(const scene *sc, const boundary_condition *b, const double *x)
{
    double nearest = INFINITY;
    for (int o = 0; o < sc->n; o++)
        for (dem_index k = 0; k < sc->obstacles[o].n_points; k++) {
            const double *p = &sc->obstacles[o].points[2 * k];
            for (dem_index i = 0; i < sc->body.n_nodes && k + 1 < sc->obstacles[o].n_points; i++)
                nearest = fmin(nearest, judge_distance(&x[2 * i], p, p + 2));
            for (dem_index e = 0; e < b->n; e++)
                nearest = fmin(nearest, judge_distance(p, &x[2 * b->ends[2 * e]], &x[2 * b->ends[2 * e + 1]]));
        }
    return nearest;
}
