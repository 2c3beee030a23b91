/* SPDX-License-Identifier: BSD-3-Clause */
/* Edges of the boundary are found from the triangles, not from the flags of contact: nodes that are held may not touch,
 * and yet the peak of a plate with lines of symmetry is at one of them. Without memory for an array that ranks have the
 * log goes without what is asked for. */
#include "whole_nodes.h"

#include <math.h>
#include <stddef.h>

#include "lattice/lattice_source.h"

/* Items of n nodes or springs, which are left as they are without memory. */
static void pick(const dem_model *model, size_t member, const dem_index *list, dem_index n, void *out)
{
    const lattice_source from = dem_private_lattice_source(model);
    (void)dem_private_lattice_pick(&from, member, list, n, out);
}

static void visit(const dem_model *model, size_t member, rows_taker *take, void *context)
{
    const lattice_source from = dem_private_lattice_source(model);
    (void)dem_private_lattice_visit(&from, member, take, context);
}

dem_index whole_nodes_body(const dem_model *model, dem_index node)
{
    int32_t body = 0;
    pick(model, offsetof(dem_lattice, body), &node, 1, &body);
    return body;
}

void whole_nodes_place(double x[2], const dem_model *model, dem_index node)
{
    x[0] = x[1] = 0.0;
    pick(model, offsetof(dem_lattice, x), &node, 1, x);
}

whole_spring whole_nodes_spring(const dem_model *model, dem_index spring)
{
    dem_index ends[2] = {0, 0};
    double x[4] = {0.0, 0.0, 0.0, 0.0};
    whole_spring s = {{0.0, 0.0}, 0.0};
    pick(model, offsetof(dem_lattice, ends), &spring, 1, ends);
    pick(model, offsetof(dem_lattice, x), ends, 2, x);
    pick(model, offsetof(dem_lattice, stiffness), &spring, 1, &s.stiffness);
    for (int c = 0; c < 2; c++) s.middle[c] = 0.5 * (x[c] + x[2 + c]);
    return s;
}

/* The other ends of the sides at a node, one for each triangle that has the side. */
typedef struct sides {
    dem_index node;
    int n;
    dem_index ends[WHOLE_NODES_SIDES];
} sides;

static dem_status find_sides(void *context, dem_index first, dem_index n, const void *triangles)
{
    sides *s = context;
    const dem_index *corners = triangles;
    (void)first;
    for (dem_index k = 0; k < 3 * n; k++) {
        const dem_index *corner = corners + k / 3 * 3;
        if (corners[k] != s->node || s->n + 2 > WHOLE_NODES_SIDES) continue;
        s->ends[s->n++] = corner[(k + 1) % 3];
        s->ends[s->n++] = corner[(k + 2) % 3];
    }
    return DEM_OK;
}

int whole_nodes_rim(double ends[WHOLE_NODES_SIDES][2], const dem_model *model, dem_index node)
{
    sides s = {.node = node};
    int found = 0;
    visit(model, offsetof(dem_lattice, triangles), find_sides, &s);
    for (int k = 0; k < s.n; k++) {
        int shared = 0;
        for (int q = 0; q < s.n; q++) shared += s.ends[q] == s.ends[k];
        if (shared == 1) whole_nodes_place(ends[found++], model, s.ends[k]);
    }
    return found;
}

/* Nodes of a body, which are one behind the other, and the farthest of them along a unit vector. */
typedef struct ahead {
    int32_t body;
    dem_index first, end;
    double from[2];
    const double *along;
    double most; /* m, from there */
} ahead;

static dem_status find_nodes(void *context, dem_index first, dem_index n, const void *bodies)
{
    ahead *a = context;
    const int32_t *body = bodies;
    for (dem_index i = 0; i < n; i++) {
        if (body[i] != a->body) continue;
        if (a->end == 0) a->first = first + i;
        a->end = first + i + 1;
    }
    return DEM_OK;
}

static dem_status find_farthest(void *context, dem_index first, dem_index n, const void *places)
{
    ahead *a = context;
    const double *x = places;
    for (dem_index i = 0; i < n; i++)
        if (first + i >= a->first && first + i < a->end)
            a->most = fmax(a->most, (x[2 * i] - a->from[0]) * a->along[0] + (x[2 * i + 1] - a->from[1]) * a->along[1]);
    return DEM_OK;
}

bool whole_nodes_any_ahead(const dem_model *model, dem_index node, const double along[2], double slack)
{
    ahead a = {.body = (int32_t)whole_nodes_body(model, node), .along = along, .most = -(double)INFINITY};
    whole_nodes_place(a.from, model, node);
    visit(model, offsetof(dem_lattice, body), find_nodes, &a);
    visit(model, offsetof(dem_lattice, x), find_farthest, &a);
    return a.most > slack;
}
