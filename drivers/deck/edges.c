/* SPDX-License-Identifier: BSD-3-Clause */
#include "edges.h"

#include <math.h>

#include "angle.h"
#include "body_outline.h"
#include "ask.h"
#include "copies.h"
#include "whole_nodes.h"

static const double blur = 1e-6; /* of the spacing: turned coordinates are rounded */

/* A node, where it is at rest, and its body. */
typedef struct place {
    const dem_model *model;
    const schema_instance *body;
    dem_index node;
    double x[2]; /* m */
} place;

/* ---- sides of the outline ---- */

/* How much farther out than the place y lies, m. */
static double ahead(const place *p, const double y[2], const double outwards[2])
{
    return (y[0] - p->x[0]) * outwards[0] + (y[1] - p->x[1]) * outwards[1];
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
static bool is_straight(const place *p, const double end[2])
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
        if (fabs(ahead(p, end, outwards)) > slack) continue;
        if (!whole_nodes_any_ahead(p->model, p->node, outwards, slack)) return true;
    }
    return false;
}

/* ---- edges of the lattice ---- */

static bool has_stepped_edge(const place *p)
{
    double ends[WHOLE_NODES_SIDES][2];
    const int n = whole_nodes_rim(ends, p->model, p->node);
    for (int k = 0; k < n; k++)
        if (!is_straight(p, ends[k])) return true;
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

bool edges_stepped(const schema_deck *groups, const dem_model *model, dem_index node)
{
    if ((dem_index)copies_total(groups) != ask_sizes(model).n_bodies) return false;
    const size_t group = copies_find(groups, (size_t)whole_nodes_body(model, node)).group;
    place p = {.model = model, .body = schema_get(groups, "body", group), .node = node};
    if (schema_is(p.body, "shape", "mesh") || schema_is(p.body, "shape", "file")) return false;
    if (is_smooth(groups, p.body)) return false;
    whole_nodes_place(p.x, model, node);
    return has_stepped_edge(&p);
}
