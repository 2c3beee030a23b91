/* SPDX-License-Identifier: BSD-3-Clause */
#include "simulation/shared_use.h"

#include "base/status.h"
#include "simulation/options.h"
#include "simulation/unseen_steps.h"
#include "time/butcher.h"

/* None where something acts that the owners of ghosts alone know. */
static ring_use rings_of(const dem_options *o)
{
    const int stages = butcher_rings_of(o->method);
    if (o->n_boundaries > 0 || o->force != NULL) return ring_use_none();
    return stages > 0 ? ring_use_of_stages(stages) : unseen_steps_ring_use(o);
}

dem_status dem_private_use_shared(dem_private_whole *whole, const dem_options *options)
{
    dem_options own;
    TRY(options_read(&own, options));
    whole->use = rings_of(&own);
    whole->touching = own.bodies != DEM_BODIES_NONE ? DEM_PRIVATE_TOUCHING_SOME : DEM_PRIVATE_TOUCHING_NONE;
    return DEM_OK;
}
