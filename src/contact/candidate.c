/* SPDX-License-Identifier: BSD-3-Clause */
/* Gaps and root functions of one candidate (docs/algorithms.md, Event location; docs/method.md, Gaps). A root function
 * is above zero while the contacts of the candidate stay as they are; the table of them for free, sliding, sticking and
 * held candidates is in algorithms.md. The root of the gap replaces the contact time (7). What happens at a root is
 * decided in candidate_resolve.c, and when it is in event_location.c; here nothing is changed. */
#include "contact/candidate.h"

#include "contact/node_motion.h"

/* ---- gaps ---- */

candidate_positions candidate_place(const contact_candidate *candidate, double t, const double *x)
{
    candidate_positions spot = {.t = t, .a = vec2_at(x, candidate->node)};
    spot.b = candidate_is_edge(candidate) ? vec2_at(x, candidate->other) : spot.a;
    spot.previous = candidate->previous >= 0 ? vec2_at(x, candidate->previous) : spot.a;
    spot.next = candidate->next >= 0 ? vec2_at(x, candidate->next) : spot.b;
    return spot;
}

candidate_positions candidate_place_at(const contact_candidate *candidate, const dense_output *p, double t)
{
    candidate_positions spot = {.t = t, .a = node_motion_position(p, t, candidate->node)};
    spot.b = candidate_is_edge(candidate) ? node_motion_position(p, t, candidate->other) : spot.a;
    spot.previous = candidate->previous >= 0 ? node_motion_position(p, t, candidate->previous) : spot.a;
    spot.next = candidate->next >= 0 ? node_motion_position(p, t, candidate->next) : spot.b;
    return spot;
}

/* The signed distance of a node to the obstacles, but for the one that it is behind and the one of its closed contact:
 * that obstacle's other segments are reached past the end of this one, which has a root function of its own. */
contact_gap candidate_searched_gap(const contact_scene *scene, const contact_candidate *candidate, surface_query at)
{
    const surface_feature on = contact_point_feature(candidate, candidate->closed[0].feature);
    const dem_index without[2] = {candidate->behind[0], candidate->n_closed > 0 ? surface_obstacle(scene, on) : -1};
    const obstacle_gap gap = surface_gap(scene, at, scene_margin(scene), without);
    return (contact_gap){gap.distance, gap.segment, 0.0, gap.normal};
}

/* Which vertices an edge's gap is taken to, as shares of its length: up to the first in front of it and up to the
 * second behind it, as far as a step may take one. */
static const double edge_reach = 0.5, edge_depth = 0.25;

static obstacle_edge edge_query(const contact_scene *scene, const contact_candidate *candidate,
                                const candidate_positions *spot)
{
    const double length = vec2_norm(vec2_sub(spot->b, spot->a));
    return (obstacle_edge){.a = spot->a,
                           .b = spot->b,
                           .previous = spot->previous,
                           .next = spot->next,
                           .tolerance = scene->rule.penetration_tolerance,
                           .depth = edge_depth * length,
                           .reach = edge_reach * length,
                           .without = {candidate->behind[0], candidate->behind[1]},
                           .except = {candidate->n_closed > 0 ? candidate->closed[0].feature : -1, -1}};
}

static contact_gap edge_gap(const contact_scene *scene, const contact_candidate *candidate,
                            const candidate_positions *spot)
{
    const obstacle_edge edge = edge_query(scene, candidate, spot);
    const obstacle_vertex_gap nearest = surface_vertex_gap(scene, spot->t, &edge);
    return (contact_gap){nearest.distance, nearest.vertex, nearest.place, nearest.normal};
}

/* The gap of a candidate changes by no more than the larger displacement of its nodes plus the way of the fastest
 * obstacle: every point of an edge lies between its nodes. */
double candidate_moved(const contact_scene *scene, const contact_candidate *candidate, const candidate_positions *spot)
{
    const double wall = surface_speed(scene) * fabs(spot->t - candidate->clearance.t);
    const double a = vec2_norm(vec2_sub(spot->a, candidate->clearance.at[0]));
    return wall +
           (candidate_is_edge(candidate) ? fmax(a, vec2_norm(vec2_sub(spot->b, candidate->clearance.at[1]))) : a);
}

/* The nearest point of a segment is found from the gap: its foot, -distance n from the node. */
vec2 contact_gap_velocity_moving(const contact_scene *scene, const contact_candidate *candidate, const contact_gap *gap,
                                 const candidate_positions *spot, vec2 v)
{
    if (gap->feature < 0) return v;
    const vec2 at = candidate_is_edge(candidate) ? surface_vertex_at(scene, gap->feature, spot->t)
                                                 : vec2_along(spot->a, -gap->distance, gap->normal);
    const dem_index id = surface_segment(scene, contact_point_feature(candidate, gap->feature));
    const obstacle_motion wall = surface_motion(scene, id, (surface_query){spot->t, at});
    return obstacle_motion_relative(&wall, v);
}

