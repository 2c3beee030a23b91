/* SPDX-License-Identifier: BSD-3-Clause */
/* The boundary is found from the triangles, not from the flags of contact: nodes that are held may not touch, and yet
 * the peak of a plate with lines of symmetry is at one of them. */
#include "edges.h"

#include <math.h>
#include <stdlib.h>

#include "angle.h"
#include "body_outline.h"
#include "copies.h"

static const double blur = 1e-6; /* of the spacing: turned coordinates are rounded */

enum { most_ends = 32 }; /* a node of a lattice of triangles has 6 of them, one of squares at most 8 */

/* A node and its body. */
typedef struct place {
    const dem_lattice *lattice;
    const schema_instance *body;
    dem_index node;
} place;

static dem_index body_of(const dem_lattice *l, dem_index node)
{
    return l->body != NULL ? l->body[node] : 0;
}

/* ---- sides of the outline ---- */

/* How much farther out than the place a node lies, m. */
static double ahead(const place *p, dem_index node, const double outwards[2])
{
    const double *x = p->lattice->x + 2 * p->node, *y = p->lattice->x + 2 * node;
    return (y[0] - x[0]) * outwards[0] + (y[1] - x[1]) * outwards[1];
}

static bool is_outermost(const place *p, const double outwards[2], double slack)
{
    const dem_lattice *l = p->lattice;
    for (dem_index i = 0; i < l->n_nodes; i++)
        if (body_of(l, i) == body_of(l, p->node) && ahead(p, i, outwards) > slack) return false;
    return true;
}

typedef struct side {
    double a[2], b[2]; /* m */
} side;

/* From corner k of n to the next. What is no figure has been refused. */
static side side_at(const dem_outline *o, dem_index k, dem_index n)
{
    side s = {{0.0, 0.0}, {0.0, 0.0}};
    (void)dem_outline_corner(o, k, s.a);
    (void)dem_outline_corner(o, (k + 1) % n, s.b);
    return s;
}

/* Twice, m^2; > 0 where the sides run counter-clockwise. */
static double area_of_sides(const dem_outline *o, dem_index n)
{
    double sum = 0.0;
    for (dem_index k = 0; k < n; k++) {
        const side s = side_at(o, k, n);
        sum += s.a[0] * s.b[1] - s.a[1] * s.b[0];
    }
    return sum;
}

/* Whether an edge from the place runs along a straight side of the outline, and no node of its body lies farther out.
 * Discs, rings and images have no such side. */
static bool is_straight(const place *p, dem_index end)
{
    if (!schema_is(p->body, "shape", "polygon") && !schema_is(p->body, "shape", "rectangle")) return false;
    const double angle = angle_degree * schema_real(p->body, "angle"), slack = blur * schema_real(p->body, "spacing");
    const dem_outline o = body_outline(p->body);
    const dem_index n = dem_outline_corners(&o);
    const double c = cos(angle), s = sin(angle), sense = area_of_sides(&o, n) > 0.0 ? 1.0 : -1.0;
    for (dem_index k = 0; k < n; k++) {
        const side e = side_at(&o, k, n);
        const double x = e.b[0] - e.a[0], y = e.b[1] - e.a[1], length = sense * hypot(x, y);
        const double normal[2] = {y / length, -x / length};
        const double outwards[2] = {c * normal[0] - s * normal[1], s * normal[0] + c * normal[1]};
        if (fabs(ahead(p, end, outwards)) <= slack && is_outermost(p, outwards, slack)) return true;
    }
    return false;
}

/* ---- edges of the lattice ---- */

/* The other ends of the sides at the place, one for each triangle that has the side. \return their number */
static int find_ends(dem_index *ends, const place *p)
{
    const dem_lattice *l = p->lattice;
    int n = 0;
    for (dem_index t = 0; t < l->n_triangles; t++)
        for (int k = 0; k < 3; k++) {
            const dem_index *corner = l->triangles + 3 * t;
            if (corner[k] != p->node || n + 2 > most_ends) continue;
            ends[n++] = corner[(k + 1) % 3];
            ends[n++] = corner[(k + 2) % 3];
        }
    return n;
}

/* Sides that only one triangle has are the edges of the boundary. */
static bool has_stepped_edge(const place *p)
{
    dem_index ends[most_ends];
    const int n = find_ends(ends, p);
    for (int k = 0; k < n; k++) {
        int shared = 0;
        for (int q = 0; q < n; q++) shared += ends[q] == ends[k];
        if (shared == 1 && !is_straight(p, ends[k])) return true;
    }
    return false;
}

/* Only cracks leave steps in it. */
static bool is_smooth(const schema_deck *groups, const schema_instance *body)
{
    for (size_t k = 0; k < schema_count(groups, "crack"); k++) {
        const size_t number = (size_t)schema_real(schema_get(groups, "crack", k), "body");
        if (schema_get(groups, "body", number - 1) == body) return false;
    }
    return schema_is(body, "outline", "smooth");
}

bool edges_stepped(const schema_deck *groups, const dem_lattice *lattice, dem_index n_bodies, dem_index node)
{
    if ((dem_index)copies_total(groups) != n_bodies) return false;
    const size_t group = copies_find(groups, (size_t)body_of(lattice, node)).group;
    const place p = {lattice, schema_get(groups, "body", group), node};
    if (schema_is(p.body, "shape", "mesh") || schema_is(p.body, "shape", "file")) return false;
    if (is_smooth(groups, p.body)) return false;
    return has_stepped_edge(&p);
}
