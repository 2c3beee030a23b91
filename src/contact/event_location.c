/* SPDX-License-Identifier: BSD-3-Clause */
/* Finds when a candidate's contacts change within an accepted step (docs/algorithms.md, Event location). The motion is
 * a quintic for each node, but a gap to polylines is only piecewise smooth, so that roots are isolated by samples, not
 * by the polynomial's coefficients: eight samples of the rest of the step, every dip between two of them followed to
 * its bottom, and a bracketed root closed in on by secants. Bounds on how far a candidate can move avoid all of it for
 * most candidates. The root functions are in candidate.c; who is asked, and what happens then, is in
 * automaton_step.c. */
#include "contact/event_location.h"

#include <float.h>

#include "base/bracket.h"
#include "contact/node_motion.h"

/* The gap of a free candidate at one time, and its root function there. */
typedef struct sample {
    double t; /* s */
    double guard;
    contact_gap gap;
} sample;

/* The gap is exact: a lower bound has no slope that shows a dip. A vertex that seems to be behind an edge which has not
 * used up its clearance has not come through it, and counts as far as the clearance says, as it does where the event
 * would be resolved: in a body folded over itself it may lie behind an edge's line, in another part of the body. */
static sample sample_edge(const contact_scene *scene, const contact_candidate *candidate, const dense_output *p,
                          double t)
{
    const candidate_positions spot = candidate_place_at(candidate, p, t);
    sample s = {.t = t, .gap = candidate_exact_gap(scene, candidate, &spot)};
    s.guard = contact_gap_guard(scene, &s.gap);
    if (s.guard > 0.0) return s;
    const contact_gap bound = candidate_gap(scene, candidate, &spot);
    s.guard = contact_gap_guard(scene, &bound);
    return s;
}

static sample sample_at(const contact_scene *scene, const contact_candidate *candidate, const dense_output *p, double t)
{
    if (candidate_is_edge(candidate)) return sample_edge(scene, candidate, p, t);
    const surface_query at = {t, node_motion_position(p, t, candidate->node)};
    sample s = {.t = t, .gap = candidate_node_gap(scene, candidate, at)};
    s.guard = contact_gap_guard(scene, &s.gap);
    return s;
}

static double guard_at(const contact_scene *scene, const contact_candidate *candidate, const dense_output *p, double t)
{
    return sample_at(scene, candidate, p, t).guard;
}

/* Derivative of the root function, m/s: the velocity of the nearest point relative to the surface, along the gap's
 * normal. Of an edge the point is at `place` between its nodes. */
static double slope_of(const contact_scene *scene, const contact_candidate *candidate, const dense_output *p,
                       const sample *s)
{
    vec2 v = node_motion_velocity(p, s->t, candidate->node);
    if (candidate_is_edge(candidate))
        v = vec2_add(vec2_scale(1.0 - s->gap.place, v),
                     vec2_scale(s->gap.place, node_motion_velocity(p, s->t, candidate->other)));
    if (surface_speed(scene) == 0.0) return vec2_dot(s->gap.normal, v);
    const candidate_positions spot = candidate_place_at(candidate, p, s->t);
    return vec2_dot(s->gap.normal, contact_gap_velocity(scene, candidate, &s->gap, &spot, v));
}

/* Whether the root function may be lower between two samples than at both: it falls at the first, or is higher there,
 * and it rises at the second, or is higher there. At one of them the vertex may be beside the edge, where there is no
 * slope, so a comparison of values alone is enough on either side. */
static bool dips(const contact_scene *scene, const contact_candidate *candidate, const dense_output *p, const sample *s,
                 const sample *next)
{
    return (next->guard < s->guard || slope_of(scene, candidate, p, s) < 0.0) &&
           (s->guard < next->guard || slope_of(scene, candidate, p, next) > 0.0);
}

/* Time of the minimum between two samples, by golden section, which shrinks the interval by 0.618 a trial; a value at
 * or below 0 ends the search, as any such time isolates the root. Where no vertex is near an edge its root function is
 * constant, and the search goes towards the lower sample. */
