/* SPDX-License-Identifier: BSD-3-Clause */
/* The impact of a group of contacts that share nodes: their impacts are resolved in turn. */
#ifndef DEM_CONTACT_IMPACT_GROUP_H
#define DEM_CONTACT_IMPACT_GROUP_H

#include "contact/impact_target.h"

/** Moves the nodes of a group so that its contacts touch, and enters the energy that this puts in.
 *  \return how far nodes have moved, m */
double impact_group_project(contact_set *c, dem_index group, contact_instant *now);

/** Takes from the velocities of a group what its closed contacts do not allow, and enters its energy and impulses. */
void impact_group_stop(contact_set *c, dem_index group, contact_instant *now);

/** The impact of an edge, or of a node that shares contacts with others: its group is put on the surfaces, its
 *  contacts are resolved in turn until none approaches any more, and those that last are closed. */
dem_status impact_group_solve(contact_set *c, dem_index k, impact_target hit, contact_instant *now);

#endif
