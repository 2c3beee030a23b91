/* SPDX-License-Identifier: BSD-3-Clause */
/* Finds bodies that run into each other or into themselves, which no force prevents: boundary nodes inside triangles of
 * which they are no corners. Boundary nodes are put into the cells of a grid, and each triangle looks at the nodes in
 * the cells that it reaches into; most of them are no larger than these, and so far from the boundary that this is seen
 * from one corner. The result is only reported; contact between bodies is not computed. */
#include "model/overlap.h"

#include <math.h>
#include <stdlib.h>

#include "base/grow.h"
#include "base/sorted.h"
#include "base/status.h"
#include "elastic/triangles.h"

/* In units of a triangle's area: a node that only touches an edge is not inside. */
static const double touching = 1e-9;

dem_status overlap_reserve(overlap *o, const mesh_boundary *boundary)
{
    CHECK(grow_array((void **)&o->nodes, &o->capacity, 2 * boundary->n, sizeof *o->nodes) &&
              grow_array((void **)&o->next, &o->next_room, 2 * boundary->n, sizeof *o->next),
          DEM_ERROR_MEMORY, "out of memory for %lld edges of the boundary", (long long)boundary->n);
    return DEM_OK;
}

/* The ends of the edges, in the room that there is. A node that has lost all of its triangles is on no boundary any
 * more. */
static void list_nodes(overlap *o, const mesh_boundary *boundary)
{
    for (dem_index k = 0; k < boundary->n; k++) {
        o->nodes[2 * k] = boundary->list[k].lower;
        o->nodes[2 * k + 1] = boundary->list[k].upper;
    }
    o->n = sorted_make(o->nodes, 2 * boundary->n);
}

/* One for four triangles: each of these then looks into three cells in the mean, into six if there were as many as
 * triangles, and most of them are empty. */
static dem_index count_cells(dem_index n_triangles)
{
    return (n_triangles + 3) / 4;
}

static dem_status create(overlap *o, const mesh_boundary *boundary)
{
    o->n_cells = count_cells(boundary->lattice->n_triangles);
    if (o->n_cells == 0) return DEM_OK;
    TRY(overlap_reserve(o, boundary));
    o->first = malloc((size_t)o->n_cells * sizeof *o->first);
    CHECK_MEMORY(o->first);
    o->place = malloc((size_t)boundary->lattice->n_nodes * sizeof *o->place);
    CHECK_MEMORY(o->place);
    list_nodes(o, boundary);
    return DEM_OK;
}

dem_status overlap_create(overlap *out, const dem_lattice *lattice)
{
    mesh_boundary boundary;
    *out = (overlap){.found = {.node = -1, .triangle = -1}};
    TRY(mesh_boundary_create(&boundary, lattice, NULL));
    const dem_status status = create(out, &boundary);
    mesh_boundary_free(&boundary);
    if (status != DEM_OK) overlap_destroy(out);
    return status;
}

void overlap_destroy(overlap *o)
{
    free(o->nodes);
    free(o->first);
    free(o->next);
    free(o->place);
    *o = (overlap){.found = o->found};
}

/* ---- cells ---- */

/* The cell of a coordinate among n. What is beyond the grid belongs to its outermost cell, and so does a NAN. */
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

/* The row and the column of a cell share a word, in which no difference of columns reaches into the rows. NEAR: there
 * may be boundary nodes around. */
enum { ROW = 16, MOST_CELLS = 0x7fff };
static const uint32_t CELL = 0x7fffffff, NEAR = 0x80000000;

/* What the list of a cell without nodes is: whether there are none either in the cells up to two further, or one back,
 * in any direction of both. */
enum { EMPTY_AROUND = -1, EMPTY = -2 };

/* Cells over all boundary nodes, about square. The list of a cell has its nodes in ascending order, since they are
 * entered backwards. */
static void fill_cells(overlap *o, const double *x)
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
    /* The grid is made of squares with columns * rows <= n_cells; a body without width or height has a single cell. */
    const double width = right - o->left, height = high - o->low, n = (double)o->n_cells;
    o->columns = o->rows = 1;
    o->cells_per_length = 0.0;
    if (width > 0.0 && height > 0.0 && n > 4.0) {
        o->columns = (dem_index)fmin(fmax(floor(sqrt(n * width / height)), 1.0), fmin(n, MOST_CELLS));
        o->rows = o->n_cells / o->columns < MOST_CELLS ? o->n_cells / o->columns : MOST_CELLS;
        o->cells_per_length = fmin((double)o->columns / width, (double)o->rows / height);
    }
    for (dem_index c = 0; c < o->n_cells; c++) o->first[c] = EMPTY_AROUND;
    for (dem_index p = o->n - 1; p >= 0; p--) {
        const vec2 at = vec2_at(x, o->nodes[p]);
        int32_t *first = &o->first[row_of(o, at.y) * o->columns + column_of(o, at.x)];
        o->next[p] = *first;
        *first = (int32_t)p;
    }
}

