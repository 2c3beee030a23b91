/* SPDX-License-Identifier: BSD-3-Clause */
/* Boundary nodes sorted by x; every triangle looks at those in its range. */
#include "overlap.h"

#include <math.h>
#include <stdlib.h>

#include "sides.h"
#include "status.h"
#include "triangles.h"

/* Of a triangle's area: a node that only touches an edge is not inside. */
static const double touching = 1e-9;

dem_status overlap_create(overlap *out, const dem_lattice *lattice)
{
    overlap o = {.found = {.node = -1, .triangle = -1}};
    *out = o;
    if (lattice->n_triangles == 0) return DEM_OK;
    unsigned char *flags = malloc((size_t)lattice->n_nodes);
    o.nodes = malloc((size_t)lattice->n_nodes * sizeof *o.nodes);
    dem_status status = flags != NULL && o.nodes != NULL ? sides_contact_flags(flags, lattice)
                                                         : status_fail(DEM_ERROR_MEMORY, "out of memory");
    for (dem_index i = 0; i < lattice->n_nodes && status == DEM_OK; i++)
        if (flags[i] & DEM_NODE_CONTACT) o.nodes[o.n++] = i;
    free(flags);
    if (status == DEM_OK)
        *out = o;
    else
        overlap_destroy(&o);
    return status;
}

void overlap_destroy(overlap *o)
{
    free(o->nodes);
    o->nodes = NULL;
}

/* By insertion: from look to look the order hardly changes. */
static void sort_nodes(overlap *o, const double *x)
{
    for (dem_index p = 1; p < o->n; p++) {
        const dem_index i = o->nodes[p];
        dem_index q = p;
        for (; q > 0 && x[2 * o->nodes[q - 1]] > x[2 * i]; q--) o->nodes[q] = o->nodes[q - 1];
        o->nodes[q] = i;
    }
}

/* The first of the sorted nodes that is not to the left of `left`. */
static dem_index seek(const overlap *o, const double *x, double left)
{
    dem_index low = 0, high = o->n;
    while (low < high) {
        const dem_index middle = low + (high - low) / 2;
        if (x[2 * o->nodes[middle]] < left)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static bool is_inside(const dem_index *corner, dem_index i, const double *x)
{
    const vec2 a = vec2_at(x, corner[0]), b = vec2_at(x, corner[1]), c = vec2_at(x, corner[2]), p = vec2_at(x, i);
    if (i == corner[0] || i == corner[1] || i == corner[2]) return false;
    const double least = touching * triangles_area(a, b, c);
    return least > 0.0 && triangles_area(a, b, p) > least && triangles_area(b, c, p) > least &&
           triangles_area(c, a, p) > least;
}

static void note(overlap *o, dem_index node, dem_index triangle, double t, const double *x)
{
    if (o->found.now++ > 0 || o->found.node >= 0) return;
    o->found.t = t;
    o->found.node = node;
    o->found.triangle = triangle;
    o->found.x[0] = x[2 * node];
    o->found.x[1] = x[2 * node + 1];
}

void overlap_look(overlap *o, const dem_lattice *lattice, double t, const double *x)
{
    sort_nodes(o, x);
    o->found.now = 0;
    for (dem_index k = 0; k < lattice->n_triangles && o->n > 0; k++) {
        const dem_index *corner = &lattice->triangles[3 * k];
        const double xa = x[2 * corner[0]], xb = x[2 * corner[1]], xc = x[2 * corner[2]];
        const double left = fmin(xa, fmin(xb, xc)), right = fmax(xa, fmax(xb, xc));
        for (dem_index p = seek(o, x, left); p < o->n && x[2 * o->nodes[p]] <= right; p++)
            if (is_inside(corner, o->nodes[p], x)) note(o, o->nodes[p], k, t, x);
    }
    if (o->found.now > o->found.most) o->found.most = o->found.now;
}
