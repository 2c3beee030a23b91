/* SPDX-License-Identifier: BSD-3-Clause */
/* From a caller's shape to a slab of its lattice (dem/slab.h): rows of the grid of the shape, of which each rank makes
 * its own, and all at some at a time to count what is left of them. Smooth edges are made in more rows than are asked
 * for, as what becomes of a node there depends on what is near it (smoothing.h). */
#include "shape/shape_slab.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/status.h"
#include "lattice/cut_rows.h"
#include "lattice/lattice.h"
#include "lattice/slab.h"
#include "shape/shape_input.h"
#include "shape/smoothing.h"
#include "shape/triangle_numbers.h"

/* What rows are cut by. */
typedef struct cutter {
    const shape *shape;
    const dem_private_rows *more; /* NULL: nothing more is taken */
    shape_grid grid;
    bool *is_idle;     /* [voids of the caller] wholly outside of the body, as far as is known from the rows so far */
    dem_index n;       /* of these voids */
    dem_index n_taken; /* by `more`, and */
    smoothing out;     /* of smooth edges: of all rows that were made so far */
} cutter;

/* ---- voids ---- */

static dem_status list_idle(cutter *c, dem_index n)
{
    c->n = n;
    c->is_idle = lattice_zeros(n, sizeof *c->is_idle);
    CHECK_MEMORY(c->is_idle);
    for (dem_index k = 0; k < n; k++) c->is_idle[k] = !shape_has_void(c->shape, &c->shape->voids[k]);
    return DEM_OK;
}

static dem_status check_voids(const cutter *c, const dem_shape *ours)
{
    for (dem_index k = 0; k < c->n; k++)
        if (c->is_idle[k]) return shape_input_refuse_void(ours, c->shape, k);
    return DEM_OK;
}

/* ---- smooth edges ---- */

/* Rows of the grid with those about them, and which of their nodes and triangles are wanted. */
typedef struct wide_rows {
    grid rows;
    dem_lattice lattice;            /* masses and strengths are numbers among all of these rows */
    dem_index n_nodes, n_triangles; /* in rows before the wanted ones */
} wide_rows;

/* Those about a range of rows. To be freed after a failure, too. */
static dem_status make_wide(wide_rows *w, const cutter *c, const grid *rows)
{
    const grid wide = grid_between(&c->grid.rows, rows->first - SMOOTHING_ROWS, rows->last + SMOOTHING_ROWS);
    *w = (wide_rows){.rows = wide, .lattice = dem_lattice_empty()};
    w->n_nodes = grid_nodes_below(&wide, rows->first);
    w->n_triangles = grid_triangles_below(&wide, rows->first);
    TRY(grid_lattice(&w->lattice, &wide));
    TRY(triangle_numbers_add(&w->lattice));
    w->lattice.mass = lattice_zeros(w->lattice.n_nodes, sizeof *w->lattice.mass);
    CHECK_MEMORY(w->lattice.mass);
    for (dem_index i = 0; i < w->lattice.n_nodes; i++) w->lattice.mass[i] = (double)i;
    return shape_place_rows(&w->lattice, &c->grid);
}

/* Heights half way to the rows beside, as a part has them that ends at these rows, or has the end of the grid. */
static smoothing_part part_of(const cutter *c, const grid *own)
{
    const double height = grid_height(&c->grid.rows), foot = c->grid.foot[1];
    smoothing_part part = {-(double)INFINITY, (double)INFINITY};
    if (own->first > c->grid.rows.first) part.from = foot + ((double)own->first - 0.5) * height;
    if (own->last < c->grid.rows.last) part.to = foot + ((double)own->last + 0.5) * height;
    return part;
}

static void add_report(smoothing *sum, const smoothing *out)
{
    sum->n_rim += out->n_rim;
    sum->n_off += out->n_off;
    sum->n_cut += out->n_cut;
    sum->n_unsettled += out->n_unsettled;
    sum->farthest = fmax(sum->farthest, out->farthest);
}

static bool is_below(dem_index n, dem_index k)
{
    return k >= 0 && k < n;
}

