/* SPDX-License-Identifier: BSD-3-Clause */
/* The event sources of a simulation: their places are their kinds, by which events at the same time are ordered. */
#ifndef DEM_EVENTS_SOURCE_LIST_H
#define DEM_EVENTS_SOURCE_LIST_H

#include "events/event_source.h"

typedef struct source_list {
    dem_index n, capacity;
    event_source *list; /* [n] */
} source_list;

/** Adds a source, before the first step, to a list that begins as {0}: of events at the same time its events come after
 *  those of the sources before it. Borrows what the source works on. Free with source_list_destroy().
 *  \return DEM_ERROR_MEMORY */
dem_status source_list_add(source_list *s, event_source source);
void source_list_destroy(source_list *s);

/** Puts the entries of all sources into a checkpoint.  \return DEM_ERROR_MEMORY */
dem_status source_list_save(const source_list *s, dem_checkpoint *checkpoint);

/** Makes all sources what they were in the checkpoint's state y at t.  \return DEM_ERROR_IO for entries that are not
 *  there or impossible, DEM_ERROR_MEMORY */
dem_status source_list_restore(const source_list *s, const dem_checkpoint *checkpoint, double t, const double *y);

#endif
