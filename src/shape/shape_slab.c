/* SPDX-License-Identifier: BSD-3-Clause */
/* From a caller's shape to a slab of its lattice (dem/slab.h): rows of the grid of the shape, of which each rank makes
 * its own, and all at some at a time to count what is left of them. */
#include "shape/shape_slab.h"

#include <stdlib.h>

#include "base/status.h"
#include "lattice/cut_rows.h"
#include "lattice/lattice.h"
#include "lattice/slab.h"
#include "shape/shape_input.h"

/* What rows are cut by. */
typedef struct cutter {
    const shape *shape;
    shape_grid grid;
    bool *is_idle; /* [voids of the caller] wholly outside of the body, as far as is known from the rows so far */
    dem_index n;   /* of these voids */
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

/* ---- rows ---- */

/* A disc is cut about the origin of the grid, all else where the shape is. */
static dem_status mark(void *context, dem_lattice *rows, bool *keep)
{
    cutter *c = context;
    const shape *s = c->shape;
    bool *node = lattice_zeros(rows->n_nodes, sizeof *node);
    CHECK(node != NULL, DEM_ERROR_MEMORY, "out of memory for %lld nodes", (long long)rows->n_nodes);
    for (dem_index i = 0; i < rows->n_nodes; i++)
        node[i] = c->grid.reach == 0.0 || grid_disc_has(&c->grid.reach, rows->x + 2 * i);
    dem_lattice_move(rows, 0.0, c->grid.foot);
    for (dem_index k = 0; k < c->n; k++) c->is_idle[k] = c->is_idle[k] && !shape_takes(s, &s->voids[k], rows, node);
    shape_mark(keep, node, s, rows);
    free(node);
    return DEM_OK;
}

/* Which rows: a part, or those of nodes `begin` to `end` where n_parts is 0. */
typedef struct rows_asked {
    dem_index part, n_parts, begin, end;
    dem_index **counts; /* of these */
} rows_asked;

static dem_status make(dem_slab *out, cutter *c, const dem_shape *ours, const rows_asked *asked)
{
    TRY(shape_input_check_edges(c->shape));
    TRY(shape_input_check_size(ours, shape_find_grid(&c->grid, c->shape)));
    TRY(list_idle(c, ours->n_voids));
    const cut_rows rows = {c->grid.rows, mark, c};
    if (asked->n_parts > 0) {
        TRY(cut_rows_slab(out, &rows, asked->part, asked->n_parts));
        return check_voids(c, ours);
    }
    const bool all_are_seen = *asked->counts == NULL;
    TRY(cut_rows_between(out, &rows, asked->counts, asked->begin, asked->end));
    return all_are_seen ? check_voids(c, ours) : DEM_OK;
}

static dem_status make_asked(dem_slab *out, const dem_shape *theirs, const rows_asked *asked)
{
    dem_shape ours;
    shape s;
    dem_slab made = dem_slab_empty();
    cutter c = {.shape = &s};
    TRY(shape_input_read(&ours, theirs));
    CHECK(ours.edge == DEM_EDGE_STEPPED, DEM_ERROR_ARGUMENT, "smooth edges are made of the whole, not of slabs");
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

dem_status dem_private_slab_between(dem_slab *out, const dem_shape *theirs, dem_index **counts, dem_index begin,
                                    dem_index end)
{
    TRY(slab_check_out(out, 0, 1));
    return make_asked(out, theirs, &(rows_asked){.begin = begin, .end = end, .counts = counts});
}
