/* SPDX-License-Identifier: BSD-3-Clause */
/* Nodes and ghosts by rank: what makes up a domain is found in them without a look at the rest of the lattice, however
 * many ranks there are. */
#ifndef DEM_DOMAIN_DOMAIN_LISTS_H
#define DEM_DOMAIN_DOMAIN_LISTS_H

#include "domain/ghost_rings.h"

/** Numbers by rank, ascending within a row. */
typedef struct rank_lists {
    dem_index *row; /* [n_ranks + 1] slots row[r] .. row[r + 1] - 1 of a rank */
    dem_index *list;
} rank_lists;

typedef struct domain_lists {
    const domain_shares *shares; /* borrowed */
    dem_index n_whole;           /* nodes */
    ghost_rings rings;           /* ghosts of all ranks */
    rank_lists own;              /* nodes by their owners */
    rank_lists ghosts;           /* places in rings.list by the ranks that have them, */
    rank_lists lent;             /* and by the owners of their nodes */
    dem_index n_common;
    dem_index *common; /* [n_common] nodes, ascending */
    dem_index *local;  /* [n_whole] -1, but for the nodes of a part in hand (domain_lists_number) */
} domain_lists;

/** Finds them. Free with domain_lists_free(), after a failure, too.  \return DEM_ERROR_MEMORY */
dem_status domain_lists_create(domain_lists *out, const dem_lattice *whole, const domain_shares *shares);
void domain_lists_free(domain_lists *l);

/** Lists the nodes that a rank integrates, and its ghosts, ascending, each once.
 *  \param[out] node  [n] to be freed with free()  \return DEM_ERROR_MEMORY */
dem_status domain_lists_nodes(const domain_lists *l, int rank, dem_index **node, dem_index *n);

/** Numbers the n nodes of a list from 0 on in `local`, or takes these numbers back. */
void domain_lists_number(domain_lists *l, const dem_index *node, dem_index n);
void domain_lists_forget(domain_lists *l, const dem_index *node, dem_index n);

#endif
