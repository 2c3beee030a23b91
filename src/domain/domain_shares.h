/* SPDX-License-Identifier: BSD-3-Clause */
/* How the nodes of a lattice are shared out among ranks. */
#ifndef DEM_DOMAIN_DOMAIN_SHARES_H
#define DEM_DOMAIN_DOMAIN_SHARES_H

#include <stdbool.h>

#include <dem/dem.h>

#include "base/ranks.h"

typedef struct domain_shares {
    int n_ranks;
    const int32_t *owner;           /* [n_nodes] the rank of each node */
    const unsigned char *is_common; /* [n_nodes] not 0: all ranks integrate it; NULL: none is */
    int n_rings;                    /* of ghosts, at most; 0: one */
    int least_rings;                /* where fewer have a place there is one */
    dem_index most_ghosts;          /* of all ranks together, in as many rings as have no more */
    const ranks *counting;          /* NULL: the lattice is the whole; else it is a part, with the ghosts of all ranks
                                       among the own nodes of this one, and ranks count them together */
} domain_shares;

/** Whether all ranks integrate node i of the lattice. */
static inline bool domain_shares_have_all(const domain_shares *s, dem_index i)
{
    return s->is_common != NULL && s->is_common[i];
}

/** Whether a rank integrates node i of the lattice always. */
static inline bool domain_shares_have(const domain_shares *s, int rank, dem_index i)
{
    return s->owner[i] == rank || domain_shares_have_all(s, i);
}

#endif
