/* SPDX-License-Identifier: BSD-3-Clause */
/* How events see constraints, that is what ties nodes together for as long as it lasts, as closed contacts do: a table
 * of functions, filled in by src/contact/contact_constraints.c. Nodes whose accelerations depend on one another at
 * once, without a spring between them, form a group, which is solved as a whole. Groups change at events only. */
#ifndef DEM_EVENTS_CONSTRAINTS_H
#define DEM_EVENTS_CONSTRAINTS_H

#include "time/changed_motion.h"

/** The receiver of rates of quadratures: rows of its own for impulses, and the totals. */
typedef struct constraint_rates {
    void *context;
    dem_status (*add)(void *context, dem_index row, const double *rate); /* of a row of the state, [dim] */
    double *totals;                                                      /* [STATE_TOTALS] are added to here */
} constraint_rates;

/** A state y = (x, v) at a time. */
typedef struct constraint_state {
    double t; /* s */
    const double *y;
} constraint_state;

/** Accelerations by forces alone that are known in a state, of some nodes. */
typedef struct constraint_free {
    const int32_t *number; /* [n_nodes] of a node among those that have numbers here, or -1 */
    dem_index n;
    const double *a; /* [n][dim] m/s^2, of those with numbers below n */
} constraint_free;

typedef struct constraints {
    void *self;
    /* Addresses of two arrays, which may be allocated again: */
    int32_t *const *group_at; /* [n_nodes] the group that a node is in, or -1 */
    double *const *a;         /* [n_nodes][dim] m/s^2, of the nodes of a group as solved for last */
    /** Calls `add` for the nodes of a group, for some more than once.  \return what it returns, if not DEM_OK */
    dem_status (*each_node)(const void *self, dem_index group, dem_status (*add)(void *context, dem_index node),
                            void *context);
    /** The groups at some nodes, each once and in an order of their own, into `list`, which holds until groups change.
     *  \return how many */
    dem_index (*groups_at)(void *self, const dem_index *nodes, dem_index n, const dem_index **list);
    /** Calls `add` for the nodes of all groups. */
    dem_status (*each_held)(const void *self, dem_status (*add)(void *context, dem_index node), void *context);
    /** Solves for the accelerations of a group; of the state its nodes are read and, unless the accelerations by forces
     *  of all of them are known, their neighbours.
     *  \param known  NULL: none */
    void (*solve)(void *self, dem_index group, constraint_state at, const constraint_free *known);
    /** What a group adds to the rates of quadratures, in a state that it was solved in last. */
    dem_status (*add_rates)(const void *self, dem_index group, constraint_state at, const constraint_rates *to);
    /** Takes from a state at the end of a step the error that changes of the motion have left in a group: moves its
     *  nodes. */
    void (*settle)(void *self, dem_index group, double t, double *y);
    /** The same of all groups at once, into the accelerations a [n_rows][dim] of a derivative. All of them have been
     *  solved in that state. */
    void (*add_all_rates)(void *self, constraint_state at, double *a);
} constraints;

/** The group of a node, or -1; without constraints (NULL) there is none. */
static inline dem_index constraints_group_at(const constraints *c, dem_index node)
{
    return c != NULL ? (*c->group_at)[node] : -1;
}

#endif
