/* SPDX-License-Identifier: BSD-3-Clause */
#include "obstacle_fill.h"

#include <stdlib.h>
#include <string.h>

enum { ARC = OBSTACLE_FILL_MORE - 2 }; /* points far away, from behind the end to behind the beginning */

static bool is_closed(const dem_obstacle *obstacle)
{
    const double *p = obstacle->points, *last = p + 2 * (obstacle->n_points - 1);
    return p[0] == last[0] && p[1] == last[1];
}

static double heading(const double *from, const double *to)
{
    return atan2(to[1] - from[1], to[0] - from[0]);
}

/* By how much the polyline turns to the left from its first segment to its last: > 0 round a closed one that runs
 * counter-clockwise. */
static double turning(const dem_obstacle *obstacle)
{
    const double pi = acos(-1.0);
    double sum = 0.0;
    for (dem_index k = 2; k < obstacle->n_points; k++) {
        const double *p = obstacle->points + 2 * k;
        sum += remainder(heading(p - 2, p) - heading(p - 4, p - 2), 2.0 * pi);
    }
    return sum;
}

static void put(obstacle_fill *out, double x, double y)
{
    out->xy[2 * out->n] = x;
    out->xy[2 * out->n + 1] = y;
    out->n++;
}

/* Rays to the right of both ends bound the solid, and far away an arc from one to the other, clockwise. Ends that face
 * each other, as of a roof, have rays that would cross: both go to the right of the line between the ends. What turns
 * back on itself is closed by that line. */
static void put_behind(const dem_obstacle *obstacle, double far, obstacle_fill *out)
{
    const double right = -0.5 * acos(-1.0), turned = turning(obstacle);
    const double *first = obstacle->points, *last = first + 2 * (obstacle->n_points - 1);
    if (turned <= 2.0 * right * (1.0 + 1e-9)) return;
    const double sweep = turned > 0.0 ? turned : 0.0;
    const double begin = (turned > 0.0 ? heading(last - 2, last) : heading(first, last)) + right;
    put(out, last[0] + far * cos(begin), last[1] + far * sin(begin));
    for (int k = 0; k <= ARC; k++) {
        const double angle = begin - sweep * k / ARC;
        put(out, first[0] + far * cos(angle), first[1] + far * sin(angle));
    }
}

/* A container, whose solid is all around it: from its beginning to a far square, round that clockwise and back. */
static void put_around(const dem_obstacle *obstacle, double far, obstacle_fill *out)
{
    static const double corners[][2] = {{-1, -1}, {-1, 1}, {1, 1}, {1, -1}, {-1, -1}};
    const double x = obstacle->points[0], y = obstacle->points[1];
    for (int k = 0; k < 5; k++) put(out, x + far * corners[k][0], y + far * corners[k][1]);
    put(out, x, y);
}

/* With everything seen and every point of the obstacle well inside. */
static double far_from(const dem_obstacle *obstacle, box view)
{
    const box all = box_join(view, box_around(obstacle->n_points, obstacle->points));
    return 4.0 * (box_width(all) + box_height(all));
}

bool obstacle_fill_outline(const dem_obstacle *obstacle, box view, obstacle_fill *out)
{
    const size_t n = (size_t)obstacle->n_points;
    *out = (obstacle_fill){0, malloc((n + ARC + 2) * 2 * sizeof *out->xy)};
    if (out->xy == NULL) return false;
    memcpy(out->xy, obstacle->points, n * 2 * sizeof *out->xy);
    out->n = n;
    const double far = far_from(obstacle, view);
    if (!is_closed(obstacle))
        put_behind(obstacle, far, out);
    else if (turning(obstacle) > 0.0)
        put_around(obstacle, far, out);
    return true;
}

bool obstacle_fill_at(const dem_obstacle *obstacle, double t, box view, obstacle_fill *out)
{
    double *points = malloc(2 * (size_t)obstacle->n_points * sizeof *points);
    dem_obstacle moved = *obstacle;
    if (points == NULL) return false;
    *out = (obstacle_fill){0};
    moved.points = points;
    const bool known = dem_obstacle_points(obstacle, t, points) == DEM_OK;
    const bool good = !known || obstacle_fill_outline(&moved, view, out);
    free(points);
    return good;
}
