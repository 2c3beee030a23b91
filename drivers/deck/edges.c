/* SPDX-License-Identifier: BSD-3-Clause */
#include "edges.h"

#include <math.h>

#include "body_geometry.h"

static const double degree = 3.14159265358979323846 / 180.0;
static const double blur = 1e-6; /* of the spacing: turned coordinates are rounded */

static dem_index body_of(const dem_lattice *l, dem_index node)
{
    return l->body != NULL ? l->body[node] : 0;
}

/* Whether no node of its body lies farther out along a direction. */
static bool is_outermost(const dem_lattice *l, dem_index node, const double direction[2], double slack)
{
    const double *x = l->x + 2 * node;
    for (dem_index i = 0; i < l->n_nodes; i++) {
        const double *y = l->x + 2 * i;
        if (body_of(l, i) != body_of(l, node)) continue;
        if ((y[0] - x[0]) * direction[0] + (y[1] - x[1]) * direction[1] > slack) return false;
    }
    return true;
}

/* Of a rectangle. */
static bool is_on_straight_side(const dem_lattice *l, dem_index node, const schema_instance *body)
{
    const double angle = degree * schema_real(body, "angle"), slack = blur * schema_real(body, "spacing");
    const double c = cos(angle), s = sin(angle), outwards[4][2] = {{-s, c}, {s, -c}, {c, s}, {-c, -s}};
    const int n_straight = body_geometry_has_squares(body) ? 4 : 2;
    for (int k = 0; k < n_straight; k++)
        if (is_outermost(l, node, outwards[k], slack)) return true;
    return false;
}

bool edges_stepped(const schema_deck *groups, const dem_lattice *lattice, dem_index n_bodies, dem_index node)
{
    if ((dem_index)schema_count(groups, "body") != n_bodies) return false;
    if (lattice->flags == NULL || (lattice->flags[node] & DEM_NODE_CONTACT) == 0) return false;
    const schema_instance *body = schema_get(groups, "body", (size_t)body_of(lattice, node));
    if (schema_is(body, "shape", "mesh") || schema_is(body, "shape", "file")) return false;
    if (!schema_is(body, "shape", "rectangle")) return true;
    return !is_on_straight_side(lattice, node, body);
}
