/* SPDX-License-Identifier: BSD-3-Clause */
/* The order of the members of groups of contacts: along the bodies' boundaries, but from the beginning of each group
 * and not from that of a boundary. Where a boundary begins depends on what else is on it, and a group is solved in the
 * order of its members, to the last digit. */
#ifndef DEM_CONTACT_GROUP_WALK_H
#define DEM_CONTACT_GROUP_WALK_H

#include <stdint.h>

#include "contact/contact_point.h"

typedef struct group_walk {
    const contact_candidate *candidates;
    dem_index *list;                 /* [n_candidates] of which the first n of group_walk_take() are set */
    dem_index *after;                /* [n_candidates] scratch: the edge that goes on where this one ends, or -1 */
    dem_index *beside;               /* [n_candidates] scratch: the next edge that starts at the same node, or -1 */
    uint8_t *state;                  /* [n_candidates] scratch */
    const contact_candidate **heads; /* [n_candidates] scratch: where walks begin */
    dem_index *starting; /* [n_nodes] scratch of the caller's: the first edge that starts at a node, or -1 */
    dem_index *of_node;  /* [n_nodes] likewise: the candidate of a node, if it is to be listed, or -1 */
} group_walk;

/** Borrows the candidates and `scratch`, two arrays [n_nodes]. Free with group_walk_destroy().
 *  \return DEM_ERROR_MEMORY */
dem_status group_walk_create(group_walk *out, const contact_candidate *candidates, dem_index n_candidates,
                             dem_index *const scratch[2]);
void group_walk_destroy(group_walk *w);

/** Lists n candidates in the order in which groups of them have their members: edge by edge along the boundary, a node
 *  before the edge that starts there, or else behind the one that ends there. A chain of edges begins where no other of
 *  them leads, a ring at its lowest edge by the numbers of its nodes; chains come in the order of their first edges,
 *  and nodes without an edge last. None of this depends on other candidates, or on the order of these. */
void group_walk_take(group_walk *w, const dem_index *members, dem_index n);

#endif
