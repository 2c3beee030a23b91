/* SPDX-License-Identifier: BSD-3-Clause */
/* What acts on the nodes near an event, constraints apart: a table of functions for folders that must not know the
 * number of dimensions. local_springs.c fills it for the forces of a model. */
#ifndef DEM_FORCES_LOCAL_FORCES_H
#define DEM_FORCES_LOCAL_FORCES_H

#include "base/state.h"
#include "forces/local_nodes.h"

/** A state of the local nodes. */
typedef struct local_state {
    double t;            /* s */
    const double *x, *v; /* [n][dim] by local numbers */
    const double *y;     /* a state of all nodes, filled in as far as the forces read it */
} local_state;

typedef struct local_forces {
    void *self;
    bool couple_velocities;    /* the force on a node depends on the velocities of its neighbours */
    bool are_driven;           /* the forces depend on time, which they read from the state of all nodes */
    bool have_power;           /* add_power() may add something */
    const unsigned char *held; /* [n_nodes] components of the motion that are prescribed; NULL: none are */
    /** Called before the first event of a step changes its motion from state y0 to state y1. */
    dem_status (*begin_step)(const void *self, const double *y0, const double *y1);
    /** Adds to the nodes those that the forces on some of them depend on: of places `first` to `last` - 1. */
    dem_status (*add_neighbours)(const void *self, local_nodes *nodes, dem_index first, dem_index last);
    /** Computes the acceleration a [dim] of one node in a whole state y. */
    void (*accelerate_one)(const void *self, dem_index node, const double *y, double *a);
    /** Lists what acts between the nodes, for the calls of accelerate() that follow. */
    dem_status (*gather)(void *self, const local_nodes *nodes);
    /** Fills in the rings round one node instead, and lists what acts there, as both were when they were kept. There
     *  are no nodes yet, but nodes->n_rings is set.
     *  \return false, and no nodes: nothing is kept, or it may have changed since. NULL: nothing ever is kept */
    bool (*recall)(void *self, dem_index node, local_nodes *nodes);
    /** Keeps what has just been gathered of the rings round one node, where it depends on the model alone. NULL where
     *  recall is. */
    void (*keep)(void *self, dem_index node, const local_nodes *nodes);
    /** The same as gather() after elements between the nodes of ring 0 have changed. */
    dem_status (*renew)(void *self, const local_nodes *nodes);
    /** Computes the accelerations a [n][dim] of the nodes of a ring or nearer, in a state that is filled as far as the
     *  next ring. */
    void (*accelerate)(void *self, const local_nodes *nodes, int ring, const local_state *s, double *a);
    /** Whether these also read positions and velocities from the state of all nodes, of those that were gathered last.
     *  Otherwise, and without have_power, they depend on positions alone. NULL: they do not. */
    bool (*read_state)(const void *self);
    /** The same right after it for another state, in which only the first n_moved nodes have moved, where it depends on
     *  positions alone. NULL: it cannot be done. */
    void (*accelerate_moved)(void *self, const local_nodes *nodes, dem_index n_moved, int ring, const local_state *s,
                             double *a);
    /** Whether these have the bits of accelerate_one() for the nodes that were gathered last. */
    bool (*are_exact)(const void *self);
    /** Evaluates the external force, if there is one, on these nodes, as accelerate() does: add_power() takes its last
     *  values. */
    void (*evaluate_external)(void *self, const local_nodes *nodes, int ring, const local_state *s);
    /** Adds the power of the forces on these nodes to the totals [STATE_TOTALS]. */
    void (*add_power)(const void *self, const local_nodes *nodes, int ring, const double *y, double *totals);
    /** Power that friction between nodes takes in a whole state y, W; NULL: there is none. */
    double (*friction_power)(const void *self, const double *y);
} local_forces;

/** Components of the motion of a node that are prescribed. */
static inline unsigned local_forces_held(const local_forces *f, dem_index node)
{
    return f->held != NULL ? f->held[node] : 0;
}

#endif
