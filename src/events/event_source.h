/* SPDX-License-Identifier: BSD-3-Clause */
/* What makes events inside accepted steps: contact, and whatever else lets velocities jump or forces change at once.
 * The event queue takes the events of all sources in the order of (time, kind, key): the kind is the source's place in
 * the queue, the key its own number of what happens. */
#ifndef DEM_EVENTS_EVENT_SOURCE_H
#define DEM_EVENTS_EVENT_SOURCE_H

#include "events/event_listener.h"
#include "events/neighbourhood.h"
#include "time/dense_output.h"

/** An event inside a step. */
typedef struct event_place {
    const dense_output *step;  /* with the changes of all events before */
    double t;                  /* s */
    const neighbourhood *near; /* what moves otherwise after it: all rings but the last */
    double *state;             /* [4 n] at t, of those nodes; scratch after the event */
} event_place;

/** A source is deterministic: after undo() the same step brings the same events. */
typedef struct event_source {
    const char *name; /* in messages: "after a NAME event" */
    void *self;
    /** Looks what happens in a step, from its start. \param state  [4 n] scratch */
    void (*begin)(void *self, const dense_output *step, double *state);
    /** When something happens next, infinity if nothing does, and its key: the lowest of several at that time. */
    double (*next)(const void *self, dem_index *key);
    /** The nodes that the event may change at once. \return how many; up to `capacity` of them are in `nodes` */
    dem_index (*seeds)(const void *self, dem_index key, dem_index *nodes, dem_index capacity);
    /** An event, of this source or another, is about to happen. */
    void (*prepare)(void *self, const event_place *at);
    /** Makes what is due happen in the state: x and v of the seeds may change, and forces on the nodes near. */
    dem_status (*resolve)(void *self, dem_index key, const event_place *at, const event_listener *listener);
    /** The rest of the step has been corrected for it: what happens to the nodes near is looked for anew. */
    void (*follow)(void *self, const event_place *at);
    /** Takes back all that events of the step have done to the source. */
    void (*undo)(void *self);
} event_source;

#endif
