/* SPDX-License-Identifier: BSD-3-Clause */
#include "simulation/rank_shares.h"

#include <sys/resource.h>

#include "simulation/private.h"

/* The system counts in units of 1024 bytes. */
static double memory_of_process(void)
{
    struct rusage used;
    return getrusage(RUSAGE_SELF, &used) == 0 ? 1024.0 * (double)used.ru_maxrss : 0.0;
}

static void join(void *packet, const void *other)
{
    rank_shares *own = packet;
    const rank_shares *theirs = other;
    for (int k = 0; k < RANK_SHARES_ALL; k++) {
        own->least[k] = fmin(own->least[k], theirs->least[k]);
        own->most[k] = fmax(own->most[k], theirs->most[k]);
    }
}

void rank_shares_measure(rank_shares *out, const dem_simulation *part)
{
    const ranks *r = part->model->ranks;
    const domain *d = part->model->domain;
    double own[RANK_SHARES_ALL] = {[RANK_SHARES_MEMORY] = memory_of_process()};
    for (dem_index i = 0; i < d->n_nodes; i++) {
        own[RANK_SHARES_OWN] += d->is_own[i] != 0;
        own[RANK_SHARES_GHOSTS] += d->is_ghost[i] != 0;
        own[RANK_SHARES_COMMON] += !d->is_own[i] && !d->is_ghost[i];
    }
    for (int k = 0; k < RANK_SHARES_ALL; k++) out->least[k] = out->most[k] = own[k];
    r->reduce(r->self, out, sizeof *out, join);
}