/* A candidate with two closed contacts is held in its corner or notch and touches nothing else. While the clearance
 * that was measured last is not used up, what is left of it is a lower bound, and costs no search. */
contact_gap candidate_gap(const contact_scene *scene, const contact_candidate *candidate,
                          const candidate_positions *spot)
{
    const bool bounded =
        candidate->n_closed < 2 && !candidate->clearance.inactive && candidate->clearance.distance > 0.0;
    const double left = bounded ? candidate->clearance.distance - candidate_moved(scene, candidate, spot) : 0.0;
    if (left > 0.0) return (contact_gap){left, -1, 0.0, {0.0, 0.0}};
    return candidate_exact_gap(scene, candidate, spot);
}

contact_gap candidate_exact_gap(const contact_scene *scene, const contact_candidate *candidate,
                                const candidate_positions *spot)
{
    if (candidate->n_closed == 2 || candidate->clearance.inactive) return (contact_gap){INFINITY, -1, 0.0, {0.0, 0.0}};
    return candidate_is_edge(candidate) ? edge_gap(scene, candidate, spot)
                                        : candidate_node_gap(scene, candidate, (surface_query){spot->t, spot->a});
}

/* The edge counts as longer at both ends by the reach, and its neighbours are left out of the question. */
contact_gap candidate_around(const contact_scene *scene, const contact_candidate *candidate,
                             const candidate_positions *spot, double reach)
{
    obstacle_edge edge = edge_query(scene, candidate, spot);
    edge.tolerance = edge.depth = edge.reach = reach;
    edge.previous = edge.a;
    edge.next = edge.b;
    const obstacle_vertex_gap nearest = surface_vertex_gap(scene, spot->t, &edge);
    return (contact_gap){nearest.distance, nearest.vertex, nearest.place, nearest.normal};
}

/* The distance of an edge to the nearest vertex, if there is one within its reach of half its length. If there is none,
 * a vertex is at least as far from the edge as its first node is from the obstacles, less the length of the edge,
 * near/edge_reach. */
static double edge_clearance(const contact_scene *scene, const contact_candidate *candidate,
                             const candidate_positions *spot)
{
    const obstacle_edge edge = edge_query(scene, candidate, spot);
    const double near = surface_clearance(scene, spot->t, &edge);
    if (near < edge.reach) return near;
    return fmax(near, surface_gap(scene, (surface_query){spot->t, spot->a}, 0.0, candidate->behind).distance -
                          near / edge_reach);
}

double candidate_clearance(const contact_scene *scene, const contact_candidate *candidate,
                           const candidate_positions *spot, dem_index *nearest)
{
    if (candidate_is_edge(candidate)) return edge_clearance(scene, candidate, spot);
    const contact_gap gap = candidate_node_gap(scene, candidate, (surface_query){spot->t, spot->a});
    *nearest = gap.feature;
    return gap.distance;
}

/* ---- root functions of closed contacts ---- */

/* Distance to the nearer end of the segment or edge plus the penetration tolerance, m: a contact that far beyond an end
 * has passed it. `end` is 1 for the end, -1 for the start. For an edge the place of the vertex on it counts, as now,
 * not as it was when a contact stuck. */
static double end_guard(const contact_scene *scene, const contact_candidate *candidate, int q, scene_state state,
                        int *end)
{
    double place, length;
    if (candidate_is_edge(candidate)) {
        const vec2 a = vec2_at(state.x, candidate->node), ab = vec2_sub(vec2_at(state.x, candidate->other), a);
        length = vec2_norm(ab);
        place = vec2_dot(vec2_sub(surface_vertex_at(scene, candidate->closed[q].feature, state.t), a), ab) / length;
    } else {
        const surface_line line = surface_line_at(scene, candidate->closed[q].feature, state.t);
        length = line.length;
        place = surface_place(&line, vec2_at(state.x, candidate->node));
    }
    *end = place > 0.5 * length ? 1 : -1;
    return fmin(place, length - place) + scene->rule.penetration_tolerance;
}

/* A contact beyond an end has passed it only if it heads out. Its tangential velocity tells, or for one at rest its
 * acceleration less that of the wall. A vertex moves along the edge opposite to the body. */
