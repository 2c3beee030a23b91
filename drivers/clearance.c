/* SPDX-License-Identifier: BSD-3-Clause */
/* The way back is found by steps that the gap allows: it changes no faster than the body moves, so nothing is jumped
 * over. The way on is exact: each node runs along a straight line into the segments, thickened by the clearance. */
#include "clearance.h"

#include <math.h>

typedef struct path {
    const dem_model *model;
    double direction[2]; /* unit */
    double clearance;
} path;

static bool may_touch(const path *p, dem_index i)
{
    return (dem_model_lattice(p->model)->flags[i] & DEM_NODE_CONTACT) != 0;
}

static double least_gap(const path *p, double s)
{
    const dem_lattice *lattice = dem_model_lattice(p->model);
    double least = (double)INFINITY;
    for (dem_index i = 0; i < lattice->n_nodes; i++) {
        const double *x = lattice->position + 2 * i;
        const double moved[2] = {x[0] + s * p->direction[0], x[1] + s * p->direction[1]};
        if (may_touch(p, i)) least = fmin(least, dem_model_gap(p->model, moved));
    }
    return least;
}

static void include(double box[4], const double x[2])
{
    for (int c = 0; c < 2; c++) {
        box[c] = fmin(box[c], x[c]);
        box[c + 2] = fmax(box[c + 2], x[c]);
    }
}

/* Diagonal of the box around nodes and obstacles. */
static double extent(const path *p)
{
    const dem_lattice *lattice = dem_model_lattice(p->model);
    const double none = (double)INFINITY;
    double box[4] = {none, none, -none, -none};
    dem_index n_obstacles;
    const dem_obstacle *list = dem_model_obstacles(p->model, &n_obstacles);
    for (dem_index i = 0; i < lattice->n_nodes; i++) include(box, lattice->position + 2 * i);
    for (dem_index k = 0; k < n_obstacles; k++)
        for (dem_index i = 0; i < list[k].n_points; i++) include(box, list[k].points + 2 * i);
    return hypot(box[2] - box[0], box[3] - box[1]);
}

/* The first s <= 0 that is free, a little beyond its bound. */
static bool retreat(const path *p, double *s)
{
    const double diagonal = extent(p), least_step = 1e-5 * diagonal, end = -2.0 * diagonal - 2.0 * p->clearance;
    double gap = least_gap(p, 0.0);
    for (*s = 0.0; gap<p->clearance && * s> end; gap = least_gap(p, *s)) *s -= p->clearance - gap + least_step;
    return gap >= p->clearance && isfinite(gap);
}

/* Way of a point at r, seen from a point, until it is at distance c from it; infinity if it never is. */
static double way_to_point(const double r[2], const double d[2], double c)
{
    const double along = -(r[0] * d[0] + r[1] * d[1]), aside = r[0] * d[1] - r[1] * d[0];
    const double left = c * c - aside * aside;
    return left < 0.0 || along <= 0.0 ? (double)INFINITY : fmax(0.0, along - sqrt(left));
}

/* The same for the straight sides of the segment ab thickened by c. */
static double way_to_sides(const double x[2], const double d[2], const double a[2], const double b[2], double c)
{
    const double length = hypot(b[0] - a[0], b[1] - a[1]), e[2] = {(b[0] - a[0]) / length, (b[1] - a[1]) / length};
    const double r[2] = {x[0] - a[0], x[1] - a[1]};
    const double height = e[0] * r[1] - e[1] * r[0], fall = e[0] * d[1] - e[1] * d[0];
    const double speed = height > 0.0 ? -fall : fall, way = (fabs(height) - c) / speed;
    const double slack = 1e-12 * length; /* neither a vertex nor a node already at distance c is missed by rounding */
    if (speed <= 0.0 || way * speed < -slack) return (double)INFINITY;
    const double place = (r[0] + way * d[0]) * e[0] + (r[1] + way * d[1]) * e[1];
    return place >= -slack && place <= length + slack ? fmax(0.0, way) : (double)INFINITY;
}

static double way_to_obstacle(const path *p, const double x[2], const dem_obstacle *obstacle)
{
    double way = (double)INFINITY;
    for (dem_index k = 0; k < obstacle->n_points; k++) {
        const double *a = obstacle->points + 2 * k, r[2] = {x[0] - a[0], x[1] - a[1]};
        way = fmin(way, way_to_point(r, p->direction, p->clearance));
        if (k + 1 < obstacle->n_points) way = fmin(way, way_to_sides(x, p->direction, a, a + 2, p->clearance));
    }
    return way;
}

/* Way from the free place s until the first node is at the clearance. */
static double advance(const path *p, double s)
{
    const dem_lattice *lattice = dem_model_lattice(p->model);
    dem_index n_obstacles;
    const dem_obstacle *list = dem_model_obstacles(p->model, &n_obstacles);
    double way = (double)INFINITY;
    for (dem_index i = 0; i < lattice->n_nodes; i++) {
        const double *x = lattice->position + 2 * i;
        const double moved[2] = {x[0] + s * p->direction[0], x[1] + s * p->direction[1]};
        for (dem_index k = 0; may_touch(p, i) && k < n_obstacles; k++)
            way = fmin(way, way_to_obstacle(p, moved, list + k));
    }
    return way;
}

bool clearance_shift(double shift[2], const dem_model *model, const double gravity[2], double clearance)
{
    const double g = hypot(gravity[0], gravity[1]);
    const path p = {.model = model, .direction = {gravity[0] / g, gravity[1] / g}, .clearance = clearance};
    double s;
    if (!retreat(&p, &s)) return false;
    const double way = advance(&p, s);
    for (int c = 0; c < 2; c++) shift[c] = (s + way) * p.direction[c];
    return isfinite(way);
}
