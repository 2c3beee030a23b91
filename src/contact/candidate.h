/* SPDX-License-Identifier: BSD-3-Clause */
/* What a candidate can touch, and the root functions that tell when its contacts change. Pure functions of (t, x, v)
 * and of the forces that follow from them; nothing here changes a state. */
#ifndef DEM_CONTACT_CANDIDATE_H
#define DEM_CONTACT_CANDIDATE_H

#include "contact/contact_forces.h"
#include "time/dense_output.h"

/** Root functions per candidate; each is > 0 while its contacts stay as they are and falls through 0 at a change. */
enum { CANDIDATE_ROOTS = 4 };

/** Distance to what a candidate is not in contact with. */
typedef struct contact_gap {
    double distance;   /* m, > 0 in front; infinity: nothing there */
    dem_index feature; /* segment, or vertex; -1: none, or the distance is a lower bound */
    double place;      /* of a vertex on the edge, 0 to 1 */
    vec2 normal;       /* unit, the way in which the distance grows */
} contact_gap;

/** Where the nodes of a candidate are at a time: a, an edge's second b, and an edge's neighbours on the boundary. */
typedef struct candidate_positions {
    double t; /* s */
    vec2 a, b, previous, next;
} candidate_positions;

candidate_positions candidate_place(const contact_candidate *candidate, double t, const double *x);
candidate_positions candidate_place_at(const contact_candidate *candidate, const dense_output *p, double t);

/** Whether no obstacle is left out of a candidate's gap: it is a free node, and behind nothing. */
static inline bool candidate_meets_all(const contact_candidate *candidate)
{
    return candidate->n_closed == 0 && candidate->behind[0] < 0 && !candidate_is_edge(candidate);
}

/** Bound of how far a candidate and the obstacles have moved towards each other since its clearance was measured, m. */
double candidate_moved(const contact_scene *scene, const contact_candidate *candidate, const candidate_positions *spot);

/** Gap of a candidate: infinite for an inactive one, a lower bound while it has moved less than its clearance. What it
 *  is in contact with is left out: for a node on a segment the whole obstacle of that segment, whose ends have a root
 *  function of their own; for an edge its vertex. */
contact_gap candidate_gap(const contact_scene *scene, const contact_candidate *candidate,
                          const candidate_positions *spot);

/** The same without the bound, whatever the clearance: what has a slope that shows a dip. */
contact_gap candidate_exact_gap(const contact_scene *scene, const contact_candidate *candidate,
                                const candidate_positions *spot);

/** The gap of a node at a place by a search. */
contact_gap candidate_searched_gap(const contact_scene *scene, const contact_candidate *candidate, surface_query at);

/** The same: of what its lone segment covers without one. */
static inline contact_gap candidate_node_gap(const contact_scene *scene, const contact_candidate *candidate,
                                             surface_query at)
{
    if (!candidate_meets_all(candidate) || !obstacle_lone_covers(&candidate->lone, at.x))
        return candidate_searched_gap(scene, candidate, at);
    const obstacle_gap height = surface_lone_gap(scene, &candidate->lone, at.x);
    return (contact_gap){height.distance, height.segment, 0.0, height.normal};
}

/** Root function of a gap, m: gap + penetration tolerance. It is bounded: where there is nothing to touch the gap is
 *  infinite. */
static inline double contact_gap_guard(const contact_scene *scene, const contact_gap *gap)
{
    const double most = 1.0; /* fmin() is a call */
    return (gap->distance < most ? gap->distance : most) + scene->rule.penetration_tolerance;
}

/** contact_gap_velocity() where some surfaces move: a function of its own, so that others do not pay for it. */
vec2 contact_gap_velocity_moving(const contact_scene *scene, const contact_candidate *candidate, const contact_gap *gap,
                                 const candidate_positions *spot, vec2 v);

/** Velocity of the point of a candidate at its gap, relative to the surface there; v is that of the point itself. */
static inline vec2 contact_gap_velocity(const contact_scene *scene, const contact_candidate *candidate,
                                        const contact_gap *gap, const candidate_positions *spot, vec2 v)
{
    return surface_speed(scene) == 0.0 ? v : contact_gap_velocity_moving(scene, candidate, gap, spot, v);
}

/** The nearest vertex within reach (m) of an edge, in front of it, behind it or beside it. */
contact_gap candidate_around(const contact_scene *scene, const contact_candidate *candidate,
                             const candidate_positions *spot, double reach);

/** How far at least a candidate is from everything else that it can touch, m; < 0 inside.
 *  \param[out] nearest  of a node, the nearest segment */
double candidate_clearance(const contact_scene *scene, const contact_candidate *candidate,
                           const candidate_positions *spot, dem_index *nearest);

/** Whether contact q is beyond the end of its segment or edge by the penetration tolerance and heads out: 1, or -1
 *  beyond the start. */
int candidate_end_passed(const contact_scene *scene, const contact_candidate *candidate, int q, scene_state state);

/** Whether sliding contact q has turned back: it slides against its sign. Without friction that does not matter. */
bool candidate_turns(const contact_scene *scene, const contact_candidate *candidate, int q, const contact_frame *f,
                     const double *v);

/** How far the friction of contact q is below what the normal force and rounding allow, N; infinity unless it sticks by
 *  friction. */
double candidate_grip(const contact_scene *scene, const contact_candidate *candidate, int q, const contact_frame *f,
                      const contact_force *force, const double *x);

/** Values of the root functions in a state, [CANDIDATE_ROOTS]: gap + penetration tolerance; smallest normal force;
 *  distance to the nearer end + penetration tolerance of a sliding contact, grip of a sticking one; speed of sliding.
 *  One that does not apply is 1.
 *  \param force  of its closed contacts in that state */
void candidate_root_functions(const contact_scene *scene, const contact_candidate *candidate,
                              const contact_force force[2], scene_state state, double *g);

/** The lowest of root functions, each in its unit; one whose unit is not above 0 is left out. Infinity if all are. */
static inline double candidate_lowest_root(const double g[CANDIDATE_ROOTS], const double unit[CANDIDATE_ROOTS])
{
    double low = INFINITY;
    for (int q = 0; q < CANDIDATE_ROOTS; q++)
        if (unit[q] > 0.0) low = fmin(low, g[q] / unit[q]);
    return low;
}

/** Whether a closed candidate's contacts have to change in a state. */
bool candidate_due(const contact_scene *scene, const contact_candidate *candidate, const contact_force force[2],
                   scene_state state);

#endif
