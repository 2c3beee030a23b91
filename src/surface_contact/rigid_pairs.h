/* SPDX-License-Identifier: BSD-3-Clause */
/* The contact pairs of one rigid body with obstacles: nodes of the body near edges of obstacles, and vertices of
 * obstacles near edges of the body. They count by places in a list of their own: nodes of the body's surface first,
 * then the corners of boxes round obstacles, by which their motion is known, then the vertices of obstacles. Of these
 * the list has what is near only. Edges count likewise: those of the body first, then those of obstacles. */
#ifndef DEM_SURFACE_CONTACT_RIGID_PAIRS_H
#define DEM_SURFACE_CONTACT_RIGID_PAIRS_H

#include "surface_contact/anchor_set.h"
#include "surface_contact/obstacle_surface.h"

typedef struct rigid_pairs {
    const obstacle_surface *obstacles;
    const touching_bodies *part; /* as contact_surface */
    dem_index body;              /* number of the body */
    surface_law law;
    double margin; /* m */
    dem_index n_nodes, n_edges;
    dem_index *nodes;    /* [n_nodes] their numbers in the lattice, ascending */
    double *half_length; /* [n_nodes] m, as those of the contact surface; of vertices it is no more than their mean, */
    double mean;         /* m */
    surface_edge *edges; /* [n_edges] of the body, by places */
    dem_index n_tracked; /* nodes and corners of boxes */
    double *reference;   /* [n_tracked][2] m, for which the list was made */
    dem_index n_near, near_capacity;
    dem_index *near;    /* [n_near] vertices that are in pairs, ascending */
    dem_index n_places; /* what is tracked, and all vertices */
    double *places;     /* [n_places][2] m, of the last evaluation, */
    double *before;     /* [n_places][2] m, at the start of a step, */
    double *force;      /* [n_places][2] N, of the last evaluation: of vertices those that are near */
    double *friction;   /* [n_places][2] N, the part of friction in it; NULL: no obstacle has any */
    bool made;          /* else there is no list */
    pair_rows pairs;    /* nearer than the thickness and the margin, in the order of (node, edge) */
    dem_index n_facing, facing_capacity;
    dem_index *facing;  /* [n_facing] edges of obstacles near the body, while the list is made */
    anchor_set anchors; /* of friction: of nodes on edges of obstacles, and of vertices on edges of the body */
} rigid_pairs;

/** Borrows the obstacles. It must stay where it is.  \return DEM_ERROR_MEMORY. Free with rigid_pairs_free(), also after
 *  an error. */
dem_status rigid_pairs_create(rigid_pairs *out, const contact_surface *of, dem_index body,
                              const obstacle_surface *obstacles);
void rigid_pairs_free(rigid_pairs *p);

/** Goes to positions x [n][2] of the lattice's nodes and the obstacles where they are. The list fits afterwards.
 *  \return DEM_ERROR_MEMORY */
dem_status rigid_pairs_follow(rigid_pairs *p, const double *x);

/** Computes the forces at these places.  \return DEM_ERROR_MEMORY */
dem_status rigid_pairs_push(rigid_pairs *p);

/** Adds the energy of the pairs at these places, J. */
void rigid_pairs_add_energy(const rigid_pairs *p, exact_sum *sum);

/** Whether any obstacle has friction. */
static inline bool rigid_pairs_have_friction(const rigid_pairs *p)
{
    return anchor_set_has_friction(&p->anchors);
}

/** Renews the anchors for positions x [n][2] that a step has reached.  \return DEM_ERROR_MEMORY */
dem_status rigid_pairs_settle(rigid_pairs *p, const double *x);

/** Puts n anchors as they were remembered in the place of all, for the positions x in which they were.
 *  \return what anchor_set_restore() returns */
dem_status rigid_pairs_restore(rigid_pairs *p, const anchor_record *records, dem_index n, const double *x);

/** The largest bound of what they add to the stiffness at a node over its mass, rad^2/s^2. */
double rigid_pairs_stiffening(rigid_pairs *p, const double *inverse_mass);

/** Called in this order, with the obstacles at the start of a step, at its end, and at its start again; x are the
 *  positions at the start and at the end. The list has all that may have met then.  \return DEM_ERROR_MEMORY */
void rigid_pairs_begin_step(rigid_pairs *p, const double *x);
dem_status rigid_pairs_end_step(rigid_pairs *p, const double *x);
void rigid_pairs_look_back(rigid_pairs *p);

/** A pair that crosses on straight ways from the start of the step to its end; NULL if none does.
 *  \param[out] part  of the step, after which it crosses */
const contact_pair *rigid_pairs_crossing(const rigid_pairs *p, double *part);

/** Refuses places in which an edge of the body crosses one of an obstacle, or is nearer than a twentieth of the contact
 *  thickness.  \return DEM_ERROR_MODEL */
dem_status rigid_pairs_check_start(const rigid_pairs *p);

/** The place of a vertex. */
static inline dem_index rigid_pairs_place(const rigid_pairs *p, dem_index vertex)
{
    return p->n_tracked + vertex;
}

/** The obstacle of a pair. */
dem_index rigid_pairs_obstacle(const rigid_pairs *p, const contact_pair *pair);

#endif
