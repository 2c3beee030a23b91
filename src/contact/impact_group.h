/* SPDX-License-Identifier: BSD-3-Clause */
/* The impact of a group of contacts that share nodes: their impacts are resolved in turn. */
#ifndef DEM_CONTACT_IMPACT_GROUP_H
#define DEM_CONTACT_IMPACT_GROUP_H

#include "contact/impact_target.h"

/** Puts a group of contacts on their surfaces, and enters what that puts in.  \return how far nodes have moved, m */
double impact_group_project(contact_set *c, dem_index group, contact_instant *now);

/** Stops a group of contacts, and enters what that takes. */
void impact_group_stop(contact_set *c, dem_index group, contact_instant *now);

/** The impact of an edge, or of a node that shares contacts with others: its group is put on the surfaces, its
 *  contacts are resolved in turn until none approaches any more, and those that last are closed. */
dem_status impact_group_solve(contact_set *c, dem_index k, impact_target hit, contact_instant *now);

#endif
