/* SPDX-License-Identifier: BSD-3-Clause */
/* The function that a source calls at each of its events, in the order in which they happen. */
#ifndef DEM_EVENTS_EVENT_LISTENER_H
#define DEM_EVENTS_EVENT_LISTENER_H

#include <dem/dem.h>

typedef struct event_listener {
    dem_status (*event)(void *context, const dem_event *event);
    void *context;
} event_listener;

#endif
