/* SPDX-License-Identifier: BSD-3-Clause */
/* What domains are cut from: a lattice and its rigid bodies, and what is found of it once for the cuts of all
 * ranks: which nodes are common, which are whose ghosts, and what is at each node. No compiled model is needed. */
#ifndef DEM_MODEL_WHOLE_LATTICE_H
#define DEM_MODEL_WHOLE_LATTICE_H

#include "domain/domain_lists.h"
#include "lattice/lattice_arrays.h"
#include "lattice/node_rows.h"
#include "model/domain_model_shares.h"
#include "model/model.h"

/** What it is made from, borrowed. */
typedef struct whole_parts {
    const dem_lattice *lattice; /* whose flags, bodies, positions and velocities are filled */
    const rigid_bodies *rigid;
    dem_index n[LATTICE_ITEMS]; /* nodes, springs and triangles of the whole */
    bool has_obstacles;
    bool is_slack; /* whether no triangle has an area term or couplings */
} whole_parts;

typedef struct whole_lattice {
    whole_parts of;
    unsigned char *is_common; /* [n_nodes] */
    domain_shares shares;
    domain_lists lists;           /* of the nodes of all ranks */
    node_rows springs, triangles; /* at each node */
} whole_lattice;

/** Those of a model, which has all of them.  \return which borrow them from it */
whole_parts whole_parts_of(const dem_model *model);

/** Finds all that. Borrows what the parts have, and the owners of the shares. Free with whole_lattice_close(), after a
 *  failure, too.  \return DEM_ERROR_MEMORY */
dem_status whole_lattice_open(whole_lattice *out, const whole_parts *of, int n_ranks,
                              const domain_model_shares *shares);
void whole_lattice_close(whole_lattice *w);

/** How many rings of neighbours about what events may concern ranks have in common. */
int whole_lattice_rings(const dem_lattice *lattice);

#endif
