/* SPDX-License-Identifier: BSD-3-Clause */
/* A contact pair: a node of a surface, and an edge of a surface that may push it. The potential of a node against a
 * surface is the sum over the edges less the sum over the vertices that two of them count, so that it has no closest
 * feature that could change: where the surface is smooth it is that of the distance, and elsewhere it is continuously
 * differentiable. Each edge brings the vertex at its first end. Where the next edge never touches the node, the edge
 * takes the vertex between off, so that its potential begins with 0 there. */
#ifndef DEM_SURFACE_CONTACT_CONTACT_PAIR_H
#define DEM_SURFACE_CONTACT_CONTACT_PAIR_H

#include <stdbool.h>

#include "base/vec2.h"
#include "surface_contact/contact_potential.h"

/** What the nodes of a pair are. */
enum {
    CONTACT_PAIR_NODE,   /**< the node that is pushed */
    CONTACT_PAIR_FIRST,  /**< first end of the edge, which runs with its body on the left */
    CONTACT_PAIR_SECOND, /**< its second end */
    CONTACT_PAIR_BEFORE, /**< the node before the first end on the same surface, */
    CONTACT_PAIR_AFTER,  /**< and the one after the second: friction alone acts on these two; at the free end of an
                            obstacle the other end of the edge */
    CONTACT_PAIR_NODES
};

/** Of the nodes of a pair those on which the potential acts. */
enum { CONTACT_PAIR_PUSHED = CONTACT_PAIR_BEFORE };

typedef struct contact_pair {
    dem_index nodes[CONTACT_PAIR_NODES];
    double thickness; /* m, contact thickness of the two bodies */
    double weight;    /* N, half the node's length of surface times the contact modulus of the two bodies */
    bool ends_at_first, ends_at_second; /* whether the edge beyond that end never touches the node */
    bool fills; /* it is what a broken triangle leaves between its corner and the edge opposite; `thickness` is
                   then how far these were apart when it broke, at most its height at rest */
} contact_pair;

/** The forces of a pair, N. */
typedef struct contact_push {
    const contact_pair *pair;
    vec2 by_edge;   /* on the node, by the inside of the edge */
    double share;   /* of it the second end takes this part, and the first end the rest */
    vec2 by_vertex; /* on the node, by the first end */
    vec2 by_second; /* likewise by the second end */
} contact_push;

/** Forces of a pair at positions x [n][2].  \return whether the node is near enough for any */
bool contact_pair_push(const contact_pair *p, const double *x, contact_push *out);

/** Adds the forces of the two ends to those of the inside of the edge.
 *  \param near_first  whether the node is so near to the first end that it might push
 *  \return whether there are any */
bool contact_pair_push_ends(const contact_pair *p, bool near_first, const double *x, contact_push *out);

/** How the node of a pair AB lies to its edge; with r = p - A, t = B - A. */
typedef struct edge_terms {
    vec2 t;
    double along, front, square, radius; /* r.t, r x t, t.t, r.r */
    bool by_edge;                        /* the inside of the edge pushes */
    bool near_first;                     /* the node is so near to the first end that it might */
} edge_terms;

/** Without a root or a division, of node and edge AB at these places, for a part of the contact thickness up to 1. */
static inline edge_terms contact_pair_terms_at(vec2 node, vec2 a, vec2 b, double part, double thickness)
{
    const vec2 r = vec2_sub(node, a), t = vec2_sub(b, a);
    const double along = vec2_dot(r, t), front = vec2_cross(r, t), square = vec2_dot(t, t), radius = vec2_dot(r, r);
    const double limit = part * part * thickness * thickness;
    const bool beside = along >= 0.0 && vec2_dot(vec2_sub(node, b), t) < 0.0;
    return (edge_terms){.t = t,
                        .along = along,
                        .front = front,
                        .square = square,
                        .radius = radius,
                        .by_edge = beside && front > 0.0 && front * front < limit * square,
                        .near_first = radius < limit};
}

