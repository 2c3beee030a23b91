/* SPDX-License-Identifier: BSD-3-Clause */
/* A triangle that breaks changes its own sides only: one that it had alone leaves the boundary, and one that it had
 * with another comes to it, with that one. So these sides are looked at anew, and merged into the list. */
#include "model/mesh_boundary.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"
#include "lattice/mesh_edges.h"

void mesh_boundary_free(mesh_boundary *b)
{
    free(b->list);
    free(b->outer);
    *b = (mesh_boundary){0};
}

void mesh_boundary_mark(const mesh_boundary *b, unsigned char *flags, unsigned char bits)
{
    for (dem_index k = 0; k < b->n; k++) {
        flags[b->list[k].lower] |= bits;
        flags[b->list[k].upper] |= bits;
    }
}

/* ---- from all triangles ---- */

/* The whole triangle that has the edge in slots p to end - 1 alone; -1: none, or more than one. */
static dem_index only_one(const mesh_edges *sides, dem_index p, dem_index end, const unsigned char *broken)
{
    dem_index found = -1, n = 0;
    for (; p < end; p++) {
        const dem_index t = sides->list[p].triangle;
        if (broken != NULL && broken[t]) continue;
        found = t;
        n++;
    }
    return n == 1 ? found : -1;
}

/* Lists the boundary, or only counts it where there is no list. */
static dem_index list_edges(const mesh_edges *sides, dem_index n_nodes, const unsigned char *broken,
                            mesh_boundary_edge *list)
{
    dem_index n = 0;
    for (dem_index i = 0; i < n_nodes; i++)
        for (dem_index p = sides->row[i], end; p < sides->row[i + 1]; p = end) {
            for (end = p + 1; end < sides->row[i + 1] && !mesh_edges_is_first(sides, i, end);) end++;
            const dem_index triangle = only_one(sides, p, end, broken);
            if (triangle < 0) continue;
            if (list != NULL) list[n] = (mesh_boundary_edge){i, sides->list[p].upper, triangle};
            n++;
        }
    return n;
}

static dem_status find(mesh_boundary *b, const mesh_edges *sides, const unsigned char *broken)
{
    const dem_lattice *l = b->lattice;
    b->n = list_edges(sides, l->n_nodes, broken, NULL);
    b->list = malloc(((size_t)b->n + 1) * sizeof *b->list);
    b->outer = calloc((size_t)l->n_nodes + 1, 1);
    CHECK(b->list && b->outer, DEM_ERROR_MEMORY, "out of memory for %lld boundary edges", (long long)b->n);
    (void)list_edges(sides, l->n_nodes, broken, b->list);
    for (dem_index i = 0; i < l->n_nodes; i++)
        for (dem_index p = sides->row[i]; p < sides->row[i + 1]; p++)
            if (mesh_edges_is_boundary(sides, i, p)) b->outer[i] = b->outer[sides->list[p].upper] = 1;
    return DEM_OK;
}

dem_status mesh_boundary_create(mesh_boundary *out, const dem_lattice *lattice, const unsigned char *broken)
{
    mesh_boundary b = {.lattice = lattice};
    mesh_edges sides;
    TRY(mesh_edges_create(&sides, lattice));
    const dem_status status = find(&b, &sides, broken);
    mesh_edges_free(&sides);
    if (status == DEM_OK)
        *out = b;
    else
        mesh_boundary_free(&b);
    return status;
}

dem_status mesh_boundary_mark_nodes(const dem_lattice *lattice, unsigned char *flags, unsigned char bits)
{
    mesh_boundary b;
    TRY(mesh_boundary_create(&b, lattice, NULL));
    mesh_boundary_mark(&b, flags, bits);
    mesh_boundary_free(&b);
    return DEM_OK;
}

/* ---- from an earlier one ---- */

static int compare(const void *a, const void *b)
{
    const mesh_boundary_edge *first = a, *second = b;
    if (first->lower != second->lower) return first->lower < second->lower ? -1 : 1;
    return (first->upper > second->upper) - (first->upper < second->upper);
}

/* The whole triangle that has a side alone; -1: none, or more than one. */
static dem_index find_holder(const element_state *s, dem_index lower, dem_index upper)
{
    dem_index found = -1, n = 0;
    for (dem_index p = s->at_row[lower]; p < s->at_row[lower + 1]; p++) {
        const dem_index t = s->at[p];
        if (s->triangle[t] || !element_state_is_corner(s, t, upper)) continue;
        found = t;
        n++;
    }
    return n == 1 ? found : -1;
}

/* The sides of the triangles of a list in order, each once, as they are now.  \return how many there are */
static dem_index list_sides(const element_state *s, const dem_index *list, dem_index n, mesh_boundary_edge *sides)
{
    const dem_lattice *l = s->lattice;
    dem_index n_sides = 0, kept = 0;
    for (dem_index k = 0; k < n; k++)
        for (int c = 0; c < 3 && list[k] < l->n_triangles; c++) {
            const dem_index i = l->triangles[3 * list[k] + c], j = l->triangles[3 * list[k] + (c + 1) % 3];
            sides[n_sides++] = (mesh_boundary_edge){i < j ? i : j, i < j ? j : i, -1};
        }
    if (n_sides > 0) qsort(sides, (size_t)n_sides, sizeof *sides, compare);
    for (dem_index k = 0; k < n_sides; k++)
        if (kept == 0 || compare(&sides[k], &sides[kept - 1]) != 0) sides[kept++] = sides[k];
    for (dem_index k = 0; k < kept; k++) sides[k].triangle = find_holder(s, sides[k].lower, sides[k].upper);
    return kept;
}

/* What the sides say takes the place of what was there. */
static void merge(mesh_boundary *b, const mesh_boundary *before, const mesh_boundary_edge *sides, dem_index n_sides)
{
    dem_index k = 0;
    for (dem_index p = 0; p < n_sides; p++) {
        while (k < before->n && compare(&before->list[k], &sides[p]) < 0) b->list[b->n++] = before->list[k++];
        if (k < before->n && compare(&before->list[k], &sides[p]) == 0) k++;
        if (sides[p].triangle >= 0) b->list[b->n++] = sides[p];
    }
    memcpy(b->list + b->n, before->list + k, (size_t)(before->n - k) * sizeof *b->list);
    b->n += before->n - k;
}

dem_status mesh_boundary_follow(mesh_boundary *out, const mesh_boundary *before, const element_state *state,
                                const dem_index *list, dem_index n)
{
    const size_t n_nodes = (size_t)before->lattice->n_nodes;
    mesh_boundary b = {.lattice = before->lattice};
    mesh_boundary_edge *sides = malloc((3 * (size_t)n + 1) * sizeof *sides);
    b.list = malloc(((size_t)before->n + 3 * (size_t)n + 1) * sizeof *b.list);
    b.outer = malloc(n_nodes + 1);
    if (sides != NULL && b.list != NULL && b.outer != NULL) {
        merge(&b, before, sides, list_sides(state, list, n, sides));
        memcpy(b.outer, before->outer, n_nodes);
        *out = b;
        free(sides);
        return DEM_OK;
    }
    free(sides);
    mesh_boundary_free(&b);
    return status_fail(DEM_ERROR_MEMORY, "out of memory for %lld boundary edges", (long long)before->n);
}
