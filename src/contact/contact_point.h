/* SPDX-License-Identifier: BSD-3-Clause */
/* Sites that may touch -- nodes, and edges of bodies -- and the contacts that they have closed: a node on a segment
 * of an obstacle, an edge on a convex vertex of it. Kinematics of a closed contact as functions of the state. */
#ifndef DEM_CONTACT_CONTACT_POINT_H
#define DEM_CONTACT_CONTACT_POINT_H

#include "base/state.h"
#include "forces/forces.h"

/** A closed contact of a site. */
typedef struct contact_point {
    dem_index feature;      /* the segment on which a node is, or the vertex on which an edge is */
    int slide;              /* the body slides along the tangent: 1, against it: -1; sticks: 0 */
    bool held;              /* one of two that hold a node at rest in a corner; there is no friction then */
    double place;           /* of a vertex on the edge where it sticks or may come to: 0 at its start, 1 at its end */
    double force, friction; /* N, along normal and tangent, at the last accepted step */
    /* of the impact under way: */
    bool fresh;    /* the contact was not closed before */
    bool opens;    /* and will not be after */
    bool struck;   /* it approached */
    bool rests;    /* what it gets away is no more than a hop that counts as rest */
    bool plastic;  /* it does not rebound, for it will last */
    vec2 before;   /* m/s, of the point of the body */
    vec2 impulse;  /* N s, given to the body */
    vec2 stop;     /* N s, of which last to stop it with its group; m/s, its velocity until then */
    double energy; /* J, taken by it */
} contact_point;

/** A node, or an edge from node to other, that may touch. */
typedef struct contact_candidate {
    dem_index node, other;    /* other: -1 for a node */
    dem_index previous, next; /* of an edge, the nodes before and after it on the boundary, or -1 */
    dem_index behind[2];      /* obstacle round whose free end the node (the edge's nodes) has passed, or -1 */
    int n_closed;             /* 0 free; 1; a node in a corner, an edge on two vertices: 2 */
    bool inactive;            /* it is far from all that it could touch besides, */
    double active_from;       /* m, until the bodies may have gone this far since the start */
    vec2 clear_at[2];         /* m, where its nodes were when all that it could touch besides */
    double clear;             /* m, was this far away */
    contact_point closed[2];
    int n_involved;     /* contacts in the impact under way: behind the closed ones are those that have opened */
    double storm_start; /* s */
    dem_index storm;    /* changes of this site since then */
} contact_candidate;

typedef struct contact_rule {
    double penetration_tolerance; /* m, depth at which an impact is taken */
    double position_error;        /* m, tolerance of positions: hops below it are rest */
    double rest_speed;            /* m/s, rebounds up to this are rest whatever else the rule says */
    double window;                /* s, impacts nearer than this are taken together */
    double max_step;              /* s, longest step: with t it sets how exactly an event is located */
    double storm_time;            /* s */
    dem_index max_impacts;        /* within storm_time at one site */
    bool vertices;                /* whether edges touch vertices */
    state_layout layout;          /* of the states */
    int n_threads;                /* that look at free sites at once; 0 counts as 1 */
    forces load;
} contact_rule;

/** What does not change during a run. */
typedef struct contact_scene {
    const dem_model *model;
    contact_rule rule;
} contact_scene;

/** A closed contact in a state: the point of the body that touches, and how it moves. */
typedef struct contact_frame {
    int n; /* nodes that carry the point: 1, or 2 */
    dem_index node[2];
    double weight[2];     /* sum 1 */
    vec2 normal, tangent; /* unit; out of the obstacle; tangent = (normal.y, -normal.x) */
    vec2 velocity;        /* m/s, of the point */
    double gap;           /* m, along the normal */
    double place;         /* m along a segment from its start; fraction of an edge from its start */
    double turning;       /* m/s^2, acceleration of the point along the normal that keeps it touching: 2 omega v_t */
    double keep[2];       /* m/s^2, the same, and that along the tangent which keeps it stuck, with what draws back
                             what the integrator's error has opened */
    double mobility;      /* 1/kg, sum of weight^2/m */
} contact_frame;

static inline const segment *scene_segment(const contact_scene *scene, dem_index s)
{
    return &scene->model->obstacles.segments[s];
}

/** By how much free ends of obstacles count as longer, m: beyond it an impact is not due to the end any more. */
static inline double scene_margin(const contact_scene *scene)
{
    return 10.0 * scene->rule.penetration_tolerance;
}

/** A state in which contacts are asked: the nodes' positions and velocities [n][2] at a time. */
typedef struct scene_state {
    double t; /* s */
    const double *x, *v;
} scene_state;

static inline bool candidate_is_edge(const contact_candidate *candidate)
{
    return candidate->other >= 0;
}

/** Where things stand in the states. */
static inline const state_layout *scene_layout(const contact_scene *scene)
{
    return &scene->rule.layout;
}

/** The state y = (x, v) at t. */
static inline scene_state scene_state_at(const contact_scene *scene, double t, const double *y)
{
    return (scene_state){t, y, y + state_velocities(scene_layout(scene))};
}

/** The segment that a contact is on, or that ends in the vertex it is on. */
dem_index contact_point_segment(const contact_scene *scene, const contact_candidate *candidate, dem_index feature);

/** The obstacle that it is on. */
const dem_obstacle *contact_point_obstacle(const contact_scene *scene, const contact_candidate *candidate,
                                           dem_index feature);

/** Coefficient of the sustained friction of Coulomb's law; 0 where there is none. */
double contact_point_friction(const contact_scene *scene, const contact_candidate *candidate, dem_index feature);

/** Frame of closed contact q of a site in a state. */
contact_frame contact_frame_at(const contact_scene *scene, const contact_candidate *candidate, int q,
                               scene_state state);

/** What rounding of the coordinates may make of the force of a contact, N. */
double contact_point_slack(const contact_scene *scene, const contact_frame *f, const double *x);

/** What rounding may leave of the velocity of a point at rest, m/s: 0 for a node, whose velocity is set. */
double contact_point_noise(const contact_frame *f, const double *v);

/** What the library tells of it at t. */
dem_contact contact_point_describe(const contact_scene *scene, const contact_candidate *candidate, int q, double t,
                                   const double *x);

#endif
