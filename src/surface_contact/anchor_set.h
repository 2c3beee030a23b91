/* SPDX-License-Identifier: BSD-3-Clause */
/* The anchors of all surface nodes: the memory of friction. A node that another surface pushes has one anchor there.
 * Anchors change between steps only (anchor_set_settle), and depend on positions and on where they were: no list of
 * candidates has a part in them. Without friction there are none, and nothing is done. */
#ifndef DEM_SURFACE_CONTACT_ANCHOR_SET_H
#define DEM_SURFACE_CONTACT_ANCHOR_SET_H

#include "base/exact_sum.h"
#include "surface_contact/anchor.h"
#include "surface_contact/contact_surface.h"
#include "surface_contact/friction_pattern.h"
#include "surface_contact/pair_rows.h"

/** The surfaces of a set of anchors: what it asks about them. Nodes and bodies are known by numbers. */
typedef struct anchor_surfaces {
    const void *of;    /* handed to the functions; NULL: nothing has friction */
    dem_index n_nodes; /* numbers of nodes are smaller */
    dem_index (*body)(const void *of, dem_index node);
    surface_law (*law)(const void *of, dem_index body, dem_index other);
    double (*half_length)(const void *of, dem_index node);     /* m, half of what a node has of its surface */
    void (*copy)(const void *of, const double *x, double *to); /* positions [n_nodes][2] of all nodes of surfaces */
} anchor_surfaces;

/** What is remembered of an anchor, as checkpoints have it. The rest follows from the state. */
typedef struct anchor_record {
    dem_index node, body;
    double force;
} anchor_record;

typedef struct anchor_list {
    dem_index n, capacity;
    anchor *at; /* [n] ascending by node */
    dem_index n_patterns, pattern_capacity;
    friction_pattern *patterns; /* [n_patterns] over S: of all pairs that pushed after the last step */
} anchor_list;

/** What pairs do to their node. */
typedef struct node_push {
    vec2 force;  /* N */
    double size; /* N, the sum of the sizes of all parts, less those that are taken off */
} node_push;

/** The friction of a pair in the state evaluated last. */
typedef struct held_push {
    dem_index anchor;
    node_push on_node;
    friction_pattern friction; /* N, on the nodes of the pair */
} held_push;

typedef struct anchor_set {
    anchor_surfaces surfaces;
    anchor_list now, before; /* `before`: as they were until the last step */
    dem_index *of;           /* [n_nodes] the anchor of each node, -1: none */
    double *x0;              /* [n_nodes][2] m, after the last step, of the surfaces' nodes; only where there are any */
    dem_index n_held, held_capacity;
    held_push *held; /* [n_held] in the order of pairs */
} anchor_set;

/** None as yet. Borrows the surfaces. Free with anchor_set_destroy().  \return DEM_ERROR_MEMORY */
dem_status anchor_set_create(anchor_set *out, const anchor_surfaces *surfaces);
void anchor_set_destroy(anchor_set *s);

/** Whether anything has friction. */
static inline bool anchor_set_has_friction(const anchor_set *s)
{
    return s->surfaces.of != NULL;
}

/** Removes all anchors. */
void anchor_set_clear(anchor_set *s);

/** Renews the anchors for the state x that a step has reached, with a list of pairs in the order of (node, edge), among
 *  them all that push in it. Nodes that are pushed get anchors, others lose theirs, and what a spring would pull with
 *  beyond friction is lost. No force changes by that.
 *  \return DEM_ERROR_MEMORY */
dem_status anchor_set_settle(anchor_set *s, const contact_pair *list, dem_index n, const double *x);

/** The anchor that has a part in the force of a pair: that of its node, if it is on the body of the edge; or NULL. */
const anchor *anchor_set_of_pair(const anchor_set *s, const contact_pair *p);

/* ---- all of them ---- */

/** Begins an evaluation of all pairs, of which there are n.  \return DEM_ERROR_MEMORY */
dem_status anchor_set_begin(anchor_set *s, dem_index n);

/** Holds a push of the evaluation, if its node has an anchor there. They come in the order of (node, edge). */
void anchor_set_hold(anchor_set *s, const contact_push *push, const double *x);

/** Ends it: from now on `held` has the friction of all pairs. */
void anchor_set_end(anchor_set *s, const double *x);

/** Adds the powers that the springs take in that state, at velocities v [n_nodes][2], W: stored and lost. */
void anchor_set_add_held_power(const anchor_set *s, const double *v, exact_sum *power);

/** Adds bounds of what the springs add to the stiffness at each node, N/m, after the last step: with g the gradient of
 *  the way and |g| the sum of the sizes |g_i|, k (g.u)^2 is at most k |g| sum |g_i| u_i^2. */
void anchor_set_add_stiffness(const anchor_set *s, void (*add)(void *to, dem_index node, double stiffness), void *to);

/* ---- some of them, with the same bits ---- */

/** anchor_ratio() of one of the anchors, whose node is in the pairs r. */
double anchor_set_ratio(const anchor_set *s, const pair_rows *r, const anchor *a, const double *x);

/** Adds the friction of all pairs r in which node i is, at positions x, N. */
void anchor_set_add_force(const anchor_set *s, const pair_rows *r, dem_index i, const double *x, vec2 *force);

/** Adds the energy that the springs give back when they are relieved, J. */
void anchor_set_add_energy(const anchor_set *s, const pair_rows *r, const double *x, exact_sum *sum);

/* ---- records ---- */

/** What is to be remembered of anchor k. */
anchor_record anchor_set_record(const anchor_set *s, dem_index k);

/** Puts n anchors as they were remembered in the place of all, for the state x in which they were, with a list of pairs
 *  as for anchor_set_settle().
 *  \return DEM_ERROR_IO if they are not those of what pushes in that state, DEM_ERROR_MEMORY */
dem_status anchor_set_restore(anchor_set *s, const anchor_record *records, dem_index n, const contact_pair *list,
                              dem_index n_pairs, const double *x);

#endif
