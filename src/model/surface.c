/* SPDX-License-Identifier: BSD-3-Clause */
/* The surface of the bodies: nodes that may touch obstacles, and the boundary edges between them, put in order along
 * each boundary, so that contact can go from an edge to the next one. Boundary edges are the sides that only one
 * triangle has (model/mesh_boundary.c). Which obstacle feature touches which edge is the business of contact/. */
#include "model/surface.h"

#include <stdbool.h>
#include <stdlib.h>

#include "base/status.h"
#include "base/vec2.h"

/* A fixed node takes no part, as no contact could move it, nor does one of a rigid body: these meet obstacles by the
 * contact of surfaces (src/surface_contact). */
static bool node_may_touch(const dem_lattice *l, dem_index i)
{
    return (l->flags[i] & DEM_NODE_CONTACT) && !(l->flags[i] & (DEM_NODE_FIXED | DEM_NODE_RIGID));
}

/* In the order of node numbers, which is the order of candidates in contact. */
static dem_status list_nodes(surface *s, const dem_lattice *l)
{
    for (dem_index i = 0; i < l->n_nodes; i++) s->n_nodes += node_may_touch(l, i);
    s->nodes = malloc(((size_t)s->n_nodes + 1) * sizeof *s->nodes);
    CHECK(s->nodes != NULL, DEM_ERROR_MEMORY, "out of memory for %lld nodes that may touch", (long long)s->n_nodes);
    for (dem_index i = 0, n = 0; i < l->n_nodes; i++)
        if (node_may_touch(l, i)) s->nodes[n++] = i;
    return DEM_OK;
}

/* An edge touches obstacles if both its nodes may touch and one of them moves. */
static bool takes_part(const dem_lattice *l, surface_extent extent, dem_index a, dem_index b)
{
    if (extent == SURFACE_WHOLE) return true;
    return (l->flags[a] & l->flags[b] & DEM_NODE_CONTACT) &&
           !(l->flags[a] & l->flags[b] & (DEM_NODE_FIXED | DEM_NODE_RIGID));
}

/* Whether side (i, j) of the triangle runs from i to j counter-clockwise. */
static bool runs_from(const dem_index *corner, dem_index i, dem_index j)
{
    return (corner[0] == i && corner[1] == j) || (corner[1] == i && corner[2] == j) ||
           (corner[2] == i && corner[0] == j);
}

/* Boundary edges, in the order of their lower nodes, each running with the body on its left, as its triangle does.
 * \param ends  NULL: they are only counted
 * \return how many there are */
static dem_index find_edges(const dem_lattice *l, surface_extent extent, const mesh_boundary *b, dem_index *ends)
{
    dem_index n = 0;
    for (dem_index k = 0; k < b->n; k++) {
        const dem_index i = b->list[k].lower, j = b->list[k].upper;
        if (!takes_part(l, extent, i, j)) continue;
        const bool forward = runs_from(&l->triangles[3 * b->list[k].triangle], i, j);
        if (ends != NULL) {
            ends[2 * n] = forward ? i : j;
            ends[2 * n + 1] = forward ? j : i;
        }
        n++;
    }
    return n;
}

/* Lists edges by node: slots row[i] to row[i + 1] - 1 of `at`, ascending. Backwards, row[i + 1] counts down to where
 * row i begins, and is then moved to row[i]. */
static void list_by_node(surface *s, dem_index n_nodes)
{
    for (dem_index k = 0; k < 2 * s->n_edges; k++) s->row[s->ends[k] + 1]++;
    for (dem_index i = 0; i < n_nodes; i++) s->row[i + 1] += s->row[i];
    for (dem_index k = 2 * s->n_edges - 1; k >= 0; k--) s->at[--s->row[s->ends[k] + 1]] = k / 2;
    for (dem_index i = 0; i < n_nodes; i++) s->row[i] = s->row[i + 1];
    s->row[n_nodes] = (int32_t)(2 * s->n_edges);
}

/* Angle by which one turns clockwise at the end of edge e, from the way back along e to the way along edge f; in (0, 2
 * pi]. */
static double turn_at_end(const surface *s, const double *x, dem_index e, dem_index f)
{
    const vec2 at = vec2_at(x, s->ends[2 * e + 1]), back = vec2_sub(vec2_at(x, s->ends[2 * e]), at),
               on = vec2_sub(vec2_at(x, s->ends[2 * f + 1]), at);
    const double turn = -atan2(vec2_cross(back, on), vec2_dot(back, on));
    return turn > 0.0 ? turn : turn + 2.0 * acos(-1.0);
}

/* Where a boundary pinches, several edges begin at a node. Turning clockwise from the way back one goes through the
 * body, which is on the left of e: the first edge met belongs to the same fan of triangles. */
static dem_index next_of(const surface *s, const double *x, dem_index e)
{
    const dem_index node = s->ends[2 * e + 1];
    dem_index next = -1;
    for (dem_index p = s->row[node]; p < s->row[node + 1]; p++) {
        const dem_index f = s->at[p];
        if (s->ends[2 * f] == node && (next < 0 || turn_at_end(s, x, e, f) < turn_at_end(s, x, e, next))) next = f;
    }
    return next;
}

/* -1 where the neighbouring edge takes no part in contact. */
static void link_edges(surface *s, const double *x)
{
    for (dem_index e = 0; e < s->n_edges; e++) s->previous[e] = -1;
    for (dem_index e = 0; e < s->n_edges; e++) {
        s->next[e] = next_of(s, x, e);
        if (s->next[e] >= 0) s->previous[s->next[e]] = e;
    }
}

/* Writes the edges in the order of a walk: open chains from where they begin in the first half of the loop, then closed
 * ones from their lowest edge. */
