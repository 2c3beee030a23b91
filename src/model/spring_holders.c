/* SPDX-License-Identifier: BSD-3-Clause */
/* A spring is held by the triangles that have it for a side, or between whose outer corners it is (the second diagonal
 * of a square), with shares in proportion to what they gave to its stiffness (model/spring_share.c). Springs are found
 * from the sides of triangles, in the order of their nodes. Who goes through them: stresses (model/stress.c), and the
 * state of elements, where triangles break (model/element_state.c). */
#include "model/spring_holders.h"

#include <stdlib.h>

#include "base/status.h"
#include "lattice/lattice.h"
#include "model/spring_share.h"

dem_status spring_holders_create(spring_holders *out, const dem_lattice *lattice, const springs *s)
{
    spring_holders h = {.lattice = lattice, .springs = s};
    TRY(mesh_edges_create(&h.sides, lattice));
    h.placed = lattice_zeros(lattice->n_springs, sizeof *h.placed);
    if (h.placed == NULL) {
        spring_holders_free(&h);
        return status_fail(DEM_ERROR_MEMORY, "out of memory for %lld springs", (long long)lattice->n_springs);
    }
    *out = h;
    return DEM_OK;
}

void spring_holders_free(spring_holders *h)
{
    mesh_edges_free(&h->sides);
    free(h->placed);
    *h = (spring_holders){0};
}

/* The corner of a triangle that is neither i nor j. */
static dem_index opposite(const dem_lattice *l, dem_index triangle, dem_index i, dem_index j)
{
    const dem_index *c = &l->triangles[3 * triangle];
    return c[0] != i && c[0] != j ? c[0] : (c[1] != i && c[1] != j ? c[1] : c[2]);
}

/* The triangles of the edge in slots p to end - 1 of the sides hold the spring. While they are counted nobody asks for
 * shares, which take the most. */
static void visit_triangles(spring_holders *h, dem_index spring, dem_index p, dem_index end,
                            spring_holders_visitor *visit, void *context)
{
    const dem_lattice *l = h->lattice;
    double sum = 0.0;
    for (dem_index q = p; q < end && !h->counts; q++) sum += spring_share_given(l, h->sides.list[q].triangle, spring);
    for (dem_index q = p; q < end; q++) {
        const dem_index t = h->sides.list[q].triangle;
        visit(context, spring, t, h->counts ? 0.0 : spring_share_given(l, t, spring) / sum);
    }
    h->placed[spring] = true;
    h->n_placed++;
}

/* The spring along the edge of node i in slots p to end - 1 of the sides; or else (`along` false), where two triangles
 * meet there, the one between their outer corners. -1: there is none. */
static dem_index spring_of(const spring_holders *h, bool along, dem_index i, dem_index p, dem_index end)
{
    const mesh_edge_slot *list = h->sides.list;
    const dem_index j = list[p].upper;
    if (along) return springs_between(h->springs, i, j);
    if (end - p != 2) return -1;
    return springs_between(h->springs, opposite(h->lattice, list[p].triangle, i, j),
                           opposite(h->lattice, list[p + 1].triangle, i, j));
}

/* Goes through all edges, and visits their springs if no triangle has them yet. */
static void visit_edges(spring_holders *h, bool along, spring_holders_visitor *visit, void *context)
{
    const mesh_edges *sides = &h->sides;
    for (dem_index i = 0; i < h->lattice->n_nodes; i++)
        for (dem_index p = sides->row[i], end; p < sides->row[i + 1]; p = end) {
            for (end = p + 1; end < sides->row[i + 1] && !mesh_edges_is_first(sides, i, end);) end++;
            const dem_index spring = spring_of(h, along, i, p, end);
            if (spring >= 0 && !h->placed[spring]) visit_triangles(h, spring, p, end, visit, context);
        }
}

/* Springs along edges come first: a spring that is an edge of some triangle must not be taken for a diagonal between
 * the outer corners of two others. Most lattices have no others. */
static void visit(spring_holders *h, spring_holders_visitor *visitor, void *context)
{
    const dem_index n = h->lattice->n_springs;
    h->n_placed = 0;
    for (dem_index k = 0; k < n; k++) h->placed[k] = false;
    visit_edges(h, true, visitor, context);
    if (h->n_placed < n) visit_edges(h, false, visitor, context);
    for (dem_index k = 0; k < 2 * n && h->n_placed < n; k++)
        if (!h->placed[k / 2]) visitor(context, k / 2, -1, 0.5);
}

void spring_holders_visit(spring_holders *h, spring_holders_visitor *visitor, void *context)
{
    h->counts = false;
    visit(h, visitor, context);
}

void spring_holders_count(spring_holders *h, spring_holders_visitor *visitor, void *context)
{
    h->counts = true;
    visit(h, visitor, context);
}
