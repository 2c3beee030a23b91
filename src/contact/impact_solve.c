/* SPDX-License-Identifier: BSD-3-Clause */
/* Chooses between the impact of a node by itself, which is most of them, and that of a group: an edge always moves two
 * nodes, and a node that shares contacts with its edges moves what they hold. */
#include "contact/impact_solve.h"

#include "contact/impact_group.h"
#include "contact/impact_node.h"

dem_status impact_solve(contact_set *c, dem_index k, impact_target hit, contact_instant *now)
{
    if (!candidate_is_edge(&c->list[k]) && !contact_set_coupled(c, k)) return impact_node_solve(c, k, hit, now);
    return impact_group_solve(c, k, hit, now);
}