static void walk(const surface *s, unsigned char *walked, dem_index *ends)
{
    dem_index n = 0;
    for (dem_index k = 0; k < 2 * s->n_edges; k++) {
        /* In the first half of the loop edges with a predecessor are passed over. */
        const dem_index start = k % s->n_edges;
        if (k < s->n_edges && s->previous[start] >= 0) continue;
        for (dem_index e = start; e >= 0 && !walked[e]; e = s->next[e]) {
            walked[e] = 1;
            ends[2 * n] = s->ends[2 * e];
            ends[2 * n + 1] = s->ends[2 * e + 1];
            n++;
        }
    }
}

/* Links are needed to find the order, and are made anew in it. */
static dem_status sort_edges(surface *s, const dem_lattice *l)
{
    unsigned char *walked = calloc((size_t)s->n_edges + 1, 1);
    dem_index *ends = malloc((2 * (size_t)s->n_edges + 1) * sizeof *ends);
    if (walked == NULL || ends == NULL) {
        free(walked);
        free(ends);
        return status_fail(DEM_ERROR_MEMORY, "out of memory for %lld boundary edges", (long long)s->n_edges);
    }
    list_by_node(s, l->n_nodes);
    link_edges(s, l->x);
    walk(s, walked, ends);
    free(walked);
    free(s->ends);
    s->ends = ends;
    for (dem_index i = 0; i <= l->n_nodes; i++) s->row[i] = 0;
    list_by_node(s, l->n_nodes);
    link_edges(s, l->x);
    return DEM_OK;
}

static dem_status allocate(surface *s, const dem_lattice *l)
{
    const size_t n = (size_t)s->n_edges;
    s->ends = malloc((2 * n + 1) * sizeof *s->ends);
    s->at = malloc((2 * n + 1) * sizeof *s->at);
    s->next = malloc((n + 1) * sizeof *s->next);
    s->previous = malloc((n + 1) * sizeof *s->previous);
    s->row = calloc((size_t)l->n_nodes + 1, sizeof *s->row);
    CHECK(s->ends && s->at && s->next && s->previous && s->row, DEM_ERROR_MEMORY,
          "out of memory for %lld boundary edges", (long long)s->n_edges);
    return DEM_OK;
}

/* Edges are counted, then listed, then put in order. */
dem_status surface_compile_boundary(surface *out, const dem_lattice *lattice, const mesh_boundary *boundary,
                                    surface_extent extent)
{
    surface s = {.n_edges = find_edges(lattice, extent, boundary, NULL)};
    dem_status status = list_nodes(&s, lattice);
    if (status == DEM_OK) status = allocate(&s, lattice);
    if (status == DEM_OK) {
        (void)find_edges(lattice, extent, boundary, s.ends);
        status = sort_edges(&s, lattice);
    }
    if (status == DEM_OK)
        *out = s;
    else
        surface_free(&s);
    return status;
}

dem_status surface_compile(surface *out, const dem_lattice *lattice, surface_extent extent)
{
    mesh_boundary boundary;
    TRY(mesh_boundary_create(&boundary, lattice, NULL));
    const dem_status status = surface_compile_boundary(out, lattice, &boundary, extent);
    mesh_boundary_free(&boundary);
    return status;
}

/* ---- where triangles are broken ---- */

enum { IS_OUTER = 1, HAS_TRIANGLES = 2, HAD_TRIANGLES = 4 };

/* What was inside, and now is on the boundary or has lost all of its triangles. Without triangles in the lattice every
 * node may touch from the start. */
static bool is_exposed(const mesh_boundary *b, unsigned char marks, dem_index node)
{
    return (marks & HAD_TRIANGLES) && !b->outer[node] && ((marks & IS_OUTER) || !(marks & HAS_TRIANGLES));
}

static void mark_triangles(const dem_lattice *l, const unsigned char *broken, unsigned char *marks)
{
    for (dem_index t = 0; t < l->n_triangles; t++) {
        const unsigned char bits = broken[t] ? HAD_TRIANGLES : HAD_TRIANGLES | HAS_TRIANGLES;
        for (int c = 0; c < 3; c++) marks[l->triangles[3 * t + c]] |= bits;
    }
}

/* Flags of the nodes as they are now, of which `flags` has the marks first. */
static void fill_flags(unsigned char *flags, const mesh_boundary *b, const unsigned char *broken,
                       const unsigned char *excluded)
{
    const dem_lattice *l = b->lattice;
    mark_triangles(l, broken, flags);
    mesh_boundary_mark(b, flags, IS_OUTER);
    for (dem_index i = 0; i < l->n_nodes; i++) {
        const bool may_touch = is_exposed(b, flags[i], i) && (excluded == NULL || !excluded[i]);
        flags[i] = may_touch ? l->flags[i] | DEM_NODE_CONTACT : l->flags[i];
    }
}

dem_status surface_compile_broken(surface *out, const mesh_boundary *boundary, const unsigned char *broken,
                                  const unsigned char *excluded)
{
    dem_lattice now = *boundary->lattice;
    now.flags = calloc((size_t)now.n_nodes, 1);
    CHECK(now.flags != NULL, DEM_ERROR_MEMORY, "out of memory for the boundary of %lld nodes", (long long)now.n_nodes);
    fill_flags(now.flags, boundary, broken, excluded);
    const dem_status status = surface_compile_boundary(out, &now, boundary, SURFACE_TOUCHING);
    free(now.flags);
    return status;
}

void surface_free(surface *s)
{
    free(s->nodes);
    free(s->ends);
    free(s->row);
    free(s->at);
    free(s->next);
    free(s->previous);
    *s = (surface){0};
}
