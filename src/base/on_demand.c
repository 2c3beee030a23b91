/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/on_demand.h"

#include "base/status.h"

dem_status on_demand_create(on_demand *d)
{
    d->is_made = false;
    CHECK(pthread_mutex_init(&d->lock, NULL) == 0, DEM_ERROR_MEMORY, "out of memory for a lock");
    return DEM_OK;
}

void on_demand_destroy(on_demand *d)
{
    (void)pthread_mutex_destroy(&d->lock);
}

dem_status on_demand_make(on_demand *d, dem_status (*make)(void *self), void *self)
{
    (void)pthread_mutex_lock(&d->lock);
    const dem_status status = d->is_made ? DEM_OK : make(self);
    d->is_made = status == DEM_OK;
    (void)pthread_mutex_unlock(&d->lock);
    return status;
}
