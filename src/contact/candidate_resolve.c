/* SPDX-License-Identifier: BSD-3-Clause */
/* Which change of a candidate's contacts is due in a state, and makes the first one (docs/method.md, Contacts that
 * last: the list of five). The order matters: a contact that pulls is released before friction is asked about, and one
 * that has turned back is stopped before its end is looked at. One call makes one change at most; automaton.c calls
 * until none is due. How an impact changes velocities is behind impact_solve(); the signs that tell of a change are in
 * candidate.c. */
#include "contact/candidate_resolve.h"

#include "base/status.h"
#include "contact/impact_group.h"
#include "contact/impact_rest.h"
#include "contact/impact_solve.h"

/* Share of the penetration tolerance: a candidate as deep as this touches, so that several that touch at nearly the
 * same time are resolved together. */
static const double touch_share = 0.99;

/* ---- free candidates ---- */

/* A node deeper inside than it can be at an impact has gone round a free end if it is at one; else it is an error. An
 * impact is found with a depth of impact_target_depth() at most. */
static dem_status go_behind(contact_set *c, dem_index k, dem_index feature, double depth, const contact_instant *now)
{
    const vec2 x = vec2_at(now->x, c->list[k].node);
    const surface_line line = surface_line_at(&c->scene, feature, now->t);
    const dem_index obstacle = surface_obstacle(&c->scene, (surface_feature){SURFACE_SEGMENT, feature});
    const bool at_free_end =
        surface_at_free_end(&c->scene, feature, surface_place(&line, x), impact_target_depth(c, k, now));
    CHECK(at_free_end && c->list[k].behind[0] < 0, DEM_ERROR_CONTACT,
          "node %lld at (%g, %g) m is %g m inside obstacle %lld at t = %.9g s", scene_node(&c->scene, c->list[k].node),
          x.x, x.y, depth, (long long)obstacle, now->t);
    contact_set_pass_behind(c, k, obstacle);
    return DEM_OK;
}

/* A node that touches hits the segments there; right on an apex it is an edge at the node that hits the vertex. A node
 * that is too deep for an impact, or touches no segment, is behind the obstacle. */
static dem_status touch_node(contact_set *c, dem_index k, const contact_gap *gap, contact_instant *now)
{
    dem_index at;
    const impact_target with =
        gap->distance >= -impact_target_depth(c, k, now) ? impact_target_of_node(c, k, now) : (impact_target){0};
    if (with.n == 0) return go_behind(c, k, gap->feature, -gap->distance, now);
    const dem_index side = with.n == 1 ? impact_target_edge(c, k, now, &at) : -1;
    return side >= 0 ? impact_solve(c, side, (impact_target){1, {at}}, now) : impact_solve(c, k, with, now);
}

/* An edge that touches a vertex hits it. One deeper behind the edge than 1e-3 of its length has not come there by a
 * step whose events were found: that is an error. */
static dem_status touch_edge(contact_set *c, dem_index k, const contact_gap *gap, contact_instant *now)
{
    const contact_candidate *candidate = &c->list[k];
    const vec2 ab = vec2_sub(vec2_at(now->x, candidate->other), vec2_at(now->x, candidate->node));
    const vec2 vertex = surface_vertex_at(&c->scene, gap->feature, now->t);
    CHECK(gap->distance >= -1e-3 * vec2_norm(ab), DEM_ERROR_CONTACT,
          "the vertex at (%g, %g) m of obstacle %lld is %g m inside the body, behind the edge from node %lld to %lld, "
          "at t = %.9g s",
          vertex.x, vertex.y, (long long)surface_obstacle(&c->scene, contact_point_feature(candidate, gap->feature)),
          -gap->distance, scene_node(&c->scene, candidate->node), scene_node(&c->scene, candidate->other), now->t);
    return impact_solve(c, k, (impact_target){1, {gap->feature}}, now);
}

dem_status candidate_resolve_touch(contact_set *c, dem_index k, const contact_gap *gap, contact_instant *now)
{
    return candidate_is_edge(&c->list[k]) ? touch_edge(c, k, gap, now) : touch_node(c, k, gap, now);
}

/* A free candidate takes an impact once it is 0.99 of the penetration tolerance deep. */
static dem_status settle_free(contact_set *c, dem_index k, contact_instant *now, bool *changed)
{
    const candidate_positions spot = candidate_place(&c->list[k], now->t, now->x);
    const contact_gap gap = candidate_gap(&c->scene, &c->list[k], &spot);
    if (gap.distance > -touch_share * c->scene.rule.penetration_tolerance) return DEM_OK;
    *changed = true;
    return candidate_resolve_touch(c, k, &gap, now);
}

