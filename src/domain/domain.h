/* SPDX-License-Identifier: BSD-3-Clause */
/* The nodes of a lattice that one rank has: its own ones; common ones (domain/common_nodes.h), which it integrates too,
 * whoever owns them; and as ghosts those of other ranks that are next to one of these, by a spring or a triangle, or in
 * further rings next to ghosts. All stand together in ascending order of their numbers in the whole lattice, so that
 * whatever goes by the order of nodes, springs or triangles has the order of the whole. */
#ifndef DEM_DOMAIN_DOMAIN_H
#define DEM_DOMAIN_DOMAIN_H

#include <stdbool.h>

#include <dem/dem.h>

#include "domain/domain_lists.h"

/** Another rank that has ghosts of own nodes, or own nodes that are ghosts here. */
typedef struct domain_neighbour {
    int rank;
    dem_index n_sent, n_received;
    dem_index *sent;     /* [n_sent] own nodes that are ghosts there, ascending */
    dem_index *received; /* [n_received] ghosts that are its own nodes, ascending */
} domain_neighbour;

typedef struct domain {
    dem_index n_nodes, n_whole;       /* of the domain, and of the whole lattice */
    dem_index *number;                /* [n_nodes] in the whole lattice, ascending */
    dem_index n_springs, n_triangles; /* of the whole lattice, and */
    dem_index n_surface_nodes;        /* that may touch obstacles */
    dem_index *spring;                /* [springs of the domain] their numbers in the whole lattice, ascending; */
    dem_index *triangle;              /* [triangles of the domain] likewise */
    unsigned char *is_own;            /* [n_nodes] 1: an own node, which counts here */
    unsigned char *is_ghost;          /* [n_nodes] 1: what it does comes from its owner; else it is integrated here */
    unsigned char *is_common;         /* [n_nodes] 1: it is integrated by all ranks */
    unsigned char *is_outer;          /* [n_nodes] 1: a ghost of the last ring: some of its neighbours are not here */
    dem_index *joined;    /* [n_nodes] where something may break: the lowest of the nodes, by the numbers of the
                                 whole, that are joined to it whatever breaks (model/joined_nodes.h); or NULL */
    dem_index *joined_to; /* [n_nodes] likewise: the lowest one of the domain that has the same `joined` */
    dem_index n_boundary;
    dem_index *boundary; /* [n_boundary] nodes integrated here on the boundary of the whole triangulation, ascending */
    int n_rings;         /* of ghosts */
    int n_neighbours;
    domain_neighbour *neighbours; /* [n_neighbours] by rank */
} domain;

/** Finds the domain of a rank in a lattice whose node numbers are known to be valid. Free with domain_free().
 *  \return DEM_ERROR_MODEL if the rank owns no node, DEM_ERROR_MEMORY */
dem_status domain_create(domain *out, const dem_lattice *whole, const domain_shares *shares, int rank);

/** The same where the lists of all ranks are known, in a time that does not depend on the whole. */
dem_status domain_create_within(domain *out, domain_lists *lists, int rank);
void domain_free(domain *d);

/** The number in the domain of a node that is integrated here, of this number in the whole lattice; -1: it is not. NULL
 *  stands for the whole lattice. */
dem_index domain_node(const domain *d, dem_index number);

/** Whether a node of the domain counts here. */
static inline bool domain_owns(const domain *d, dem_index i)
{
    return d == NULL || d->is_own[i];
}

/** The lowest of the n nodes of a spring or a triangle: it counts where that one does. */
static inline dem_index domain_lowest(const dem_index *nodes, int n)
{
    dem_index lowest = nodes[0];
    for (int k = 1; k < n; k++) lowest = nodes[k] < lowest ? nodes[k] : lowest;
    return lowest;
}

/** The nodes from `first` to *end - 1, of n, are all own ones, or none is. NULL stands for the whole lattice.
 *  \return whether they are own ones */
static inline bool domain_run(const domain *d, dem_index first, dem_index n, dem_index *end)
{
    *end = n;
    if (d == NULL) return true;
    for (*end = first + 1; *end < n && d->is_own[*end] == d->is_own[first];) ++*end;
    return d->is_own[first] != 0;
}

/** The number in the whole lattice of node i, spring k, triangle t. */
static inline dem_index domain_number(const domain *d, dem_index i)
{
    return d != NULL ? d->number[i] : i;
}

static inline dem_index domain_spring(const domain *d, dem_index k)
{
    return d != NULL ? d->spring[k] : k;
}

static inline dem_index domain_triangle(const domain *d, dem_index t)
{
    return d != NULL ? d->triangle[t] : t;
}

#endif
