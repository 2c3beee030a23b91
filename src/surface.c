/* SPDX-License-Identifier: BSD-3-Clause */
/* Sides of one triangle only, walked along each boundary. */
#include "surface.h"

#include <stdlib.h>

#include "sides.h"
#include "status.h"

/* An edge may be touched if both its nodes may and one of them moves. */
static bool may_touch(const dem_lattice *l, dem_index a, dem_index b)
{
    return (l->flags[a] & l->flags[b] & DEM_NODE_CONTACT) && !(l->flags[a] & l->flags[b] & DEM_NODE_FIXED);
}

/* Whether side (i, j) of the triangle runs from i to j counter-clockwise. */
static bool runs_from(const dem_index *corner, dem_index i, dem_index j)
{
    return (corner[0] == i && corner[1] == j) || (corner[1] == i && corner[2] == j) ||
           (corner[2] == i && corner[0] == j);
}

/* Boundary edges from start to end, in the order of their lower nodes, into ends; returns how many. */
static dem_index find_edges(const dem_lattice *l, const sides *list, dem_index *ends)
{
    dem_index n = 0;
    for (dem_index i = 0; i < l->n_nodes; i++)
        for (dem_index p = list->row[i]; p < list->row[i + 1]; p++) {
            const dem_index j = list->list[p].upper;
            const bool last = p + 1 == list->row[i + 1] || sides_edge_begins(list, i, p + 1);
            if (!sides_edge_begins(list, i, p) || !last || !may_touch(l, i, j)) continue;
            const bool forward = runs_from(&l->triangles[3 * list->list[p].triangle], i, j);
            ends[2 * n] = forward ? i : j;
            ends[2 * n + 1] = forward ? j : i;
            n++;
        }
    return n;
}

/* Edges listed by node: row[i] .. row[i+1]-1 of `at`. */
static void list_by_node(surface *s, dem_index n_nodes)
{
    for (dem_index k = 0; k < 2 * s->n_edges; k++) s->row[s->ends[k] + 1]++;
    for (dem_index i = 0; i < n_nodes; i++) s->row[i + 1] += s->row[i];
    for (dem_index k = 2 * s->n_edges - 1; k >= 0; k--) s->at[--s->row[s->ends[k] + 1]] = k / 2;
    for (dem_index i = 0; i < n_nodes; i++) s->row[i] = s->row[i + 1];
    s->row[n_nodes] = 2 * s->n_edges;
}

/* The first edge not yet walked that starts at the node, or -1. */
static dem_index next_edge(const surface *s, const unsigned char *walked, dem_index node)
{
    for (dem_index p = s->row[node]; p < s->row[node + 1]; p++)
        if (!walked[s->at[p]] && s->ends[2 * s->at[p]] == node) return s->at[p];
    return -1;
}

/* Whether an edge ends where this one starts. */
static bool has_previous(const surface *s, dem_index edge)
{
    const dem_index node = s->ends[2 * edge];
    for (dem_index p = s->row[node]; p < s->row[node + 1]; p++)
        if (s->ends[2 * s->at[p] + 1] == node) return true;
    return false;
}

static void walk(const surface *s, unsigned char *walked, dem_index *ends)
{
    dem_index n = 0;
    for (dem_index k = 0; k < 2 * s->n_edges; k++) { /* open chains from where they begin, then closed ones */
        const dem_index start = k % s->n_edges;
        if (walked[start] || (k < s->n_edges && has_previous(s, start))) continue;
        for (dem_index e = start; e >= 0; e = next_edge(s, walked, s->ends[2 * e + 1])) {
            walked[e] = 1;
            ends[2 * n] = s->ends[2 * e];
            ends[2 * n + 1] = s->ends[2 * e + 1];
            n++;
        }
    }
}

/* Puts the edges in the order of a walk along each boundary. */
static dem_status sort_edges(surface *s, dem_index n_nodes)
{
    unsigned char *walked = calloc((size_t)s->n_edges + 1, 1);
    dem_index *ends = malloc((2 * (size_t)s->n_edges + 1) * sizeof *ends);
    if (walked == NULL || ends == NULL) {
        free(walked);
        free(ends);
        return status_fail(DEM_ERROR_MEMORY, "out of memory for %lld boundary edges", (long long)s->n_edges);
    }
    list_by_node(s, n_nodes);
    walk(s, walked, ends);
    free(walked);
    free(s->ends);
    s->ends = ends;
    for (dem_index i = 0; i <= n_nodes; i++) s->row[i] = 0;
    list_by_node(s, n_nodes);
    return DEM_OK;
}

static dem_status allocate(surface *s, const dem_lattice *l)
{
    const size_t most = 6 * (size_t)l->n_triangles + 1;
    s->ends = malloc(most * sizeof *s->ends);
    s->at = malloc(most * sizeof *s->at);
    s->row = calloc((size_t)l->n_nodes + 1, sizeof *s->row);
    CHECK(s->ends && s->at && s->row, DEM_ERROR_MEMORY, "out of memory for the boundary of %lld triangles",
          (long long)l->n_triangles);
    return DEM_OK;
}

dem_status surface_compile(surface *out, const dem_lattice *lattice)
{
    surface s = {0};
    sides list = {0};
    dem_status status = allocate(&s, lattice);
    if (status == DEM_OK && lattice->n_triangles > 0) {
        status = sides_create(&list, lattice);
        if (status == DEM_OK) s.n_edges = find_edges(lattice, &list, s.ends);
        if (status == DEM_OK) status = sort_edges(&s, lattice->n_nodes);
        sides_free(&list);
    }
    if (status == DEM_OK)
        *out = s;
    else
        surface_free(&s);
    return status;
}

void surface_free(surface *s)
{
    free(s->ends);
    free(s->row);
    free(s->at);
    *s = (surface){0};
}
