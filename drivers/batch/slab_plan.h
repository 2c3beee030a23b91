/* SPDX-License-Identifier: BSD-3-Clause */
/* When ranks make the bodies of a deck in slabs (deck_slabs.h), what memory that takes, and the model of the whole. */
#ifndef DEM_SLAB_PLAN_H
#define DEM_SLAB_PLAN_H

#include "command.h"
#include "estimate.h"

/* Decides it, before the deck is built, by the number of nodes that its bodies will have. */
void slab_plan_decide(deck *d, const command *c, double nodes);

/* Changes an estimate to what the rank that has most takes. */
void slab_plan_share_memory(estimate *e, const deck *d);

/* Makes the model that rank 0 leads a run with, and those of all ranks.
 * \return as dem_model_create_mpi_slab() */
dem_status slab_plan_model(dem_model **out, const deck *d, const struct rank_group *ranks);

#endif