/* ---- closed candidates ---- */

/* Reports an event that is no impact, and counts it. */
static dem_status enter(contact_set *c, dem_index k, dem_index feature, dem_event_kind kind, contact_instant *now)
{
    const dem_event event = contact_set_event(c, k, feature, kind, now);
    ledger_enter(&c->ledger, &event, now);
    return DEM_OK;
}

/* A contact that would pull opens. Velocities do not jump. */
static dem_status release(contact_set *c, dem_index k, int q, contact_instant *now)
{
    const dem_index feature = c->list[k].closed[q].feature;
    TRY(contact_set_open(c, k, q));
    return enter(c, k, feature, DEM_EVENT_RELEASE, now);
}

/* A node slides past the end of its segment. If the next segment stands in the way (concave), it takes an impact with
 * both. If the next one bends away, or there is none, it falls free. If the next one goes on in line, the node is put
 * on it, and its normal velocity relative to that becomes 0. */
static dem_status pass_node(contact_set *c, dem_index k, bool backwards, contact_instant *now)
{
    contact_candidate *candidate = &c->list[k];
    impact_target next = {.n = 1};
    const dem_index here = candidate->closed[0].feature;
    const obstacle_bend bend = surface_bend(&c->scene, here, backwards, &next.feature[0]);
    TRY(enter(c, k, here, DEM_EVENT_PASS, now));
    if (bend == OBSTACLE_CONCAVE) return impact_solve(c, k, (impact_target){2, {next.feature[0], here}}, now);
    if (bend != OBSTACLE_STRAIGHT) return release(c, k, 0, now);
    const surface_line line = surface_line_at(&c->scene, next.feature[0], now->t);
    const vec2 v = vec2_at(now->v, candidate->node), x = vec2_at(now->x, candidate->node);
    const obstacle_motion wall = surface_motion(&c->scene, next.feature[0], (surface_query){now->t, x});
    candidate->closed[0].feature = next.feature[0];
    contact_set_move(c, candidate->node, vec2_scale(-surface_height(&line, x), line.normal), now->x);
    vec2_put(now->v, candidate->node,
             vec2_along(v, -vec2_dot(obstacle_motion_relative(&wall, v), line.normal), line.normal));
    return DEM_OK;
}

/* The edge that goes on behind the end of edge k, and could take over its vertex; -1 if there is none, or if it has
 * that vertex or two others already. */
static dem_index edge_beyond(const contact_set *c, dem_index k, bool backwards, dem_index feature)
{
    const surface *s = c->surface;
    const dem_index own = k - s->n_nodes, beyond = backwards ? s->previous[own] : s->next[own];
    if (beyond < 0) return -1;
    const contact_candidate *edge = &c->list[contact_set_of_edge(c, beyond)];
    const bool taken = edge->n_closed == 2 || candidate_point_on(edge, feature) >= 0;
    return taken ? -1 : contact_set_of_edge(c, beyond);
}

/* A vertex that has come to the end of an edge: the node there is put on it, and the next edge takes over by an impact.
 * Where the body bends in, the vertex hits that edge. If its rebound would be no more than a hop that counts as rest,
 * it comes to rest in the notch, and both contacts are kept. Otherwise it slides on along the next edge, or leaves if
 * the body bends away too fast. */
static dem_status pass_edge(contact_set *c, dem_index k, int q, bool backwards, contact_instant *now)
{
    const dem_index node = backwards ? c->list[k].node : c->list[k].other, feature = c->list[k].closed[q].feature;
    const dem_index next = edge_beyond(c, k, backwards, feature);
    TRY(enter(c, k, feature, DEM_EVENT_PASS, now));
    if (next < 0) return release(c, k, q, now);
    const vec2 at = surface_vertex_at(&c->scene, feature, now->t);
    contact_set_move(c, node, vec2_sub(at, vec2_at(now->x, node)), now->x);
    if (!impact_rest_in_notch(c, k, next, now)) TRY(release(c, k, q, now));
    return impact_solve(c, next, (impact_target){1, {feature}}, now);
}

/* Whether the point of contact q, at rest, would go against its sign with the forces last solved for. */
static bool slides_against_sign(const contact_set *c, dem_index k, int q, const contact_instant *now)
{
    const contact_frame f = contact_frame_at(&c->scene, &c->list[k], q, instant_state(now));
    const double along = vec2_dot(contact_nodes_sum(&f.nodes, c->forces.a), f.tangent) - f.carried;
    return c->list[k].closed[q].slide * along < 0.0;
}

