/* SPDX-License-Identifier: BSD-3-Clause */
/* The sides of all triangles, sorted by their lower, then upper node: sides that are next to each other and equal are
 * one edge between two triangles, a single one is an edge of the boundary. A bucket for each lower node, sorted by
 * insertion, costs about as much as reading the triangles. What surfaces and contact make of the boundary is in
 * model/surface.c. */
#include "lattice/mesh_edges.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"

/* Insertion sort of one bucket. Equal sides keep the order of their triangles. */
static void sort_by_upper(mesh_edge_slot *list, dem_index n)
{
    for (dem_index p = 1; p < n; p++) {
        const mesh_edge_slot current = list[p];
        dem_index q = p;
        for (; q > 0 && list[q - 1].upper > current.upper; q--) list[q] = list[q - 1];
        list[q] = current;
    }
}

/* Side k of all triangles goes from corner k to the next corner of the same triangle; this returns that corner's
 * place. */
static dem_index side_end(const dem_index *corner, dem_index k)
{
    return corner[k % 3 == 2 ? k - 2 : k + 1];
}

/* Counting sort by the lower node: counts are entered two places ahead and summed up, so that row[i + 1] is where
 * bucket i goes on while it is filled, and row[i] where it begins once all are. */
static void fill(mesh_edges *s, const dem_index *corner, dem_index n_nodes, dem_index n_sides)
{
    for (dem_index k = 0; k < n_sides; k++) {
        const dem_index i = corner[k], j = side_end(corner, k);
        s->row[(i < j ? i : j) + 2]++;
    }
    for (dem_index i = 0; i <= n_nodes; i++) s->row[i + 1] += s->row[i];
    for (dem_index k = 0; k < n_sides; k++) {
        const dem_index i = corner[k], j = side_end(corner, k), lower = i < j ? i : j;
        s->list[s->row[lower + 1]++] = (mesh_edge_slot){.upper = i < j ? j : i, .triangle = k / 3};
    }
}

/* Two more entries in `row` than nodes: fill() counts two places ahead. */
dem_status mesh_edges_create(mesh_edges *out, const dem_lattice *lattice)
{
    const dem_index n = lattice->n_nodes, n_sides = 3 * lattice->n_triangles;
    mesh_edges s = {.row = calloc((size_t)n + 2, sizeof *s.row), .list = calloc((size_t)n_sides + 1, sizeof *s.list)};
    if (s.row == NULL || s.list == NULL) {
        mesh_edges_free(&s);
        return status_fail(DEM_ERROR_MEMORY, "out of memory for the sides of %lld triangles", (long long)n_sides / 3);
    }
    fill(&s, lattice->triangles, n, n_sides);
    for (dem_index i = 0; i < n; i++) sort_by_upper(s.list + s.row[i], s.row[i + 1] - s.row[i]);
    *out = s;
    return DEM_OK;
}

void mesh_edges_free(mesh_edges *s)
{
    free(s->row);
    free(s->list);
    *s = (mesh_edges){0};
}

bool mesh_edges_is_first(const mesh_edges *s, dem_index i, dem_index p)
{
    return p == s->row[i] || s->list[p].upper != s->list[p - 1].upper;
}

/* The slot is the first of its edge, and so is the one behind it. */
bool mesh_edges_is_boundary(const mesh_edges *s, dem_index i, dem_index p)
{
    return mesh_edges_is_first(s, i, p) && (p + 1 == s->row[i + 1] || mesh_edges_is_first(s, i, p + 1));
}

/* Without triangles there is no boundary, and every node may touch. */
dem_status mesh_edges_contact_flags(unsigned char *flags, const dem_lattice *lattice)
{
    const dem_index n = lattice->n_nodes;
    mesh_edges s;
    memset(flags, lattice->n_triangles > 0 ? 0 : DEM_NODE_CONTACT, (size_t)n);
    if (lattice->n_triangles == 0) return DEM_OK;
    TRY(mesh_edges_create(&s, lattice));
    for (dem_index i = 0; i < n; i++)
        for (dem_index p = s.row[i]; p < s.row[i + 1]; p++)
            if (mesh_edges_is_boundary(&s, i, p)) flags[i] = flags[s.list[p].upper] = DEM_NODE_CONTACT;
    mesh_edges_free(&s);
    return DEM_OK;
}