static dem_index larger(dem_index a, dem_index b)
{
    return a > b ? a : b;
}

static dem_index smaller(dem_index a, dem_index b)
{
    return a < b ? a : b;
}

/* The cells from which that of a boundary node is at most two further, or one back. */
static void mark_around(overlap *o, dem_index node, const double *x)
{
    const dem_index row = row_of(o, x[2 * node + 1]), column = column_of(o, x[2 * node]);
    for (dem_index r = larger(row - 2, 0); r <= smaller(row + 1, o->rows - 1); r++)
        for (dem_index c = larger(column - 2, 0); c <= smaller(column + 1, o->columns - 1); c++)
            if (o->first[r * o->columns + c] == EMPTY_AROUND) o->first[r * o->columns + c] = EMPTY;
}

/* Once for all triangles at a node. */
static void find_places(overlap *o, dem_index n_nodes, const double *x)
{
    for (dem_index p = 0; p < o->n; p++) mark_around(o, o->nodes[p], x);
    for (dem_index i = 0; i < n_nodes; i++) {
        const dem_index row = row_of(o, x[2 * i + 1]), column = column_of(o, x[2 * i]);
        const bool near = o->first[row * o->columns + column] != EMPTY_AROUND;
        o->place[i] = (uint32_t)(row << ROW | column) | (near ? NEAR : 0);
    }
}

/* ---- triangles ---- */

/* A node is inside if it makes a positive area with each side. A triangle that is itself folded has no inside. */
static bool is_inside(const dem_index *corner, dem_index i, const double *x)
{
    const vec2 a = vec2_at(x, corner[0]), b = vec2_at(x, corner[1]), c = vec2_at(x, corner[2]), p = vec2_at(x, i);
    if (i == corner[0] || i == corner[1] || i == corner[2]) return false;
    const double least = touching * vec2_triangle_area(a, b, c);
    return least > 0.0 && vec2_triangle_area(a, b, p) > least && vec2_triangle_area(b, c, p) > least &&
           vec2_triangle_area(c, a, p) > least;
}

/* Counts an overlap, and keeps the time and place of the first one of a run. */
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

/* Whether no boundary node can be in a triangle: there are none around one of its corners, from which the two others
 * are at most two cells further, or one back. */
static bool is_far(const overlap *o, const dem_index *corner)
{
    const uint32_t one_back = 1u << ROW | 1u, further = 3u << ROW | 3u, a = o->place[corner[0]];
    const uint32_t b = (o->place[corner[1]] & CELL) + one_back - a, c = (o->place[corner[2]] & CELL) + one_back - a;
    return (a & NEAR) == 0 && ((b | c) & ~further) == 0;
}

/* All cells that the triangle's bounding box reaches into. */
static void look_in(overlap *o, const dem_lattice *lattice, dem_index k, double t, const double *x)
{
    const dem_index *corner = &lattice->triangles[3 * k];
    const vec2 a = vec2_at(x, corner[0]), b = vec2_at(x, corner[1]), c = vec2_at(x, corner[2]);
    const dem_index first = column_of(o, least_of(a.x, b.x, c.x)), last = column_of(o, most_of(a.x, b.x, c.x));
    const dem_index top = row_of(o, most_of(a.y, b.y, c.y));
    for (dem_index row = row_of(o, least_of(a.y, b.y, c.y)); row <= top; row++)
        for (dem_index column = first; column <= last; column++)
            for (int32_t p = o->first[row * o->columns + column]; p >= 0; p = o->next[p])
                if (is_inside(corner, o->nodes[p], x)) note(o, o->nodes[p], k, t, x);
}

/* ---- looks ---- */

void overlap_break(overlap *o, const mesh_boundary *boundary, const unsigned char *broken)
{
    o->boundary = boundary;
    o->broken = broken;
}

/* There is room for the cells, as triangles that are whole get fewer. */
static void renew(overlap *o)
{
    const dem_lattice *l = o->boundary->lattice;
    list_nodes(o, o->boundary);
    dem_index n_whole = 0;
    for (dem_index t = 0; t < l->n_triangles; t++) n_whole += o->broken == NULL || !o->broken[t];
    o->n_cells = count_cells(n_whole);
    o->boundary = NULL;
}

/* The grid is filled anew, since nodes move; `most` keeps the largest number found so far. */
void overlap_look(overlap *o, const dem_lattice *lattice, double t, const double *x)
{
    o->found.now = 0;
    if (o->boundary != NULL) renew(o);
    if (o->n == 0) return;
    fill_cells(o, x);
    find_places(o, lattice->n_nodes, x);
    for (dem_index k = 0; k < lattice->n_triangles; k++)
        if (!is_far(o, &lattice->triangles[3 * k]) && (o->broken == NULL || !o->broken[k]))
            look_in(o, lattice, k, t, x);
    if (o->found.now > o->found.most) o->found.most = o->found.now;
}
