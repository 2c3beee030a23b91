/* SPDX-License-Identifier: BSD-3-Clause */
/* Candidates that may touch -- nodes, and edges of bodies -- and the contacts that they have closed: a node on a
 * segment of an obstacle, an edge on a convex vertex of it. Kinematics of a closed contact as functions of the
 * state. */
#ifndef DEM_CONTACT_CONTACT_POINT_H
#define DEM_CONTACT_CONTACT_POINT_H

#include "contact/surface_feature.h"

/** A closed contact of a candidate. */
typedef struct contact_point {
    dem_index feature;      /* the segment on which a node is, or the vertex on which an edge is */
    int slide;              /* the body slides along the tangent: 1, against it: -1; sticks: 0 */
    bool held;              /* one of two that hold a node at rest in a corner; there is no friction then */
    double place;           /* of a vertex on the edge where it sticks or may come to: 0 at its start, 1 at its end */
    double force, friction; /* N, along normal and tangent, at the last accepted step */
} contact_point;

/** How far a candidate is known to be from all that it could touch besides its closed contacts. */
typedef struct contact_clearance {
    bool inactive;      /* it is so far, */
    double active_from; /* m, until the bodies may have gone this far since the start */
    double t;           /* s, when it was */
    vec2 at[2];         /* m, where its nodes were then, */
    double distance;    /* m, this far away */
} contact_clearance;

/** Changes of a candidate in a short time. */
typedef struct contact_storm {
    double start; /* s */
    dem_index n;  /* changes since then */
} contact_storm;

/** A node, or an edge from node to other, that may touch. */
typedef struct contact_candidate {
    dem_index node, other;    /* other: -1 for a node */
    dem_index previous, next; /* of an edge, the nodes before and after it on the boundary, or -1 */
    dem_index behind[2];      /* obstacle round whose free end the node (the edge's nodes) has passed, or -1 */
    int n_closed;             /* 0 free; 1; a node in a corner, an edge on two vertices: 2 */
    contact_point closed[2];
    contact_clearance clearance;
    contact_storm storm;
} contact_candidate;

/** A closed contact in a state: the point of the body that touches, and how it moves. */
typedef struct contact_frame {
    int n; /* nodes that carry the point: 1, or 2 */
    dem_index node[2];
    double weight[2];     /* sum 1 */
    vec2 normal, tangent; /* unit; out of the obstacle; tangent = (normal.y, -normal.x) */
    vec2 wall;            /* m/s, velocity of the obstacle there */
    vec2 velocity;        /* m/s, of the point relative to that */
    double gap;           /* m, along the normal */
    double place;         /* m along a segment from its start; fraction of an edge from its start */
    double turning;       /* m/s^2, acceleration of the point along the normal that keeps it touching: 2 omega v_t, and
                             that of what stays on the obstacle there and slides as the point does */
    double carried;       /* m/s^2, along the tangent, of the latter */
    double keep[2];       /* m/s^2, the same, and that along the tangent which keeps it stuck, with what draws back
                             what the integrator's error has opened */
    double mobility;      /* 1/kg, sum of weight^2/m */
} contact_frame;

static inline bool candidate_is_edge(const contact_candidate *candidate)
{
    return candidate->other >= 0;
}

/** What a candidate touches under this number: a node touches segments, an edge vertices. */
static inline surface_feature contact_point_feature(const contact_candidate *candidate, dem_index id)
{
    return (surface_feature){candidate_is_edge(candidate) ? SURFACE_VERTEX : SURFACE_SEGMENT, id};
}

/** The law between a candidate and what it touches under this number. */
static inline contact_law contact_point_law(const contact_scene *scene, const contact_candidate *candidate,
                                            dem_index id)
{
    return contact_law_of(scene, surface_obstacle(scene, contact_point_feature(candidate, id)));
}

/** Coefficient of the sustained friction of Coulomb's law; 0 where there is none. */
double contact_point_friction(const contact_scene *scene, const contact_candidate *candidate, dem_index feature);

/** Frame of closed contact q of a candidate in a state. */
contact_frame contact_frame_at(const contact_scene *scene, const contact_candidate *candidate, int q,
                               scene_state state);

/** The same where some obstacles move: apart, so that those at rest cost nothing more. */
contact_frame contact_frame_moving(const contact_scene *scene, const contact_candidate *candidate, int q,
                                   scene_state state);

/** What rounding of the coordinates may make of the force of a contact, N. */
double contact_point_slack(const contact_scene *scene, const contact_frame *f, const double *x);

/** Velocity of the point seen from outside, m/s. */
vec2 contact_frame_velocity(const contact_frame *f, const double *v);

/** What rounding may leave of the velocity of a point at rest, m/s: 0 for a node on an obstacle at rest, whose velocity
 *  is set. */
double contact_point_noise(const contact_frame *f, const double *v);

/** What the library tells of it at t. */
dem_contact contact_point_describe(const contact_scene *scene, const contact_candidate *candidate, int q, double t,
                                   const double *x);

#endif
