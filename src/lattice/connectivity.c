/* SPDX-License-Identifier: BSD-3-Clause */
/* Which nodes of a lattice springs join (parts), which triangles share edges (pieces), and how many boundary edges meet
 * at a node (rims). Bodies that have fallen apart, and single nodes that act as hinges, are found by them. What to do
 * with loose pieces is decided by the callers (drivers/body). */
#include "lattice/lattice.h"

#include <stdlib.h>

#include "base/status.h"
#include "base/union_find.h"
#include "lattice/mesh_edges.h"

/* n members that are all apart; NULL if there is no memory. */
static dem_index *make_parents(dem_index n)
{
    dem_index *parent = lattice_zeros(n, sizeof *parent);
    if (parent != NULL) union_find_start(parent, n);
    return parent;
}

/* Numbers parts by their lowest members. Since that is the root, part[root] is known when another member needs it.
 * \param[out] part  [n]; may be NULL */
static dem_index number_parts(dem_index *part, dem_index *parent, dem_index n)
{
    dem_index n_parts = 0;
    for (dem_index i = 0; i < n; i++) {
        const dem_index root = union_find_root(parent, i);
        if (part != NULL) part[i] = root == i ? n_parts : part[root];
        n_parts += root == i;
    }
    return n_parts;
}

/* Each spring unites the sets of its two ends. */
dem_status dem_lattice_parts(const dem_lattice *lattice, dem_index *n_parts, dem_index *part)
{
    TRY(lattice_check(lattice));
    CHECK(n_parts != NULL, DEM_ERROR_ARGUMENT, "n_parts is NULL");
    dem_index *parent = make_parents(lattice->n_nodes);
    CHECK_MEMORY(parent);
    for (dem_index k = 0; k < lattice->n_springs; k++)
        union_find_unite(parent, lattice->ends[2 * k], lattice->ends[2 * k + 1]);
    *n_parts = number_parts(part, parent, lattice->n_nodes);
    free(parent);
    return DEM_OK;
}

/* Triangles that share an edge stand next to each other in the sorted list of sides. */
dem_status dem_lattice_pieces(const dem_lattice *lattice, dem_index *n_pieces, dem_index *piece)
{
    mesh_edges s;
    TRY(lattice_check(lattice));
    CHECK(n_pieces != NULL, DEM_ERROR_ARGUMENT, "n_pieces is NULL");
    TRY(mesh_edges_create(&s, lattice));
    dem_index *parent = make_parents(lattice->n_triangles);
    /* Slots p - 1 and p are sides of one edge if p is not the first slot of its edge. */
    for (dem_index i = 0; parent != NULL && i < lattice->n_nodes; i++)
        for (dem_index p = s.row[i]; p < s.row[i + 1]; p++)
            if (!mesh_edges_is_first(&s, i, p)) union_find_unite(parent, s.list[p - 1].triangle, s.list[p].triangle);
    mesh_edges_free(&s);
    CHECK_MEMORY(parent);
    *n_pieces = number_parts(piece, parent, lattice->n_triangles);
    free(parent);
    return DEM_OK;
}

/* A node on a simple boundary has 2 boundary edges; 4 or more are those of a hinge. */
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
