/* SPDX-License-Identifier: BSD-3-Clause */
/* The way back is found by steps that the gap allows: it changes no faster than the body moves, so nothing is jumped
 * over. The way on is exact: each node runs along a straight line into the segments, thickened by the clearance, and
 * each point of an obstacle, as the body sees it, into the sides between nodes. */
#include "clearance.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ask.h"

/* ---- points of obstacles and sides of the body ---- */

static const double no_box[4] = {INFINITY, INFINITY, -INFINITY, -INFINITY};

static void include(double box[4], const double x[2])
{
    for (int c = 0; c < 2; c++) {
        box[c] = fmin(box[c], x[c]);
        box[c + 2] = fmax(box[c + 2], x[c]);
    }
}

typedef struct candidate {
    clearance_spike spike;
    bool inside;
} candidate;

typedef struct side {
    dem_index ends[2]; /* ascending */
} side;

/* Obstacles of a model, or those of a deck, from which no model can be made. */
typedef struct ground {
    const dem_model *model;   /* NULL: */
    const dem_obstacle *list; /* [n] */
    dem_index n;
} ground;

static const dem_obstacle *obstacle_of(const ground *g, dem_index k)
{
    return g->model != NULL ? dem_model_obstacle(g->model, k) : &g->list[k];
}

/* Sides of a body: those of one triangle only. */
typedef struct rim {
    const dem_lattice *lattice;
    bool is_strip;
    side *sides;
    size_t n;
    double box[4]; /* around all nodes: lowest, highest x and y */
} rim;

static int by_x(const void *a, const void *b)
{
    const clearance_spike *p = &((const candidate *)a)->spike, *q = &((const candidate *)b)->spike;
    if (p->x[0] < q->x[0] || p->x[0] > q->x[0]) return p->x[0] < q->x[0] ? -1 : 1;
    if (p->obstacle != q->obstacle) return p->obstacle < q->obstacle ? -1 : 1;
    return p->point < q->point ? -1 : 1;
}

static int by_ends(const void *a, const void *b)
{
    const side *p = a, *q = b;
    if (p->ends[0] != q->ends[0]) return p->ends[0] < q->ends[0] ? -1 : 1;
    return (p->ends[1] > q->ends[1]) - (p->ends[1] < q->ends[1]);
}

/* Side k of all triangles. */
static side side_of(const dem_lattice *lattice, size_t k)
{
    const dem_index a = lattice->triangles[k], b = lattice->triangles[k % 3 == 2 ? k - 2 : k + 1];
    return a < b ? (side){{a, b}} : (side){{b, a}};
}

static const double *start_of(const dem_lattice *lattice, dem_index i)
{
    return (lattice->position != NULL ? lattice->position : lattice->x) + 2 * i;
}

static bool can_move(const dem_lattice *lattice, const dem_index corners[3])
{
    for (int c = 0; c < 3; c++)
        if (lattice->flags == NULL || (lattice->flags[corners[c]] & DEM_NODE_FIXED) == 0) return true;
    return false;
}

/* Twice the area of a, b, x. */
static double turn(const double a[2], const double b[2], const double x[2])
{
    return (b[0] - a[0]) * (x[1] - a[1]) - (b[1] - a[1]) * (x[0] - a[0]);
}

/* Marks the points, sorted, that are in a triangle or on its rim. */
static void mark(candidate *list, size_t n, const double a[2], const double b[2], const double c[2])
{
    const double left = fmin(a[0], fmin(b[0], c[0])), right = fmax(a[0], fmax(b[0], c[0]));
    size_t low = 0, high = n;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (list[middle].spike.x[0] < left)
            low = middle + 1;
        else
            high = middle;
    }
    for (; low < n && list[low].spike.x[0] <= right; low++) {
        const double *x = list[low].spike.x, p = turn(a, b, x), q = turn(b, c, x), r = turn(c, a, x);
        if ((p >= 0.0 && q >= 0.0 && r >= 0.0) || (p <= 0.0 && q <= 0.0 && r <= 0.0)) list[low].inside = true;
    }
}

