/* SPDX-License-Identifier: BSD-3-Clause */
/* Slabs of callers, and those of whole rectangles; rows that are cut are in cut_rows.c. */
#include "lattice/slab.h"

#include <math.h>
#include <stdlib.h>

#include "base/status.h"
#include "base/struct_size.h"
#include "base/vec2.h"
#include "lattice/cut_rows.h"
#include "lattice/jitter.h"
#include "lattice/lattice.h"

/* `lattice` is the last member, which has a version of its own. */
static const struct_kind kind = {"dem_slab", offsetof(dem_slab, lattice) + STRUCT_SIZE_WITH(dem_lattice, velocity),
                                 sizeof(dem_slab)};

/* ---- checks ---- */

static dem_status check_rim(const dem_slab *s)
{
    const dem_index n = s->lattice.n_nodes - s->n_own;
    CHECK(n == 0 || s->rim != NULL, DEM_ERROR_ARGUMENT, "a slab has no numbers of %lld nodes of its rim", (long long)n);
    for (dem_index k = 0; k < n; k++) {
        const dem_index least = k == s->first_own ? s->first_node + s->n_own : k > 0 ? s->rim[k - 1] + 1 : 0;
        const dem_index end = k < s->first_own ? s->first_node : s->n_nodes;
        CHECK(s->rim[k] >= least && s->rim[k] < end, DEM_ERROR_ARGUMENT,
              "number %lld of node %lld of the rim of a slab is not from %lld to %lld", (long long)s->rim[k],
              (long long)k, (long long)least, (long long)end - 1);
    }
    return DEM_OK;
}

static dem_status check(const dem_slab *s)
{
    CHECK(s != NULL, DEM_ERROR_ARGUMENT, "slab is NULL");
    TRY(struct_size_check(&kind, s));
    TRY(lattice_check(&s->lattice));
    const dem_index n = s->lattice.n_nodes;
    CHECK(s->first_own >= 0 && s->n_own > 0 && s->n_own <= n - s->first_own, DEM_ERROR_ARGUMENT,
          "a slab of %lld nodes has no %lld own ones from %lld on", (long long)n, (long long)s->n_own,
          (long long)s->first_own);
    CHECK(s->first_node >= 0 && s->n_own <= s->n_nodes - s->first_node, DEM_ERROR_ARGUMENT,
          "a slab of %lld nodes from %lld on is no part of %lld nodes", (long long)s->n_own, (long long)s->first_node,
          (long long)s->n_nodes);
    return check_rim(s);
}

/* ---- jitter ---- */

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

/* ---- what is done with slabs of callers ---- */

/* All but the lattice. */
static void put_place(dem_slab *s, const dem_slab *from)
{
    s->n_nodes = from->n_nodes;
    s->n_triangles = from->n_triangles;
    s->first_node = from->first_node;
    s->first_triangle = from->first_triangle;
    s->first_own = from->first_own;
    s->n_own = from->n_own;
    s->rim = from->rim;
    s->rim_boundary = from->rim_boundary;
}

static void forget(dem_slab *s)
{
    const dem_slab none = dem_slab_empty();
    put_place(s, &none);
    lattice_give(&s->lattice, &none.lattice);
}

dem_status slab_check_out(const dem_slab *out, dem_index part, dem_index n_parts)
{
    CHECK(out != NULL, DEM_ERROR_ARGUMENT, "out is NULL");
    TRY(struct_size_check(&kind, out));
    TRY(lattice_check_out(&out->lattice));
    CHECK(n_parts > 0 && part >= 0 && part < n_parts, DEM_ERROR_ARGUMENT, "there is no part %lld of %lld",
          (long long)part, (long long)n_parts);
    return DEM_OK;
}

void slab_give(dem_slab *out, const dem_slab *made)
{
    put_place(out, made);
    lattice_give(&out->lattice, &made->lattice);
}

dem_status slab_take(dem_slab *ours, dem_slab *theirs)
{
    TRY(check(theirs));
    *ours = dem_slab_empty();
    TRY(lattice_read(&ours->lattice, &theirs->lattice));
    put_place(ours, theirs);
    forget(theirs);
    return DEM_OK;
}

/* ---- public ---- */

void dem_slab_free(dem_slab *slab)
{
    if (slab == NULL || !struct_size_fits(&kind, slab)) return;
    dem_lattice_free(&slab->lattice);
    free(slab->rim);
    free(slab->rim_boundary);
    forget(slab);
}

static dem_status make(dem_slab *out, const grid *whole, dem_index part, dem_index n_parts)
{
    dem_slab made = dem_slab_empty();
    TRY(cut_rows_slab(&made, &(cut_rows){.whole = *whole, .height = 1}, part, n_parts));
    slab_give(out, &made);
    return DEM_OK;
}

dem_status dem_slab_rectangle(dem_slab *out, double width, double height, double spacing, dem_index part,
                              dem_index n_parts)
{
    grid whole;
    TRY(slab_check_out(out, part, n_parts));
    TRY(grid_of_rectangle(&whole, width, height, spacing));
    return make(out, &whole, part, n_parts);
}

dem_status dem_slab_squares(dem_slab *out, double width, double height, double spacing, dem_index part,
                            dem_index n_parts)
{
    grid whole;
    TRY(slab_check_out(out, part, n_parts));
    TRY(grid_of_squares(&whole, width, height, spacing));
    return make(out, &whole, part, n_parts);
}

/* With shifts of at most 0.3 a triangle that is equilateral keeps a fifth of its area, and half a square a seventh. So
 * no corner goes back, which could be because of one of another slab. */
dem_status dem_slab_jitter(dem_slab *slab, double radius, uint64_t seed)
{
    static const double most = 0.3 * (1.0 + 1e-9); /* a spacing is rounded */
    TRY(check(slab));
    const double side = shortest_side(&slab->lattice);
    CHECK(!(radius > most * side), DEM_ERROR_ARGUMENT,
          "nodes of a slab can be moved by 0.3 of the shortest side of a triangle, %g m, at most: %g m", side, radius);
    CHECK(slab->n_own == slab->lattice.n_nodes || slab->rim_boundary != NULL, DEM_ERROR_ARGUMENT,
          "a slab has no rim_boundary: it is not known which nodes of its rim are to be moved");
    const jitter_part part = {.first = slab->first_node,
                              .begin = slab->first_own,
                              .end = slab->first_own + slab->n_own,
                              .rim = slab->rim,
                              .rim_boundary = slab->rim_boundary};
    return jitter_move(&slab->lattice, &part, radius, seed);
}
