/* SPDX-License-Identifier: BSD-3-Clause */
/* The forces of a model near an event. Where undamped springs are all that acts between nodes, they are listed by local
 * numbers; otherwise each node is evaluated by the functions of forces.h. */
#ifndef DEM_FORCES_LOCAL_SPRINGS_H
#define DEM_FORCES_LOCAL_SPRINGS_H

#include "forces/forces.h"
#include "forces/local_forces.h"

/** A spring between two local nodes: first < second. */
typedef struct local_bond {
    int32_t first, second;
} local_bond;

typedef struct local_springs {
    const forces *forces;
    dem_index velocities;                   /* where they begin in a state */
    bool plain;                             /* springs are listed: of the nodes gathered last */
    dem_index bonds_end[LOCAL_NODES_RINGS]; /* those that act on the nodes of ring r or nearer */
    dem_index n_bonds, capacity;
    local_bond *bonds;               /* [n_bonds] */
    double *stiffness, *rest_length; /* [n_bonds] */
    double *dx, *dy, *pull;          /* [n_bonds] scratch */
    double *rigid;                   /* [n_nodes][2] m/s^2, scratch; NULL until rigid bodies need it */
} local_springs;

/** Borrows the forces, to which nothing may be added afterwards. Free with local_springs_destroy(). */
void local_springs_create(local_springs *out, const forces *f, const state_layout *l);
void local_springs_destroy(local_springs *b);

/** `b` must stay where it is. */
local_forces local_springs_forces(local_springs *b);

#endif
