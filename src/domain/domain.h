/* SPDX-License-Identifier: BSD-3-Clause */
/* The nodes of a lattice that one rank has: its own ones, and as ghosts those of other ranks that are next to one of
 * these, by a spring or a triangle. Both stand together in ascending order of their numbers in the whole lattice, so
 * that whatever goes by the order of nodes, springs or triangles has the order of the whole. */
#ifndef DEM_DOMAIN_DOMAIN_H
#define DEM_DOMAIN_DOMAIN_H

#include <stdbool.h>

#include <dem/dem.h>

/** Another rank that has ghosts of own nodes; it has own nodes that are ghosts here, too. */
typedef struct domain_neighbour {
    int rank;
    dem_index n_sent, n_received;
    dem_index *sent;     /* [n_sent] own nodes that are ghosts there, ascending */
    dem_index *received; /* [n_received] ghosts that are its own nodes, ascending */
} domain_neighbour;

typedef struct domain {
    dem_index n_nodes, n_whole;                 /* of the domain, and of the whole lattice */
    dem_index *number;                          /* [n_nodes] in the whole lattice, ascending */
    dem_index n_springs, n_triangles;           /* of the whole lattice, and */
    dem_index n_surface_nodes, n_surface_edges; /* that may touch obstacles */
    dem_index *spring;     /* [springs of the domain] their numbers in the whole lattice, ascending */
    unsigned char *is_own; /* [n_nodes] 0: a ghost */
    int n_neighbours;
    domain_neighbour *neighbours; /* [n_neighbours] by rank */
} domain;

/** Finds the domain of a rank in a lattice whose node numbers are known to be valid. Free with domain_free().
 *  \param owner  [n_nodes] the rank of each node
 *  \return DEM_ERROR_MODEL if the rank owns no node, DEM_ERROR_MEMORY */
dem_status domain_create(domain *out, const dem_lattice *whole, const int32_t *owner, int rank);
void domain_free(domain *d);

/** The number in the domain of an own node of this number in the whole lattice; -1: it is not an own one. NULL stands
 *  for the whole lattice. */
dem_index domain_own_node(const domain *d, dem_index number);

/** The nodes from `first` to *end - 1, of n, are all own ones, or all ghosts. NULL stands for the whole lattice.
 *  \return whether they are own ones */
static inline bool domain_run(const domain *d, dem_index first, dem_index n, dem_index *end)
{
    *end = n;
    if (d == NULL) return true;
    for (*end = first + 1; *end < n && d->is_own[*end] == d->is_own[first];) ++*end;
    return d->is_own[first] != 0;
}

/** The number in the whole lattice of node i. */
static inline dem_index domain_number(const domain *d, dem_index i)
{
    return d != NULL ? d->number[i] : i;
}

#endif
