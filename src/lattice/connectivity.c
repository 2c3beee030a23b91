/* SPDX-License-Identifier: BSD-3-Clause */
/* Which nodes and triangles of a lattice hang together, and how many boundary edges meet at a node. */
#include "lattice/lattice.h"

#include <stdlib.h>

#include "base/status.h"
#include "lattice/mesh_edges.h"

static dem_index root_of(dem_index *parent, dem_index i)
{
    while (parent[i] != i) {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    return i;
}

/* A part's root is its lowest node. */
static void unite(dem_index *parent, dem_index i, dem_index j)
{
    const dem_index a = root_of(parent, i), b = root_of(parent, j);
    if (a < b)
        parent[b] = a;
    else
        parent[a] = b;
}

/* n things that are all apart; NULL without memory. */
static dem_index *make_parents(dem_index n)
{
    dem_index *parent = lattice_zeros(n, sizeof *parent);
    for (dem_index i = 0; parent != NULL && i < n; i++) parent[i] = i;
    return parent;
}

/* Numbers parts by their lowest members. \param[out] part  [n]; may be NULL */
static dem_index number_parts(dem_index *part, dem_index *parent, dem_index n)
{
    dem_index n_parts = 0;
    for (dem_index i = 0; i < n; i++) {
        const dem_index root = root_of(parent, i);
        if (part != NULL) part[i] = root == i ? n_parts : part[root];
        n_parts += root == i;
    }
    return n_parts;
}

dem_status dem_lattice_parts(const dem_lattice *lattice, dem_index *n_parts, dem_index *part)
{
    TRY(lattice_check(lattice));
    CHECK(n_parts != NULL, DEM_ERROR_ARGUMENT, "n_parts is NULL");
    dem_index *parent = make_parents(lattice->n_nodes);
    CHECK_MEMORY(parent);
    for (dem_index k = 0; k < lattice->n_springs; k++) unite(parent, lattice->ends[2 * k], lattice->ends[2 * k + 1]);
    *n_parts = number_parts(part, parent, lattice->n_nodes);
    free(parent);
    return DEM_OK;
}

dem_status dem_lattice_pieces(const dem_lattice *lattice, dem_index *n_pieces, dem_index *piece)
{
    mesh_edges s;
    TRY(lattice_check(lattice));
    CHECK(n_pieces != NULL, DEM_ERROR_ARGUMENT, "n_pieces is NULL");
    TRY(mesh_edges_create(&s, lattice));
    dem_index *parent = make_parents(lattice->n_triangles);
    for (dem_index i = 0; parent != NULL && i < lattice->n_nodes; i++)
        for (dem_index p = s.row[i]; p < s.row[i + 1]; p++)
            if (!mesh_edges_is_first(&s, i, p)) unite(parent, s.list[p - 1].triangle, s.list[p].triangle);
    mesh_edges_free(&s);
    CHECK_MEMORY(parent);
    *n_pieces = number_parts(piece, parent, lattice->n_triangles);
    free(parent);
    return DEM_OK;
}

dem_status dem_lattice_rims(const dem_lattice *lattice, dem_index *n_edges)
{
    mesh_edges s;
    TRY(lattice_check(lattice));
    CHECK(n_edges != NULL, DEM_ERROR_ARGUMENT, "n_edges is NULL");
    TRY(mesh_edges_create(&s, lattice));
    for (dem_index i = 0; i < lattice->n_nodes; i++) n_edges[i] = 0;
    for (dem_index i = 0; i < lattice->n_nodes; i++)
        for (dem_index p = s.row[i]; p < s.row[i + 1]; p++) {
            if (!mesh_edges_is_boundary(&s, i, p)) continue;
            n_edges[i]++;
            n_edges[s.list[p].upper]++;
        }
    mesh_edges_free(&s);
    return DEM_OK;
}
