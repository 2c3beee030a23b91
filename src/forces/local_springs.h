/* SPDX-License-Identifier: BSD-3-Clause */
/* The forces of a model near an event: springs and triangles are listed by local numbers; where springs are damped each
 * node is evaluated by the functions of forces.h. */
#ifndef DEM_FORCES_LOCAL_SPRINGS_H
#define DEM_FORCES_LOCAL_SPRINGS_H

#include "forces/local_cache.h"
#include "forces/local_forces.h"

typedef struct local_springs {
    const forces *forces;
    local_elements elements; /* near the nodes gathered last */
    local_cache cache;
    dem_index velocities; /* where they begin in a state */
    bool alone;           /* elements are all that acts between these, and nothing is given */
    bool reads_state;     /* accelerations of these depend on the state of all nodes, too */
    double *rigid;        /* [n_nodes][2] m/s^2, scratch; NULL until rigid bodies need it */
} local_springs;

/** Borrows the forces, to which nothing may be added afterwards. Free with local_springs_destroy(). */
void local_springs_create(local_springs *out, const forces *f, const state_layout *l);
void local_springs_destroy(local_springs *b);

/** `b` must stay where it is. */
local_forces local_springs_forces(local_springs *b);

#endif
