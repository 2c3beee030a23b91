/* SPDX-License-Identifier: BSD-3-Clause */
/* Candidates that may touch -- nodes, and edges of bodies -- and the contacts that they have closed: a node on a
 * segment of an obstacle, an edge on a convex vertex of it. Kinematics of a closed contact as functions of the state:
 * its point, normal, gap, relative velocity, and the acceleration that keeps it closed. A contact that slides has the
 * sign of its motion along the tangent, one that sticks the sign 0. */
#ifndef DEM_CONTACT_CONTACT_POINT_H
#define DEM_CONTACT_CONTACT_POINT_H

#include "contact/contact_nodes.h"
#include "contact/surface_feature.h"

/** What a candidate is, whatever its place in a list: its nodes. With a feature it is the key of a contact point, as a
 *  candidate has one at most on each. */
typedef struct contact_key {
    dem_index node, other; /* other: -1 for a node */
} contact_key;

/** A closed contact of a candidate. */
typedef struct contact_point {
    dem_index feature;      /* the segment on which a node is, or the vertex on which an edge is */
    int slide;              /* the body slides along the tangent: 1, against it: -1; sticks: 0 */
    bool held;              /* one of two that hold a node at rest in a corner; there is no friction then */
    bool pinned;            /* one that sticks does so until the step ends, whatever friction that takes */
    double place;           /* of a vertex on the edge where it sticks or may come to: 0 at its start, 1 at its end */
    double force, friction; /* N, along normal and tangent, at the last accepted step */
} contact_point;

/** A lower bound of a candidate's distance to all that it can touch besides its closed contacts. */
typedef struct contact_clearance {
    bool inactive;      /* too far from everything to touch it */
    double active_from; /* m, and so until the broad phase's `travelled` is this */
    double t;           /* s, when the distance was measured */
    vec2 at[2];         /* m, where its nodes were at that time */
    double distance;    /* m, the distance then */
} contact_clearance;

/** Counts a candidate's changes in a short time, in a step and at once, and its events without a change, which are
 *  limited. */
typedef struct contact_storm {
    double start;      /* s */
    dem_index n;       /* changes since then */
    double step;       /* s, contact_set.step when it changed last */
    dem_index in_step; /* changes in that step */
    double last;       /* s, when it changed last */
    dem_index at_once; /* changes until then, none an instant after the one before */
    double idle_step;  /* s, contact_set.step when an event last had nothing to change */
    dem_index idle;    /* such events in that step since it changed last */
} contact_storm;

/** A node, or an edge from node to other, that may touch. */
typedef struct contact_candidate {
    dem_index node, other;    /* other: -1 for a node */
    dem_index previous, next; /* of an edge, the nodes before and after it on the boundary, or -1 */
    dem_index behind[2]; /* obstacle round whose free end the node (the edge's nodes) has passed, or in which it has
                                 come to the surface; or -1 */
    bool is_new;         /* a node that has come to the surface, and has not been looked at there */
    int n_closed;        /* 0 free; 1; a node in a corner, an edge on two vertices: 2 */
    contact_point closed[2];
    contact_clearance clearance;
    obstacle_lone_segment lone; /* of a node, about where it was when none was known there */
    contact_storm storm;
} contact_candidate;

/** A closed contact in a state: the point of the body that touches, and how it moves. */
typedef struct contact_frame {
    contact_nodes nodes;  /* that carry the point */
    vec2 normal, tangent; /* unit; out of the obstacle; tangent = (normal.y, -normal.x) */
    vec2 wall;            /* m/s, velocity of the obstacle there */
    vec2 velocity;        /* m/s, of the point relative to that */
    double gap;           /* m, along the normal */
    double place;         /* m along a segment from its start; fraction of an edge from its start */
    double turning;       /* m/s^2, normal acceleration of the point that keeps it touching: 2 omega v_t, and that of
                             a point which slides with it on the moving obstacle */
    double carried;       /* m/s^2, tangential acceleration of the latter */
    double keep[2];       /* m/s^2, normal and tangential acceleration that keep it closed and stuck, with a part that
                             draws back what the integrator's error has opened */
    double mobility;      /* 1/kg, of the nodes */
} contact_frame;

static inline bool candidate_is_edge(const contact_candidate *candidate)
{
    return candidate->other >= 0;
}

static inline contact_key candidate_key(const contact_candidate *candidate)
{
    return (contact_key){candidate->node, candidate->other};
}

/** An order of candidates by what they are, wherever they stand in a list: nodes before edges, both by the numbers of
 *  their nodes, the lower one first. */
bool candidate_is_before(const contact_candidate *a, const contact_candidate *b);

static inline bool contact_key_equal(contact_key a, contact_key b)
{
    return a.node == b.node && a.other == b.other;
}

/** Which of its closed contacts a candidate has on a feature, or -1. */
static inline int candidate_point_on(const contact_candidate *candidate, dem_index feature)
{
    for (int q = 0; q < candidate->n_closed; q++)
        if (candidate->closed[q].feature == feature) return q;
    return -1;
}

/** Whether a contact sticks by friction: it does not slide, nor is it held in a corner. */
static inline bool contact_point_sticks(const contact_point *point)
{
    return point->slide == 0 && !point->held;
}

/** What reports call its state: one that is held in a corner does not slide either. */
static inline dem_contact_state contact_point_state(const contact_point *point)
{
    return point->slide == 0 || point->held ? DEM_CONTACT_STICK : DEM_CONTACT_SLIP;
}

/** The feature with this number: a node touches segments, an edge touches vertices. */
static inline surface_feature contact_point_feature(const contact_candidate *candidate, dem_index id)
{
    return (surface_feature){candidate_is_edge(candidate) ? SURFACE_VERTEX : SURFACE_SEGMENT, id};
}

/** The contact law between a candidate and the feature with this number. */
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

/** Frame that a contact of a candidate on a feature would have, closed or not. */
contact_frame contact_frame_on(const contact_scene *scene, const contact_candidate *candidate, dem_index feature,
                               scene_state state);

/** contact_frame_at() where some obstacles move: a function of its own, so that runs without any do not pay for it. */
contact_frame contact_frame_moving(const contact_scene *scene, const contact_candidate *candidate, int q,
                                   scene_state state);

/** Acceleration of a node that stays on a segment with this line, which moves as `wall`, and slides along it as it
 *  does, m/s^2; where obstacles accelerate, with the terms that draw back what the integrator's error has opened. */
vec2 contact_point_keep(const contact_scene *scene, dem_index node, const surface_line *line,
                        const obstacle_motion *wall, scene_state state);

/** The same of a node that is held in the corner of two segments with these lines, which moves as `corner`. */
vec2 contact_point_keep_corner(const contact_scene *scene, dem_index node, const surface_line lines[2],
                               const obstacle_motion *corner, scene_state state);

/** Bound of the error of a contact's force by rounding of the coordinates, N. */
double contact_point_slack(const contact_scene *scene, const contact_frame *f, const double *x);

/** Velocity of the point itself, not relative to the obstacle, m/s. */
static inline vec2 contact_frame_velocity(const contact_frame *f, const double *v)
{
    return contact_nodes_sum(&f->nodes, v);
}

/** Bound of the velocity that rounding leaves to a point at rest, m/s: 0 for a node on an obstacle at rest, whose
 *  velocity is set to 0. */
double contact_point_noise(const contact_frame *f, const double *v);

/** What the public functions report of closed contact q at t. */
dem_contact contact_point_describe(const contact_scene *scene, const contact_candidate *candidate, int q, double t,
                                   const double *x);

#endif
