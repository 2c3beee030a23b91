/* SPDX-License-Identifier: BSD-3-Clause */
/* Whether nodes are to be shared out among ranks anew, as one of them works longer than others, which wait for it; and
 * what nodes weigh then. Who owns which node has no part in any result (docs/algorithms.md, Ranks). */
#ifndef DEM_DOMAIN_BALANCE_H
#define DEM_DOMAIN_BALANCE_H

#include <stdbool.h>

#include <dem/dem.h>

#include "base/ranks.h"

typedef struct balance {
    double *weights; /* [nodes] s of work for each node of the whole; NULL: all weigh the same */
    int n_shared;    /* how often nodes have been shared out, */
    double price;    /* s, and what the last time took */
    int n_ranks;
    double *busy;                      /* [n_ranks] s, of each rank since then */
    dem_index *n_own, *n_start;        /* [n_ranks] nodes of each, now and at first; 0: not known yet */
    ranks_message *reports, *requests; /* [n_ranks - 1] from and to other ranks */
} balance;

/** On rank 0; on other ranks it stays empty. Free with balance_free(), after a failure, too.
 *  \return DEM_ERROR_MEMORY */
dem_status balance_create(balance *b, int n_ranks);
void balance_free(balance *b);

/** Nodes have been shared out by the weights, in so many seconds. */
void balance_begin(balance *b, double price);

/** They have been by the same weights as before, in so many seconds. */
void balance_go_on(balance *b, double price);

/** Tells rank 0 how long each rank has worked since then. Collective.
 *  \param own  s, of this rank */
void balance_collect(balance *b, const ranks *r, double own);

/** Tells rank 0 how many nodes each rank has. Collective. */
void balance_count(balance *b, const ranks *r, dem_index own);

/** Whether it pays to share nodes out anew. What ranks have waited for the busiest one, in the mean, has to be more
 *  than the last time took, twice as much after every further time, and more than a twentieth of the work: so a
 *  difference that no partition removes costs little. */
bool balance_pays(const balance *b);

/** Gives the nodes of each rank equal parts of its work as their weights.  \return DEM_ERROR_MEMORY; the weights stay
 *  what they were then */
dem_status balance_weigh(balance *b, const dem_lattice *whole);

/** Cuts the nodes, which ranks have in their order, into ranges with equal parts of the work, as far as no rank gets
 *  more than 1.25 times as many as at first, for the sake of its memory, and none less than a quarter.
 *  \param[out] first  [n_ranks + 1] from 0 to the number of nodes */
void balance_cut(const balance *b, dem_index *first);

/** The ranges that there are. */
void balance_ranges(const balance *b, dem_index *first);

#endif
