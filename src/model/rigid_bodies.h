/* SPDX-License-Identifier: BSD-3-Clause */
/* The rigid bodies of a model: their nodes, masses and shapes at rest, and the means and moments of vectors at their
 * nodes, from which their motion follows. Sums are exact, and vectors are taken relative to the node in the middle, so
 * that what all nodes have in common is kept to the bit. */
#ifndef DEM_MODEL_RIGID_BODIES_H
#define DEM_MODEL_RIGID_BODIES_H

#include "obstacle/pose.h"

typedef struct rigid_body {
    dem_index number; /* of the body */
    dem_guide guide;
    dem_index n_nodes;
    const dem_index *nodes; /* [n_nodes] ascending */
    const double *masses;   /* [n_nodes] kg */
    const double *shape;    /* [n_nodes][2] m, places at rest from the centre of mass */
    double mass, inertia;   /* kg, kg m^2 about the centre of mass */
    dem_index middle;       /* the node nearest to that */
} rigid_body;

typedef struct rigid_bodies {
    dem_index n;
    rigid_body *list;   /* [n] ascending */
    dem_index *of_node; /* [n_nodes] which of the list the node is of; -1: none. NULL if there are no rigid bodies */
    dem_index n_nodes;
    dem_index *nodes; /* [n_nodes] of all, one body after the other */
    double *masses, *shapes;
} rigid_bodies;

/** Finds the rigid bodies of a lattice whose flags, bodies, positions and velocities are filled. Free with
 *  rigid_bodies_free().
 *  \return DEM_ERROR_MODEL with the node that does not fit into a rigid body, or into its motion */
dem_status rigid_bodies_compile(rigid_bodies *out, const dem_lattice *lattice);
void rigid_bodies_free(rigid_bodies *r);

/** Copies the rigid bodies of a whole lattice to a part of n_nodes nodes that has all of their nodes.
 *  \param number  [nodes of the whole] in the part
 *  \return DEM_ERROR_MEMORY. Free with rigid_bodies_free(). */
dem_status rigid_bodies_cut(rigid_bodies *out, const rigid_bodies *whole, const dem_index *number, dem_index n_nodes);

/** Points each body of the list to what it has in the arrays of all. */
void rigid_bodies_link(rigid_bodies *r);

/** The rigid body of a node; NULL if there is none. */
static inline const rigid_body *rigid_bodies_at(const rigid_bodies *r, dem_index node)
{
    return r->n > 0 && r->of_node[node] >= 0 ? &r->list[r->of_node[node]] : NULL;
}

/** Mean over the body by mass of vectors at nodes [n][2]: of places its centre, of velocities its velocity. */
vec2 rigid_body_mean(const rigid_body *b, const double *vectors);

/** Vectors at nodes [n][2], less one that is the same for all. */
typedef struct rigid_vectors {
    const double *at;
    vec2 less;
} rigid_vectors;

/** Sums over the body of m a.b and of m a x b. */
double rigid_body_dot(const rigid_body *b, rigid_vectors first, rigid_vectors second);
double rigid_body_cross(const rigid_body *b, rigid_vectors first, rigid_vectors second);

/** The pose nearest to places x [n][2], in which node k of the body is at pose_outside() of its shape[k]; it is at rest
 *  there. */
pose rigid_body_pose(const rigid_body *b, const double *x);

/** The node whose place deforms the body most, or whose velocity is furthest from a rigid motion along its guide; -1 if
 *  that is not more than a billionth of the body's size, or of its largest velocity. */
dem_index rigid_body_misplaced(const rigid_body *b, const double *x);
dem_index rigid_body_deviating(const rigid_body *b, const double *x, const double *v);

#endif