/* Whether a candidate has changed so often in this step that it is not to turn back again: within a step velocities
 * have the error of its dense output, and where friction lacks less than that a contact which slides turns back at
 * once. */
static bool has_turned_enough(const contact_set *c, dem_index k)
{
    const contact_storm *storm = &c->list[k].storm;
    const dem_index most = c->scene.rule.turns_in_step;
    return most > 0 && storm->step == c->step && storm->in_step >= most;
}

/* A sliding contact that has turned back comes to rest: it is taken to stick, its group is stopped, and forces are
 * solved with it. If abs(T) <= mu N, or it has turned enough, it goes on sticking; else it slides the way that T would
 * have prevented.
 *
 * Where other contacts of the group hold its nodes, N = N_s + beta (T - T_s) for all T that keep it closed, with N_s
 * and T_s of sticking, and its point gets the acceleration gamma (T - T_s), gamma > 0. Let T_s > mu N_s. Sliding asks
 * for T = mu N, so T - T_s = (mu N_s - T_s)/(1 - mu beta): with mu beta > 1 the point goes the wrong way, and the other
 * way of sliding, T = -mu N, is wrong as well. But then N = N_s - beta T_s < 0 without friction: such a contact opens.
 */
static dem_status stop(contact_set *c, dem_index k, int q, contact_instant *now)
{
    contact_point *point = &c->list[k].closed[q];
    const contact_frame f = contact_frame_at(&c->scene, &c->list[k], q, instant_state(now));
    point->slide = 0;
    point->place = f.place;
    impact_group_stop(c, c->forces.group[k], now);
    contact_set_solve_forces(c, k, instant_state(now));
    const contact_force force = {point->force, point->friction};
    point->pinned = has_turned_enough(c, k);
    if (candidate_grip(&c->scene, &c->list[k], q, &f, &force, now->x) < 0.0) {
        point->slide = force.tangent > 0.0 ? -1 : 1;
        contact_set_solve_forces(c, k, instant_state(now));
        if (slides_against_sign(c, k, q, now)) return release(c, k, q, now);
    }
    return enter(c, k, point->feature, DEM_EVENT_STICK, now);
}

/* A sticking contact whose friction exceeds mu N slides the way that friction had prevented, against T. */
static dem_status begin_to_slide(contact_set *c, dem_index k, int q, contact_instant *now)
{
    contact_point *point = &c->list[k].closed[q];
    point->slide = point->friction > 0.0 ? -1 : 1; /* against the friction that held it */
    return enter(c, k, point->feature, DEM_EVENT_SLIP, now);
}

/* Closed contact q with the forces stored last: release comes first, then stick and slip, then the end of the segment
 * or edge. Contacts of a corner have no friction, and no end: they are only released. */
static dem_status settle_contact(contact_set *c, dem_index k, int q, contact_instant *now, bool *changed)
{
    const contact_candidate *candidate = &c->list[k];
    const contact_frame f = contact_frame_at(&c->scene, candidate, q, instant_state(now));
    const contact_force force = {candidate->closed[q].force, candidate->closed[q].friction};
    *changed = true;
    if (force.normal <= 0.0) return release(c, k, q, now);
    const bool held = candidate->closed[q].held;
    if (!held && candidate_turns(&c->scene, candidate, q, &f, now->v)) return stop(c, k, q, now);
    if (!held && candidate_grip(&c->scene, candidate, q, &f, &force, now->x) < 0.0) return begin_to_slide(c, k, q, now);
    const int passed = held ? 0 : candidate_end_passed(&c->scene, candidate, q, instant_state(now));
    if (passed != 0 && candidate_is_edge(candidate)) return pass_edge(c, k, q, passed < 0, now);
    if (passed != 0) return pass_node(c, k, passed < 0, now);
    *changed = false;
    return DEM_OK;
}

/* A candidate with one closed contact that touches something else takes an impact: a node with both surfaces if they
 * form a corner, else with the new one. */
static dem_status settle_other(contact_set *c, dem_index k, contact_instant *now, bool *changed)
{
    const contact_candidate *candidate = &c->list[k];
    const candidate_positions spot = candidate_place(candidate, now->t, now->x);
    const contact_gap gap = candidate_gap(&c->scene, candidate, &spot);
    if (gap.distance > -touch_share * c->scene.rule.penetration_tolerance) return DEM_OK;
    *changed = true;
    if (candidate_is_edge(candidate)) return touch_edge(c, k, &gap, now);
    const double depth = impact_target_depth(c, k, now);
    if (gap.distance < -depth) return go_behind(c, k, gap.feature, -gap.distance, now);
    const dem_index here = candidate->closed[0].feature;
    const bool both =
        impact_target_is_corner(c, gap.feature, here, (surface_query){now->t, vec2_at(now->x, candidate->node)}, depth);
    return impact_solve(c, k, (impact_target){both ? 2 : 1, {gap.feature, here}}, now);
}