/* Nodes of the wide rows to where they are among the wanted ones. */
static void take_nodes(dem_lattice *rows, const wide_rows *w)
{
    for (dem_index i = 0; i < w->lattice.n_nodes; i++) {
        const dem_index to = (dem_index)w->lattice.mass[i] - w->n_nodes;
        if (is_below(rows->n_nodes, to)) memcpy(rows->x + 2 * to, w->lattice.x + 2 * i, 2 * sizeof *rows->x);
    }
}

/* Likewise triangles. One at the ends of the rows that has got a node beyond them keeps its nodes. */
static void take_triangles(dem_lattice *rows, bool *keep, const wide_rows *w)
{
    const dem_lattice *l = &w->lattice;
    memset(keep, 0, (size_t)rows->n_triangles * sizeof *keep);
    for (dem_index t = 0; t < l->n_triangles; t++) {
        const dem_index to = (dem_index)l->strength[t] - w->n_triangles;
        dem_index corner[3];
        bool are_here = true;
        if (!is_below(rows->n_triangles, to)) continue;
        for (int k = 0; k < 3; k++) {
            corner[k] = (dem_index)l->mass[l->triangles[3 * t + k]] - w->n_nodes;
            are_here = are_here && is_below(rows->n_nodes, corner[k]);
        }
        if (are_here) memcpy(rows->triangles + 3 * to, corner, sizeof corner);
        keep[to] = true;
    }
}

/* Where no triangle is kept there is nothing to smooth. */
static dem_status mark_smooth(cutter *c, const cut_range *range, dem_lattice *rows, bool *keep)
{
    const smoothing_part part = part_of(c, &range->own);
    wide_rows w;
    smoothing out = {0};
    dem_status status = make_wide(&w, c, &range->rows);
    if (status == DEM_OK) status = smoothing_apply(&out, &w.lattice, c->shape, &part);
    if (status == DEM_ERROR_MODEL) memset(keep, 0, (size_t)rows->n_triangles * sizeof *keep);
    if (status == DEM_OK) {
        take_nodes(rows, &w);
        take_triangles(rows, keep, &w);
    }
    add_report(&c->out, &out);
    dem_lattice_free(&w.lattice);
    return status == DEM_ERROR_MODEL ? DEM_OK : status;
}

/* ---- rows ---- */

static dem_index count_kept(const bool *keep, dem_index begin, dem_index end)
{
    dem_index n = 0;
    for (dem_index t = begin; t < end; t++) n += keep[t];
    return n;
}

static dem_status take_more(cutter *c, const cut_range *range, const dem_lattice *rows, bool *keep)
{
    const dem_index begin = grid_triangles_below(&range->rows, range->own.first);
    const dem_index end = grid_triangles_below(&range->rows, range->own.last + 1);
    if (c->more == NULL || c->more->cut == NULL) return DEM_OK;
    const dem_index n = count_kept(keep, begin, end);
    TRY(c->more->cut(c->more->program, rows, keep, begin, end));
    c->n_taken += n - count_kept(keep, begin, end);
    return DEM_OK;
}

/* A disc is cut about the origin of the grid, all else where the shape is. */
static dem_status mark(void *context, const cut_range *range, dem_lattice *rows, bool *keep)
{
    cutter *c = context;
    const shape *s = c->shape;
    bool *node = lattice_zeros(rows->n_nodes, sizeof *node);
    CHECK(node != NULL, DEM_ERROR_MEMORY, "out of memory for %lld nodes", (long long)rows->n_nodes);
    for (dem_index i = 0; i < rows->n_nodes; i++)
        node[i] = c->grid.reach == 0.0 || grid_disc_has(&c->grid.reach, rows->x + 2 * i);
    dem_lattice_move(rows, 0.0, c->grid.foot);
    for (dem_index k = 0; k < c->n; k++) c->is_idle[k] = c->is_idle[k] && !shape_takes(s, &s->voids[k], rows, node);
    if (!s->smooth) shape_mark(keep, node, s, rows);
    free(node);
    if (s->smooth) TRY(mark_smooth(c, range, rows, keep));
    return take_more(c, range, rows, keep);
}

