/* SPDX-License-Identifier: BSD-3-Clause */
/* The anchors of all surface nodes: the memory of friction. A node that another surface pushes has one anchor there.
 * Anchors move between steps only (anchor_set_settle), and depend on positions and on where they were: no list of
 * candidates has a part in them. Without friction there are none, and nothing is done. */
#ifndef DEM_SURFACE_CONTACT_ANCHOR_SET_H
#define DEM_SURFACE_CONTACT_ANCHOR_SET_H

#include "base/exact_sum.h"
#include "surface_contact/anchor.h"
#include "surface_contact/contact_surface.h"
#include "surface_contact/pair_rows.h"

/** The surfaces of a set of anchors: what it asks about them. Nodes, edges and bodies are known by numbers. */
typedef struct anchor_surfaces {
    const void *of;    /* handed to the functions; NULL: nothing has friction */
    dem_index n_nodes; /* numbers of nodes are smaller */
    dem_index (*body)(const void *of, dem_index node);
    surface_law (*law)(const void *of, dem_index body, dem_index other);
    double (*half_length)(const void *of, dem_index node); /* m, half of what a node has of its surface */
    /* Ends of an edge.  \return false if there is no such node, or no such edge that may push it */
    bool (*ends)(const void *of, dem_index node, dem_index edge, dem_index ends[2]);
} anchor_surfaces;

/** What is remembered of an anchor, as checkpoints have it. */
typedef struct anchor_record {
    dem_index node, edge;
    double weight, place[2], direction[2], shift;
} anchor_record;

typedef struct anchor_set {
    anchor_surfaces surfaces;
    dem_index n, capacity;
    anchor *list; /* [n] ascending by node */
    dem_index n_old, old_capacity;
    anchor *old;   /* [n_old] as they were before they moved */
    dem_index *of; /* [n_nodes] the anchor of each node, -1: none */
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

/** Finds the anchors again after edges have got other numbers: an edge is known by its ends. Those whose node or edge
 *  is no more are removed.
 *  \param edge  the number of an edge, -1 if there is none
 *  \return DEM_ERROR_MEMORY */
dem_status anchor_set_follow_edges(anchor_set *s, dem_index (*edge)(const void *of, dem_index first, dem_index second));

/** Moves the anchors for the state x that a step has reached, with a list of pairs in the order of (node, edge), among
 *  them all that push in it. Nodes that are pushed get anchors, others lose theirs, and where the spring would pull
 *  with more than friction it is relieved. No force changes by that.
 *  \return DEM_ERROR_MEMORY */
dem_status anchor_set_settle(anchor_set *s, const contact_pair *list, dem_index n, const double *x);

/** The anchor that has a part in the force of a pair: that of its node, if it is on the body of the edge; or NULL. */
const anchor *anchor_set_of_pair(const anchor_set *s, const contact_pair *p);

/** anchor_ratio() of one of the anchors, whose node is in the pairs r. */
double anchor_set_ratio(const anchor_set *s, const pair_rows *r, const anchor *a, const double *x);

/** Adds the friction of all pairs r in which node i is, at positions x, N.  \return whether there is any */
bool anchor_set_add_force(const anchor_set *s, const pair_rows *r, dem_index i, const double *x, vec2 *force);

/** Adds that of all anchors to the forces [n_nodes][2], N, with other bits. */
void anchor_set_add_forces(const anchor_set *s, const pair_rows *r, const double *x, double *forces);

/** Adds the energy that the springs give back when they are relieved, J. */
void anchor_set_add_energy(const anchor_set *s, const pair_rows *r, const double *x, exact_sum *sum);

/** Power that the springs take at velocities v [n][2], W: stored and lost. */
double anchor_set_power(const anchor_set *s, const pair_rows *r, const double *x, const double *v);

/** What is to be remembered of anchor k. */
anchor_record anchor_set_record(const anchor_set *s, dem_index k);

/** Puts anchors as they were remembered in the place of all.
 *  \return DEM_ERROR_IO if they are none of these surfaces, DEM_ERROR_MEMORY */
dem_status anchor_set_restore(anchor_set *s, const anchor_record *list, dem_index n);

#endif
