/* SPDX-License-Identifier: BSD-3-Clause */
/* An anchor: the friction of one node on another surface, as a spring that knows how far the node has come along that
 * surface. Within a step the spring depends on positions alone; how anchors change between steps is in anchor_set.c.
 * What a surface pushes a node with, N, and friction, T, have the same way to the nodes: each force of each pair is
 * turned by a right angle and scaled by T/N. */
#ifndef DEM_SURFACE_CONTACT_ANCHOR_H
#define DEM_SURFACE_CONTACT_ANCHOR_H

#include "surface_contact/contact_pair.h"

/** Of the nodes of a pair those on which forces act: CONTACT_PAIR_NODE, CONTACT_PAIR_FIRST and CONTACT_PAIR_SECOND. */
enum { ANCHOR_NODES = CONTACT_PAIR_BEFORE };

/** Vectors are along the edge, and to the left of it. */
typedef struct anchor {
    dem_index nodes[ANCHOR_NODES]; /* the node that is held, and the ends of the edge to which it is seen */
    dem_index edge;                /* number on the surface */
    double weight;                 /* of the second end in a point of the edge, 0 to 1; that of the first is the rest */
    vec2 place;                    /* m, where the node was from that point after the last step, */
    vec2 direction;                /* unit, that of friction then, */
    double shift;                  /* m, by which the spring was stretched then */
    double stiffness;              /* N/m, of the spring */
    double friction;               /* coefficient of friction of the two bodies */
} anchor;

/** How far the spring is stretched, m, at positions x [n][2] where the surface pushes the node with `normal`, N, which
 *  is not 0. Where it pushes the other way than after the last step, it is not. */
double anchor_shift(const anchor *a, vec2 normal, const double *x);

/** T/N: friction over the force that pushes the node, no more than the coefficient of friction in size. */
double anchor_ratio(const anchor *a, vec2 normal, const double *x);

/** Energy that the spring gives back when it is relieved, J. */
double anchor_energy(const anchor *a, vec2 normal, const double *x);

/** What friction adds to the forces of a pair with this T/N, N. Over all nodes it sums up to 0, and so do its
 *  moments. */
void anchor_turn_push(const contact_push *push, double ratio, const double *x, vec2 out[ANCHOR_NODES]);

/** Bounds of what the spring adds to the stiffness at each of its nodes, N/m: k (g.u)^2 is at most k |g| sum |g_i|
 *  u_i^2, with g the gradient of the shift and |g| the sum of the sizes |g_i|. */
void anchor_stiffness(const anchor *a, const double *x, double added[ANCHOR_NODES]);

/** Distance of the node's foot from the first end over the length of the edge. */
double anchor_foot(const anchor *a, const double *x);

/** Makes the positions x those after the last step, with this shift, m. */
void anchor_put(anchor *a, vec2 normal, double shift, const double *x);

#endif
