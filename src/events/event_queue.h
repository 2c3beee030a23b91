/* SPDX-License-Identifier: BSD-3-Clause */
/* The events of all sources inside one accepted step, in the order of time. Each is resolved where and when it happens,
 * and the rest of the step is corrected for it on a neighbourhood, which may bring further events: the integration of
 * the whole body is never stopped. All of it can be taken back. Ranks that share a model each have all events. */
#ifndef DEM_EVENTS_EVENT_QUEUE_H
#define DEM_EVENTS_EVENT_QUEUE_H

#include "base/exact_sum.h"
#include "events/local_correction.h"
#include "events/source_list.h"

typedef struct event_queue {
    state_layout layout;
    const local_forces *forces;
    const constraints *constraints; /* NULL: none */
    const source_list *sources;
    const unsigned char *is_common; /* [n_nodes] see below */
    bool lacks_nodes;               /* an event has concerned a node that is not */
    local_correction correction;
    changed_motion changed;
    local_nodes renewed;      /* those with another derivative at the end */
    const dense_output *step; /* the accepted one */
    double *state;            /* [2 dim n_rows] scratch, the caller's */
    double now;               /* s, events until here are resolved */
    bool settled;             /* the end of the step is put right: contacts, derivative */
    bool happens;             /* whether there may be events at all */
    bool quiet;               /* nothing happens in the step */
    exact_sum error;          /* of all local corrections, squared */
    exact_sum ahead;          /* what it would be if the events had come right at the start of the step, squared */
    double most;              /* of `error`; beyond it the step is rejected */
    bool exceeded;            /* by one event alone, after which no other is resolved */
    dem_index seed_capacity;
    dem_index *seeds; /* [seed_capacity] nodes that an event changes at once */
    dem_index n_events, capacity;
    dem_event *events; /* [n_events] */
    dem_index n_taken; /* events resolved in the step; those at the same time count each */
} event_queue;

/** What a queue works with, all borrowed. */
typedef struct event_queue_parts {
    const state_layout *layout;
    const local_forces *forces;
    const constraints *constraints; /* NULL: none */
    const source_list *sources;
    const unsigned char *is_common; /* [n_nodes] whether all ranks that share a model integrate a node: those that an
                                       event concerns; NULL: one process has all */
    local_correction_rule rule;
    bool happens;    /* whether there may be events of any source */
    bool controlled; /* a step is rejected for an error above 1 */
} event_queue_parts;

/** Must stay where it is. Free with event_queue_destroy(). */
dem_status event_queue_create(event_queue *out, const event_queue_parts *parts);
void event_queue_destroy(event_queue *q);

/** Begins with an accepted step: finds the first event of every source. The step ends in y1, with derivative f1, which
 *  change with it; it gets the changed motions, and must stay where it is.
 *  \param state  [2 dim n_rows] scratch */
void event_queue_start(event_queue *q, dense_output *step, double *y1, double *f1, double *state);

/** Whether there is an event in a step that has just begun. */
bool event_queue_has_event(const event_queue *q);

/** Resolves the events up to t, and takes back those after it, so that sources and motion are those at t; the end of
 *  the step is complete when t is not before it.
 *  \return what a source returns for an event, DEM_ERROR_INTEGRATOR if what follows from an event is not finite,
 *  DEM_ERROR_MEMORY; DEM_STOPPED on all ranks, at the same event, if it concerns nodes that not all of them have */
dem_status event_queue_show(event_queue *q, double t);

/** Whether it has, so that the run cannot go on with these shares of the model. */
bool event_queue_lacks_nodes(const event_queue *q);

/** Error of the step by its events, in units of the largest allowed. */
double event_queue_error(const event_queue *q);

/** A bound of the next step, s: in a longer one the error that these events would cause may exceed what is allowed, and
 *  its own estimate may miss that. Infinity if there is no bound. */
double event_queue_reach(const event_queue *q);

/** Takes back all events: the sources and the end of the step are as they were. */
void event_queue_undo(event_queue *q);

#endif
