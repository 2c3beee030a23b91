/* SPDX-License-Identifier: BSD-3-Clause */
/* What domains are cut from: a lattice and its rigid bodies, and what is found of it once for the cuts of all ranks:
 * which nodes are common, which are whose ghosts, and what is at each node. No compiled model is needed. The lattice
 * may be a part of the whole that has all that the domain of one rank depends on: then that one can be cut. */
#ifndef DEM_MODEL_WHOLE_LATTICE_H
#define DEM_MODEL_WHOLE_LATTICE_H

#include "domain/domain_lists.h"
#include "lattice/lattice_arrays.h"
#include "lattice/node_rows.h"
#include "model/domain_model_shares.h"
#include "model/model.h"

/** What it is made from, borrowed. */
typedef struct whole_parts {
    const dem_lattice *lattice; /* whose flags, bodies and velocities are filled */
    const rigid_bodies *rigid;
    dem_index n[LATTICE_ITEMS]; /* nodes, springs and triangles of the whole */
    /* [nodes], [springs], [triangles] of the lattice: numbers in the whole, ascending; all NULL: it is the whole */
    const dem_index *number[LATTICE_ITEMS];
    /* [nodes] 1: common, as owners have found in the whole where nothing may break or is rigid, without rings about
     * such nodes; NULL: to be found in the lattice */
    const unsigned char *is_common;
    const ranks *counting; /* as domain_shares has it */
    bool has_obstacles;
    bool is_slack; /* whole_lattice_is_slack() */
} whole_parts;

typedef struct whole_lattice {
    whole_parts of;
    unsigned char *is_common; /* [n_nodes] 1: all ranks integrate it */
    dem_index *joined;        /* [n_nodes] joined_nodes_find(); NULL: nothing may break */
    domain_shares shares;
    domain_lists lists;           /* of the nodes of all ranks */
    node_rows springs, triangles; /* at each node */
} whole_lattice;

/** Those of a model, which has all of them.  \return which borrow them from it */
whole_parts whole_parts_of(const dem_model *model);

/** Finds all that. Borrows what the parts have, and the owners of the shares. A part of the whole needs the own and all
 *  common nodes of a rank, those that are as many rings away from these as there may be of ghosts and one more, and all
 *  springs and triangles between all of them; owners are then those of its nodes, and all that may touch an obstacle is
 *  near. Where bodies touch common nodes have to be given, as triangles have sides of their own where a part ends.
 *  Collective, where ranks count together. Free with whole_lattice_close(), after a failure, too.
 *  \return DEM_ERROR_MEMORY */
dem_status whole_lattice_open(whole_lattice *out, const whole_parts *of, int n_ranks,
                              const domain_model_shares *shares);
void whole_lattice_close(whole_lattice *w);

/** How many rings of ghosts there are at most. Of the lattice only is looked at which arrays there are. */
int whole_lattice_most_rings(const whole_parts *of, int n_ranks, const domain_model_shares *shares);

/** Whether no triangle has an area term or couplings. */
bool whole_lattice_is_slack(const dem_lattice *lattice);

/** How many rings of neighbours about what events may concern ranks have in common. */
int whole_lattice_rings(const dem_lattice *lattice);

#endif