static double distance_to(const double x[2], const double a[2], const double b[2])
{
    const double e[2] = {b[0] - a[0], b[1] - a[1]}, r[2] = {x[0] - a[0], x[1] - a[1]};
    const double square = e[0] * e[0] + e[1] * e[1], along = r[0] * e[0] + r[1] * e[1];
    const double place = square > 0.0 ? fmin(fmax(along / square, 0.0), 1.0) : 0.0;
    return hypot(r[0] - place * e[0], r[1] - place * e[1]);
}

/* Sides of all triangles in the order of their ends, some twice: those of each lower end have a place of their own in
 * the list, where they come one by one. NULL when memory runs out. */
static side *list_sides(const dem_lattice *lattice, size_t n)
{
    size_t *next = calloc((size_t)lattice->n_nodes + 1, sizeof *next);
    side *list = next != NULL ? calloc(n + 1, sizeof *list) : NULL;
    for (size_t k = 0; list != NULL && k < n; k++) next[side_of(lattice, k).ends[0] + 1]++;
    for (dem_index i = 0; list != NULL && i < lattice->n_nodes; i++) next[i + 1] += next[i];
    for (size_t k = 0; list != NULL && k < n; k++) {
        const side own = side_of(lattice, k);
        side *at = &list[next[own.ends[0]]++];
        for (; at > list && by_ends(at - 1, &own) > 0; at--) *at = *(at - 1);
        *at = own;
    }
    free(next);
    return list;
}

/* Where a strip ends inside of the body it has sides that are none of the body. */
static bool is_side(const rim *r, const side *at)
{
    const uint8_t *flags = r->lattice->flags;
    return !r->is_strip || (flags[at->ends[0]] & flags[at->ends[1]] & DEM_NODE_CONTACT) != 0;
}

/* Returns false when memory runs out. */
static bool find_rim(rim *out, const dem_lattice *lattice, bool is_strip)
{
    const size_t most = 3 * (size_t)lattice->n_triangles;
    side *list = list_sides(lattice, most);
    *out = (rim){.lattice = lattice, .is_strip = is_strip, .sides = list};
    if (list == NULL) return false;
    memcpy(out->box, no_box, sizeof no_box);
    for (dem_index i = 0; i < lattice->n_nodes; i++) include(out->box, start_of(lattice, i));
    for (size_t k = 0, next; k < most; k = next) {
        for (next = k + 1; next < most && by_ends(&list[k], &list[next]) == 0;) next++;
        if (next == k + 1 && is_side(out, &list[k])) list[out->n++] = list[k];
    }
    return true;
}

static double distance_to_rim(const rim *r, const double x[2])
{
    double least = (double)INFINITY;
    for (size_t k = 0; k < r->n; k++)
        least = fmin(least, distance_to(x, start_of(r->lattice, r->sides[k].ends[0]),
                                        start_of(r->lattice, r->sides[k].ends[1])));
    return least;
}

/* The obstacles' points as a body sees them that is moved by `shift`, sorted; NULL when memory runs out. */
static candidate *list_points(const ground *g, const double shift[2], size_t *n)
{
    *n = 0;
    for (dem_index k = 0; k < g->n; k++) *n += (size_t)obstacle_of(g, k)->n_points;
    candidate *list = calloc(*n + 1, sizeof *list), *at = list;
    for (dem_index k = 0; list != NULL && k < g->n; k++)
        for (dem_index i = 0; i < obstacle_of(g, k)->n_points; i++, at++) {
            const double *x = obstacle_of(g, k)->points + 2 * i;
            at->spike = (clearance_spike){.obstacle = k, .point = i, .x = {x[0] - shift[0], x[1] - shift[1]}};
        }
    if (list != NULL) qsort(list, *n, sizeof *list, by_x);
    return list;
}

