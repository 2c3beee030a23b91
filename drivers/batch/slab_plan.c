/* SPDX-License-Identifier: BSD-3-Clause */
#include "slab_plan.h"

#include <math.h>
#include <stdlib.h>

#include "copies.h"
#include "rank_group.h"

static const dem_index of_look = 65536;  /* nodes of slabs of files, a piece of which has as many rows */
static const double most_bodies = 100.0; /* of c->slab_nodes: smaller ones are mostly surface, which all ranks have */

/* Bodies that are large enough, so that a rank has a share of them alone. */
void slab_plan_decide(deck *d, const command *c, double nodes)
{
    const double each = nodes / (double)copies_total(&d->groups);
    const bool large = nodes >= c->slab_nodes && most_bodies * each >= c->slab_nodes;
    if (c->ranks != NULL && c->ranks->size > 1 && large && deck_slabs_suit(&d->groups)) d->slabs.n = c->ranks->size;
    d->slabs.least = of_look;
}

/* Of a large body a rank takes up to 1.23 times its share, with common nodes and ghosts, and each process by itself 60
 * to 80 MB (docs/performance.md). */
void slab_plan_share_memory(estimate *e, const deck *d)
{
    static const double of_share = 1.25, of_process = 8e7; /* bytes */
    if (d->slabs.n > 0) e->memory = fmin(e->memory, of_share * e->memory / (double)d->slabs.n + of_process);
}

dem_status slab_plan_model(dem_model **out, const deck *d, const rank_group *ranks)
{
    size_t size = 0;
    void *recipe = deck_slabs_recipe(&size, &d->slabs, d->echo);
    if (recipe == NULL) return DEM_ERROR_MEMORY;
    const slab_recipe all = {.bytes = recipe,
                             .size = size,
                             .obstacles = d->obstacles,
                             .n_obstacles = d->n_obstacles,
                             .options = &d->options};
    const dem_status status = rank_group_slabs(ranks, out, &all);
    free(recipe);
    return status;
}