int candidate_end_passed(const contact_scene *scene, const contact_candidate *candidate, int q, scene_state state)
{
    int end;
    if (contact_point_sticks(&candidate->closed[q]) || end_guard(scene, candidate, q, state, &end) > 0.0) return 0;
    const contact_frame f = contact_frame_at(scene, candidate, q, state);
    double speed = vec2_dot(f.velocity, f.tangent);
    const bool rests = speed == 0.0;
    for (int p = 0; p < f.nodes.n && rests; p++)
        speed += f.nodes.weight[p] *
                 vec2_dot(forces_acceleration(scene->forces, f.nodes.node[p], state.x, state.v), f.tangent);
    if (rests) speed -= f.carried;
    const double heading = candidate_is_edge(candidate) ? -speed : speed;
    return end * heading > 0.0 ? end : 0;
}

/* In penetration tolerances per longest step: slower sliding than this is rounding. */
static const double rest_noise = 1e-16;

/* A sliding contact may have a velocity against its sign by rounding alone, just after it began to slide. It has turned
 * back only if that exceeds what rounding leaves. */
bool candidate_turns(const contact_scene *scene, const contact_candidate *candidate, int q, const contact_frame *f,
                     const double *v)
{
    const int sign = candidate->closed[q].slide;
    if (sign == 0 || contact_point_friction(scene, candidate, candidate->closed[q].feature) == 0.0) return false;
    const double least = rest_noise * scene->rule.penetration_tolerance / scene->rule.max_step;
    return sign * vec2_dot(f->velocity, f->tangent) < -fmax(contact_point_noise(f, v), least);
}

/* mu N - abs(T) plus the rounding of forces: without that a contact at the limit of friction could begin to slide and
 * stop without end. One that is pinned has no limit. */
double candidate_grip(const contact_scene *scene, const contact_candidate *candidate, int q, const contact_frame *f,
                      const contact_force *force, const double *x)
{
    if (!contact_point_sticks(&candidate->closed[q]) || candidate->closed[q].pinned) return INFINITY;
    const double limit = contact_point_friction(scene, candidate, candidate->closed[q].feature) * force->normal;
    return limit + contact_point_slack(scene, f, x) - fabs(force->tangent);
}

/* Of two closed contacts the lower value counts. In the order of g: gap; normal force, N; for contacts that slide the
 * end of the segment, m, for those that stick the grip, N; speed along the sign, m/s, where there is friction. What
 * does not apply is 1. */
void candidate_root_functions(const contact_scene *scene, const contact_candidate *candidate,
                              const contact_force force[2], scene_state state, double *g)
{
    int end;
    const candidate_positions spot = candidate_place(candidate, state.t, state.x);
    const contact_gap gap = candidate_gap(scene, candidate, &spot);
    g[0] = contact_gap_guard(scene, &gap);
    g[1] = g[2] = g[3] = 1.0;
    if (candidate->n_closed == 0) return;
    g[1] = g[2] = g[3] = INFINITY;
    for (int q = 0; q < candidate->n_closed; q++) {
        const contact_point *point = &candidate->closed[q];
        const bool slides = !contact_point_sticks(point);
        g[1] = fmin(g[1], force[q].normal);
        if (point->held) continue;
        if (slides) g[2] = fmin(g[2], end_guard(scene, candidate, q, state, &end));
        if (slides && contact_point_friction(scene, candidate, point->feature) == 0.0) continue;
        const contact_frame f = contact_frame_at(scene, candidate, q, state);
        if (slides)
            g[3] = fmin(g[3], point->slide * vec2_dot(f.velocity, f.tangent));
        else
            g[2] = fmin(g[2], candidate_grip(scene, candidate, q, &f, &force[q], state.x));
    }
    for (int k = 1; k < CANDIDATE_ROOTS; k++)
        if (isinf(g[k])) g[k] = 1.0;
}

/* The same conditions as candidate_root_functions(), but without those that rounding alone may put below zero: an end
 * is passed only when heading out, and a speed below rounding is no turning back. */
bool candidate_due(const contact_scene *scene, const contact_candidate *candidate, const contact_force force[2],
                   scene_state state)
{
    const candidate_positions spot = candidate_place(candidate, state.t, state.x);
    const contact_gap gap = candidate_gap(scene, candidate, &spot);
    if (contact_gap_guard(scene, &gap) <= 0.0) return true;
    for (int q = 0; q < candidate->n_closed; q++) {
        if (force[q].normal <= 0.0) return true;
        if (candidate->closed[q].held) continue;
        if (candidate_end_passed(scene, candidate, q, state) != 0) return true;
        if (contact_point_friction(scene, candidate, candidate->closed[q].feature) == 0.0) continue;
        const contact_frame f = contact_frame_at(scene, candidate, q, state);
        if (candidate_grip(scene, candidate, q, &f, &force[q], state.x) < 0.0 ||
            candidate_turns(scene, candidate, q, &f, state.v))
            return true;
    }
    return false;
}