/* Whether a ray from x to the right crosses a side. */
static bool crosses(const double x[2], const double a[2], const double b[2])
{
    if ((a[1] > x[1]) == (b[1] > x[1])) return false;
    return (turn(a, b, x) > 0.0) == (b[1] > a[1]);
}

/* What is inside of all sides is in some triangle, whether it is here or not. */
static void mark_enclosed(candidate *points, size_t n, const rim *r)
{
    for (size_t p = 0; p < n; p++)
        for (size_t k = 0; k < r->n; k++)
            if (crosses(points[p].spike.x, start_of(r->lattice, r->sides[k].ends[0]),
                        start_of(r->lattice, r->sides[k].ends[1])))
                points[p].inside = !points[p].inside;
}

static void mark_all(candidate *points, size_t n, const dem_lattice *lattice)
{
    for (dem_index k = 0; k < lattice->n_triangles; k++) {
        const dem_index *corners = lattice->triangles + 3 * k;
        if (can_move(lattice, corners))
            mark(points, n, start_of(lattice, corners[0]), start_of(lattice, corners[1]),
                 start_of(lattice, corners[2]));
    }
}

static bool is_near(const double box[4], const double x[2], double reach)
{
    return x[0] >= box[0] - reach && x[0] <= box[2] + reach && x[1] >= box[1] - reach && x[1] <= box[3] + reach;
}

/* The point deepest in the body moved by `shift`, or nearest to it: of negative depth, no less than -reach, where none
 * is inside. deepest->x is where the unmoved body sees it. Returns false when memory runs out. */
static bool find_deepest(clearance_spike *deepest, const rim *r, const ground *g, const double shift[2], double reach)
{
    size_t n;
    candidate *points = list_points(g, shift, &n);
    *deepest = (clearance_spike){.depth = -reach};
    if (points == NULL) return false;
    if (r->is_strip)
        mark_enclosed(points, n, r);
    else
        mark_all(points, n, r->lattice);
    for (size_t k = 0; k < n; k++) {
        const double *x = points[k].spike.x;
        if (!points[k].inside && !is_near(r->box, x, reach)) continue;
        const double distance = distance_to_rim(r, x), depth = points[k].inside ? distance : -distance;
        if (depth <= deepest->depth) continue;
        *deepest = points[k].spike;
        deepest->depth = depth;
    }
    free(points);
    return true;
}

bool clearance_find_spike(clearance_spike *deepest, const clearance_body *body, const dem_obstacle *list,
                          dem_index n_obstacles)
{
    const ground g = {NULL, list, n_obstacles};
    rim r;
    const bool good =
        find_rim(&r, body->lattice, body->is_strip) && find_deepest(deepest, &r, &g, (const double[2]){0.0, 0.0}, 0.0);
    free(r.sides);
    return good;
}

/* ---- obstacles through sides ---- */

static bool may_touch(const dem_model *model, dem_index i)
{
    return (dem_model_lattice(model)->flags[i] & DEM_NODE_CONTACT) != 0;
}

static bool both_may_touch(const dem_model *model, const side *at)
{
    const uint8_t *flags = dem_model_lattice(model)->flags;
    return may_touch(model, at->ends[0]) && may_touch(model, at->ends[1]) &&
           ((flags[at->ends[0]] | flags[at->ends[1]]) & DEM_NODE_FIXED) == 0;
}

static bool parts(const double a[2], const double b[2], const double p[2], const double q[2])
{
    const double left = turn(a, b, p), right = turn(a, b, q);
    return (left > 0.0 && right < 0.0) || (left < 0.0 && right > 0.0);
}

