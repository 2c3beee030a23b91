/* SPDX-License-Identifier: BSD-3-Clause */
/* Impacts: what the velocity of a candidate becomes, and whether the contact lasts. */
#ifndef DEM_CONTACT_IMPACT_SOLVE_H
#define DEM_CONTACT_IMPACT_SOLVE_H

#include "contact/impact_target.h"

/** The impact of a candidate, as a node by itself or with the group of contacts that share its nodes. */
dem_status impact_solve(contact_set *c, dem_index k, impact_target hit, contact_instant *now);

#endif
