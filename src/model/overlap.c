/* SPDX-License-Identifier: BSD-3-Clause */
/* Finds bodies that run into each other or into themselves, which no force prevents: boundary nodes inside triangles of
 * which they are no corners. Boundary nodes are put into the cells of a grid, and each triangle looks at the nodes in
 * the cells that it reaches into; most of them are no larger than these, and so far from the boundary that this is seen
 * from one corner. Ranks that share a lattice know all boundary nodes, and pass over those that are beyond all of their
 * triangles. The result is only reported; contact between bodies is not computed. */
#include "model/overlap.h"

#include <math.h>
#include <stdlib.h>

#include "base/grow.h"
#include "base/reduce.h"
#include "base/status.h"
#include "elastic/triangles.h"

/* In units of a triangle's area: a node that only touches an edge is not inside. */
static const double touching = 1e-9;

static dem_status reserve_next(overlap *o)
{
    CHECK(grow_array((void **)&o->next, &o->next_room, o->nodes.room, sizeof *o->next), DEM_ERROR_MEMORY,
          "out of memory for %lld nodes of the boundary", (long long)o->nodes.room);
    return DEM_OK;
}

dem_status overlap_reserve(overlap *o, const mesh_boundary *boundary)
{
    TRY(boundary_nodes_reserve(&o->nodes, boundary));
    return reserve_next(o);
}

/* One for four triangles: each of these then looks into three cells in the mean, into six if there were as many as
 * triangles, and most of them are empty. */
static dem_index count_cells(dem_index n_triangles)
{
    return n_triangles / 4 + 1;
}

static dem_status allocate(overlap *o, const dem_lattice *lattice)
{
    o->n_cells = count_cells(lattice->n_triangles);
    o->first = malloc((size_t)o->n_cells * sizeof *o->first);
    CHECK_MEMORY(o->first);
    o->place = malloc((size_t)lattice->n_nodes * sizeof *o->place);
    CHECK_MEMORY(o->place);
    return reserve_next(o);
}

dem_status overlap_create(overlap *out, const dem_lattice *lattice, const ranks *r, const domain *d)
{
    *out = (overlap){.found = {.node = -1, .triangle = -1}};
    if ((d != NULL ? d->n_triangles : lattice->n_triangles) == 0) return DEM_OK;
    TRY(boundary_nodes_create(&out->nodes, lattice, r, d));
    return reduce_status(r, allocate(out, lattice), 0.0);
}

