/* SPDX-License-Identifier: BSD-3-Clause */
/* What ranks have of a model that they share, and what they take: the least and the most that one of them does. */
#ifndef DEM_SIMULATION_RANK_SHARES_H
#define DEM_SIMULATION_RANK_SHARES_H

#include <dem/dem.h>

enum {
    RANK_SHARES_OWN,    /* nodes */
    RANK_SHARES_GHOSTS, /* nodes */
    RANK_SHARES_COMMON, /* nodes that others own and this rank integrates too */
    RANK_SHARES_MEMORY, /* bytes that the process has had at most so far */
    RANK_SHARES_ALL
};

typedef struct rank_shares {
    double least[RANK_SHARES_ALL], most[RANK_SHARES_ALL];
} rank_shares;

/** Measures those of all ranks. Collective. */
void rank_shares_measure(rank_shares *out, const dem_simulation *part);

#endif
