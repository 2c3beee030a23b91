/* SPDX-License-Identifier: BSD-3-Clause */
/* The function that is called at events. */
#ifndef DEM_EVENTS_EVENT_LISTENER_H
#define DEM_EVENTS_EVENT_LISTENER_H

#include <dem/dem.h>

typedef struct event_listener {
    dem_status (*event)(void *context, const dem_event *event);
    void *context;
} event_listener;

#endif
