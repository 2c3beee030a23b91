/* SPDX-License-Identifier: BSD-3-Clause */
/* What causes events inside accepted steps: contact, and whatever else makes velocities or forces jump. The event queue
 * resolves the events of all sources in the order of (time, generation, kind, key): the kind is the source's place in
 * the list, the key its own number of what happens, in an order of its own that goes by what this is and not by where
 * it stands in a list. For each event the queue calls seeds, prepare, resolve and follow in this order; between seeds
 * and prepare the local correction computes the motion without the event. A further source is a folder of its own with
 * such a table: docs/architecture.md, Where a line goes. */
#ifndef DEM_EVENTS_EVENT_SOURCE_H
#define DEM_EVENTS_EVENT_SOURCE_H

#include <dem/checkpoint.h>

#include "events/event_listener.h"
#include "events/neighbourhood.h"
#include "time/dense_output.h"

/** When an event is due. */
typedef struct event_due {
    double t;             /* s; infinity: there is none */
    dem_index generation; /* 0, or one more than that of the event at the same time that has made it due: an event comes
                             after its cause, whatever their kinds and keys */
    dem_index key;
} event_due;

/** An event inside a step. */
typedef struct event_place {
    const dense_output *step;  /* with the changes of all events before */
    double t;                  /* s */
    dem_index generation;      /* as in event_due */
    const neighbourhood *near; /* whose motion it changes: all rings but the last */
    double *state;             /* [2 dim n_rows] at t, of those nodes; scratch after the event */
} event_place;

/** A source is deterministic: after undo() the same step brings the same events. */
typedef struct event_source {
    const char *name; /* in messages: "after a NAME event" */
    void *self;
    bool changes_forces; /* its events change the forces between their seeds, and neither positions nor velocities */
    /** Finds the events of a step, from its start.
     *  \param state  [2 dim n_rows] scratch */
    void (*begin)(void *self, const dense_output *step, double *state);
    /** The next event: of several at that time one of the lowest generation, and of these the first. */
    event_due (*next)(const void *self);
    /** The nodes that the event may change at once. \return how many; up to `capacity` of them are in `nodes` */
    dem_index (*seeds)(const void *self, dem_index key, dem_index *nodes, dem_index capacity);
    /** Called before an event, of this source or another. */
    void (*prepare)(void *self, const event_place *at);
    /** Resolves the event in the state: x and v of the seeds may change, or the forces between them. */
    dem_status (*resolve)(void *self, dem_index key, const event_place *at, const event_listener *listener);
    /** Called when the rest of the step has been corrected for the event: finds the next events of the nodes near
     *  again. */
    void (*follow)(void *self, const event_place *at);
    /** Takes back all that events of the step have done to the source. */
    void (*undo)(void *self);
    /** Puts what the source has to know to go on after a step into a checkpoint, in entries of its own names.
     *  \return DEM_ERROR_MEMORY */
    dem_status (*save)(const void *self, dem_checkpoint *checkpoint);
    /** Makes the source what it was in the checkpoint's state y at t.
     *  \return DEM_ERROR_IO for entries that are not there or impossible, DEM_ERROR_MEMORY */
    dem_status (*restore)(void *self, const dem_checkpoint *checkpoint, double t, const double *y);
} event_source;

#endif
