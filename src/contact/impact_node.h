/* SPDX-License-Identifier: BSD-3-Clause */
/* The impact of a node that shares no closed contact. */
#ifndef DEM_CONTACT_IMPACT_NODE_H
#define DEM_CONTACT_IMPACT_NODE_H

#include "contact/impact_target.h"

/** The impact of a node by itself: it is put back on the surface, rebounds, and the contacts that last are closed. A
 *  contact that it has with a segment not hit again opens. */
dem_status impact_node_solve(contact_set *c, dem_index k, impact_target hit, contact_instant *now);

#endif