static double lowest(const contact_scene *scene, const contact_candidate *candidate, const dense_output *p,
                     const sample *s, const sample *next)
{
    const double ratio = 0.6180339887498949;
    double lo = s->t, hi = next->t, a = hi - ratio * (hi - lo), b = lo + ratio * (hi - lo);
    double ga = guard_at(scene, candidate, p, a), gb = guard_at(scene, candidate, p, b);
    for (int k = 0; k < 40 && ga > 0.0 && gb > 0.0; k++) {
        if (ga < gb || (ga == gb && s->guard < next->guard)) {
            hi = b;
            b = a;
            gb = ga;
            a = hi - ratio * (hi - lo);
            ga = guard_at(scene, candidate, p, a);
        } else {
            lo = a;
            a = b;
            ga = gb;
            b = lo + ratio * (hi - lo);
            gb = guard_at(scene, candidate, p, b);
        }
    }
    return ga < gb ? a : b;
}

/* The first time known at which the candidate is deeper than the penetration tolerance: the end of the bracket, where
 * the root function is not above 0. */
static double crossing(const contact_scene *scene, const contact_candidate *candidate, const dense_output *p,
                       const sample *clear, const sample *deep)
{
    const double width = dense_output_resolution(p);
    bracket b = {clear->t, deep->t, clear->guard, deep->guard, 0, 0};
    while (b.after - b.before > width) {
        const double t = bracket_trial(&b, width), guard = guard_at(scene, candidate, p, t);
        bracket_close(&b, t, guard, guard <= 0.0);
    }
    return b.after;
}

/* Speed of the faster node of a candidate, m/s. */
static double fastest(const dense_output *p, double t, const contact_candidate *candidate)
{
    const double v = vec2_norm(node_motion_velocity(p, t, candidate->node));
    return candidate_is_edge(candidate) ? fmax(v, vec2_norm(node_motion_velocity(p, t, candidate->other))) : v;
}

/* How far an edge may deviate in a step from uniform motion between its ends, m. A constant acceleration a takes a path
 * h^2 a/8 off its chord. Here four times as much is allowed, h^2/2 times the sum of three accelerations: the largest of
 * the nodes at both ends of the step, 2 omega v for the turning of the edge, and that of the surfaces. */
static double bend(const contact_scene *scene, const contact_candidate *candidate, const dense_output *p)
{
    const double h = p->t1 - p->t0;
    const dem_index v = state_velocities(&p->layout), a0 = candidate->node, b0 = candidate->other;
    const double *start = p->f0 + v, *end = p->f1 + v;
    const double a = fmax(fmax(vec2_norm(vec2_at(start, a0)), vec2_norm(vec2_at(end, a0))),
                          fmax(vec2_norm(vec2_at(start, b0)), vec2_norm(vec2_at(end, b0))));
    const vec2 va = node_motion_velocity(p, p->end, candidate->node),
               vb = node_motion_velocity(p, p->end, candidate->other);
    const double length = vec2_norm(
        vec2_sub(node_motion_position(p, p->end, candidate->other), node_motion_position(p, p->end, candidate->node)));
    const double turn =
        2.0 * vec2_norm(vec2_sub(vb, va)) / length * (fmax(vec2_norm(va), vec2_norm(vb)) + surface_speed(scene));
    return 0.5 * h * h * (a + turn + surface_acceleration(scene));
}

/* Whether no vertex can have come through an edge: none is near it or beside it at the end of the step, or the nearest
 * is further in front than the edge can have moved. Seen backwards from the end, the gap was smaller by no more than
 * the edge's speed along the normal times the time, and its bend. */
static bool edge_is_clear(const contact_scene *scene, const contact_candidate *candidate, const dense_output *p,
                          double from, double reach)
{
    const candidate_positions spot = candidate_place_at(candidate, p, p->end);
    const contact_gap around = candidate_around(scene, candidate, &spot, reach + scene->rule.penetration_tolerance);
    if (around.feature < 0) return true;
    const double va = vec2_dot(node_motion_velocity(p, p->end, candidate->node), around.normal),
                 vb = vec2_dot(node_motion_velocity(p, p->end, candidate->other), around.normal);
    const double way = (p->end - from) * fmax(0.0, fmax(va, vb) + surface_speed(scene));
    return around.distance + scene->rule.penetration_tolerance > way + bend(scene, candidate, p);
}

