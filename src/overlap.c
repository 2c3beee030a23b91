/* SPDX-License-Identifier: BSD-3-Clause */
/* A triangle in cells where there are boundary nodes looks at those in its range of x, by which they are sorted. */
#include "overlap.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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
    o.n_cells = lattice->n_triangles;
    o.taken = malloc((size_t)o.n_cells);
    dem_status status = flags != NULL && o.nodes != NULL && o.taken != NULL
                            ? sides_contact_flags(flags, lattice)
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
    free(o->taken);
    o->nodes = NULL;
    o->taken = NULL;
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

/* ---- cells ---- */

static dem_index cell_of(double x, double start, double per_length, dem_index n)
{
    if (!(x > start)) return 0;
    const double place = (x - start) * per_length;
    return place < (double)n ? (dem_index)place : n - 1;
}

static dem_index column_of(const overlap *o, double x)
{
    return cell_of(x, o->left, o->cells_per_length, o->columns);
}

static dem_index row_of(const overlap *o, double y)
{
    return cell_of(y, o->low, o->cells_per_length, o->rows);
}

/* As many cells as there are triangles, or fewer, over all boundary nodes. */
static void mark_cells(overlap *o, const double *x)
{
    double right = -INFINITY, high = -INFINITY;
    o->left = o->low = INFINITY;
    for (dem_index p = 0; p < o->n; p++) {
        const vec2 at = vec2_at(x, o->nodes[p]);
        o->left = fmin(o->left, at.x);
        o->low = fmin(o->low, at.y);
        right = fmax(right, at.x);
        high = fmax(high, at.y);
    }
    const double width = right - o->left, height = high - o->low, n = (double)o->n_cells;
    o->columns = o->rows = 1;
    o->cells_per_length = 0.0;
    if (width > 0.0 && height > 0.0 && n > 4.0) {
        o->columns = (dem_index)fmin(fmax(floor(sqrt(n * width / height)), 1.0), n);
        o->rows = o->n_cells / o->columns;
        o->cells_per_length = fmin((double)o->columns / width, (double)o->rows / height);
    }
    memset(o->taken, 0, (size_t)o->n_cells);
    for (dem_index p = 0; p < o->n; p++) {
        const vec2 at = vec2_at(x, o->nodes[p]);
        o->taken[row_of(o, at.y) * o->columns + column_of(o, at.x)] = 1;
    }
}

/* Whether there may be boundary nodes in a box. */
static bool any_in(const overlap *o, vec2 least, vec2 most)
{
    const dem_index first = column_of(o, least.x), last = column_of(o, most.x), top = row_of(o, most.y);
    for (dem_index row = row_of(o, least.y); row <= top; row++)
        for (dem_index column = first; column <= last; column++)
            if (o->taken[row * o->columns + column]) return true;
    return false;
}

/* ---- triangles ---- */

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

static double least_of(double a, double b, double c)
{
    const double less = a < b ? a : b;
    return less < c ? less : c;
}

static double most_of(double a, double b, double c)
{
    return -least_of(-a, -b, -c);
}

static void look_in(overlap *o, const dem_lattice *lattice, dem_index k, double t, const double *x)
{
    const dem_index *corner = &lattice->triangles[3 * k];
    const vec2 a = vec2_at(x, corner[0]), b = vec2_at(x, corner[1]), c = vec2_at(x, corner[2]);
    const vec2 least = {least_of(a.x, b.x, c.x), least_of(a.y, b.y, c.y)};
    const vec2 most = {most_of(a.x, b.x, c.x), most_of(a.y, b.y, c.y)};
    if (!any_in(o, least, most)) return;
    for (dem_index p = seek(o, x, least.x); p < o->n && x[2 * o->nodes[p]] <= most.x; p++)
        if (is_inside(corner, o->nodes[p], x)) note(o, o->nodes[p], k, t, x);
}

void overlap_look(overlap *o, const dem_lattice *lattice, double t, const double *x)
{
    o->found.now = 0;
    if (o->n == 0) return;
    sort_nodes(o, x);
    mark_cells(o, x);
    for (dem_index k = 0; k < lattice->n_triangles; k++) look_in(o, lattice, k, t, x);
    if (o->found.now > o->found.most) o->found.most = o->found.now;
}
