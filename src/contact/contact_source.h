/* SPDX-License-Identifier: BSD-3-Clause */
/* Contact as a source of events: its keys are the numbers of the candidates. */
#ifndef DEM_CONTACT_CONTACT_SOURCE_H
#define DEM_CONTACT_CONTACT_SOURCE_H

#include "contact/automaton.h"
#include "events/event_heap.h"
#include "events/event_source.h"

typedef struct contact_source {
    automaton *automaton;
    const dense_output *step; /* the accepted one */
    double *state;            /* [4 n] scratch, the queue's */
    event_heap heap;          /* candidates by the time of their next change */
    dem_index taken;          /* the one whose change is under way, or -1 */
    double *crossing;         /* [n candidates] s, when a free one touches, while a step is begun */
    bool *kept;               /* [n candidates] whether one is among `saved` */
    dem_index n_saved;
    dem_index *saved;          /* [n_saved] those that may have changed; -1: it is a candidate no more */
    contact_candidate *before; /* [n_saved] as they were before the step */
    bool has_ledger;           /* whether `ledger` is set: there has been an event */
    contact_ledger ledger;     /* as it was before the step */
} contact_source;

/** Borrows the automaton. Free with contact_source_destroy().  \return DEM_ERROR_MEMORY */
dem_status contact_source_create(contact_source *out, automaton *c);
void contact_source_destroy(contact_source *s);

/** The candidates become those of another surface, as by automaton_follow_surface(), also while an event of another
 *  source is resolved. That source takes it back in its undo(): it comes after contact in the queue, so that its undo()
 *  goes first. Candidates near the event are looked at when that has been resolved.
 *  \return DEM_ERROR_MEMORY, with all as it was */
dem_status contact_source_follow_surface(contact_source *s, const surface *to);

/** `s` must stay where it is. */
event_source contact_source_events(contact_source *s);

#endif
