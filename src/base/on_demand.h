/* SPDX-License-Identifier: BSD-3-Clause */
/* What is made when it is first asked for, by whichever thread comes first. */
#ifndef DEM_BASE_ON_DEMAND_H
#define DEM_BASE_ON_DEMAND_H

#include <pthread.h>

#include <dem/status.h>

typedef struct on_demand {
    pthread_mutex_t lock;
    bool is_made;
} on_demand;

/** Free with on_demand_destroy().  \return DEM_ERROR_MEMORY */
dem_status on_demand_create(on_demand *d);
void on_demand_destroy(on_demand *d);

/** Calls `make` unless it has succeeded before. Whoever returns from here with DEM_OK sees what it has made. */
dem_status on_demand_make(on_demand *d, dem_status (*make)(void *self), void *self);

#endif