/* How far ab and pq, which cross, must move to come apart: until an end of one is on the other. 0 if they do not. */
static double crossing_depth(const double a[2], const double b[2], const double p[2], const double q[2])
{
    if (!parts(a, b, p, q) || !parts(p, q, a, b)) return 0.0;
    return fmin(fmin(distance_to(a, p, q), distance_to(b, p, q)), fmin(distance_to(p, a, b), distance_to(q, a, b)));
}

/* Whether the segment from p to q meets the box. */
static bool meets(const double box[4], const double p[2], const double q[2])
{
    return fmax(p[0], q[0]) >= box[0] && fmin(p[0], q[0]) <= box[2] && fmax(p[1], q[1]) >= box[1] &&
           fmin(p[1], q[1]) <= box[3];
}

/* Of all sides against the segment from p to q. */
static void pierce(clearance_pierced *deepest, const dem_model *model, const rim *r, const double p[2],
                   const double q[2])
{
    for (size_t k = 0; k < r->n; k++) {
        const double *a = start_of(r->lattice, r->sides[k].ends[0]), *b = start_of(r->lattice, r->sides[k].ends[1]);
        const double depth = both_may_touch(model, &r->sides[k]) ? crossing_depth(a, b, p, q) : 0.0;
        if (depth <= deepest->depth) continue;
        *deepest = (clearance_pierced){.x = {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])}, .depth = depth};
    }
}

/* Of the body moved by `shift`; deepest->x is on the unmoved one. */
static clearance_pierced find_pierced(const dem_model *model, const rim *r, const ground *g, const double shift[2])
{
    clearance_pierced deepest = {.depth = 0.0};
    for (dem_index o = 0; o < g->n; o++)
        for (dem_index k = 0; k + 1 < obstacle_of(g, o)->n_points; k++) {
            const double *at = obstacle_of(g, o)->points + 2 * k, before = deepest.depth;
            const double p[2] = {at[0] - shift[0], at[1] - shift[1]}, q[2] = {at[2] - shift[0], at[3] - shift[1]};
            if (meets(r->box, p, q)) pierce(&deepest, model, r, p, q);
            if (deepest.depth > before) deepest.obstacle = o, deepest.point = k;
        }
    return deepest;
}

bool clearance_find_pierced(clearance_pierced *deepest, const clearance_body *body)
{
    const ground g = {.model = body->model, .n = ask_sizes(body->model).n_obstacles};
    rim r;
    const bool good = find_rim(&r, body->lattice, body->is_strip);
    if (good) *deepest = find_pierced(body->model, &r, &g, (const double[2]){0.0, 0.0});
    free(r.sides);
    return good;
}

/* ---- the way back ---- */

typedef struct path {
    const dem_model *model;
    double direction[2]; /* unit */
    double clearance;
    rim rim;
    ground ground;
} path;

static double least_gap(const path *p, double s)
{
    const dem_lattice *lattice = dem_model_lattice(p->model);
    double least = (double)INFINITY;
    for (dem_index i = 0; i < lattice->n_nodes; i++) {
        const double *x = lattice->position + 2 * i;
        const double moved[2] = {x[0] + s * p->direction[0], x[1] + s * p->direction[1]};
        if (may_touch(p->model, i)) least = fmin(least, dem_model_gap(p->model, moved));
    }
    return least;
}

/* Diagonal of the box around nodes and obstacles. */
static double extent(const path *p)
{
    double box[4];
    memcpy(box, p->rim.box, sizeof box);
    for (dem_index k = 0; k < p->ground.n; k++)
        for (dem_index i = 0; i < obstacle_of(&p->ground, k)->n_points; i++)
            include(box, obstacle_of(&p->ground, k)->points + 2 * i);
    return hypot(box[2] - box[0], box[3] - box[1]);
}

