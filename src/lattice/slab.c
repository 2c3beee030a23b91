/* SPDX-License-Identifier: BSD-3-Clause */
/* Slabs of the lattices that are made row by row. The numbers of their nodes and triangles in the whole are counts of
 * rows, so that a slab needs nothing of the others. */
#include "lattice/slab.h"

#include <math.h>

#include "base/status.h"
#include "base/struct_size.h"
#include "base/vec2.h"
#include "lattice/grid.h"
#include "lattice/jitter.h"
#include "lattice/lattice.h"

/* `lattice` is the last member, which has a version of its own. */
static const struct_kind kind = {"dem_slab", offsetof(dem_slab, lattice) + STRUCT_SIZE_WITH(dem_lattice, velocity),
                                 sizeof(dem_slab)};

/* ---- rows ---- */

static grid rows_of(const grid *whole, dem_index first, dem_index last)
{
    grid rows = *whole;
    rows.first = first;
    rows.last = last;
    return rows;
}

/* Of n rows each part has n/n_parts, and the first ones have one more. */
static grid own_rows(const grid *whole, dem_index part, dem_index n_parts)
{
    const dem_index n = whole->last + 1, each = n / n_parts, more = n % n_parts;
    const dem_index first = part * each + (part < more ? part : more);
    return rows_of(whole, first, first + each - (part < more ? 0 : 1));
}

/* The rows from `first` on, of which those of `own` are own ones. */
static dem_status make(dem_slab *out, const grid *whole, const grid *own)
{
    const dem_index first = own->first > 0 ? own->first - 1 : 0;
    const grid rows = rows_of(whole, first, own->last < whole->last ? own->last + 1 : own->last),
               before = rows_of(whole, 0, first - 1), strips = rows_of(whole, 0, first),
               rim = rows_of(whole, first, own->first - 1);
    dem_lattice lattice;
    TRY(grid_lattice(&lattice, &rows));
    out->n_nodes = grid_count_nodes(whole);
    out->n_triangles = grid_count_triangles(whole);
    out->first_node = grid_count_nodes(&before);
    out->first_triangle = grid_count_triangles(&strips);
    out->first_own = grid_count_nodes(&rim);
    out->n_own = grid_count_nodes(own);
    lattice_give(&out->lattice, &lattice);
    return DEM_OK;
}

static dem_status check_out(const dem_slab *out, dem_index part, dem_index n_parts)
{
    CHECK(out != NULL, DEM_ERROR_ARGUMENT, "out is NULL");
    TRY(struct_size_check(&kind, out));
    TRY(lattice_check_out(&out->lattice));
    CHECK(n_parts > 0 && part >= 0 && part < n_parts, DEM_ERROR_ARGUMENT, "there is no part %lld of %lld",
          (long long)part, (long long)n_parts);
    return DEM_OK;
}

static dem_status make_part(dem_slab *out, const grid *whole, dem_index part, dem_index n_parts)
{
    CHECK(n_parts <= whole->last + 1, DEM_ERROR_MODEL, "%lld rows of nodes cannot be %lld slabs",
          (long long)(whole->last + 1), (long long)n_parts);
    const grid own = own_rows(whole, part, n_parts);
    return make(out, whole, &own);
}

/* ---- jitter ---- */

static dem_status check(const dem_slab *s)
{
    CHECK(s != NULL, DEM_ERROR_ARGUMENT, "slab is NULL");
    TRY(struct_size_check(&kind, s));
    TRY(lattice_check(&s->lattice));
    const dem_index n = s->lattice.n_nodes;
    CHECK(s->first_own >= 0 && s->n_own > 0 && s->n_own <= n - s->first_own, DEM_ERROR_ARGUMENT,
          "a slab of %lld nodes has no %lld own ones from %lld on", (long long)n, (long long)s->n_own,
          (long long)s->first_own);
    CHECK(s->first_node >= 0 && n <= s->n_nodes - s->first_node, DEM_ERROR_ARGUMENT,
          "a slab of %lld nodes from %lld on is no part of %lld nodes", (long long)n, (long long)s->first_node,
          (long long)s->n_nodes);
    return DEM_OK;
}

/* m; infinity without triangles. */
static double shortest_side(const dem_lattice *l)
{
    double shortest = (double)INFINITY;
    for (dem_index k = 0; k < 3 * l->n_triangles; k++) {
        const dem_index next = k % 3 == 2 ? k - 2 : k + 1;
        const vec2 side = vec2_sub(vec2_at(l->x, l->triangles[next]), vec2_at(l->x, l->triangles[k]));
        shortest = fmin(shortest, vec2_norm(side));
    }
    return shortest;
}

static void forget_place(dem_slab *s)
{
    s->n_nodes = s->n_triangles = s->first_node = s->first_triangle = s->first_own = s->n_own = 0;
}

/* ---- public ---- */

dem_status slab_take(dem_slab *ours, dem_slab *theirs)
{
    const dem_lattice none = dem_lattice_empty();
    TRY(check(theirs));
    *ours = dem_slab_empty();
    ours->n_nodes = theirs->n_nodes;
    ours->n_triangles = theirs->n_triangles;
    ours->first_node = theirs->first_node;
    ours->first_triangle = theirs->first_triangle;
    ours->first_own = theirs->first_own;
    ours->n_own = theirs->n_own;
    TRY(lattice_read(&ours->lattice, &theirs->lattice));
    lattice_give(&theirs->lattice, &none);
    forget_place(theirs);
    return DEM_OK;
}

void dem_slab_free(dem_slab *slab)
{
    if (slab == NULL || !struct_size_fits(&kind, slab)) return;
    dem_lattice_free(&slab->lattice);
    forget_place(slab);
}

dem_status dem_slab_rectangle(dem_slab *out, double width, double height, double spacing, dem_index part,
                              dem_index n_parts)
{
    grid whole;
    TRY(check_out(out, part, n_parts));
    TRY(grid_of_rectangle(&whole, width, height, spacing));
    return make_part(out, &whole, part, n_parts);
}

dem_status dem_slab_squares(dem_slab *out, double width, double height, double spacing, dem_index part,
                            dem_index n_parts)
{
    grid whole;
    TRY(check_out(out, part, n_parts));
    TRY(grid_of_squares(&whole, width, height, spacing));
    return make_part(out, &whole, part, n_parts);
}

/* With shifts of at most 0.3 a triangle that is equilateral keeps a fifth of its area, and half a square a seventh. So
 * no corner goes back, which could be because of one of another slab. */
dem_status dem_slab_jitter(dem_slab *slab, double radius, uint64_t seed)
{
    static const double most = 0.3 * (1.0 + 1e-9); /* a spacing is rounded */
    TRY(check(slab));
    const dem_index n = slab->lattice.n_nodes;
    const double side = shortest_side(&slab->lattice);
    CHECK(!(radius > most * side), DEM_ERROR_ARGUMENT,
          "nodes of a slab can be moved by 0.3 of the shortest side of a triangle, %g m, at most: %g m", side, radius);
    const jitter_part part = {.first = slab->first_node,
                              .begin = slab->first_node > 0 ? slab->first_own : 0,
                              .end = slab->first_node + n < slab->n_nodes ? slab->first_own + slab->n_own : n};
    return jitter_move(&slab->lattice, &part, radius, seed);
}
