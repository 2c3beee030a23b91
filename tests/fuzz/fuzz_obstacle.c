/* SPDX-License-Identifier: BSD-3-Clause */
/* Obstacles of any points. What compiles has a distance everywhere: finite, with a unit normal, as a search through all
 * segments finds it, and of the sign of the side. */
#include "obstacle/obstacle_set.h"
#include "obstacle/point_gap.h"
#include "obstacle/vertex_gap.h"

#include "bytes.h"
#include "polygon.h"

enum { MOST_OBSTACLES = 3, MOST_POINTS = 12, QUERIES = 16 };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* On a coarse grid, where points meet and lines are straight; anywhere; rarely no number of this world. */
static double coordinate(bytes *from, unsigned kind)
{
    if (kind < 8) return (double)bytes_below(from, 9) - 4.0;
    return kind < 15 ? bytes_between(from, -4.0, 4.0) : bytes_real(from);
}

static dem_obstacle make(bytes *from, double *points)
{
    const unsigned shape = bytes_take(from);
    dem_obstacle o = {.struct_size = sizeof(dem_obstacle),
                      .n_points = 2 + shape % (MOST_POINTS - 1),
                      .points = points,
                      .restitution = 0.5,
                      .friction = 0.3};
    for (dem_index k = 0; k < 2 * o.n_points; k++) points[k] = coordinate(from, shape >> 4);
    if (shape % 2 == 0) memcpy(points + 2 * o.n_points - 2, points, 2 * sizeof *points);
    return o;
}

/* ---- by brute force ---- */

static double along(const segment *s, vec2 x)
{
    return (x.x - s->start.x) * s->tangent.x + (x.y - s->start.y) * s->tangent.y;
}

static double across(const segment *s, vec2 x)
{
    return (x.x - s->start.x) * s->normal.x + (x.y - s->start.y) * s->normal.y;
}

/* What of a free end is in another obstacle counts as on it. */
static double distance_to(const segment *s, vec2 x)
{
    const double place = along(s, x);
    if (place >= -s->buried[0] && place <= s->length + s->buried[1]) return fabs(across(s, x));
    const vec2 end = place < 0.0 ? s->start : s->end;
    return hypot(x.x - end.x, x.y - end.y);
}

static double distance_all(const obstacle_set *o, vec2 x, dem_index obstacle)
{
    double nearest = INFINITY;
    for (dem_index k = o->first[obstacle]; k < o->first[obstacle + 1]; k++)
        nearest = fmin(nearest, distance_to(&o->segments[k], x));
    return nearest;
}

static int count_touching(const obstacle_set *o, vec2 x, double tolerance)
{
    int n = 0;
    for (dem_index k = 0; k < o->n_segments; k++) {
        const segment *s = &o->segments[k];
        const double place = along(s, x);
        n += fabs(across(s, x)) <= tolerance && place >= -tolerance - s->buried[0] &&
             place <= s->length + tolerance + s->buried[1];
    }
    return n;
}

/* ---- what must hold ---- */

static void check_side(const dem_obstacle *obstacle, vec2 x, double distance)
{
    const double *points = obstacle->points, *last = points + 2 * obstacle->n_points - 2;
    const double place[2] = {x.x, x.y};
    if (points[0] != last[0] || points[1] != last[1] || fabs(distance) < 1e-9) return;
    const bool left = polygon_is_left(points, obstacle->n_points),
               inside = polygon_has(points, obstacle->n_points, place);
    require((distance > 0.0) == (inside == left));
}

static void check_gap(const obstacle_set *o, vec2 x, dem_index obstacle)
{
    const obstacle_gap gap = obstacles_gap_of(o, 0.0, x, 0.0, obstacle);
    const double size = 1.0 + fabs(x.x) + fabs(x.y);
    require(isfinite(gap.distance) && gap.segment >= o->first[obstacle] && gap.segment < o->first[obstacle + 1]);
    require(fabs(hypot(gap.normal.x, gap.normal.y) - 1.0) < 1e-12);
    require(fabs(fabs(gap.distance) - distance_all(o, x, obstacle)) <= 1e-12 * size);
    if (o->n > 1) return; /* else the end may be buried, and the nearest point is not on it */
    const vec2 foot = {x.x - gap.distance * gap.normal.x, x.y - gap.distance * gap.normal.y};
    require(distance_all(o, foot, obstacle) <= 1e-10 * size);
    check_side(&o->list[obstacle], x, gap.distance);
}

static void check_vertices(const obstacle_set *o, bytes *from)
{
    const vec2 a = {coordinate(from, 0), coordinate(from, 8)}, b = {coordinate(from, 8), coordinate(from, 0)};
    const obstacle_edge edge = {.a = a,
                                .b = b,
                                .previous = a,
                                .next = b,
                                .tolerance = 1e-6,
                                .depth = 0.5,
                                .reach = 2.0,
                                .except = {-1, -1},
                                .without = {-1, -1}};
    const double ends[4] = {a.x, a.y, b.x, b.y};
    if (a.x == b.x && a.y == b.y) return;
    const obstacle_vertex_gap gap = obstacles_vertex_gap(o, 0.0, &edge);
    require(gap.vertex >= -1 && gap.vertex < o->n_vertices && gap.place >= 0.0 && gap.place <= 1.0);
    require(gap.vertex < 0 || (gap.distance > -edge.depth && gap.distance < edge.reach));
    double nearest = edge.reach;
    for (dem_index k = 0; k < o->n_vertices; k++) {
        const double at[2] = {o->vertices[k].at.x, o->vertices[k].at.y};
        nearest = fmin(nearest, polygon_to_side(at, ends, ends + 2));
    }
    require(fabs(obstacles_clearance(o, 0.0, &edge) - nearest) <= 1e-12);
}

static void query(const obstacle_set *o, bytes *from, bool tame)
{
    dem_index hits[64];
    for (int q = 0; q < QUERIES && from->left > 0; q++) {
        const unsigned kind = bytes_below(from, tame ? 15 : 16);
        const vec2 x = {coordinate(from, kind), coordinate(from, kind)};
        const obstacle_touch point = {.tolerance = 1e-6 * (double)bytes_take(from), .without = -1};
        const int n = obstacles_touching(o, 0.0, x, &point, hits, 64);
        if (!tame) continue; /* of points at 1e300 only that they do no harm */
        for (dem_index k = 0; k < o->n; k++) check_gap(o, x, k);
        require(obstacles_gap(o, 0.0, x, 0.0, -1, -1).segment >= 0);
        require(n >= count_touching(o, x, point.tolerance * (1.0 - 1e-9) - 1e-12));
        require(n <= count_touching(o, x, point.tolerance * (1.0 + 1e-9) + 1e-12));
        check_vertices(o, from);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    bytes from = {data, size};
    double points[MOST_OBSTACLES][2 * MOST_POINTS + 2];
    dem_obstacle list[MOST_OBSTACLES];
    obstacle_set o;
    bool tame = true;
    const unsigned n = 1 + bytes_below(&from, MOST_OBSTACLES);
    for (unsigned k = 0; k < n; k++) {
        list[k] = make(&from, points[k]);
        for (dem_index c = 0; c < 2 * list[k].n_points; c++) tame = tame && fabs(points[k][c]) <= 4.0;
    }
    const dem_status status = obstacles_compile(&o, list, n);
    require(status == DEM_OK || status == DEM_ERROR_MODEL);
    if (status != DEM_OK) return 0;
    query(&o, &from, tame);
    obstacles_free(&o);
    return 0;
}