/* The forces are solved for in the state as it is: what was stored may be that of before the event. */
static dem_status settle_closed(contact_set *c, dem_index k, contact_instant *now, bool *changed)
{
    contact_set_solve_forces(c, k, instant_state(now));
    for (int q = 0; q < c->list[k].n_closed && !*changed; q++) TRY(settle_contact(c, k, q, now, changed));
    if (*changed || c->list[k].n_closed == 2) return DEM_OK;
    return settle_other(c, k, now, changed);
}

/* Changes of a candidate at once: more go on without time advancing. Random decks have 3 at most. */
enum { most_at_once = 50 };

/* Counts begin anew after the storm time, in another step, and once time has advanced. */
static void count_up(const contact_set *c, contact_storm *storm, double t)
{
    if (t - storm->start > c->scene.rule.storm_time) storm->start = t, storm->n = 0;
    if (storm->step != c->step) storm->step = c->step, storm->in_step = 0;
    if (t - storm->last > scene_instant(&c->scene, t)) storm->at_once = 0;
    storm->last = t;
    storm->idle = 0;
    storm->n++, storm->in_step++, storm->at_once++;
}

/* Counts a change of a candidate. One with more than most_in_step of them in a step asks for a shorter step, as those
 * that follow each other so fast are often due to the error of a long one. One with more than most_at_once at once, or
 * with more than max_impacts within storm_time, is an error in any case. */
static dem_status count(const contact_set *c, contact_candidate *candidate, const contact_instant *now)
{
    const contact_rule *rule = &c->scene.rule;
    const contact_storm *storm = &candidate->storm;
    const char *kind = candidate_is_edge(candidate) ? "the edge from node" : "node";
    const vec2 place = vec2_at(now->x, candidate->node);
    count_up(c, &candidate->storm, now->t);
    CHECK(storm->n <= rule->max_impacts, DEM_ERROR_CONTACT,
          "%s %lld at (%g, %g) m had more than %lld contact events within %g s, at t = %.9g s", kind,
          scene_node(&c->scene, candidate->node), place.x, place.y, (long long)rule->max_impacts, rule->storm_time,
          now->t);
    CHECK(rule->most_in_step == 0 || storm->in_step <= rule->most_in_step, DEM_ERROR_CONTACT,
          "%s %lld at (%g, %g) m had more than %lld contact events in a step, at t = %.9g s", kind,
          scene_node(&c->scene, candidate->node), place.x, place.y, (long long)rule->most_in_step, now->t);
    CHECK(storm->at_once <= most_at_once, DEM_ERROR_CONTACT,
          "%s %lld at (%g, %g) m had more than %d contact events at once, at t = %.9g s: a larger 'rest_speed' may end "
          "them",
          kind, scene_node(&c->scene, candidate->node), place.x, place.y, most_at_once, now->t);
    return DEM_OK;
}

/* More than most_in_step of them ask for a shorter step, or else more than max_impacts are an error, as the run would
 * stand still. Each candidate counts its own, as events elsewhere have nothing to do with it. */
dem_status candidate_count_idle(contact_set *c, dem_index k, const contact_instant *now)
{
    const contact_rule *rule = &c->scene.rule;
    const dem_index most = rule->most_in_step > 0 ? rule->most_in_step : rule->max_impacts;
    contact_candidate *candidate = &c->list[k];
    contact_storm *storm = &candidate->storm;
    if (storm->idle_step != c->step) storm->idle_step = c->step, storm->idle = 0;
    CHECK(++storm->idle <= most, DEM_ERROR_CONTACT,
          "%s %lld had more than %lld contact events in a row that changed nothing, at t = %.9g s",
          candidate_is_edge(candidate) ? "the edge from node" : "node", scene_node(&c->scene, candidate->node),
          (long long)most, now->t);
    return DEM_OK;
}

/* Makes the first change that is due. */
dem_status candidate_resolve(contact_set *c, dem_index k, contact_instant *now, bool *changed)
{
    bool here = false;
    contact_candidate *candidate = &c->list[k];
    if (candidate->clearance.inactive && candidate->n_closed == 0) return DEM_OK;
    TRY(candidate->n_closed == 0 ? settle_free(c, k, now, &here) : settle_closed(c, k, now, &here));
    if (!here) return DEM_OK;
    *changed = true;
    return count(c, candidate, now);
}