/* Whether a candidate ends the step so near to where its clearance was measured that it has touched nothing. */
static bool stays_clear(const contact_scene *scene, const contact_candidate *candidate, const dense_output *p,
                        double reach)
{
    const candidate_positions spot = candidate_place_at(candidate, p, p->end);
    return candidate_moved(scene, candidate, &spot) + reach < candidate->clearance.distance;
}

/* The first crossing of a candidate whose gap is exact, no lower bound. A node's gap changes no faster than the node
 * moves: to go from the first gap down to 0 and up to the last takes their sum, so a node that cannot go as far has not
 * touched. Between two samples dips are followed only where the lower gap is less than the way in an eighth of the
 * step. */
static double crossing_within(const contact_scene *scene, const contact_candidate *candidate, const dense_output *p,
                              double from, double reach)
{
    enum { n = 8 };
    const double h = p->end - from;
    if (candidate_is_edge(candidate) && edge_is_clear(scene, candidate, p, from, reach)) return INFINITY;
    const sample last = sample_at(scene, candidate, p, p->end);
    sample s = sample_at(scene, candidate, p, from);
    if (s.guard <= 0.0) return from;
    const bool on_its_way = s.guard + last.guard <= reach;
    if (!candidate_is_edge(candidate) && !on_its_way) return INFINITY;
    for (int k = 1; k <= n; k++) {
        const sample next = k == n ? last : sample_at(scene, candidate, p, from + h * k / n);
        if (next.guard <= 0.0) return crossing(scene, candidate, p, &s, &next);
        if (fmin(s.guard, next.guard) < reach / n && dips(scene, candidate, p, &s, &next)) {
            const sample low = sample_at(scene, candidate, p, lowest(scene, candidate, p, &s, &next));
            if (low.guard <= 0.0) return crossing(scene, candidate, p, &s, &low);
        }
        s = next;
    }
    return INFINITY;
}

static bool covers_all(const obstacle_lone_segment *lone, const double *points, int n)
{
    bool all = true;
    for (int k = 0; k < n; k++) all = all && obstacle_lone_covers(lone, vec2_at(points, k));
    return all;
}

/* Whether a free node has not touched anything, as the hull of its way is above its lone segment, by more than
 * the rounding errors of what would be found at any time. */
static bool way_is_clear(const contact_scene *scene, contact_candidate *candidate, const dense_output *p)
{
    double hull[2 * DENSE_OUTPUT_HULL], low = INFINITY;
    obstacle_lone_segment *lone = &candidate->lone;
    if (!candidate_meets_all(candidate)) return false;
    const int n = dense_output_hull(p, candidate->node, hull);
    if (!covers_all(lone, hull, n)) {
        *lone = surface_lone(scene, vec2_at(hull, 0));
        if (!covers_all(lone, hull, n)) return false;
    }
    const segment *line = surface_lone_segment(scene, lone);
    double size = fabs(line->start.x) + fabs(line->start.y);
    for (int k = 0; k < n; k++) {
        const double height = segment_height(line, vec2_at(hull, k));
        low = height < low ? height : low;
        size += fabs(hull[2 * k]) + fabs(hull[2 * k + 1]);
    }
    return low + scene->rule.penetration_tolerance > 64.0 * DBL_EPSILON * size;
}

/* `reach` bounds how far the candidate and the obstacles go towards each other: twice the way that its fastest node at
 * either end of the step makes, and the fastest obstacle. */
double event_location_crossing(const contact_scene *scene, contact_candidate *candidate, const dense_output *p,
                               double from)
{
    if (way_is_clear(scene, candidate, p)) return INFINITY;
    const double h = p->end - from;
    const double reach =
        2.0 * h * (fmax(fastest(p, from, candidate), fastest(p, p->end, candidate)) + surface_speed(scene));
    return stays_clear(scene, candidate, p, reach) ? INFINITY : crossing_within(scene, candidate, p, from, reach);
}