/* Which rows: a part, or those of nodes `begin` to `end` where n_parts is 0. */
typedef struct rows_asked {
    dem_index part, n_parts, begin, end;
    dem_index **counts;     /* of these */
    dem_private_rows *rows; /* of these: what is found is written there; NULL otherwise */
} rows_asked;

/* Rows are counted in pieces of which those about them are the smaller part. */
static cut_rows rows_to_cut(cutter *c)
{
    const bool is_smooth = c->shape->smooth;
    return (cut_rows){.whole = c->grid.rows,
                      .mark = mark,
                      .context = c,
                      .height = is_smooth ? SMOOTHING_HEIGHT : 1,
                      .least = is_smooth ? 4 * SMOOTHING_ROWS : 0};
}

static void put_found(dem_private_rows *found, const cutter *c)
{
    found->n_taken = c->n_taken;
    found->report.n_rim = c->out.n_rim;
    found->report.n_off = c->out.n_off;
    found->report.n_cut = c->out.n_cut;
    found->report.farthest = c->out.farthest;
}

static dem_status count(cutter *c, const cut_rows *rows, const dem_shape *ours, const rows_asked *asked)
{
    dem_slab none = dem_slab_empty();
    TRY(cut_rows_between(&none, rows, asked->counts, 0, 0));
    put_found(asked->rows, c);
    return check_voids(c, ours);
}

static dem_status cut(dem_slab *out, cutter *c, const dem_shape *ours, const rows_asked *asked)
{
    const cut_rows rows = rows_to_cut(c);
    if (asked->n_parts > 0) {
        TRY(cut_rows_slab(out, &rows, asked->part, asked->n_parts));
        return check_voids(c, ours);
    }
    if (*asked->counts == NULL) TRY(count(c, &rows, ours, asked));
    return cut_rows_between(out, &rows, asked->counts, asked->begin, asked->end);
}

static dem_status make(dem_slab *out, cutter *c, const dem_shape *ours, const rows_asked *asked)
{
    TRY(shape_input_check_edges(c->shape));
    TRY(shape_input_check_size(ours, shape_find_grid(&c->grid, c->shape)));
    TRY(list_idle(c, ours->n_voids));
    TRY(cut(out, c, ours, asked));
    CHECK(c->out.n_unsettled == 0, DEM_ERROR_MODEL,
          "%s: %lld triangles at smooth edges go by what is too far off for a slab: its lattice can be made as a whole",
          shape_input_name(ours), (long long)c->out.n_unsettled);
    return DEM_OK;
}

static dem_status make_asked(dem_slab *out, const dem_shape *theirs, const rows_asked *asked)
{
    dem_shape ours;
    shape s;
    dem_slab made = dem_slab_empty();
    cutter c = {.shape = &s, .more = asked->rows};
    TRY(shape_input_read(&ours, theirs));
    CHECK(!ours.numbered, DEM_ERROR_ARGUMENT, "triangles are numbered in the whole before it is cut, not in slabs");
    TRY(shape_input_make(&s, &ours));
    const dem_status status = make(&made, &c, &ours, asked);
    free(c.is_idle);
    shape_free(&s);
    if (status == DEM_OK)
        slab_give(out, &made);
    else
        dem_slab_free(&made);
    return status;
}

/* ---- public ---- */

dem_status dem_slab_shape(dem_slab *out, const dem_shape *theirs, dem_index part, dem_index n_parts)
{
    TRY(slab_check_out(out, part, n_parts));
    return make_asked(out, theirs, &(rows_asked){.part = part, .n_parts = n_parts});
}

dem_status dem_private_slab_between(dem_slab *out, const dem_shape *theirs, dem_private_rows *rows, dem_index **counts,
                                    dem_index begin, dem_index end)
{
    TRY(slab_check_out(out, 0, 1));
    return make_asked(out, theirs, &(rows_asked){.begin = begin, .end = end, .counts = counts, .rows = rows});
}