/** Of a pair at positions x [n][2], for the whole thickness. */
static inline edge_terms contact_pair_terms(const contact_pair *p, const double *x)
{
    return contact_pair_terms_at(vec2_at(x, p->nodes[CONTACT_PAIR_NODE]), vec2_at(x, p->nodes[CONTACT_PAIR_FIRST]),
                                 vec2_at(x, p->nodes[CONTACT_PAIR_SECOND]), 1.0, p->thickness);
}

/** What an edge that pushes does. */
typedef struct edge_push {
    double share;       /* of the second end */
    double u, pressure; /* distance over thickness; contact_potential_pressure() */
    vec2 normal;
} edge_push;

static inline edge_push contact_pair_edge(edge_terms e, double thickness)
{
    const double length = sqrt(e.square), u = e.front / length / thickness;
    return (edge_push){.share = e.along / e.square,
                       .u = u,
                       .pressure = contact_potential_pressure(u),
                       .normal = {e.t.y / length, -e.t.x / length}};
}

/** Force on one of the nodes, N. Over all of them the forces sum up to 0, and so do their moments. */
static inline vec2 contact_push_on(const contact_push *push, int which)
{
    if (which == CONTACT_PAIR_NODE) return vec2_add(vec2_add(push->by_edge, push->by_vertex), push->by_second);
    if (which == CONTACT_PAIR_FIRST)
        return vec2_along(vec2_scale(-1.0, push->by_vertex), push->share - 1.0, push->by_edge);
    if (which == CONTACT_PAIR_SECOND) return vec2_along(vec2_scale(-1.0, push->by_second), -push->share, push->by_edge);
    return (vec2){0.0, 0.0};
}

/** The sizes of the forces on the node, with a minus where an end is taken off, N. */
double contact_push_size(const contact_push *push, const double *x);

/** Energy at positions x, J; < 0 where it takes back what another pair has too much. */
double contact_pair_energy(const contact_pair *p, const double *x);

/** Bounds of what the pair adds to the stiffness at each of its nodes, N/m: K (n.(u_p - (1-s) u_A - s u_B))^2 is at
 *  most 2 K (u_p^2 + (1-s) u_A^2 + s u_B^2).
 *  \param[out] added  of the nodes that are pushed, if the node is near enough for any
 *  \return whether it is */
bool contact_pair_stiffness(const contact_pair *p, const double *x, double added[CONTACT_PAIR_PUSHED]);

/** Square of the distance of a point from the segment ab, m^2. */
static inline double contact_pair_square_distance(vec2 point, vec2 a, vec2 b)
{
    const vec2 r = vec2_sub(point, a), t = vec2_sub(b, a);
    const double s = vec2_dot(r, t) / vec2_dot(t, t), beside = s < 1.0 ? s : 1.0;
    const vec2 way = vec2_along(r, s > 0.0 ? -beside : -0.0, t);
    return vec2_dot(way, way);
}

/** That distance, m. */
static inline double contact_pair_distance(vec2 point, vec2 a, vec2 b)
{
    return sqrt(contact_pair_square_distance(point, a, b));
}

/** Square of the distance of the node of a pair from its edge, m^2. */
static inline double contact_pair_square_gap(const contact_pair *p, const double *x)
{
    return contact_pair_square_distance(vec2_at(x, p->nodes[CONTACT_PAIR_NODE]),
                                        vec2_at(x, p->nodes[CONTACT_PAIR_FIRST]),
                                        vec2_at(x, p->nodes[CONTACT_PAIR_SECOND]));
}

/** That distance, m. */
static inline double contact_pair_gap(const contact_pair *p, const double *x)
{
    return sqrt(contact_pair_square_gap(p, x));
}

/** Whether the node crosses the edge when all move along straight lines from x0 to x1.
 *  \param[out] when  the part of the way at which it does */
bool contact_pair_crosses(const contact_pair *p, const double *x0, const double *x1, double *when);

#endif