/* ---- closed contacts ---- */

static void put_position(const dense_output *p, double t, dem_index i, double *state)
{
    dense_output_position(p, t, i, state + state_row(&p->layout, i));
}

static void put_node(const dense_output *p, double t, dem_index i, double *state)
{
    put_position(p, t, i, state);
    dense_output_velocity(p, t, i, state + state_velocities(&p->layout) + state_row(&p->layout, i));
}

/* Puts a node and all those on which its force depends into the state at t: the rest of that state is not read. */
static void put_around(const forces *f, const dense_output *p, double t, dem_index i, double *state)
{
    put_node(p, t, i, state);
    for (forces_neighbours j = forces_neighbours_of(f, i); forces_next_neighbour(&j);) put_node(p, t, j.node, state);
}

void event_location_place(const contact_candidate *candidate, const dense_output *p, double t, double *state)
{
    put_position(p, t, candidate->node, state);
    if (candidate_is_edge(candidate)) put_position(p, t, candidate->other, state);
    if (candidate->previous >= 0) put_position(p, t, candidate->previous, state);
    if (candidate->next >= 0) put_position(p, t, candidate->next, state);
}

/* Neighbours of an edge are read by its gap, not by its forces; the time is read by forces that depend on it. */
void event_location_state(const contact_forces *r, dem_index group, const dense_output *p, double t, double *state)
{
    for (dem_index m = group; m >= 0; m = r->next[m]) {
        const contact_candidate *candidate = &r->candidates[m];
        put_around(r->scene->forces, p, t, candidate->node, state);
        if (!candidate_is_edge(candidate)) continue;
        put_around(r->scene->forces, p, t, candidate->other, state);
        if (candidate->previous >= 0) put_node(p, t, candidate->previous, state);
        if (candidate->next >= 0) put_node(p, t, candidate->next, state);
    }
    if (forces_are_driven(r->scene->forces)) put_node(p, t, state_time_row(&p->layout), state);
}

/* Solves for a group's forces at t, from the part of the state that they depend on. */
static void solve_at(contact_forces *r, dem_index group, const dense_output *p, double t, double *state)
{
    event_location_state(r, group, p, t, state);
    contact_forces_solve(r, group, scene_state_at(r->scene, t, state));
}

/* The lowest of a candidate's root functions in the state at t, each divided by its value at first, which makes forces,
 * lengths and speeds comparable. One that was not above 0 at first is left out. */
static double lowest_guard(contact_forces *r, dem_index k, double t, const double *state, const double *scale)
{
    double guard[CANDIDATE_ROOTS];
    candidate_root_functions(r->scene, &r->candidates[k], r->force[k], scene_state_at(r->scene, t, state), guard);
    return candidate_lowest_root(guard, scale);
}

/* Called where a change is due at the end of the step. Which end of the bracket moves is decided by candidate_due(),
 * the very condition by which the change is made; root functions only place the trials. A change that is due at first
 * is found at `from`. */
double event_location_change(contact_forces *r, const contact_candidate *candidate, const dense_output *p, double from,
                             double *state)
{
    const dem_index k = candidate - r->candidates, group = r->group[k];
    const double width = dense_output_resolution(p);
    const scene_state first = scene_state_at(r->scene, from, state);
    double scale[CANDIDATE_ROOTS];
    solve_at(r, group, p, from, state);
    if (candidate_due(r->scene, candidate, r->force[k], first)) return from;
    candidate_root_functions(r->scene, candidate, r->force[k], first, scale);
    bracket b = {from, p->end, lowest_guard(r, k, from, state, scale), 0.0, 0, 0};
    solve_at(r, group, p, p->end, state);
    b.below = lowest_guard(r, k, p->end, state, scale);
    while (b.after - b.before > width) {
        const double t = bracket_trial(&b, width);
        solve_at(r, group, p, t, state);
        bracket_close(&b, t, lowest_guard(r, k, t, state, scale),
                      candidate_due(r->scene, candidate, r->force[k], scene_state_at(r->scene, t, state)));
    }
    return b.after;
}