void overlap_destroy(overlap *o)
{
    boundary_nodes_free(&o->nodes);
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

/* What lies beyond all triangles here is in none of them. In the whole nothing does. */
static void find_reach(overlap *o, dem_index n_nodes, const double *x)
{
    o->reach = (box){{-INFINITY, -INFINITY}, {INFINITY, INFINITY}};
    if (o->nodes.domain == NULL) return;
    o->reach = box_empty();
    for (dem_index i = 0; i < n_nodes; i++) o->reach = box_with(o->reach, vec2_at(x, i));
}

static bool is_in_reach(const overlap *o, dem_index p)
{
    const vec2 at = vec2_at(o->nodes.x, p);
    return at.x >= o->reach.low.x && at.x <= o->reach.high.x && at.y >= o->reach.low.y && at.y <= o->reach.high.y;
}

/* The grid is made of squares with columns * rows <= n_cells; a body without width or height has a single cell. */
static void lay_grid(overlap *o)
{
    box all = box_empty();
    for (dem_index p = 0; p < o->nodes.n; p++)
        if (is_in_reach(o, p)) all = box_with(all, vec2_at(o->nodes.x, p));
    const double width = all.high.x - all.low.x, height = all.high.y - all.low.y, n = (double)o->n_cells;
    o->left = all.low.x;
    o->low = all.low.y;
    o->columns = o->rows = 1;
    o->cells_per_length = 0.0;
    if (width > 0.0 && height > 0.0 && n > 4.0) {
        o->columns = (dem_index)fmin(fmax(floor(sqrt(n * width / height)), 1.0), fmin(n, MOST_CELLS));
        o->rows = o->n_cells / o->columns < MOST_CELLS ? o->n_cells / o->columns : MOST_CELLS;
        o->cells_per_length = fmin((double)o->columns / width, (double)o->rows / height);
    }
}

/* Boundary nodes, in lists. */
static void fill_cells(overlap *o)
{
    for (dem_index c = 0; c < o->n_cells; c++) o->first[c] = EMPTY_AROUND;
    for (dem_index p = 0; p < o->nodes.n; p++) {
        const vec2 at = vec2_at(o->nodes.x, p);
        int32_t *first = &o->first[row_of(o, at.y) * o->columns + column_of(o, at.x)];
        if (!is_in_reach(o, p)) continue;
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
static void mark_around(overlap *o, vec2 at)
{
    const dem_index row = row_of(o, at.y), column = column_of(o, at.x);
    for (dem_index r = larger(row - 2, 0); r <= smaller(row + 1, o->rows - 1); r++)
        for (dem_index c = larger(column - 2, 0); c <= smaller(column + 1, o->columns - 1); c++)
            if (o->first[r * o->columns + c] == EMPTY_AROUND) o->first[r * o->columns + c] = EMPTY;
}

/* Once for all triangles at a node. */
static void find_places(overlap *o, dem_index n_nodes, const double *x)
{
    for (dem_index p = 0; p < o->nodes.n; p++)
        if (is_in_reach(o, p)) mark_around(o, vec2_at(o->nodes.x, p));
    for (dem_index i = 0; i < n_nodes; i++) {
        const dem_index row = row_of(o, x[2 * i + 1]), column = column_of(o, x[2 * i]);
        const bool near = o->first[row * o->columns + column] != EMPTY_AROUND;
        o->place[i] = (uint32_t)(row << ROW | column) | (near ? NEAR : 0);
    }
}

/* ---- triangles ---- */

/* One in which nodes are looked for. */
typedef struct target {
    vec2 a, b, c;
    dem_index corner[3]; /* numbers in the whole */
} target;

static target target_of(const overlap *o, const dem_index *corner, const double *x)
{
    const domain *d = o->nodes.domain;
    return (target){vec2_at(x, corner[0]),
                    vec2_at(x, corner[1]),
                    vec2_at(x, corner[2]),
                    {domain_number(d, corner[0]), domain_number(d, corner[1]), domain_number(d, corner[2])}};
}

/* A node is inside if it makes a positive area with each side. A triangle that is itself folded has no inside. */
static bool is_inside(const target *of, const boundary_nodes *nodes, dem_index p)
{
    const vec2 at = vec2_at(nodes->x, p);
    const dem_index number = nodes->number[p];
    if (number == of->corner[0] || number == of->corner[1] || number == of->corner[2]) return false;
    const double least = touching * vec2_triangle_area(of->a, of->b, of->c);
    return least > 0.0 && vec2_triangle_area(of->a, of->b, at) > least &&
           vec2_triangle_area(of->b, of->c, at) > least && vec2_triangle_area(of->c, of->a, at) > least;
}

/* Counts an overlap of boundary node p; triangles come in ascending order, nodes in any. */
static void note(overlap_sight *seen, const boundary_nodes *nodes, dem_index p, dem_index triangle)
{
    seen->n++;
    if (seen->triangle >= 0 && (seen->triangle != triangle || seen->node < nodes->number[p])) return;
    seen->triangle = triangle;
    seen->node = nodes->number[p];
    vec2_put(seen->x, 0, vec2_at(nodes->x, p));
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
static void look_in(overlap *o, const dem_lattice *lattice, dem_index k, const double *x)
{
    const target t = target_of(o, &lattice->triangles[3 * k], x);
    const dem_index first = column_of(o, least_of(t.a.x, t.b.x, t.c.x)),
                    last = column_of(o, most_of(t.a.x, t.b.x, t.c.x));
    const dem_index top = row_of(o, most_of(t.a.y, t.b.y, t.c.y));
    for (dem_index row = row_of(o, least_of(t.a.y, t.b.y, t.c.y)); row <= top; row++)
        for (dem_index column = first; column <= last; column++)
            for (int32_t p = o->first[row * o->columns + column]; p >= 0; p = o->next[p])
                if (is_inside(&t, &o->nodes, p)) note(&o->seen, &o->nodes, p, domain_triangle(o->nodes.domain, k));
}

/* ---- looks ---- */

void overlap_break(overlap *o, const mesh_boundary *boundary, const unsigned char *broken)
{
    o->boundary = boundary;
    o->broken = broken;
}

/* There is room for the cells, as triangles that are whole get fewer. */
static void renew(overlap *o, const dem_lattice *lattice)
{
    dem_index n_whole = 0;
    for (dem_index t = 0; t < lattice->n_triangles; t++) n_whole += o->broken == NULL || !o->broken[t];
    boundary_nodes_follow(&o->nodes, o->boundary);
    o->n_cells = count_cells(n_whole);
    o->boundary = NULL;
}

/* Whether triangle k may have something in it, and is looked at here. */
static bool is_worth_it(const overlap *o, const dem_lattice *lattice, dem_index k)
{
    const dem_index *corner = &lattice->triangles[3 * k];
    return !is_far(o, corner) && (o->broken == NULL || !o->broken[k]) &&
           domain_owns(o->nodes.domain, domain_lowest(corner, 3));
}

static void join(void *packet, const void *other)
{
    overlap_sight *own = packet;
    const overlap_sight *theirs = other;
    const dem_index n = own->n + theirs->n;
    if (theirs->n > 0 && (own->n == 0 || theirs->triangle < own->triangle)) *own = *theirs;
    own->n = n;
}

/* Keeps the time and place of the first overlap of a run, and the largest number of a look. */
static void keep(dem_overlap *found, const overlap_sight *seen, double t)
{
    found->now = seen->n;
    if (seen->n > found->most) found->most = seen->n;
    if (seen->n == 0 || found->node >= 0) return;
    found->t = t;
    found->node = seen->node;
    found->triangle = seen->triangle;
    vec2_put(found->x, 0, vec2_at(seen->x, 0));
}

/* The grid is filled anew, since nodes move. */
void overlap_look(overlap *o, const dem_lattice *lattice, double t, const double *x)
{
    if (!overlap_is_possible(o)) return;
    const ranks *r = o->nodes.ranks;
    if (o->boundary != NULL) renew(o, lattice);
    boundary_nodes_locate(&o->nodes, x);
    find_reach(o, lattice->n_nodes, x);
    lay_grid(o);
    fill_cells(o);
    find_places(o, lattice->n_nodes, x);
    o->seen = (overlap_sight){.triangle = -1, .node = -1};
    for (dem_index k = 0; k < lattice->n_triangles; k++)
        if (is_worth_it(o, lattice, k)) look_in(o, lattice, k, x);
    r->reduce(r->self, &o->seen, sizeof o->seen, join);
    keep(&o->found, &o->seen, t);
}
