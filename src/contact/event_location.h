/* SPDX-License-Identifier: BSD-3-Clause */
/* The first change of a candidate's contacts within an accepted step. */
#ifndef DEM_CONTACT_EVENT_LOCATION_H
#define DEM_CONTACT_EVENT_LOCATION_H

#include "contact/candidate.h"

/** First time in the step, after `from`, at which a free candidate is as deep as the penetration tolerance; infinity if
 *  never. The rest of the step is sampled eight times, and between samples every dip is searched for its minimum. */
double event_location_crossing(const contact_scene *scene, contact_candidate *candidate, const dense_output *p,
                               double from);

/** First time in the step, after `from`, at which a candidate's closed contacts have to change that have to at its end.
 *  Looks at no other candidate.
 *  \param[out] state  [4 n] scratch */
double event_location_change(contact_forces *r, const contact_candidate *candidate, const dense_output *p, double from,
                             double *state);

/** The positions at t of the nodes that the gap of a candidate depends on, into state [4 n]. */
void event_location_place(const contact_candidate *candidate, const dense_output *p, double t, double *state);

/** The positions and velocities at t that the forces on a group's nodes depend on, into state [4 n]. */
void event_location_state(const contact_forces *r, dem_index group, const dense_output *p, double t, double *state);

#endif
