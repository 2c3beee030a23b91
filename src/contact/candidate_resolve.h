/* SPDX-License-Identifier: BSD-3-Clause */
/* Changes of contacts that are due at one candidate in a state: it touches, is released, stops or begins to slide,
 * passes an end or is stopped in a corner. */
#ifndef DEM_CONTACT_CANDIDATE_RESOLVE_H
#define DEM_CONTACT_CANDIDATE_RESOLVE_H

#include "contact/contact_set.h"

/** Makes the first change that is due at a candidate, if there is one: then `changed` becomes true.
 *  \return DEM_ERROR_CONTACT on a storm, or for what is found deep inside */
dem_status candidate_resolve(contact_set *c, dem_index k, contact_instant *now, bool *changed);

/** Counts an event of a candidate at which neither it nor what is around it had anything to change.
 *  \return DEM_ERROR_CONTACT if there are too many in a step */
dem_status candidate_count_idle(contact_set *c, dem_index k, const contact_instant *now);

/** Resolves a candidate with this gap that touches: an impact, unless it has gone round a free end. */
dem_status candidate_resolve_touch(contact_set *c, dem_index k, const contact_gap *gap, contact_instant *now);

#endif