/* Of nodes, points and sides, less than all of it only below the clearance. Returns false when memory runs out. */
static bool find_gap(double *gap, const path *p, double s)
{
    const double shift[2] = {s * p->direction[0], s * p->direction[1]};
    clearance_spike nearest;
    if (!find_deepest(&nearest, &p->rim, &p->ground, shift, p->clearance)) return false;
    *gap = least_gap(p, s);
    if (nearest.depth > -p->clearance) *gap = fmin(*gap, -nearest.depth);
    const clearance_pierced pierced = find_pierced(p->model, &p->rim, &p->ground, shift);
    if (pierced.depth > 0.0) *gap = fmin(*gap, -pierced.depth);
    return true;
}

/* The first s <= 0 that is free, a little beyond its bound; *found: there is one. False when memory runs out. */
static bool retreat(double *s, bool *found, const path *p)
{
    const double diagonal = extent(p), least_step = 1e-5 * diagonal, end = -2.0 * diagonal - 2.0 * p->clearance;
    double gap;
    bool good = find_gap(&gap, p, 0.0);
    for (*s = 0.0; good && gap<p->clearance && * s> end; good = find_gap(&gap, p, *s))
        *s -= p->clearance - gap + least_step;
    *found = good && gap >= p->clearance && isfinite(gap);
    return good;
}

/* ---- the way on ---- */

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
    const double slack = 1e-12 * length; /* neither a vertex nor a node already at distance c is missed by rounding */
    const double toward = height > 0.0 ? -fall : fall, speed = fabs(height) <= slack ? fabs(fall) : toward;
    const double way = (fabs(height) - c) / speed;
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
static double advance_nodes(const path *p, double s)
{
    const dem_lattice *lattice = dem_model_lattice(p->model);
    double way = (double)INFINITY;
    for (dem_index i = 0; i < lattice->n_nodes; i++) {
        const double *x = lattice->position + 2 * i;
        const double moved[2] = {x[0] + s * p->direction[0], x[1] + s * p->direction[1]};
        for (dem_index k = 0; may_touch(p->model, i) && k < p->ground.n; k++)
            way = fmin(way, way_to_obstacle(p, moved, obstacle_of(&p->ground, k)));
    }
    return way;
}

/* The same until the first side is, of a point that comes towards the body. */
static double advance_sides(const path *p, double s)
{
    const dem_lattice *lattice = dem_model_lattice(p->model);
    const double back[2] = {-p->direction[0], -p->direction[1]};
    double way = (double)INFINITY;
    for (size_t k = 0; k < p->rim.n; k++) {
        const dem_index i = p->rim.sides[k].ends[0], j = p->rim.sides[k].ends[1];
        const double *a = lattice->position + 2 * i, *b = lattice->position + 2 * j;
        if (!may_touch(p->model, i) || !may_touch(p->model, j)) continue;
        for (dem_index o = 0; o < p->ground.n; o++)
            for (dem_index q = 0; q < obstacle_of(&p->ground, o)->n_points; q++) {
                const double *x = obstacle_of(&p->ground, o)->points + 2 * q;
                const double seen[2] = {x[0] - s * p->direction[0], x[1] - s * p->direction[1]};
                way = fmin(way, way_to_sides(seen, back, a, b, p->clearance));
            }
    }
    return way;
}

bool clearance_shift(double shift[2], bool *reached, const clearance_body *body, const double gravity[2],
                     double clearance)
{
    const dem_model *model = body->model;
    const double g = hypot(gravity[0], gravity[1]);
    path p = {.model = model, .direction = {gravity[0] / g, gravity[1] / g}, .clearance = clearance};
    double s = 0.0;
    p.ground = (ground){.model = model, .n = ask_sizes(model).n_obstacles};
    const bool good = find_rim(&p.rim, dem_model_lattice(model), body->is_strip) && retreat(&s, reached, &p);
    if (good && *reached) {
        const double way = fmin(advance_nodes(&p, s), advance_sides(&p, s));
        for (int c = 0; c < 2; c++) shift[c] = (s + way) * p.direction[c];
        *reached = isfinite(way);
    }
    free(p.rim.sides);
    return good;
}
